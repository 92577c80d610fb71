//! Bounding volume hierarchy: packed references, and the one traversal for all kernels.
//!
//! A binary tree whose nodes hold both children's boxes, so that one record decides which way to go. It is laid out in
//! preorder, and triangles stand in the order of the leaves, and so do spheres. A leaf holds either; primitives are numbered
//! through, triangles first. The near child is visited first, the far one waits on a
//! stack that the caller provides; its depth is known when the tree is built (Shirley & Morley, "Realistic Ray Tracing"
//! 2003, 10; Wald, Boulos & Shirley, "Ray Tracing Deformable Scenes using Dynamic BVHs", 2007).
//!
//! The nearest hit is the smallest (t, id), in exact order, with the id that the triangle has in its file. So the answer
//! does not depend on the order of the visit, and nothing is pruned at equal t.

mod drawing;
mod rows;
mod together;
mod walk;

pub use walk::{InPlace, Walk};

use core::cmp::Ordering;
use core::fmt::Debug;
use core::num::NonZeroU32;

use heapless::VecView;

use crate::camera::Camera;
use crate::kernel::{ANY_OCTANT, Bounds, Kernel, NONE};
use crate::mesh::Mesh;
use crate::profile::{Need, Prefer, Profile};
use crate::render::Tile;
use crate::section::Integers;
use crate::stats::Stats;

/// What a child is: another node, or a run of triangles or of spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Child {
    /// The index of a node.
    Node(u32),
    /// Primitives `first .. first + count`, all of them triangles or all of them spheres.
    Leaf {
        /// The first primitive.
        first: u32,
        /// How many, 1 to [`Child::COUNT_MAX`].
        count: u32,
    },
}

impl Child {
    /// The largest leaf.
    pub const COUNT_MAX: u32 = 64;
    /// Primitives and nodes are numbered below this.
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

    /// The nearest hits of a tile of rays, row by row, given the ray of a pixel. Where they are those of a camera, from its eye,
    /// a kernel that can may walk the tree once for many of them, with the room of [`tile::ROOM`](crate::tile::ROOM) bytes.
    #[expect(clippy::too_many_arguments, reason = "the storage of a tile has three parts")]
    fn closest_tile(
        &self,
        camera: Option<&Camera<K::Word>>,
        ray: impl Fn([u16; 2]) -> Option<K::Ray>,
        tile: Tile,
        hits: &mut [u32],
        room: &mut [u8],
        stack: &mut Stack<K>,
        stats: &mut impl Stats,
    );
}

type RayOf<P> = <<P as Profile>::Kernel as Kernel>::Ray;
type SpanOf<P> = <<P as Profile>::Kernel as Kernel>::Span;
type PathOf<P> = <<P as Profile>::Kernel as Kernel>::Path;
type DistanceOf<P> = <<P as Profile>::Kernel as Kernel>::Distance;

/// A tree over a blob's sections.
#[derive(Clone, Copy, Debug)]
pub struct Bvh<'a, P: Profile> {
    /// The root, packed.
    pub root: u32,
    /// Nodes in preorder.
    pub nodes: &'a [<P::Kernel as Kernel>::Node],
    /// Triangles in the order of the leaves.
    pub triangles: Mesh<'a, P>,
    /// Spheres in the order of the leaves; none where the profile has none.
    pub spheres: &'a [<P::Kernel as Kernel>::Sphere],
    /// The id of each primitive, where records of triangles have none.
    pub ids: Integers<'a>,
}

