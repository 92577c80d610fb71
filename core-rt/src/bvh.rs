//! Bounding volume hierarchy: packed references, and the one traversal for all kernels.
//!
//! A binary tree whose nodes hold both children's boxes, so that one record decides which way to go. It is laid out in
//! preorder, and triangles stand in the order of the leaves. The near child is visited first, the far one waits on a
//! stack that the caller provides; its depth is known when the tree is built (Shirley & Morley, "Realistic Ray Tracing"
//! 2003, 10; Wald, Boulos & Shirley, "Ray Tracing Deformable Scenes using Dynamic BVHs", 2007).
//!
//! The nearest hit is the smallest (t, id), in exact order, with the id that the triangle has in its file. So the answer
//! does not depend on the order of the visit, and nothing is pruned at equal t.

use core::cmp::Ordering;

use heapless::VecView;

use crate::kernel::{Kernel, NONE};
use crate::section::Integers;
use crate::stats::Stats;

/// What a child is: another node, or a run of triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Child {
    /// The index of a node.
    Node(u32),
    /// Triangles `first .. first + count`.
    Leaf {
        /// The first triangle.
        first: u32,
        /// How many, 1 to [`Child::COUNT_MAX`].
        count: u32,
    },
}

impl Child {
    /// The largest leaf.
    pub const COUNT_MAX: u32 = 64;
    /// Triangles and nodes are numbered below this.
    pub const INDEX_END: u32 = 1 << 25;

    /// Bit 31: a leaf; bits 25 to 30: its count less one; the rest: the index.
    #[must_use]
    pub const fn pack(self) -> u32 {
        match self {
            Self::Node(index) => index,
            Self::Leaf { first, count } => 1 << 31 | (count - 1) << 25 | first,
        }
    }

    /// The inverse of [`Child::pack`]; every word is some child.
    #[inline]
    #[must_use]
    pub const fn unpack(word: u32) -> Self {
        if word >> 31 == 0 {
            Self::Node(word)
        } else {
            Self::Leaf { first: word & (Self::INDEX_END - 1), count: (word >> 25 & 63) + 1 }
        }
    }
}

/// A subtree that waits, and where the ray enters it.
pub type Waiting<K> = (u32, <K as Kernel>::Distance);

/// The traversal's stack. One entry per level of the tree is enough.
pub type Stack<K> = VecView<Waiting<K>>;

/// The nearest hit's place among the records, for exactly one ray at a time or for a tile of camera rays.
///
/// Traversals return a record's index alone; [`Kernel::resolve`] gives the rest from (ray, index).
pub trait Intersect<K: Kernel> {
    /// The nearest hit, the smallest (t, id), or [`NONE`].
    fn closest(&self, ray: &K::Ray, stack: &mut Stack<K>, stats: &mut impl Stats) -> u32;

    /// Whether anything that is hit blocks, by its index. Whatever is hit is asked about once.
    fn any(&self, ray: &K::Ray, stack: &mut Stack<K>, stats: &mut impl Stats, blocks: impl FnMut(u32) -> bool) -> bool;

    /// The nearest hits of a tile of rays, row by row; a kernel that can may walk the tree once for all of them.
    fn closest_tile(
        &self,
        rays: impl Iterator<Item = Option<K::Ray>>,
        hits: &mut [u32],
        stack: &mut Stack<K>,
        stats: &mut impl Stats,
    ) {
        for (ray, hit) in rays.zip(hits) {
            *hit = ray.map_or(NONE, |ray| self.closest(&ray, stack, stats));
        }
    }
}

/// A tree over a blob's sections.
#[derive(Clone, Copy, Debug)]
pub struct Bvh<'a, K: Kernel> {
    /// The root, packed.
    pub root: u32,
    /// Nodes in preorder.
    pub nodes: &'a [K::Node],
    /// Triangles in the order of the leaves.
    pub triangles: &'a [K::Triangle],
    /// The id of each triangle: its index in the file.
    pub ids: Integers<'a>,
}

