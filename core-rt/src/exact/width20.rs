//! 20 bits: everything in `i64`, and the signs of the edge functions without a filter.
//!
//! | value | bound | fits |
//! | --- | --- | --- |
//! | vertices, edges, origins - vertices | < 2^20 | `i32` |
//! | directions D | < 2^21, largest >= 2^20 | `i32` |
//! | R = S x D | < 2^42 | `i64` |
//! | N = e1 x e2 | < 2^40 (area of a projection) | `i64` |
//! | U, V, W, det | < 3 * 2^61 < 2^63 | `i64` |
//! | tn | <= 2^61 | `i64` |
//! | S . S, r^2 | < 3 * 2^40 | `i64` |
//! | D . D | < 3 * 2^42 | `i64` |
//! | S . D | < 3 * 2^41 | `i64` |
//! | its square, (D . D) (S . S - r^2) | < 9 * 2^82 | `i128`, spheres alone |
//! | t | <= 2^20 / 2^20 = 1 | Q41 |
//!
//! **U fits.** It is the triple product of D with an edge and an offset of the origin. The ends of the edge and the origin
//! are three points that a cube of side 2^20 holds, since the budget is on differences; twice the area of such a triangle
//! is at most sqrt(3) 2^40. |D| is at most sqrt(3) 2^21. So |U| <= 3 * 2^61. V and W are the same for the other edges, and
//! det for three corners. The terms of these sums may overflow, their sum does not: they are formed modulo 2^64. tn is six
//! times the volume of a tetrahedron in that cube, which holds one of a third of its own: 2 * 2^60.
//!
//! A grid of 21 bits does not fit. What is gained is time on hosts with 64-bit words: no filter, and no shift in the box
//! test.

use core::cmp::Ordering;

use super::Width29;
use super::boxes::BoxNode29;
use super::slopes::PerAxis;
use super::width::{Reciprocal, Width};
use crate::kernel::Surface;
use crate::num::{Triple, dot};
use crate::space::{Grid29, Space};

/// The widths of `exact20`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Width20;

/// `floor(2^41 / |component|)`, with the component's sign: t in Q41 per grid unit.
#[derive(Clone, Copy, Debug)]
pub struct Reciprocal20(i64);

impl Reciprocal for Reciprocal20 {
    type Word = i64;
    const SLACK: i64 = Width20::SLACK;

    #[inline]
    fn new(component: i64) -> Self {
        match component {
            // A delta of 1 is then farther than any hit.
            0 => Self(2 * Width20::T_MAX),
            // Truncation is towards 0: of the component's sign, and never above in magnitude.
            _ => Self((1 << Width20::T_BITS) / component),
        }
    }

    /// |delta| <= 2^20 and the reciprocal is at most 2^42: the product is at most 2^62.
    #[inline(always)]
    fn along(self, delta: i64) -> i64 {
        delta * self.0
    }
}

impl Width for Width20 {
    const ID: u16 = 20;
    const NAME: &'static str = "exact20";
    const GRID_BITS: u32 = 20;
    const MARGIN: i32 = 8;
    const SPAN: i32 = (1 << 20) - 8;
    const DIRECTION_BITS: u32 = 21;
    const NORMAL_BITS: u32 = 30;
    const MATERIALS_MAX: u32 = (1 << 26) - 1;
    const FILTERED: bool = false;
    const T_BITS: u32 = 41;
    /// An exit is computed low by less than its delta (the floor of the reciprocal), so by less than 2^20. A depth is
    /// within 3 * 2^10 of true.
    const SLACK: i64 = 1 << 20;
    const T_MAX: i64 = 1 << 41;

    type Space = Grid29;
    type Word = i64;
    type Wide = i64;
    type Short = i32;
    type Node = BoxNode29;
    type Slopes = PerAxis<Reciprocal20>;

    #[inline(always)]
    fn short(word: i64) -> i32 {
        debug_assert!(i64::from(word as i32) == word);
        word as i32
    }

    #[inline(always)]
    fn dot(a: Triple<i64>, b: Triple<i64>) -> i64 {
        let product = |axis: usize| a[axis].wrapping_mul(b[axis]);
        product(0).wrapping_add(product(1)).wrapping_add(product(2))
    }

    #[inline(always)]
    fn square(a: Triple<i64>) -> i64 {
        dot(a, a)
    }

    /// The root is below 2^44, as b is.
    #[inline]
    fn discriminant_root(a: i64, b: i64, c: i64) -> Option<(i64, bool)> {
        Width29::discriminant_root(a.into(), b.into(), c.into()).map(|(root, is_whole)| (root as i64, is_whole))
    }

    #[inline]
    fn order(a: (i64, i64), b: (i64, i64)) -> Ordering {
        (i128::from(a.0) * i128::from(b.1)).cmp(&(i128::from(b.0) * i128::from(a.1)))
    }

    /// From 32 leading bits of the denominator: t in Q31 is within 3, as [`Width29`]'s depth. The numerator is at most
    /// 2^32 then (t <= 1), and 2^63 in Q31.
    #[inline]
    fn depth(numerator: i64, denominator: i64) -> i64 {
        let bits = i64::BITS - denominator.leading_zeros();
        let scaled = |value: i64| if bits > 32 { value >> (bits - 32) } else { value << (32 - bits) } as u64;
        // Says that it is not 0, which the compiler cannot know: else it would link a panic.
        let t_q31 = (scaled(numerator) << 31) / scaled(denominator).max(1);
        (t_q31 as i64) << (Self::T_BITS - 31)
    }

    #[inline]
    fn fraction(numerator: i64, denominator: i64) -> <Grid29 as Space>::Fraction {
        Width29::fraction(numerator.into(), denominator.into())
    }

    /// As [`Width29`]'s: here t <= 1, so the numerator is below 2^63 and 2^125 shifted, and D t is smaller.
    #[inline]
    fn point(origin: Triple<i64>, direction: Triple<i64>, numerator: i64, denominator: i64) -> Triple<i64> {
        Width29::point(origin, direction, numerator.into(), denominator.into())
    }

    /// As [`Width29`]'s, with t <= 1; but what a t that was rounded up to a multiple of 1 / |D|^2 adds is up to 2^-20.
    #[inline]
    fn on_sphere(
        centre: Triple<i64>,
        s: Triple<i64>,
        direction: Triple<i64>,
        numerator: i64,
        denominator: i64,
    ) -> (Triple<i64>, Triple<i64>) {
        Width29::on_sphere(centre, s, direction, numerator.into(), denominator.into())
    }

    #[inline]
    fn normalise(vector: Triple<i64>) -> Option<<Grid29 as Space>::Unit> {
        Width29::normalise(vector)
    }

    /// As [`Width29`]'s: points and normals have its formats, and its bounds hold with larger t.
    #[inline]
    fn stand_off(surface: &Surface<Grid29>) -> Triple<i64> {
        Width29::stand_off(surface)
    }

    #[inline]
    fn direction(unit: <Grid29 as Space>::Unit) -> Triple<i64> {
        Width29::direction(unit)
    }

    fn join_meta(shift: u32, material: u32) -> Option<i32> {
        Width29::join_meta(shift, material)
    }

    #[inline(always)]
    fn split_meta(meta: i32) -> (u32, u32) {
        Width29::split_meta(meta)
    }
}
