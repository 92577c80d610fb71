//! The report's box test (2.3), with the slabs of Williams, Barrus, Morley & Shirley, "An Efficient and Robust Ray-Box
//! Intersection Algorithm" (2005), and one in its place that loses nothing.
//!
//! **The report's.** With n = 2^(31 + C), a plane is crossed at `((plane - origin) >> D) (n / direction)`, which is t with
//! C - D fractional bits. Where a component of the direction is less than `LEAST` (1 for 0, or 16), that takes its place. Both
//! roundings may move a plane to the wrong side: the test is not conservative, and that is what is to be shown.
//!
//! A difference is at most 2^29 + 2^7. With `LEAST` = 1 and D = C the product is at most 2^60 + 2^38 + 2^(31 + C), with 16 and
//! C - D <= 6 at most 2^62 + 2^40 + 2^(27 + C): C <= 28 fits. The report's bounds come from a largest component of at least
//! 1 / sqrt(3): along that axis an entry is above -2^31, so it fits an `i32` as the largest of three.
//!
//! **The conservative one** is [`Exact29`](crate::exact::Exact29)'s. A unit vector in Q31 has a component of at least 2^30,
//! which is as that kernel scales its directions, and its t in Q31 is then in grid units, like t here. Let X be the
//! point of the ray at the t of a hit. If X is in the box, the box is entered (the proof is at `Exact29`'s boxes). But hits
//! here are rounded, and X may be beside the triangle:
//!
//! - Along p and q less than 1 above what the triangle test takes for it.
//! - Along r by what the plane test is off. That is, in grid units: 3 (its numerator: two floors, the rounding of d and of
//!   n_p and n_q times 2^29), sqrt(3) (t is truncated), 2 (the denominator is off by less than 4 / 2^31, and t <= 2^30), and 2
//!   for what X is off along p and q. Less than 9 in all.
//!
//! So boxes are stored larger by 9. What edges are rounded by is not in this: on slivers, and with an E that clamps, that has
//! no useful bound. So a hit counts only where the ray enters the triangle's own box, stored as boxes are, before t. The
//! test is monotone, in planes and in the limit: reciprocals are of one sign, and floors keep order. Hence a ray whose hit
//! counts enters every box above it, not beyond t, and **the tree loses no hit**, whatever its shape.

use core::fmt::Debug;

use crate::arithmetic::Arithmetic;
use crate::exact::{Reciprocal, Reciprocal29, in_order, slab};
use crate::kernel::Bounds;
use crate::num::Triple;

/// Low and high corner, as stored.
pub(super) type Planes = [[u32; 3]; 2];

/// A box test: what it keeps of a ray's direction.
pub trait Slab: Copy + Debug {
    /// By how much boxes are stored larger, below and above.
    const PAD: [i32; 2];
    /// By how much an entry may exceed the limit.
    const SLACK: i32;
    /// Whether a hit counts only where the ray enters the triangle's own box before it.
    const CONFIRMS: bool;

    /// For a direction of length 1, Q31.
    fn new(settings: Arithmetic, direction: Triple<i64>) -> Self;
    /// Where a ray of an octant enters a box, if it does before `limit`, grid units.
    fn enter<const OCTANT: usize>(&self, origin: Triple<i64>, planes: &[[u32; 3]; 2], limit: i32) -> Option<i32>;
}

/// A box as it is stored. It must be where vertices may be.
pub(super) fn planes<S: Slab>(bounds: Bounds) -> Planes {
    let [below, above] = S::PAD;
    [bounds.low.map(|c| c.wrapping_sub(below) as u32), bounds.high.map(|c| c.wrapping_add(above) as u32)]
}

/// The box of a record; of one that [`planes`] did not make, one that is where no vertex may be.
pub(super) fn bounds<S: Slab>([low, high]: Planes) -> Bounds {
    let [below, above] = S::PAD;
    Bounds { low: low.map(|c| (c as i32).wrapping_add(below)), high: high.map(|c| (c as i32).wrapping_sub(above)) }
}

/// The report's test; the components of directions are taken to be at least `LEAST` units.
#[derive(Clone, Copy, Debug)]
pub struct TightSlab<const LEAST: i64> {
    /// Of the direction's sign; in Q C.
    reciprocal: Triple<i64>,
    /// D.
    d_bits: u32,
    /// C - D.
    fraction_bits: u32,
}

impl<const LEAST: i64> Slab for TightSlab<LEAST> {
    const PAD: [i32; 2] = [0, 0];
    const SLACK: i32 = 0;
    const CONFIRMS: bool = false;

    #[inline]
    fn new(settings: Arithmetic, direction: Triple<i64>) -> Self {
        let one = 1i64 << (31 + settings.c_bits); // at most 2^59
        let reciprocal = |component: i64| {
            let magnitude = one / component.abs().max(LEAST);
            if component < 0 { -magnitude } else { magnitude }
        };
        let fraction_bits = settings.c_bits - settings.d_bits;
        Self {
            reciprocal: direction.map(reciprocal),
            d_bits: settings.d_bits.into(),
            fraction_bits: fraction_bits.into(),
        }
    }

    /// Derived is that a box behind the origin is left out: the listing leaves that to its caller.
    #[inline(always)]
    fn enter<const OCTANT: usize>(&self, origin: Triple<i64>, planes: &[[u32; 3]; 2], limit: i32) -> Option<i32> {
        // entry >> (C - D) <= limit; below 2^37.
        let limit = ((i64::from(limit) + 1) << self.fraction_bits) - 1;
        let along =
            |axis: usize, plane: u32| ((i64::from(plane) - origin[axis]) >> self.d_bits) * self.reciprocal[axis];
        let crossed =
            |axis: usize| in_order::<OCTANT, _>(axis, along(axis, planes[0][axis]), along(axis, planes[1][axis]));
        slab(limit, 0, crossed).map(|entry| (entry >> self.fraction_bits) as i32)
    }
}

/// The test that loses nothing.
#[derive(Clone, Copy, Debug)]
pub struct ConservativeSlab([Reciprocal29; 3]);

impl Slab for ConservativeSlab {
    /// One more above, as `Exact29`'s.
    const PAD: [i32; 2] = [9, 10];
    const SLACK: i32 = Reciprocal29::SLACK as i32;
    const CONFIRMS: bool = true;

    #[inline]
    fn new(_: Arithmetic, direction: Triple<i64>) -> Self {
        Self(direction.map(Reciprocal::new))
    }

    #[inline(always)]
    fn enter<const OCTANT: usize>(&self, origin: Triple<i64>, planes: &[[u32; 3]; 2], limit: i32) -> Option<i32> {
        let along = |axis: usize, plane: u32| self.0[axis].along(i64::from(plane) - origin[axis]);
        let crossed =
            |axis: usize| in_order::<OCTANT, _>(axis, along(axis, planes[0][axis]), along(axis, planes[1][axis]));
        slab(i64::from(limit) + Reciprocal29::SLACK, Reciprocal29::SLACK, crossed).map(|entry| entry as i32)
    }
}

#[cfg(test)]
mod tests;
