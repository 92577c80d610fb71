//! 32 bits: everything on the hot path in `i32`, exact decisions in `i64`.
//!
//! | value | bound | fits |
//! | --- | --- | --- |
//! | vertices, edges | < 2^15 | `i16` |
//! | origins - vertices | < 2^15 | |
//! | directions D | < 2^13, largest >= 2^12 | |
//! | R = S x D | < 2^29 | `i32` |
//! | N = e1 x e2 | < 2^30 (area of a projection) | `i32` |
//! | U, V, det, tn | < 3 * 2^15 * 2^30 < 2^47 | `i64` |
//! | S . S, r^2 | < 3 * 2^30 | `u32` |
//! | D . D | < 3 * 2^26 | `i32` |
//! | S . D | < 3 * 2^28 | `i32` |
//! | its square, (D . D) (S . S - r^2) | < 9 * 2^56 < 2^60 | `i64` |
//! | t | < 2^15 / 2^12 = 2^3 | Q13 in 16 bits |
//!
//! The budget is on differences, so a camera inside the geometry costs nothing and the grid has 15 bits; one that looks
//! on from outside takes about one of them. The kernel is named for the 14 that are always there.

use core::cmp::Ordering;

use super::boxes::BoxNode14;
use super::slopes::Slopes14;
use super::width::Width;
use crate::kernel::Surface;
use crate::num::{BitLength, Triple, isqrt_u64, reciprocal, round_shift};
use crate::space::grid14::{POINT_BITS, normalise};
use crate::space::{Grid14, Space};

/// The widths of `exact14`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Width14;

/// Half of how far rays start above a surface, in grid units: they start 3/2 above.
///
/// The resolved point is within 1/4 + 1/32 of the true one along each axis (t is within 2^-16 (1 + 2^-7) and D below 2^13,
/// so 1/8, and the rounding to Q4), the unit normal within 2^-12 along each axis, and the rounding to the grid is 1/2.
/// Along the normal that is at most sqrt(3) (9/32 + 1/2 + 2^-11) < 1.36 < 3/2 (1 - 2^-11): the origin is on the normal's
/// side of the plane, and a ray that leaves to that side does not meet it.
const STAND_OFF_2X: i32 = 3;

impl Width for Width14 {
    const ID: u16 = 14;
    const NAME: &'static str = "exact14";
    const GRID_BITS: u32 = 15;
    const MARGIN: i32 = 4;
    const SPAN: i32 = (1 << 15) - 4;
    const DIRECTION_BITS: u32 = 13;
    const NORMAL_BITS: u32 = 15;
    const MATERIALS_MAX: u32 = (1 << 12) - 1;
    const T_BITS: u32 = 13;
    /// A depth is high by less than 2^16 2^-15 = 2 (its denominator is truncated to 16 bits) and low by less than
    /// 2^16 2^-14 + 2 (its numerator, truncated, times a mantissa of 2^16 / 2^15) + 1 = 7. Of boxes [`Slopes14`] says it.
    const SLACK: i32 = 8;
    const T_MAX: i32 = 1 << 16;

    type Space = Grid14;
    type Word = i32;
    type Wide = i64;
    type Short = i16;
    type Node = BoxNode14;
    type Slopes = Slopes14;

    /// Without a sign: a Cortex-M0 reads such a half-word from anywhere in a record, and one with a sign only by a register.
    #[inline(always)]
    fn coordinate(short: i16) -> i32 {
        (short as u16).into()
    }

    #[inline(always)]
    fn short(word: i32) -> i16 {
        debug_assert!(i32::from(word as i16) == word);
        word as i16
    }

    /// By 15-bit limbs of b, so that a Cortex-M0 needs `muls` alone. For |a| < 2^15 and |b| <= 2^30 a limb's product is at
    /// most 2^15 (2^15 - 1), and two of them fit; the third is added in 64 bits.
    #[cfg_attr(not(prefer_size), inline)]
    #[cfg_attr(prefer_size, inline(never))]
    fn dot(a: Triple<i32>, b: Triple<i32>) -> i64 {
        let sum =
            |limb: fn(i32) -> i32| i64::from(a[0] * limb(b[0]) + a[1] * limb(b[1])) + i64::from(a[2] * limb(b[2]));
        (sum(|b| b >> 15) << 15) + sum(|b| b & 0x7fff)
    }

