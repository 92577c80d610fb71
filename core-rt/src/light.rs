//! The light that reaches a point of a surface: from which side, how strong, and what is between.
//!
//! A light counts where it is in front of the shading normal, and nothing opaque is in the open segment to it. What is between may be glass that tints its shadow: then every crossing takes its share, and the way is
//! not bent.

use crate::bvh::{Intersect, Stack};
use crate::colour::{Albedo, Colour, WHITE, product};
use crate::kernel::{Kernel, Surface};
use crate::num::Triple;
use crate::profile::{Need, Profile};
use crate::record::Light;
use crate::scene::Scene;
use crate::shade::{RayOf, Smooth, SpaceOf, UnitOf};
use crate::space::{self, Scalar, Space};
use crate::stats::{RayKind, Stats};

/// Light that has arrived: how strong it is under a right angle, the direction to where it comes from, and the cosine
/// between that and the shading normal.
type Arriving<P> = (space::Light<SpaceOf<P>>, UnitOf<P>, Scalar<SpaceOf<P>>);

/// What arrives of a light, if anything does.
pub(crate) fn arriving<P: Profile>(
    scene: &Scene<'_, P>,
    surface: &Surface<SpaceOf<P>>,
    smooth: Option<Smooth<SpaceOf<P>>>,
    light: &Light,
    hit: u32,
    stack: &mut Stack<P::Kernel>,
    stats: &mut impl Stats,
) -> Option<Arriving<P>> {
    let is_point =
        P::NEEDS.has(Need::PointLight) && (!P::NEEDS.has(Need::DirectionalLight) || light.kind == Light::POINT);
    let towards = if is_point {
        SpaceOf::<P>::towards(surface.point, SpaceOf::<P>::point(light.place))?
    } else {
        SpaceOf::<P>::unit_from_q30(light.place)
    };
    if smooth.is_none_or(|smooth| smooth.lifted == surface.point) {
        SpaceOf::<P>::cosine(surface.normal, towards)?;
    }
    let cosine = SpaceOf::<P>::cosine(smooth.map_or(surface.normal, |smooth| smooth.normal), towards)?;
    let mut tint = WHITE;
    if scene.shadows() {
        stats.ray(RayKind::Shadow);
        let from = &Surface { point: smooth.map_or(surface.point, |smooth| smooth.lifted), ..*surface };
        let shadow = if is_point {
            P::Kernel::segment(scene.settings, from, light.place, hit)
        } else {
            P::Kernel::leaving(scene.settings, from, towards, hit)
        };
        let blocked = shadow.is_some_and(|ray| {
            scene.hits().any(&ray, stack, stats, |between| {
                if P::NEEDS.has(Need::TintedShadow) {
                    tint = product(&tint, &passed(scene, &ray, hit, between, is_point.then_some(light.place)));
                    tint == [0; 3]
                } else {
                    true
                }
            })
        });
        // Told in either case apart: between the two, it would move code of firmware that is told nothing.
        if blocked {
            stats.lit();
            return None;
        }
        stats.lit();
    }
    let mut light_here = <SpaceOf<P> as Space>::Colour::light(&light.radiance);
    if P::NEEDS.has(Need::Falloff) && is_point && light.reach.mantissa != 0 {
        let place = SpaceOf::<P>::point(light.place);
        light_here = SpaceOf::<P>::faded(light_here, surface.point, place, &light.reach);
    }
    if P::NEEDS.has(Need::TintedShadow) {
        light_here = <SpaceOf<P> as Space>::Colour::tinted(light_here, &tint);
    }
    Some((light_here, towards, cosine))
}

/// What a primitive between leaves of light: its tint once for each crossing of its surface, two for a sphere but where the
/// ray starts or the light is in it.
fn passed<P: Profile>(
    scene: &Scene<'_, P>,
    ray: &RayOf<P>,
    start: u32,
    between: u32,
    end: Option<Triple<i32>>,
) -> Albedo {
    let lustre = scene.material(between).and_then(|material| scene.lustre(material));
    let tint = lustre.map_or([0; 3], |lustre| lustre.shadow);
    match scene.bvh.sphere(between) {
        Some(sphere) if tint != [0; 3] => {
            let starts_inside = || P::Kernel::intersect_sphere(ray, sphere, true).is_some();
            let ends_inside = || end.is_some_and(|end| P::Kernel::ball(sphere).contains(end));
            if between == start || starts_inside() || ends_inside() { tint } else { product(&tint, &tint) }
        }
        _ => tint,
    }
}
