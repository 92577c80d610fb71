//! Lambert's law with hard shadows: the radiance that a surface sends towards the ray that hit it.
//!
//! `emission + albedo (ambient + sum of visible lights' radiance * cos)`. No 1 / pi and no falloff: a light of radiance 1
//! that shines straight down on a white surface makes it white.
//!
//! The shading normal is brought to the geometric normal's side, and that one to the viewer's. A light behind either
//! gives nothing.

use crate::bvh::{Intersect, Stack};
use crate::colour::Colour;
use crate::kernel::{Kernel, NONE, Surface};
use crate::profile::{Need, Profile};
use crate::record::Light;
use crate::scene::Scene;
use crate::space::Space;
use crate::stats::{RayKind, Stats};

type SpaceOf<P> = <<P as Profile>::Kernel as Kernel>::Space;
type ColourOf<P> = <SpaceOf<P> as Space>::Colour;
type RayOf<P> = <<P as Profile>::Kernel as Kernel>::Ray;

/// What a ray sees whose nearest hit is known.
pub(crate) fn radiance<P: Profile>(
    scene: &Scene<'_, P>,
    ray: &RayOf<P>,
    hit: u32,
    stack: &mut Stack<P::Kernel>,
    stats: &mut impl Stats,
) -> ColourOf<P> {
    let Some((triangle, material)) = scene.surface(hit) else {
        return Colour::constant(&scene.header.background);
    };
    let surface = P::Kernel::resolve(ray, triangle);
    let normal = shading_normal(scene, hit, &surface);
    let mut arriving = ColourOf::<P>::default();
    if P::NEEDS.has(Need::Ambient) {
        arriving = Colour::constant(&scene.header.ambient);
    }
    for light in scene.shading.lights {
        if let Some(lit) = direct(scene, &surface, normal, light, hit, stack, stats) {
            arriving = arriving.plus(lit);
        }
    }
    let leaving = arriving.reflected(&material.albedo);
    if P::NEEDS.has(Need::Emission) && !material.emission.is_black() {
        leaving.plus(Colour::constant(&material.emission))
    } else {
        leaving
    }
}

/// The interpolated normal on the geometric normal's side, or that one for a flat triangle.
fn shading_normal<P: Profile>(
    scene: &Scene<'_, P>,
    hit: u32,
    surface: &Surface<SpaceOf<P>>,
) -> <SpaceOf<P> as Space>::Unit {
    if !P::NEEDS.has(Need::SmoothNormals) {
        return surface.normal;
    }
    let interpolated = scene
        .shading
        .normals(hit)
        .and_then(|normals| <SpaceOf<P> as Space>::interpolate(normals, surface.u, surface.v));
    match interpolated {
        None => surface.normal,
        Some(normal) if <SpaceOf<P> as Space>::aligned(normal, surface.normal) => normal,
        Some(normal) => <SpaceOf<P> as Space>::negate(normal),
    }
}

/// What one light adds, if it is in front of the surface and nothing is between.
fn direct<P: Profile>(
    scene: &Scene<'_, P>,
    surface: &Surface<SpaceOf<P>>,
    normal: <SpaceOf<P> as Space>::Unit,
    light: &Light,
    hit: u32,
    stack: &mut Stack<P::Kernel>,
    stats: &mut impl Stats,
) -> Option<ColourOf<P>> {
    let point_light =
        P::NEEDS.has(Need::PointLight) && (!P::NEEDS.has(Need::DirectionalLight) || light.kind == Light::POINT);
    let towards = if point_light {
        SpaceOf::<P>::towards(surface.point, SpaceOf::<P>::point(light.place))?
    } else {
        SpaceOf::<P>::unit_from_q30(light.place)
    };
    SpaceOf::<P>::cosine(surface.normal, towards)?;
    let cosine = SpaceOf::<P>::cosine(normal, towards)?;
    if P::NEEDS.has(Need::Shadows) {
        let shadow = if point_light {
            P::Kernel::segment(scene.settings, surface, light.place, hit)
        } else {
            P::Kernel::leaving(scene.settings, surface, towards, hit)
        };
        stats.ray(RayKind::Shadow);
        if shadow.is_some_and(|ray| scene.bvh.any(&ray, stack, stats)) {
            return None;
        }
    }
    Some(Colour::lit(&light.radiance, cosine))
}

impl<P: Profile> Scene<'_, P> {
    /// The triangle and the material of a hit; `None` for a miss.
    #[inline]
    fn surface(&self, hit: u32) -> Option<(&<P::Kernel as Kernel>::Triangle, &crate::record::Material)> {
        if hit == NONE {
            return None;
        }
        let triangle = self.bvh.triangles.get(hit as usize)?;
        Some((triangle, self.shading.materials.get(P::Kernel::material(triangle) as usize)?))
    }
}