    /// Below 3 * 2^30.
    #[inline(always)]
    fn square(a: Triple<i32>) -> i64 {
        a.iter().map(|&c| (c * c) as u32).sum::<u32>().into()
    }

    #[inline]
    fn discriminant_root(a: i64, b: i64, c: i64) -> Option<(i64, bool)> {
        let discriminant = b * b - a * c;
        if discriminant < 0 {
            return None;
        }
        // At most b^2, which is below 2^60.
        let root = isqrt_u64(discriminant.cast_unsigned()).cast_signed();
        Some((root, root * root == discriminant))
    }

    #[inline]
    fn order(a: (i64, i64), b: (i64, i64)) -> Ordering {
        product(a.0, b.1).cmp(&product(b.0, a.1))
    }

    /// With the denominator scaled to 16 bits, the numerator is below 2^19, and 2^16 after three more bits are dropped;
    /// t = numerator / denominator in Q13 = (numerator / 2^3) mantissa / 2^15.
    #[cfg_attr(not(prefer_size), inline)]
    #[cfg_attr(prefer_size, inline(never))]
    fn depth(numerator: i64, denominator: i64) -> i32 {
        let bits = bits_of(denominator);
        let r = reciprocal(scaled(denominator, bits, 16) as u32);
        (((scaled(numerator, bits, 13) as u32) * r.mantissa) >> 15) as i32
    }

    /// Within 4 units of 2^-14: the reciprocal is low by one in 2^14, the denominator's truncation makes it high by one in
    /// 2^15, the numerator's is less than two units of 2^-15, and the floor is one.
    #[cfg_attr(not(prefer_size), inline)]
    #[cfg_attr(prefer_size, inline(never))]
    fn fraction(numerator: i64, denominator: i64) -> <Grid14 as Space>::Fraction {
        let bits = bits_of(denominator);
        let r = reciprocal(scaled(denominator, bits, 16) as u32);
        // numerator <= denominator < 2^16 and mantissa < 2^16; mantissa / 2^31 is 1 / denominator; to Q14.
        let fraction = ((scaled(numerator, bits, 16) as u32 * r.mantissa) >> 17).min(1 << 14);
        <Grid14 as Space>::Fraction::from_bits(fraction as i16)
    }

    /// t is low by less than 2^-16 (1 + 2^-7). |D t| is at most SPAN grid units, so below 2^31 - 2^18 in Q16.
    #[inline]
    fn point(origin: Triple<i32>, direction: Triple<i32>, numerator: i64, denominator: i64) -> Triple<i32> {
        let t_q16 = quotient_q16(numerator, denominator);
        let moved =
            |origin: i32, direction: i32| (origin << POINT_BITS) + round_shift(direction * t_q16, 16 - POINT_BITS);
        [moved(origin[0], direction[0]), moved(origin[1], direction[1]), moved(origin[2], direction[2])]
    }

    /// t to Q26 by a second correction. What is left of tn after t in Q16 is between -1/64 and 65/64 determinants, and its
    /// quotient in Q10 is off by less than 1 1/4: 1/8 by the truncation of the numerator to 13 bits or more, 1/16 by
    /// that of the denominator and the reciprocal, 1 by the floor. So t is within 5/4 * 2^-26, and D t within 5/4 * 2^-13. The rest
    /// are 2^-17 of rounding, and the 2^-12 of a t that was rounded up to a multiple of 1 / |D|^2. The sum is a radius at
    /// most, below 2^30 in Q16; its terms may wrap.
    #[inline]
    fn on_sphere(
        centre: Triple<i32>,
        s: Triple<i32>,
        direction: Triple<i32>,
        numerator: i64,
        denominator: i64,
    ) -> (Triple<i32>, Triple<i32>) {
        const OFFSET_BITS: u32 = 16;
        let t_q16 = quotient_q16(numerator, denominator);
        let remainder = (numerator << 16) - i64::from(t_q16) * denominator;
        let bits = bits_of(denominator);
        let r = reciprocal(scaled(denominator, bits, 16) as u32);
        // At most 65/64 * 2^14, times a mantissa below 2^16; mantissa / 2^29 is 1 / the 14-bit denominator.
        let rest_q26 = (scaled(remainder, bits, 14) as i32 * r.mantissa as i32) >> 19;
        let offset = |axis: usize| {
            let coarse = direction[axis] * t_q16; // at most SPAN grid units
            let fine = round_shift(direction[axis] * rest_q26, 26 - OFFSET_BITS); // 2^13 * 2^11
            (s[axis] << OFFSET_BITS).wrapping_add(coarse).wrapping_add(fine)
        };
        let offset = [offset(0), offset(1), offset(2)];
        let placed = |axis: usize| (centre[axis] << POINT_BITS) + round_shift(offset[axis], OFFSET_BITS - POINT_BITS);
        ([placed(0), placed(1), placed(2)], offset)
    }

