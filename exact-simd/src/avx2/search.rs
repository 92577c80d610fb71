//! What a ray may hit, in the order in which boxes are entered; for lanes of any number.

use core_rt::bvh::Bvh;
use core_rt::kernel::Kernel;
use core_rt::profile::Profile;
use core_rt::stats::Stats;

use super::tree::{Node, Packet, Wide, Word};
use super::walk::{Entered, walk};

pub(super) type RayOf<P> = <<P as Profile>::Kernel as Kernel>::Ray;
pub(super) type DepthOf<P> = <<P as Profile>::Kernel as Kernel>::Depth;

/// What is come upon.
pub(super) enum Found<'t, T, const ROWS: usize, D> {
    /// Triangles, of which some may be hit within the limit.
    Packet(&'t Packet<T, ROWS>, T),
    /// A sphere that is hit, by its index.
    Sphere(u32, D),
}

/// Tells `test` of all that may be hit before the limit that it returns, until it returns none. `reach` is the first.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn search<P: Profile, T: Copy + Default + PartialOrd, const ROWS: usize>(
    (tree, bvh): (&Wide<T, ROWS>, &Bvh<'_, P>),
    ray: &RayOf<P>,
    reach: T,
    stats: &mut impl Stats,
    enter: impl for<'n> Fn(&'n Node<T>, T) -> Entered<'n, T>,
    mut test: impl FnMut(Found<'_, T, ROWS, DepthOf<P>>) -> Option<T>,
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
                        if let Some(depth) = sphere(bvh, ray, index) {
                            limit = test(Found::Sphere(index, depth))?;
                        }
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

/// The hit with a sphere, by the kernel's own test.
#[inline(never)]
fn sphere<P: Profile>(bvh: &Bvh<'_, P>, ray: &RayOf<P>, index: u32) -> Option<DepthOf<P>> {
    P::Kernel::intersect_sphere(ray, bvh.sphere(index)?, index == P::Kernel::skip(ray))
}

/// The nearest of some hits: the smallest (t, id).
pub(super) struct Nearest<D> {
    hit: u32,
    depth: Option<D>,
}

impl<D: Copy> Nearest<D> {
    pub(super) const NONE: Self = Self { hit: core_rt::kernel::NONE, depth: None };

    /// The index of the nearest.
    pub(super) fn hit(&self) -> u32 {
        self.hit
    }

    /// Takes a hit where it is nearer; whether it is.
    #[inline]
    pub(super) fn take<P: Profile<Kernel: Kernel<Depth = D>>>(
        &mut self,
        bvh: &Bvh<'_, P>,
        index: u32,
        depth: D,
    ) -> bool {
        let is_nearer = self.depth.is_none_or(|nearest| match P::Kernel::order(&depth, &nearest) {
            core::cmp::Ordering::Less => true,
            core::cmp::Ordering::Equal => bvh.id(index) < bvh.id(self.hit),
            core::cmp::Ordering::Greater => false,
        });
        if is_nearer {
            *self = Self { hit: index, depth: Some(depth) };
        }
        is_nearer
    }
}