impl<'a, P: Profile> Bvh<'a, P> {
    /// The sphere of a primitive's index; `None` for a triangle's.
    #[inline(always)]
    #[must_use]
    pub fn sphere(&self, index: u32) -> Option<&'a <P::Kernel as Kernel>::Sphere> {
        if !P::NEEDS.has(Need::Spheres) {
            return None;
        }
        self.spheres.get(index.checked_sub(self.triangles.len())? as usize)
    }

    /// The id of a primitive: its index in the file; past the end the largest number.
    #[inline]
    #[must_use]
    pub fn id(&self, index: u32) -> u32 {
        let are_apart = match (P::NEEDS.has(Need::Ids), P::NEEDS.has(Need::IdsInRecords)) {
            (true, true) => !self.ids.is_empty(),
            (apart, _) => apart,
        };
        if are_apart { self.ids.get(index) } else { self.triangles.id(index) }
    }

    /// The boxes of all primitives, triangles first.
    pub fn bounds(&self) -> impl Iterator<Item = Bounds> {
        let spheres = if P::NEEDS.has(Need::Spheres) { self.spheres } else { &[] };
        self.triangles.bounds().chain(spheres.iter().map(|sphere| P::Kernel::ball(sphere).bounds()))
    }

    /// Whether a hit is nearer than another of the same ray: the smaller (t, id).
    #[inline(always)]
    fn nearer(&self, ray: &RayOf<P>, (index, span): (u32, &SpanOf<P>), (other, than): (u32, &SpanOf<P>)) -> bool {
        match P::Kernel::compare(span, than) {
            Some(Ordering::Less) => true,
            Some(Ordering::Greater) => false,
            Some(Ordering::Equal) => self.id(index) < self.id(other),
            None => self.replaces(ray, index, other),
        }
    }

    /// Whether a ray hits a primitive, nearer than another that it hits or that is [`NONE`]. By what they are hit at, without error.
    #[inline(never)]
    #[must_use]
    pub fn replaces(&self, ray: &RayOf<P>, index: u32, other: u32) -> bool {
        let depth = |index: u32| match self.sphere(index) {
            Some(sphere) => P::Kernel::intersect_sphere(ray, sphere, index == P::Kernel::skip(ray)),
            None => self.triangles.of(index, |triangle| P::Kernel::intersect(ray, triangle)).flatten(),
        };
        let Some(new) = depth(index) else { return false };
        depth(other).is_none_or(|old| match P::Kernel::order(&new, &old) {
            Ordering::Less => true,
            Ordering::Equal => self.id(index) < self.id(other),
            Ordering::Greater => false,
        })
    }

    /// Tests every primitive that may be hit before the limit that `visit` returns, nearest boxes first, until it returns
    /// none. What it is given is the primitive's index and its hit, if there is one.
    #[inline(always)]
    fn walk(
        &self,
        ray: &RayOf<P>,
        path: &PathOf<P>,
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
        mut visit: impl FnMut(u32, Option<SpanOf<P>>) -> Option<DistanceOf<P>>,
    ) {
        let mut limit = P::Kernel::reach(ray, path);
        let (skip, octant) = (P::Kernel::skip(ray), P::Kernel::octant(path));
        let mut next = Some(self.root);
        stack.clear();
        while let Some(leaf) = next.and_then(|child| self.leaf(octant, path, child, limit, stack, stats)) {
            let Child::Leaf { first, count } = Child::unpack(leaf.get()) else { return };
            if P::NEEDS.has(Need::Spheres)
                && let Some(first_sphere) = first.checked_sub(self.triangles.len())
            {
                let Some(run) = self.spheres.get(first_sphere as usize..(first_sphere + count) as usize) else {
                    return;
                };
                for (index, sphere) in (first..).zip(run) {
                    stats.sphere();
                    // A ray that starts on a sphere may meet it again, from inside.
                    let depth = P::Kernel::intersect_sphere(ray, sphere, index == skip);
                    match visit(index, depth.as_ref().map(P::Kernel::span)) {
                        Some(nearer) => limit = nearer,
                        None => return,
                    }
                }
            } else if self.triangles.is_shared() {
                for index in (first..first + count).filter(|&index| index != skip) {
                    stats.triangle();
                    let Some(triangle) = self.triangles.assemble(index) else { return };
                    match visit(index, P::Kernel::meet(ray, &triangle)) {
                        Some(nearer) => limit = nearer,
                        None => return,
                    }
                }
            } else if P::NEEDS.has(Need::WholeTriangles) {
                let Some(run) = self.triangles.run(first, count) else { return };
                for (index, triangle) in (first..).zip(run) {
                    if index != skip {
                        stats.triangle();
                        match visit(index, P::Kernel::meet(ray, triangle)) {
                            Some(nearer) => limit = nearer,
                            None => return,
                        }
                    }
                }
            }
            next = waiting::<P::Kernel>(stack, limit);
        }
    }

    /// The first leaf at or below `child`, or below what waits, that the ray enters before the limit, packed: a leaf is not
    /// word 0. One copy an octant, of the descent alone: it is most of the work and little code. One for all where size is preferred.
    #[inline(always)]
    fn leaf(
        &self,
        octant: usize,
        path: &PathOf<P>,
        child: u32,
        limit: DistanceOf<P>,
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
    ) -> Option<NonZeroU32> {
        if P::PREFER == Prefer::Size {
            return self.leaf_in::<ANY_OCTANT>(path, child, limit, stack, stats);
        }
        match octant {
            0 => self.leaf_in::<0>(path, child, limit, stack, stats),
            1 => self.leaf_in::<1>(path, child, limit, stack, stats),
            2 => self.leaf_in::<2>(path, child, limit, stack, stats),
            3 => self.leaf_in::<3>(path, child, limit, stack, stats),
            4 => self.leaf_in::<4>(path, child, limit, stack, stats),
            5 => self.leaf_in::<5>(path, child, limit, stack, stats),
            6 => self.leaf_in::<6>(path, child, limit, stack, stats),
            ANY_OCTANT if P::Kernel::ANY_OCTANT => self.leaf_in::<ANY_OCTANT>(path, child, limit, stack, stats),
            _ => self.leaf_in::<7>(path, child, limit, stack, stats),
        }
    }

    #[inline(never)]
    fn leaf_in<const OCTANT: usize>(
        &self,
        path: &PathOf<P>,
        child: u32,
        limit: DistanceOf<P>,
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
    ) -> Option<NonZeroU32> {
        let enter = |node: &_, child| P::Kernel::enter::<OCTANT>(path, node, child, limit);
        self.descend(child, limit, stack, stats, enter)
    }

    /// The first leaf at or below `child`, or below what waits, that is entered before the limit.
    #[inline(always)]
    fn descend(
        &self,
        mut child: u32,
        limit: DistanceOf<P>,
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
        enter: impl Fn(&<P::Kernel as Kernel>::Node, usize) -> Option<DistanceOf<P>>,
    ) -> Option<NonZeroU32> {
        loop {
            let index = match Child::unpack(child) {
                Child::Leaf { .. } => return NonZeroU32::new(child),
                Child::Node(index) => index,
            };
            // A checked scene has the node; an end without it is what a traversal of nothing is.
            let node = self.nodes.get(index as usize)?;
            stats.boxes(2);
            let [first, second] = P::Kernel::children(node);
            // The second test stands here twice: the code knows of the first what it found, and keeps no flag.
            let enter = |child| enter(node, child);
            child = if let Some(a) = enter(0) {
                if let Some(b) = enter(1) {
                    // A checked tree is no deeper than the stack.
                    if b < a {
                        let _ = stack.push((first, a));
                        second
                    } else {
                        let _ = stack.push((second, b));
                        first
                    }
                } else {
                    first
                }
            } else if enter(1).is_some() {
                second
            } else {
                waiting::<P::Kernel>(stack, limit)?
            };
        }
    }
}