    #[inline]
    fn normalise(vector: Triple<i32>) -> Option<<Grid14 as Space>::Unit> {
        normalise(vector)
    }

    #[inline]
    fn stand_off(surface: &Surface<Grid14>) -> Triple<i32> {
        let placed = |point_q4: i32, unit_q14: i32| {
            // One rounding: the sum in Q15, the point being below 2^15 + 1 grid units.
            round_shift((point_q4 << (15 - POINT_BITS)) + STAND_OFF_2X * unit_q14, 15)
        };
        let n = surface.normal.map(|c| i32::from(c.to_bits()));
        [placed(surface.point[0], n[0]), placed(surface.point[1], n[1]), placed(surface.point[2], n[2])]
    }

    #[inline]
    fn direction(unit: <Grid14 as Space>::Unit) -> Triple<i32> {
        unit.map(|c| i32::from(c.to_bits()))
    }

    /// The shift in the low 4 bits, the material above.
    fn join_meta(shift: u32, material: u32) -> Option<i16> {
        (shift <= Self::GRID_BITS && material <= Self::MATERIALS_MAX).then_some((material << 4 | shift) as u16 as i16)
    }

    #[inline(always)]
    fn split_meta(meta: i16) -> (u32, u32) {
        (u32::from(meta as u16 & 15), u32::from(meta as u16 >> 4))
    }
}

#[cfg_attr(not(prefer_size), inline(always))]
#[cfg_attr(prefer_size, inline(never))]
fn product(a: i64, b: i64) -> i128 {
    i128::from(a) * i128::from(b)
}

/// t to Q16 by one correction of the approximate depth: with t0 in Q16, the remainder (tn << 16) - t0 det is at most
/// SLACK * 2^3 = 2^6 determinants, and its quotient by the 16-bit reciprocal is within 2^-7 of true before the floor. So t
/// is low by less than 2^-16 (1 + 2^-7).
#[cfg_attr(not(prefer_size), inline(always))]
#[cfg_attr(prefer_size, inline(never))]
fn quotient_q16(numerator: i64, denominator: i64) -> i32 {
    let t0_q16 = Width14::depth(numerator, denominator) << 3;
    // tn < 2^47, so tn << 16 fits, and t0 det is the same within 2^6 det < 2^51.
    let remainder = (numerator << 16) - i64::from(t0_q16) * denominator;
    let bits = bits_of(denominator);
    let r = reciprocal(scaled(denominator, bits, 16) as u32);
    // |remainder| < 2^6 det: scaled to a denominator of 16 bits and 8 bits less, below 2^14.
    let scaled = scaled(remainder, bits, 8) as i32;
    // mantissa / 2^31 is 1 / the 16-bit denominator.
    t0_q16 + ((scaled * r.mantissa as i32) >> 23)
}

/// The number of bits of a positive value.
#[cfg_attr(not(prefer_size), inline)]
#[cfg_attr(prefer_size, inline(never))]
fn bits_of(value: i64) -> u32 {
    value.cast_unsigned().bit_length()
}

/// `value * 2^(to - from)`, rounded down: of a value with `from` bits, the leading `to`.
#[cfg_attr(not(prefer_size), inline)]
#[cfg_attr(prefer_size, inline(never))]
fn scaled(value: i64, from: u32, to: u32) -> i64 {
    if from > to { value >> (from - to) } else { value << (to - from) }
}
