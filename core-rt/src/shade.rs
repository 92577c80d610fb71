//! The light that a surface sends of its own and of the lights: Lambert's law, highlights.
//!
//! `emission + albedo (ambient + sum of E cos) + specular * sum of E lobe`, for the light E that arrives. No 1 / pi: a light of
//! radiance 1 that shines straight down on a white surface makes it white. A lobe is the cosine between the normal and the
//! direction half way to the light (Blinn, "Models of Light Reflection for Computer Synthesized Pictures", 1977), or between
//! the mirrored view and the light (Phong, "Illumination for Computer Generated Pictures", 1975), to the material's exponent.
//!
//! The shading normal is brought to the geometric normal's side, and that one to the viewer's.

use crate::albedo::albedo;
use crate::bvh::Stack;
use crate::colour::{Colour, towards_white};
use crate::kernel::{Kernel, NONE, Surface};
use crate::light::arriving;
use crate::profile::{Need, Profile};
use crate::record::{Lustre, Material};
use crate::scene::Scene;
use crate::space::{Scalar, Space};
use crate::stats::Stats;

pub(crate) type SpaceOf<P> = <<P as Profile>::Kernel as Kernel>::Space;
pub(crate) type UnitOf<P> = <SpaceOf<P> as Space>::Unit;
pub(crate) type ColourOf<P> = <SpaceOf<P> as Space>::Colour;
pub(crate) type RayOf<P> = <<P as Profile>::Kernel as Kernel>::Ray;

/// A surface with the light that it sends, and what rays go on by.
#[derive(Debug)]
pub(crate) struct Shaded<'a, P: Profile> {
    pub(crate) surface: Surface<SpaceOf<P>>,
    /// The shading normal.
    pub(crate) normal: UnitOf<P>,
    /// The cosine between it and the way back, if that is in front of it; only where there is a lustre.
    pub(crate) cosine: Option<Scalar<SpaceOf<P>>>,
    /// `None` for a matt surface.
    pub(crate) lustre: Option<&'a Lustre>,
    /// How far a metal's colours are on the way to white.
    pub(crate) whiteness: u16,
    pub(crate) colour: ColourOf<P>,
}

/// The light alone that the surface sends which a ray hits, where no ray goes on from it; `None` for a miss.
pub(crate) fn sent<P: Profile>(
    scene: &Scene<'_, P>,
    ray: &RayOf<P>,
    hit: u32,
    stack: &mut Stack<P::Kernel>,
    stats: &mut impl Stats,
) -> Option<ColourOf<P>> {
    shaded(scene, ray, hit, stack, stats).map(|shaded| shaded.colour)
}

/// The surface that a ray hits, shaded; `None` for a miss.
pub(crate) fn shade<'a, P: Profile>(
    scene: &Scene<'a, P>,
    ray: &RayOf<P>,
    hit: u32,
    stack: &mut Stack<P::Kernel>,
    stats: &mut impl Stats,
) -> Option<Shaded<'a, P>> {
    shaded(scene, ray, hit, stack, stats)
}

/// See [`shade`]. A part of the caller, so that what that does not ask for is not made.
#[inline(always)]
fn shaded<'a, P: Profile>(
    scene: &Scene<'a, P>,
    ray: &RayOf<P>,
    hit: u32,
    stack: &mut Stack<P::Kernel>,
    stats: &mut impl Stats,
) -> Option<Shaded<'a, P>> {
    let (surface, material) = scene.surface(ray, hit)?;
    let lustre = scene.lustre(material);
    let smooth = smooth(scene, hit, &surface);
    let normal = smooth.map_or(surface.normal, |smooth| smooth.normal);
    let along = lustre.map(|_| P::Kernel::heading(ray));
    let cosine = along.and_then(|along| SpaceOf::<P>::cosine(SpaceOf::<P>::negate(along), normal));
    let whiteness = match lustre {
        Some(lustre) if P::NEEDS.has(Need::Schlick) && lustre.flags & Lustre::METAL != 0 => {
            ColourOf::<P>::share(SpaceOf::<P>::fresnel(cosine.unwrap_or_default(), 0))
        }
        _ => 0,
    };
    let albedo = albedo(scene, hit, material, &surface);
    let shine = lustre.zip(along).filter(|(lustre, _)| P::NEEDS.highlights() && !lustre.specular_is_black());
    let mut colour = ColourOf::<P>::default();
    // What gives nothing back need not be lit.
    if albedo != [0; 3] || shine.is_some() {
        let mut diffuse = ColourOf::<P>::default();
        let mut shining = ColourOf::<P>::default();
        if P::NEEDS.has(Need::Ambient) {
            diffuse = Colour::constant(&scene.frame.ambient);
        }
        let mut add = |number, light| {
            let Some((light, towards, cosine)) = arriving(scene, &surface, smooth, light, hit, stack, stats) else {
                return;
            };
            stats.light(number);
            diffuse = diffuse.plus(Colour::lit(&light, cosine));
            if P::NEEDS.highlights()
                && let Some((lustre, along)) = shine
            {
                let lobe = lobe::<P>(lustre, along, normal, towards);
                shining = shining.plus(Colour::lit(&light, lobe));
            }
        };
        // One light takes no loop.
        if P::NEEDS.has(Need::SeveralLights) {
            for (number, light) in (0..).zip(scene.shading.lights) {
                add(number, light);
            }
        } else if let Some(light) = scene.shading.lights.first() {
            add(0, light);
        }
        colour = diffuse.reflected(&albedo);
        if P::NEEDS.highlights()
            && let Some((lustre, _)) = shine
        {
            let specular = towards_white(&lustre.specular, whiteness);
            colour = colour.plus(shining.reflected(&specular).doubled(lustre.gain.into()));
        }
    }
    if P::NEEDS.has(Need::Emission) && !material.emission.is_black() {
        colour = colour.plus(Colour::constant(&material.emission));
    }
    Some(Shaded { surface, normal, cosine, lustre, whiteness, colour })
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