/// The ray, prepared for the boxes of [`Bvh::leaf`].
#[inline(always)]
fn path<P: Profile>(ray: &RayOf<P>) -> PathOf<P> {
    match P::PREFER {
        Prefer::Speed => P::Kernel::path(ray),
        Prefer::Size => P::Kernel::path_of_any(ray),
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

impl<P: Profile> Intersect<P::Kernel> for Bvh<'_, P> {
    #[inline(never)]
    fn closest(&self, ray: &RayOf<P>, stack: &mut Stack<P::Kernel>, stats: &mut impl Stats) -> u32 {
        let mut best: Option<SpanOf<P>> = None;
        let mut hit = NONE;
        let path = path::<P>(ray);
        let mut limit = P::Kernel::reach(ray, &path);
        self.walk(ray, &path, stack, stats, |index, span| {
            if let Some(span) = span
                && best.as_ref().is_none_or(|best| self.nearer(ray, (index, &span), (hit, best)))
            {
                limit = P::Kernel::limit(&path, &span);
                best = Some(span);
                hit = index;
            }
            Some(limit)
        });
        hit
    }

    fn any(
        &self,
        ray: &RayOf<P>,
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
        mut blocks: impl FnMut(u32) -> bool,
    ) -> bool {
        let mut hit = false;
        let path = path::<P>(ray);
        let limit = P::Kernel::reach(ray, &path);
        self.walk(ray, &path, stack, stats, |index, span| {
            hit = span.is_some() && blocks(index);
            (!hit).then_some(limit)
        });
        hit
    }

    fn closest_tile(
        &self,
        camera: Option<&Camera<<P::Kernel as Kernel>::Word>>,
        ray: impl Fn([u16; 2]) -> Option<RayOf<P>>,
        tile: Tile,
        hits: &mut [u32],
        room: &mut [u8],
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
    ) {
        self.tile(camera, ray, tile, hits, room, stack, stats);
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
