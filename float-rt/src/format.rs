//! What a float kernel fixes beside its numbers: grid, directions, distances, records.
//!
//! | | `f32` | `f64` |
//! | --- | --- | --- |
//! | vertices, edges, origins - vertices | < 2^24, exact | < 2^29, exact |
//! | camera directions | < 2^24, exact | < 2^31, exact: those of `exact29` |
//! | determinants | < 2^76 | < 2^94 |
//!
//! So what the blob holds is exact in either, and no magnitude comes near the end of the exponents: all that is lost
//! is lost by rounding.

use crate::real::Real;
use crate::record::{
    Node32, Node64, NodeRecord, Sphere32, Sphere64, SphereRecord, Triangle32, Triangle64, TriangleRecord,
};

/// The numbers of a kernel and what goes with them.
pub trait Format: Real {
    /// See [`Kernel::ID`](core_rt::kernel::Kernel::ID); 128 and the bits of a number.
    const ID: u16;
    /// See [`Kernel::NAME`](core_rt::kernel::Kernel::NAME).
    const NAME: &'static str;
    /// See [`Kernel::GRID_BITS`](core_rt::kernel::Kernel::GRID_BITS). Every integer of that many bits is a number.
    const GRID_BITS: u32;
    /// See [`Kernel::DIRECTION_BITS`](core_rt::kernel::Kernel::DIRECTION_BITS).
    const DIRECTION_BITS: u32;
    /// How far rays start above a surface, grid units.
    ///
    /// A point is `v0 + (u e1 + v e2)`: whatever u and v are, it is off the plane by the roundings of these operations
    /// alone, four an axis, each at most half an ulp of a coordinate, and a fifth when it is moved. With the grid below
    /// 2^g and e the relative error of a rounding that is less than 5 sqrt(3) e 2^g, or 9 e 2^g. In `f32` that would
    /// be 9 units if all errors were the largest at once; 8, or 256 units of 2^-29 of the scene, is what was measured to
    /// avoid self-intersection but on slivers. In `f64` far more can be afforded: 2^12 times the bound.
    const STAND_OFF: Self;
    /// See [`Kernel::RADIUS_MIN`](core_rt::kernel::Kernel::RADIUS_MIN): at least twice [`Format::STAND_OFF`].
    const RADIUS_MIN: i32;
    /// Where the segment from a surface (0) to a light (1) ends: before 1 by more than the error of a `t`, so that what
    /// the light lies on does not hide it.
    const SEGMENT_END: Self;

    /// A node's record.
    type Node: NodeRecord<Self>;
    /// A triangle's record.
    type Triangle: TriangleRecord<Self>;
    /// A sphere's record.
    type Sphere: SphereRecord<Self>;
}

impl Format for f32 {
    const ID: u16 = 128 + 32;
    const NAME: &'static str = "f32";
    const GRID_BITS: u32 = 24;
    const DIRECTION_BITS: u32 = 24;
    const STAND_OFF: Self = 8.0;
    const RADIUS_MIN: i32 = 16;
    const SEGMENT_END: Self = 1.0 - 1.0 / (1 << 12) as Self;

    type Node = Node32;
    type Triangle = Triangle32;
    type Sphere = Sphere32;
}

impl Format for f64 {
    const ID: u16 = 128 + 64;
    const NAME: &'static str = "f64";
    const GRID_BITS: u32 = 29;
    const DIRECTION_BITS: u32 = 31;
    const STAND_OFF: Self = 1.0 / (1 << 9) as Self;
    const RADIUS_MIN: i32 = 2;
    const SEGMENT_END: Self = 1.0 - 1.0 / (1u64 << 40) as Self;

    type Node = Node64;
    type Triangle = Triangle64;
    type Sphere = Sphere64;
}