/// What a surface has between smooth corners.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Smooth<S: Space> {
    /// The interpolated normal, on the geometric normal's side.
    pub(crate) normal: S::Unit,
    /// From where lights are looked for: the surface that the normals speak of, where it is convex, is above the triangle,
    /// whose own shadow would show as a dark band otherwise.
    pub(crate) lifted: S::Point,
}

/// The smooth surface at a hit; `None` for a flat triangle and for a sphere.
fn smooth<P: Profile>(scene: &Scene<'_, P>, hit: u32, surface: &Surface<SpaceOf<P>>) -> Option<Smooth<SpaceOf<P>>> {
    if !P::NEEDS.has(Need::SmoothNormals) {
        return None;
    }
    // There is none for a sphere.
    let vertices = scene.bvh.triangles.vertices(hit)?;
    let mut normals = scene.shading.normals(hit)?;
    let mut normal = SpaceOf::<P>::interpolate(normals, surface.u, surface.v)?;
    if !SpaceOf::<P>::aligned(normal, surface.normal) {
        normal = SpaceOf::<P>::negate(normal);
        normals = normals.map(SpaceOf::<P>::negate);
    }
    let mut lifted = surface.point;
    // A triangle with a normal far off its own is creased, and no part of a smooth surface.
    if scene.shadows() && normals.iter().all(|&normal| SpaceOf::<P>::near(normal, surface.normal)) {
        let corners = vertices.map(SpaceOf::<P>::point);
        let (low, high) = (P::Kernel::MARGIN, (1 << P::Kernel::GRID_BITS) - 1 - P::Kernel::MARGIN);
        let range = [low, high].map(|c| SpaceOf::<P>::point([c; 3]));
        lifted = SpaceOf::<P>::lift(lifted, corners, normals, [surface.u, surface.v], range);
    }
    Some(Smooth { normal, lifted })
}

impl<'a, P: Profile> Scene<'a, P> {
    /// The surface and the material of a hit; `None` for a miss.
    #[inline(always)]
    fn surface(&self, ray: &RayOf<P>, hit: u32) -> Option<(Surface<SpaceOf<P>>, &'a Material)> {
        // No hit is past the end of triangles; past that of spheres too, but then it takes a look at both.
        if P::NEEDS.has(Need::Spheres) && hit == NONE {
            return None;
        }
        let (number, mut surface) = match self.bvh.sphere(hit) {
            Some(sphere) => (P::Kernel::sphere_material(sphere), P::Kernel::resolve_sphere(ray, sphere)),
            None => {
                let surface = self.bvh.triangles.of(hit, |triangle| P::Kernel::resolve(ray, triangle))?;
                (self.bvh.triangles.material(hit)?, surface)
            }
        };
        let material = self.shading.materials.get(number as usize)?;
        // What nothing reads need not be worked out.
        if !P::NEEDS.weights() {
            (surface.u, surface.v) = Default::default();
        }
        Some((surface, material))
    }

    /// The material of a hit; `None` for a miss.
    #[inline(always)]
    pub(crate) fn material(&self, hit: u32) -> Option<&'a Material> {
        if hit == NONE {
            return None;
        }
        let number = match self.bvh.sphere(hit) {
            Some(sphere) => P::Kernel::sphere_material(sphere),
            None => self.bvh.triangles.material(hit)?,
        };
        self.shading.materials.get(number as usize)
    }

    /// What a material is more than matt.
    #[inline]
    pub(crate) fn lustre(&self, material: &Material) -> Option<&'a Lustre> {
        if !P::NEEDS.lustres() {
            return None;
        }
        self.shading.lustres.get(usize::from(material.lustre).wrapping_sub(1))
    }
}
