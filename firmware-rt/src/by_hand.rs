//! The picture of the smallest profile (one point light on matt, flat triangles, without shadows, to linear RGB888), by a loop
//! in which nothing else ever was: what the tracer's own costs more than this would be for what others need.

use core_rt::bvh::Intersect;
use core_rt::colour::{Colour, Transfer};
use core_rt::kernel::Kernel;
use core_rt::profile::Profile;
use core_rt::render::{Tile, Workspace};
use core_rt::scene::Scene;
use core_rt::space::Space;
use core_rt::stats::NoStats;

type SpaceOf<P> = <<P as Profile>::Kernel as Kernel>::Space;
type ColourOf<P> = <SpaceOf<P> as Space>::Colour;

/// Renders a tile; the bytes of its pixels.
pub(crate) fn draw<P: Profile>(scene: &Scene<'_, P>, tile: Tile, workspace: &mut Workspace<'_, P::Kernel>) -> usize {
    // What a tile's storage is for every profile.
    if workspace.stack.capacity() < usize::from(scene.frame.depth) {
        return 0;
    }
    let hits = workspace.hits.get_mut(..tile.pixels()).unwrap_or_default();
    let ray = |[x, y]: [u16; 2]| P::Kernel::primary(scene.settings, &scene.camera, x, y);
    scene.bvh.closest_tile(Some(&scene.camera), ray, tile, hits, workspace.pixels, workspace.stack, &mut NoStats);
    let pixels = workspace.pixels.as_chunks_mut().0;
    for ((pixel, &hit), place) in pixels.iter_mut().zip(&*hits).zip(tile.places()) {
        let colour = ray(place).and_then(|ray| lit(scene, &ray, hit));
        let colour = colour.unwrap_or_else(|| ColourOf::<P>::constant(&scene.frame.background[0]));
        *pixel = colour.encode(Transfer::Linear);
    }
    3 * tile.pixels()
}

/// What the hit of a ray sends back, by Lambert's law; `None` for a miss.
fn lit<P: Profile>(scene: &Scene<'_, P>, ray: &<P::Kernel as Kernel>::Ray, hit: u32) -> Option<ColourOf<P>> {
    let material = scene.shading.materials.get(scene.bvh.triangles.material(hit)? as usize)?;
    let surface = scene.bvh.triangles.of(hit, |triangle| P::Kernel::resolve(ray, triangle))?;
    let mut colour = ColourOf::<P>::default();
    if material.albedo != [0; 3]
        && let Some(light) = scene.shading.lights.first()
        && let Some(towards) = SpaceOf::<P>::towards(surface.point, SpaceOf::<P>::point(light.place))
        && let Some(cosine) = SpaceOf::<P>::cosine(surface.normal, towards)
    {
        colour = ColourOf::<P>::lit(&ColourOf::<P>::light(&light.radiance), cosine).reflected(&material.albedo);
    }
    Some(colour)
}
