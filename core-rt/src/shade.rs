//! The light that a surface sends of its own and of the lights: Lambert's law, highlights, hard shadows.
//!
//! `emission + albedo (ambient + sum of visible lights' radiance * cos) + specular * sum of radiance * lobe`. No 1 / pi and
//! no falloff: a light of radiance 1 that shines straight down on a white surface makes it white. A lobe is the cosine
//! between the normal and the direction half way to the light (Blinn, "Models of Light Reflection for Computer Synthesized
//! Pictures", 1977), or between the mirrored view and the light (Phong, "Illumination for Computer Generated Pictures",
//! 1975), to the material's exponent.
//!
//! The shading normal is brought to the geometric normal's side, and that one to the viewer's. A light behind either
//! gives nothing.

use crate::bvh::{Intersect, Stack};
use crate::colour::Colour;
use crate::kernel::{Kernel, NONE, Surface};
use crate::profile::{Need, Profile};
use crate::record::{Light, Lustre, Material};
use crate::scene::Scene;
use crate::space::{Scalar, Space};
use crate::stats::{RayKind, Stats};

pub(crate) type SpaceOf<P> = <<P as Profile>::Kernel as Kernel>::Space;
type UnitOf<P> = <SpaceOf<P> as Space>::Unit;
/// The direction to a light, and the cosine.
type Lit<P> = (UnitOf<P>, Scalar<SpaceOf<P>>);
pub(crate) type ColourOf<P> = <SpaceOf<P> as Space>::Colour;
pub(crate) type RayOf<P> = <<P as Profile>::Kernel as Kernel>::Ray;

/// A surface with the light that it sends, and what rays go on by.
#[derive(Debug)]
pub(crate) struct Shaded<'a, P: Profile> {
    pub(crate) surface: Surface<SpaceOf<P>>,
    /// The shading normal.
    pub(crate) normal: UnitOf<P>,
    /// `None` for a matt surface.
    pub(crate) lustre: Option<&'a Lustre>,
    pub(crate) colour: ColourOf<P>,
}

/// The surface that a ray hits, shaded; `None` for a miss.
pub(crate) fn shade<'a, P: Profile>(
    scene: &Scene<'a, P>,
    ray: &RayOf<P>,
    hit: u32,
    stack: &mut Stack<P::Kernel>,
    stats: &mut impl Stats,
) -> Option<Shaded<'a, P>> {
    let (surface, material) = scene.surface(ray, hit)?;
    let lustre = scene.lustre(material);
    let normal = shading_normal(scene, hit, &surface);
    let shine = lustre.filter(|lustre| P::NEEDS.highlights() && !lustre.specular_is_black());
    let along = shine.map(|_| P::Kernel::heading(ray));
    let mut arriving = ColourOf::<P>::default();
    let mut shining = ColourOf::<P>::default();
    if P::NEEDS.has(Need::Ambient) {
        arriving = Colour::constant(&scene.header.ambient);
    }
    for light in scene.shading.lights {
        let Some((towards, cosine)) = direct(scene, &surface, normal, light, hit, stack, stats) else { continue };
        arriving = arriving.plus(Colour::lit(&light.radiance, cosine));
        if let Some((lustre, along)) = shine.zip(along) {
            let lobe = lobe::<P>(lustre, along, normal, towards);
            shining = shining.plus(Colour::lit(&light.radiance, lobe));
        }
    }
    let mut colour = arriving.reflected(&material.albedo);
    if let Some(lustre) = shine {
        colour = colour.plus(shining.reflected(&lustre.specular).doubled(lustre.gain.into()));
    }
    if P::NEEDS.has(Need::Emission) && !material.emission.is_black() {
        colour = colour.plus(Colour::constant(&material.emission));
    }
    Some(Shaded { surface, normal, lustre, colour })
}

/// How much of a light is seen in a highlight.
fn lobe<P: Profile>(lustre: &Lustre, along: UnitOf<P>, normal: UnitOf<P>, towards: UnitOf<P>) -> Scalar<SpaceOf<P>> {
    let needs = P::NEEDS;
    let phong = needs.has(Need::Phong) && (!needs.has(Need::BlinnPhong) || lustre.flags & Lustre::PHONG != 0);
    let (a, b) = if phong {
        (SpaceOf::<P>::reflect(along, normal), towards)
    } else {
        // Opposite directions have no half way; then the light is behind.
        let view = SpaceOf::<P>::negate(along);
        (SpaceOf::<P>::halfway(towards, view).unwrap_or(view), normal)
    };
    SpaceOf::<P>::lobe(a, b, lustre.exponent_q2)
}

/// The interpolated normal on the geometric normal's side, or that one for a flat triangle or a sphere.
fn shading_normal<P: Profile>(scene: &Scene<'_, P>, hit: u32, surface: &Surface<SpaceOf<P>>) -> UnitOf<P> {
    if !P::NEEDS.has(Need::SmoothNormals) || scene.bvh.sphere(hit).is_some() {
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

/// The direction to a light and the cosine there, if it is in front of the surface and nothing is between.
fn direct<P: Profile>(
    scene: &Scene<'_, P>,
    surface: &Surface<SpaceOf<P>>,
    normal: UnitOf<P>,
    light: &Light,
    hit: u32,
    stack: &mut Stack<P::Kernel>,
    stats: &mut impl Stats,
) -> Option<Lit<P>> {
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
    Some((towards, cosine))
}

impl<'a, P: Profile> Scene<'a, P> {
    /// The surface and the material of a hit; `None` for a miss.
    #[inline(always)]
    fn surface(&self, ray: &RayOf<P>, hit: u32) -> Option<(Surface<SpaceOf<P>>, &'a Material)> {
        if hit == NONE {
            return None;
        }
        if let Some(sphere) = self.bvh.sphere(hit) {
            let material = self.shading.materials.get(P::Kernel::sphere_material(sphere) as usize)?;
            return Some((P::Kernel::resolve_sphere(ray, sphere), material));
        }
        let triangle = self.bvh.triangles.get(hit as usize)?;
        let material = self.shading.materials.get(P::Kernel::material(triangle) as usize)?;
        Some((P::Kernel::resolve(ray, triangle), material))
    }

    /// What a material is more than matt.
    #[inline]
    fn lustre(&self, material: &Material) -> Option<&'a Lustre> {
        if !P::NEEDS.highlights() && !P::NEEDS.branches() {
            return None;
        }
        self.shading.lustres.get(usize::from(material.lustre).wrapping_sub(1))
    }
}