impl<K: Kernel> Bvh<'_, K> {
    /// Visits every triangle that may be hit before the limit that `visit` returns, nearest boxes first, until it returns
    /// none.
    #[inline(always)]
    fn walk(
        &self,
        ray: &K::Ray,
        stack: &mut Stack<K>,
        stats: &mut impl Stats,
        mut visit: impl FnMut(u32, &K::Triangle) -> Option<K::Distance>,
    ) {
        let mut limit = K::reach(ray);
        let (skip, octant) = (K::skip(ray), K::octant(ray));
        let mut next = Some(self.root);
        stack.clear();
        while let Some((first, count)) = next.and_then(|child| self.leaf(octant, ray, child, limit, stack, stats)) {
            let run = self.triangles.get(first as usize..(first + count) as usize).unwrap_or_default();
            for (index, triangle) in (first..).zip(run) {
                if index != skip {
                    stats.triangle();
                    match visit(index, triangle) {
                        Some(nearer) => limit = nearer,
                        None => return,
                    }
                }
            }
            next = waiting::<K>(stack, limit);
        }
    }

    /// The first leaf at or below `child`, or below what waits, that the ray enters before the limit: its first triangle
    /// and their count. One copy an octant, of the descent alone: it is most of the work and little code.
    #[inline(always)]
    fn leaf(
        &self,
        octant: usize,
        ray: &K::Ray,
        child: u32,
        limit: K::Distance,
        stack: &mut Stack<K>,
        stats: &mut impl Stats,
    ) -> Option<(u32, u32)> {
        match octant {
            0 => self.leaf_in::<0>(ray, child, limit, stack, stats),
            1 => self.leaf_in::<1>(ray, child, limit, stack, stats),
            2 => self.leaf_in::<2>(ray, child, limit, stack, stats),
            3 => self.leaf_in::<3>(ray, child, limit, stack, stats),
            4 => self.leaf_in::<4>(ray, child, limit, stack, stats),
            5 => self.leaf_in::<5>(ray, child, limit, stack, stats),
            6 => self.leaf_in::<6>(ray, child, limit, stack, stats),
            _ => self.leaf_in::<7>(ray, child, limit, stack, stats),
        }
    }

    #[inline(never)]
    fn leaf_in<const OCTANT: usize>(
        &self,
        ray: &K::Ray,
        mut child: u32,
        limit: K::Distance,
        stack: &mut Stack<K>,
        stats: &mut impl Stats,
    ) -> Option<(u32, u32)> {
        loop {
            let index = match Child::unpack(child) {
                Child::Leaf { first, count } => return Some((first, count)),
                Child::Node(index) => index,
            };
            // A checked scene has the node; an end without it is what a traversal of nothing is.
            let node = self.nodes.get(index as usize)?;
            stats.boxes(2);
            let [first, second] = K::children(node);
            child = match K::enter::<OCTANT>(ray, node, limit) {
                [Some(a), Some(b)] => {
                    let (near, far) = if b < a { (second, (first, a)) } else { (first, (second, b)) };
                    // A checked tree is no deeper than the stack.
                    let _ = stack.push(far);
                    near
                }
                [Some(_), None] => first,
                [None, Some(_)] => second,
                [None, None] => waiting::<K>(stack, limit)?,
            };
        }
    }
}

/// The next subtree that may hold something before the limit.
#[inline(always)]
fn waiting<K: Kernel>(stack: &mut Stack<K>, limit: K::Distance) -> Option<u32> {
    while let Some((waiting, entry)) = stack.pop() {
        if K::within(entry, limit) {
            return Some(waiting);
        }
    }
    None
}

impl<K: Kernel> Intersect<K> for Bvh<'_, K> {
    fn closest(&self, ray: &K::Ray, stack: &mut Stack<K>, stats: &mut impl Stats) -> u32 {
        let mut best: Option<K::Depth> = None;
        let mut hit = NONE;
        let mut limit = K::reach(ray);
        self.walk(ray, stack, stats, |index, triangle| {
            if let Some(depth) = K::intersect(ray, triangle) {
                let nearer = match &best {
                    None => true,
                    Some(best) => match K::order(&depth, best) {
                        Ordering::Less => true,
                        Ordering::Equal => self.ids.get(index) < self.ids.get(hit),
                        Ordering::Greater => false,
                    },
                };
                if nearer {
                    limit = K::limit(&depth);
                    best = Some(depth);
                    hit = index;
                }
            }
            Some(limit)
        });
        hit
    }

    fn any(
        &self,
        ray: &K::Ray,
        stack: &mut Stack<K>,
        stats: &mut impl Stats,
        mut blocks: impl FnMut(u32) -> bool,
    ) -> bool {
        let mut hit = false;
        let limit = K::reach(ray);
        self.walk(ray, stack, stats, |index, triangle| {
            hit = K::intersect(ray, triangle).is_some() && blocks(index);
            (!hit).then_some(limit)
        });
        hit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn children_survive_packing() {
        for child in [
            Child::Node(0),
            Child::Node(Child::INDEX_END - 1),
            Child::Leaf { first: 0, count: 1 },
            Child::Leaf { first: Child::INDEX_END - 1, count: Child::COUNT_MAX },
        ] {
            assert_eq!(Child::unpack(child.pack()), child);
        }
    }
}
