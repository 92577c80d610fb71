//! The nearest hits of camera rays and nothing else, and the picture of them.

use core_rt::bvh::Intersect;
use core_rt::colour::Rgb888;
use core_rt::format::Format;
use core_rt::kernel::NONE;
use core_rt::profile::Profile;
use core_rt::render::Tile;
use core_rt::scene::Scene;
use core_rt::stats::{RayKind, Stats};

/// What hits are painted in.
pub const HITS_FORMAT: Format = Format::Rgb888;

/// How the nearest hits are looked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// One ray at a time.
    Single,
    /// A tile of rays at a time.
    Tile,
}

/// Finds the nearest hits of a tile's camera rays, row by row. `hits` has one entry a pixel, the stack is as deep as the
/// scene's tree, and a tile's rays walk together where there is [room](core_rt::tile::ROOM).
pub fn find<P: Profile>(
    scene: &Scene<'_, P>,
    tile: Tile,
    way: Way,
    hits: &mut [u32],
    room: &mut [u8],
    stack: &mut core_rt::bvh::Stack<P::Kernel>,
    stats: &mut impl Stats,
) {
    let ray = |[x, y]: [u16; 2]| scene.primary(&scene.camera, x, y);
    match way {
        Way::Tile => {
            for _ in 0..tile.pixels() {
                stats.ray(RayKind::Primary);
            }
            scene.bvh.closest_tile(scene.shared_origin(), ray, tile, hits, room, stack, stats);
        }
        Way::Single => {
            for (hit, place) in hits.iter_mut().zip(tile.places()) {
                stats.ray(RayKind::Primary);
                *hit = ray(place).as_ref().map_or(NONE, |ray| scene.bvh.closest(ray, stack, stats));
            }
        }
    }
}

/// Paints hits by their triangles' numbers in the file, which do not depend on the kernel; black for none.
pub fn paint<P: Profile>(scene: &Scene<'_, P>, hits: &[u32], pixels: &mut [u8]) {
    // Taken off one by one: to know how many there are takes a division, which the compiler may move to where time is measured.
    let mut left = pixels;
    for &hit in hits {
        let Some((pixel, rest)) = left.split_first_chunk_mut() else { break };
        *pixel = if hit == NONE { [0; 3] } else { colour(scene.bvh.id(hit)) };
        left = rest;
    }
}

/// A colour that tells neighbours apart and is never black: the number's multiple of 2^24 / golden ratio, which is odd,
/// so that the first 2^24 numbers have as many colours.
#[must_use]
pub fn colour(id: u32) -> Rgb888 {
    let [r, g, b, _] = id.wrapping_add(1).wrapping_mul(0x009e_3779).to_le_bytes();
    [r, g, b]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_all_different_and_not_black() {
        let mut seen = vec![false; 1 << 24];
        for id in 0..(1 << 24) - 1 {
            let [r, g, b] = colour(id);
            let place = u32::from_le_bytes([r, g, b, 0]) as usize;
            assert!(place != 0 && !seen[place], "{id}");
            seen[place] = true;
        }
    }
}
