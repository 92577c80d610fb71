//! An exact kernel on a grid of two bits, and wrong ones beside it.
//!
//! | value | bound |
//! | --- | --- |
//! | vertices, origins | 0 to 3 |
//! | directions D | < 2^B, largest >= 2^(B - 1), B = 2 or 3 |
//! | R = S x D | < 2^(3 + B) |
//! | t | <= 3 / 2^(B - 1), Q5 |

use std::cmp::Ordering;

use core_rt::exact::{BoxNode14, PerAxis, Reciprocal, Width, Width14};
use core_rt::kernel::Surface;
use core_rt::num::Triple;
use core_rt::space::{Grid14, Space};

/// What is wrong with a width.
pub(crate) const NOTHING: u8 = 0;
/// `SLACK` is one less than what the reciprocals ask for.
pub(crate) const SLACK: u8 = 1;
/// A ray that does not move along an axis is taken to move by eight units.
pub(crate) const RECIPROCAL: u8 = 2;
/// The filter takes edges to be half as long as they may be.
pub(crate) const FILTER: u8 = 3;
/// Depths are too large by more than twice `SLACK`, where the denominator is odd.
pub(crate) const DEPTH: u8 = 4;

/// Bits of a coordinate.
pub(crate) const GRID_BITS: u32 = 2;

/// Q of `t`. A power of two that three does not divide without a remainder of two: the floor is as bad as it can be.
const T_BITS: u32 = 5;

/// The width for directions of so many bits.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Toy<const DIRECTION_BITS: u32, const FAULT: u8>;

/// `floor(2^5 / |component|)`, with the component's sign.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ToyReciprocal<const DIRECTION_BITS: u32, const FAULT: u8>(i32);

impl<const DIRECTION_BITS: u32, const FAULT: u8> Reciprocal for ToyReciprocal<DIRECTION_BITS, FAULT> {
    type Word = i32;
    const SLACK: i32 = Toy::<DIRECTION_BITS, FAULT>::SLACK;

    fn new(component: i32) -> Self {
        Self(match component {
            0 if FAULT == RECIPROCAL => (1 << T_BITS) / 8,
            // No t in Q5 is larger: 3 / 2.
            0 => 3 << (T_BITS - 1),
            _ => (1 << T_BITS) / component,
        })
    }

    fn along(self, delta: i32) -> i32 {
        delta * self.0
    }
}

impl<const DIRECTION_BITS: u32, const FAULT: u8> Width for Toy<DIRECTION_BITS, FAULT> {
    const ID: u16 = 2;
    const NAME: &'static str = "toy";
    const GRID_BITS: u32 = GRID_BITS;
    const MARGIN: i32 = 0;
    const SPAN: i32 = (1 << GRID_BITS) - 1;
    const DIRECTION_BITS: u32 = DIRECTION_BITS;
    const NORMAL_BITS: u32 = GRID_BITS;
    const MATERIALS_MAX: u32 = 31;
    const T_BITS: u32 = T_BITS;
    /// An exit at a low plane is computed low by its delta times what the floor takes off, (2^5 mod c) / c: with B = 2 at most
    /// 3 * 2 / 3 = 2, with B = 3 at most 3 * 4 / 7 < 2, which is 1 between whole numbers. A high plane stands one farther, and
    /// its exit is not low. Depths are low by less than 1.
    const SLACK: i32 = 4 - DIRECTION_BITS as i32 - (FAULT == SLACK) as i32;
    const T_MAX: i32 = 3 << (T_BITS + 1 - DIRECTION_BITS);

    type Space = Grid14;
    type Word = i32;
    type Wide = i64;
    type Short = i8;
    type Node = BoxNode14;
    type Slopes = PerAxis<ToyReciprocal<DIRECTION_BITS, FAULT>>;

    fn short(word: i32) -> i8 {
        word as i8
    }

    fn dot(a: Triple<i32>, b: Triple<i32>) -> i64 {
        (0..3).map(|axis| i64::from(a[axis]) * i64::from(b[axis])).sum()
    }

    fn square(a: Triple<i32>) -> i64 {
        Self::dot(a, a)
    }

    fn discriminant_root(a: i64, b: i64, c: i64) -> Option<(i64, bool)> {
        Width14::discriminant_root(a, b, c)
    }

    fn order(a: (i64, i64), b: (i64, i64)) -> Ordering {
        (a.0 * b.1).cmp(&(b.0 * a.1))
    }

    fn depth(numerator: i64, denominator: i64) -> i32 {
        let t = ((numerator << T_BITS) / denominator) as i32;
        if FAULT == DEPTH && denominator & 1 == 1 { t + 5 } else { t }
    }

    fn fraction(numerator: i64, denominator: i64) -> <Grid14 as Space>::Fraction {
        Width14::fraction(numerator, denominator)
    }

    fn point(origin: Triple<i32>, direction: Triple<i32>, numerator: i64, denominator: i64) -> Triple<i32> {
        Width14::point(origin, direction, numerator, denominator)
    }

    fn on_sphere(
        centre: Triple<i32>,
        s: Triple<i32>,
        direction: Triple<i32>,
        numerator: i64,
        denominator: i64,
    ) -> (Triple<i32>, Triple<i32>) {
        Width14::on_sphere(centre, s, direction, numerator, denominator)
    }

    fn normalise(vector: Triple<i32>) -> Option<<Grid14 as Space>::Unit> {
        Width14::normalise(vector)
    }

    fn stand_off(surface: &Surface<Grid14>) -> Triple<i32> {
        Width14::stand_off(surface)
    }

    fn direction(unit: <Grid14 as Space>::Unit) -> Triple<i32> {
        Width14::direction(unit)
    }

    fn join_meta(shift: u32, material: u32) -> Option<i8> {
        (shift <= GRID_BITS && material <= Self::MATERIALS_MAX).then_some((material << 2 | shift) as i8)
    }

    fn split_meta(meta: i8) -> (u32, u32) {
        let (shift, material) = (u32::from(meta as u8 & 3), u32::from(meta as u8 >> 2));
        (if FAULT == FILTER { shift.saturating_sub(1) } else { shift }, material)
    }
}
