//! Tiles of camera rays that walk the tree together.
//!
//! The rays of a small rectangle of pixels start at one point and their directions are linear in the pixel, but for rounding.
//! So a box is tested against the four planes around all of them (a [`Beam`]), and a triangle is drawn into the rectangle as a
//! rasteriser does it: edge functions and the inverse of the depth are linear in the pixel, and are stepped by addition
//! (Pineda, "A Parallel Algorithm for Polygon Rasterization", 1988; Reshetov, Soupikov & Hurley, "Multi-Level Ray Tracing
//! Algorithm", 2005). Every stepped value has a stated bound on its error. Where a sign, or which of two hits is nearer, is not
//! certain within that bound, the ray of the pixel is tested by itself: the hits are those of single rays, all of them. Of a sphere
//! rays are tested wherever its box may be seen.

use crate::camera::Camera;
use crate::kernel::{Bounds, Kernel, Vertices};
use crate::num::Triple;
use crate::render::Tile;

/// Pixels a side that walk together, at most.
pub const SIDE: u16 = 16;

/// The bytes that the walk of a tile needs for its depths, wherever they lie: two a pixel, and one to begin at an even address.
pub const ROOM: usize = 2 * SIDE as usize * SIDE as usize + 1;

/// The rays of a tile, at most [`SIDE`] pixels wide and high.
///
/// Depth is counted along one axis, that along which the middle of the tile looks: distances to boxes are coordinates.
pub trait Beam<K: Kernel>: Sized {
    /// `None` where the tile's rays are to be traced one by one.
    fn new(camera: &Camera<K::Word>, tile: Tile) -> Option<Self>;
    /// The axis of depth.
    fn axis(&self) -> usize;
    /// The limit beyond which nothing counts.
    fn reach(&self) -> K::Distance;
    /// A limit for [`Beam::enter`] that leaves out nothing that could be at or before what is at least so near in every pixel.
    fn limit(&self, nearness: i32) -> K::Distance;
    /// Where the rays may enter a child of a node, 0 or 1, if one of them may before `limit`.
    fn enter<const AXIS: usize>(&self, node: &K::Node, child: usize, limit: K::Distance) -> Option<K::Distance>;
    /// What of the tile a triangle covers.
    fn footprint(&self, vertices: &Vertices, edges: &mut Edges) -> Footprint;
    /// Functions that are not negative, all of them, wherever a ray may meet a box; `None` where that may be anywhere.
    fn around(&self, bounds: &Bounds) -> Option<[Linear; 4]>;
    /// Whether the ray of a pixel of the tile hits the triangle of a footprint, where that is certain by the ray's own direction.
    fn meets(ray: &K::Ray, edges: &Edges) -> Option<bool>;
}

/// Of kernels that trace every ray by itself.
#[derive(Clone, Copy, Debug)]
pub enum NoBeam {}

impl<K: Kernel> Beam<K> for NoBeam {
    fn new(_: &Camera<K::Word>, _: Tile) -> Option<Self> {
        None
    }

    fn axis(&self) -> usize {
        match *self {}
    }

    fn reach(&self) -> K::Distance {
        match *self {}
    }

    fn limit(&self, _: i32) -> K::Distance {
        match *self {}
    }

    fn enter<const AXIS: usize>(&self, _: &K::Node, _: usize, _: K::Distance) -> Option<K::Distance> {
        match *self {}
    }

    fn footprint(&self, _: &Vertices, _: &mut Edges) -> Footprint {
        match *self {}
    }

    fn around(&self, _: &Bounds) -> Option<[Linear; 4]> {
        match *self {}
    }

    fn meets(_: &K::Ray, _: &Edges) -> Option<bool> {
        None
    }
}

/// A function that is linear in the pixel of a tile, counted from its first: its value there, and what a step to the right
/// and one down adds.
#[derive(Clone, Copy, Debug, Default)]
pub struct Linear {
    /// In the first pixel.
    pub first: i32,
    /// To the right.
    pub right: i32,
    /// Down.
    pub down: i32,
}

impl Linear {
    /// In a pixel.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, x: i32, y: i32) -> i32 {
        self.first + x * self.right + y * self.down
    }

    /// The largest value in a tile whose last pixel is at `last`.
    #[inline(always)]
    #[must_use]
    pub fn most(&self, last: [i32; 2]) -> i32 {
        self.first + last[0] * self.right.max(0) + last[1] * self.down.max(0)
    }
}

/// What a triangle covers of a tile.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Footprint {
    /// Nothing.
    Nothing,
    /// Perhaps any pixel.
    Unknown,
    /// What its edges say.
    Edges,
}

/// An edge of a triangle in the pixels of a tile.
#[derive(Clone, Copy, Debug, Default)]
pub struct Edge {
    /// Negative where the ray certainly misses.
    pub line: Linear,
    /// All of a triangle's are at least these where it certainly hits.
    pub uncertain: i32,
    /// What directions are multiplied by for their values.
    pub vector: Triple<i32>,
}

/// A triangle in the pixels of a tile.
#[derive(Clone, Copy, Debug, Default)]
pub struct Edges {
    /// One after the other.
    pub edges: [Edge; 3],
    /// The inverse of the depth, before it is shifted.
    pub nearness: Linear,
    /// By what it is shifted to the right.
    pub shift: u32,
    /// By what it may be wrong, before it is shifted.
    pub band: i32,
}
