//! What a ray may hit, in the order in which boxes are entered; for lanes of any number.

use core_rt::stats::Stats;

use super::tree::{Node, Packet, Wide, Word};
use super::walk::{Entered, walk};

/// What is come upon.
pub(super) enum Found<'t, T, const ROWS: usize> {
    /// Triangles, of which some may be hit within the limit.
    Packet(&'t Packet<T, ROWS>, T),
    /// A sphere that may be, by its index.
    Sphere(u32, T),
}

/// Tells `test` of all that may be hit before the limit that it returns, until it returns none. `reach` is the first.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn search<T: Copy + Default + PartialOrd, const ROWS: usize>(
    tree: &Wide<T, ROWS>,
    reach: T,
    stats: &mut impl Stats,
    enter: impl for<'n> Fn(&'n Node<T>, T) -> Entered<'n, T>,
    mut test: impl FnMut(Found<'_, T, ROWS>) -> Option<T>,
) {
    let (mut boxes, mut triangles) = (0, 0);
    walk(
        reach,
        |index, limit| {
            let node = tree.nodes.get(index as usize)?;
            boxes += node.count;
            Some(enter(node, limit))
        },
        |leaf, mut limit| {
            match leaf {
                Word::Node(_) => {}
                Word::Packets { first, count } => {
                    for packet in tree.packets.get(first as usize..(first + count) as usize).unwrap_or_default() {
                        triangles += packet.count;
                        limit = test(Found::Packet(packet, limit))?;
                    }
                }
                Word::Spheres(place) => {
                    let [first, count] = tree.spheres.get(place as usize).copied().unwrap_or_default();
                    for index in first..first + count {
                        stats.sphere();
                        limit = test(Found::Sphere(index, limit))?;
                    }
                }
            }
            Some(limit)
        },
    );
    stats.boxes(boxes);
    for _ in 0..triangles {
        stats.triangle();
    }
}
