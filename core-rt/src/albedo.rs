//! The albedo of a point: the material's, times its texture, times the colours of its vertices.

use crate::colour::{Albedo, product};
use crate::kernel::Surface;
use crate::profile::{Need, Profile};
use crate::record::Material;
use crate::scene::Scene;
use crate::shade::SpaceOf;
use crate::space::Space;

/// What the point of a hit gives back of light.
pub(crate) fn albedo<P: Profile>(
    scene: &Scene<'_, P>,
    hit: u32,
    material: &Material,
    surface: &Surface<SpaceOf<P>>,
) -> Albedo {
    let mut albedo = painted(scene, material, surface);
    if P::NEEDS.has(Need::Texture)
        && let Some(texel) = texel(scene, hit, surface)
    {
        albedo = product(&albedo, &texel);
    }
    if P::NEEDS.has(Need::VertexColours)
        && scene.bvh.sphere(hit).is_none()
        && let Some([a, b, c]) = scene.shading.paint.colours_of(hit)
    {
        let channel = |a: u16, b: u16, c: u16| {
            let mixed = SpaceOf::<P>::blend([a.into(), b.into(), c.into()], surface.u, surface.v);
            // Weights are off by their rounding, so at an edge one may be below 0.
            mixed.clamp(0, u16::MAX.into()) as u16
        };
        let mixed = [channel(a[0], b[0], c[0]), channel(a[1], b[1], c[1]), channel(a[2], b[2], c[2])];
        albedo = product(&albedo, &mixed);
    }
    albedo
}

/// The material's own, in one of its cubes or the other.
fn painted<P: Profile>(scene: &Scene<'_, P>, material: &Material, surface: &Surface<SpaceOf<P>>) -> Albedo {
    if P::NEEDS.has(Need::Checker)
        && let Some(checker) = scene.shading.checkers.get(usize::from(material.checker).wrapping_sub(1))
        && SpaceOf::<P>::is_odd(surface.point, SpaceOf::<P>::longest(surface.normal), checker)
    {
        return checker.other;
    }
    material.albedo
}

/// What the texture says there; `None` where there is none, or the triangle does not say where.
fn texel<P: Profile>(scene: &Scene<'_, P>, hit: u32, surface: &Surface<SpaceOf<P>>) -> Option<Albedo> {
    let paint = &scene.shading.paint;
    let texture = paint.textures.get(scene.bvh.triangles.material(hit)? as usize)?;
    let [a, b, c] = paint.uvs_of(hit)?;
    let blend = |a: i32, b: i32, c: i32| SpaceOf::<P>::blend([a, b, c], surface.u, surface.v);
    // A profile without it needs no look at the header.
    let bilinear = P::NEEDS.has(Need::Bilinear) && scene.frame.needs.has(Need::Bilinear);
    texture.look_up(paint.texels, [blend(a[0], b[0], c[0]), blend(a[1], b[1], c[1])], bilinear)
}
