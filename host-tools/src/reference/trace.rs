//! The tree of rays.
//!
//! T. Whitted, "An Improved Illumination Model for Shaded Display", Communications of the ACM 23(6), 1980.

use core_rt::kernel::NONE;
use glam::DVec3;

use super::Reference;
use super::random::Random;
use super::ray::Ray;
use super::surface::Surface;
use crate::witness::{Place, Seen};

/// The share of the pixel, in the brightest channel, below which a ray is not followed.
const CUT_OFF: f64 = 1.0 / (1 << 20) as f64;

/// A ray's place in the tree.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounce {
    /// How often it was reflected or refracted.
    depth: u32,
    /// What of its light reaches the pixel.
    share: DVec3,
    /// Which ray it is.
    pub(super) place: Place,
}

impl Bounce {
    /// The camera ray of a sample.
    pub(super) fn first(sample: u32) -> Self {
        Self { depth: 0, share: DVec3::ONE, place: Place::camera(sample) }
    }

    /// The ray at `place` that adds `weight` of its light to this one's; `None` where that cannot be seen.
    pub(super) fn next(self, place: Place, weight: DVec3) -> Option<Self> {
        let share = self.share * weight;
        (share.max_element() >= CUT_OFF).then_some(Self { depth: self.depth + 1, share, place })
    }
}

impl Reference<'_> {
    /// The light, linear RGB, that reaches a point of a surface from `direction`.
    pub(super) fn trace(
        &self,
        from: &Surface<'_>,
        direction: DVec3,
        bounce: Bounce,
        random: &mut Random,
        seen: &mut Seen,
    ) -> DVec3 {
        if bounce.depth > self.model.render.max_depth {
            return self.background(direction);
        }
        let ray = Ray::new(from.point, direction);
        let nearest = self.closest(&ray, |shape, ray| shape.intersect_from(ray, from.prim, self.contact));
        seen.surface(bounce.place, nearest.map_or(NONE, |(_, prim)| prim));
        match nearest {
            Some((crossing, prim)) => self.shade(&self.surface(&ray, crossing, prim), bounce, random, seen).0,
            None => self.background(direction),
        }
    }
}
