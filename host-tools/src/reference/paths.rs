//! A path from the camera: at each surface it goes on in one direction, chosen at random.
//!
//! J. T. Kajiya, "The Rendering Equation", SIGGRAPH 1986. What lights without extent send is added at each surface, since no path
//! would ever meet them.

use core_rt::kernel::NONE;
use glam::DVec3;

use super::Reference;
use super::optics::reflect;
use super::random::Random;
use super::ray::Ray;
use super::shade::Ways;
use super::shape::Shape;
use super::surface::Surface;
use crate::witness::{Place, Seen};

impl Reference<'_> {
    /// The light, linear RGB, that comes along the path on which `surface` is the first, and the lights that contribute
    /// there.
    pub(super) fn path(
        &self,
        surface: Surface<'_>,
        random: &mut Random,
        place: Place,
        seen: &mut Seen,
    ) -> (DVec3, u64) {
        let (mut surface, mut place) = (surface, place);
        let (mut share, mut colour) = (DVec3::ONE, DVec3::ZERO);
        let mut first = None;
        for depth in 0.. {
            let ways = surface.ways();
            let (sent, lights) = self.sent(&surface, &ways, DVec3::ZERO, place, seen);
            colour += share * sent;
            first.get_or_insert(lights);
            if depth == self.model.render.max_depth {
                break;
            }
            let Some((direction, weight)) = surface.goes_on(&ways, random) else { break };
            share *= weight;
            place = place.mirrored();
            let ray = Ray::new(surface.point, direction);
            let from = surface.prim;
            let nearest = self.closest(&ray, |shape: &Shape, ray| shape.intersect_from(ray, from, self.contact));
            seen.surface(place, nearest.map_or(NONE, |(_, prim)| prim));
            let Some((crossing, prim)) = nearest else {
                colour += share * self.background(direction);
                break;
            };
            surface = self.surface(&ray, crossing, prim);
        }
        (colour, first.unwrap_or(0))
    }
}

impl Surface<'_> {
    /// Where the path goes on, a direction of unit length, and by how much what comes from there is multiplied; `None` where
    /// the surface gives nothing back. A way is as probable as the largest channel of its weight.
    fn goes_on(&self, ways: &Ways, random: &mut Random) -> Option<(DVec3, DVec3)> {
        let (mirrored, mirrored_weight) = ways.mirrored;
        let (refracted, refracted_weight) = ways.refracted.unwrap_or((mirrored, DVec3::ZERO));
        let weights = [ways.diffuse, mirrored_weight, refracted_weight];
        let likely = weights.map(DVec3::max_element);
        let all: f64 = likely.iter().sum();
        let mut left = random.unit() * all;
        // Where rounding leaves something after the last way, that is taken; a way of weight zero never is.
        let last = likely.iter().rposition(|&likely| likely > 0.0)?;
        let way = likely[..last].iter().position(|&likely| {
            left -= likely;
            left < 0.0
        });
        let way = way.unwrap_or(last);
        let direction = match way {
            0 => self.diffuse(random),
            1 => self.strewn(mirrored, random),
            _ => refracted,
        };
        Some((direction, weights[way] * (all / likely[way])))
    }

    /// A direction above the surface, as likely as the cosine to its normal.
    fn diffuse(&self, random: &mut Random) -> DVec3 {
        self.above((self.normal + random.on_sphere()).try_normalize().unwrap_or(self.normal))
    }

    /// A mirrored direction, strewn by as much as the surface is rough.
    pub(super) fn strewn(&self, mirrored: DVec3, random: &mut Random) -> DVec3 {
        let roughness = self.material.roughness;
        if roughness == 0.0 {
            return mirrored;
        }
        self.above((mirrored + random.on_sphere() * roughness).try_normalize().unwrap_or(mirrored))
    }

    /// The direction itself, or its mirror image where it leads into the surface.
    fn above(&self, direction: DVec3) -> DVec3 {
        if direction.dot(self.geometric_normal) < 0.0 { reflect(direction, self.geometric_normal) } else { direction }
    }
}
