//! Shading beside a 29-bit grid, in 64 bits: points in Q8, unit vectors and barycentrics in Q30 or Q31.
//!
//! Q30 holds 1, and what rounding makes of it. Q31 does not: there 1 is `1 - 2^-31`, as in the 2009 report's Table 1, and
//! what is made saturates.

mod optics;

pub(crate) use optics::Optics;

use core::marker::PhantomData;

use fixed::FixedI32;
use fixed::types::U16F16;
use fixed::types::extra::{U30, U31};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use super::{Space, faded, is_unit_q30, raised_q31};
use crate::colour::{Radiance, Rgb16};
use crate::num::{Triple, bits, dot, inverse_sqrt_u64, on_circle_q30, round_shift, sqrt_u64, sub};
use crate::record::{Checker, Reach};

/// The space of 29-bit grids, with `F` (30 or 31) fractional bits in unit vectors and barycentrics.
#[derive(Clone, Copy, Debug, Default)]
pub struct Grid29With<F>(PhantomData<F>);

/// With Q30: components in [-2, 2).
pub type Grid29 = Grid29With<U30>;

/// With Q31: components in [-1, 1).
pub type GridQ31 = Grid29With<U31>;

/// Fractional bits of a point: the grid is subdivided by 256.
pub(crate) const POINT_BITS: u32 = 8;

/// A unit vector in Q30.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Normal29(pub [i32; 3]);

/// 30 or 31 fractional bits.
pub trait Fraction: Optics {}

impl Fraction for U30 {}
impl Fraction for U31 {}

/// The nearest number of the format.
#[inline]
pub(crate) fn saturated<F: Fraction>(bits: i64) -> FixedI32<F> {
    FixedI32::from_bits(bits.clamp(i32::MIN.into(), i32::MAX.into()) as i32)
}

/// The components in Q30, in which products have room.
#[inline]
pub(crate) fn q30<F: Fraction>(unit: Triple<FixedI32<F>>) -> Triple<i64> {
    wide(unit).map(|c| c >> (F::U32 - 30))
}

#[inline]
pub(crate) fn from_q30<F: Fraction>(c_q30: i64) -> FixedI32<F> {
    saturated(c_q30 << (F::U32 - 30))
}

#[inline]
pub(crate) fn wide<F: Fraction>(unit: Triple<FixedI32<F>>) -> Triple<i64> {
    unit.map(|c| c.to_bits().into())
}

/// `v` with length 1, each component within 2^-28 of true; `None` for zero. Any `v` up to 2^62.
///
/// As in 14 bits: `v` scaled to 31 bits, its squares sum to less than 2^64, [`inverse_sqrt_u64`] has 2^-28.
/// (v <= 2^31) * (y <= 2^31) fits. The error of the square root is one factor for all three: it makes the vector longer or
/// shorter, and its direction is within 2^-31.
#[inline]
pub(crate) fn normalise<F: Fraction>(v: Triple<i64>) -> Option<Triple<FixedI32<F>>> {
    let bits = bits(v);
    if bits == 0 {
        return None;
    }
    let v = if bits > 31 { v.map(|c| round_shift(c, bits - 31)) } else { v.map(|c| c << (31 - bits)) };
    let square: u64 = v.iter().map(|&c| (c * c) as u64).sum();
    let half_shift = u32::from(square < 1 << 62); // the square is at least 2^60
    let y_q31 = (inverse_sqrt_u64(square << (2 * half_shift)) >> 1) as i64;
    // v / sqrt(square) = v y 2^half_shift / 2^62.
    Some(v.map(|c| saturated(round_shift(c * y_q31, 62 - F::U32 - half_shift))))
}

impl<F: Fraction> Space for Grid29With<F> {
    type Point = Triple<i64>;
    type Unit = Triple<FixedI32<F>>;
    type Fraction = FixedI32<F>;
    type Colour = Rgb16;
    type Normal = Normal29;

    #[inline]
    fn unit(normal: &Normal29) -> Self::Unit {
        Self::unit_from_q30(normal.0)
    }

    fn is_unit(normal: &Normal29) -> bool {
        is_unit_q30(normal.0)
    }

    fn normal(unit_q30: Triple<i32>) -> Normal29 {
        Normal29(unit_q30)
    }

    #[inline]
    fn unit_from_q30(unit_q30: Triple<i32>) -> Self::Unit {
        unit_q30.map(|c| saturated(i64::from(c) << (F::U32 - 30)))
    }

    #[inline]
    fn point(grid: Triple<i32>) -> Self::Point {
        grid.map(|c| i64::from(c) << POINT_BITS)
    }

    #[inline]
    fn towards(from: Self::Point, to: Self::Point) -> Option<Self::Unit> {
        normalise(sub(to, from)) // both below 2^39
    }

    /// Weights sum to 1 and units are at most 1, in Q31 at most: each sum is at most 2^62.
    #[inline]
    fn interpolate(normals: [Self::Unit; 3], u: FixedI32<F>, v: FixedI32<F>) -> Option<Self::Unit> {
        let (u, v) = (i64::from(u.to_bits()), i64::from(v.to_bits()));
        let w = (1 << F::U32) - u - v;
        let [n0, n1, n2] = normals.map(wide);
        normalise([
            w * n0[0] + u * n1[0] + v * n2[0],
            w * n0[1] + u * n1[1] + v * n2[1],
            w * n0[2] + u * n1[2] + v * n2[2],
        ])
    }

    /// Differences are scaled to 31 bits, as in 14 bits to 15.
    fn lift(
        point: Self::Point,
        corners: [Self::Point; 3],
        normals: [Self::Unit; 3],
        [u, v]: [FixedI32<F>; 2],
        [low, high]: [Self::Point; 2],
    ) -> Self::Point {
        let [u, v] = [u, v].map(|weight| i64::from(weight.to_bits()) >> (F::U32 - 30));
        let mut lifted = point;
        for ((corner, normal), weight_q30) in corners.into_iter().zip(normals).zip([(1 << 30) - u - v, u, v]) {
            let away = sub(point, corner);
            let shift = bits(away).saturating_sub(31);
            let normal = q30(normal);
            let height = round_shift(dot(away.map(|c| c >> shift), normal), 30);
            if height < 0 {
                for (lifted, n_q30) in lifted.iter_mut().zip(normal) {
                    *lifted -= round_shift(round_shift(height * n_q30, 30) * weight_q30, 30) << shift;
                }
            }
        }
        // Not `clamp`, which would panic if the range had no inside.
        let within = |axis: usize| lifted[axis].max(low[axis]).min(high[axis]);
        [within(0), within(1), within(2)]
    }

    #[inline]
    fn near(a: Self::Unit, b: Self::Unit) -> bool {
        dot(wide(a), wide(b)) > 1 << (2 * F::U32 - 2)
    }

    /// Differences are below 2^30 and weights at most 1 in Q31: each product is at most 2^61. What is wider than 32 bits, of
    /// weights that no hit has, is cut.
    #[inline]
    fn blend([a, b, c]: Triple<i32>, u: FixedI32<F>, v: FixedI32<F>) -> i32 {
        let share = |to: i32, weight: FixedI32<F>| i64::from(to - a) * i64::from(weight.to_bits());
        (i64::from(a) + round_shift(share(b, u) + share(c, v), F::U32)) as i32
    }

    #[inline]
    fn negate(unit: Self::Unit) -> Self::Unit {
        wide(unit).map(|c| saturated(-c))
    }

    #[inline]
    fn aligned(a: Self::Unit, b: Self::Unit) -> bool {
        dot(wide(a), wide(b)) >= 0
    }

    /// Of units the dot product and its partial sums are at most 1 in Q60 or Q62, and little over 1 by what they are off.
    #[inline]
    fn cosine(a: Self::Unit, b: Self::Unit) -> Option<U16F16> {
        let cosine = dot(wide(a), wide(b));
        (cosine > 0).then(|| U16F16::from_bits((round_shift(cosine, 2 * F::U32 - 16) as u32).min(1 << 16)))
    }

    #[inline]
    fn reflect(along: Self::Unit, normal: Self::Unit) -> Self::Unit {
        F::reflect(along, normal)
    }

    #[inline]
    fn refract(along: Self::Unit, normal: Self::Unit, eta_q28: u32) -> Option<Self::Unit> {
        F::refract(along, normal, eta_q28)
    }

    /// As in 14 bits, with all bits of the numbers: the root is below 2^32, and its half times the circle's Q30 below 2^62.
    fn anywhere([height, turn]: [u32; 2]) -> Self::Unit {
        let up_q32 = 2 * u64::from(height) + 1;
        let across_q31 = ((sqrt_u64(((1 << 33) - up_q32) * up_q32) + 1) >> 1) as i64;
        let [x, y] = on_circle_q30(turn).map(|c_q30| saturated(round_shift(across_q31 * c_q30, 61 - F::U32)));
        [x, y, saturated(round_shift(up_q32 as i64 - (1 << 32), 32 - F::U32))]
    }

    fn strewn(unit: Self::Unit, by: Self::Unit, share: u16) -> Option<Self::Unit> {
        // A 65535th is 65537 of 2^32 - 1. Each product is at most 2^61.
        let (unit, by, share_q30) = (wide(unit), wide(by), (i64::from(share) * 65_537 + 2) >> 2);
        let sum = |a: i64, b: i64| (a << 30) + b * share_q30;
        normalise([sum(unit[0], by[0]), sum(unit[1], by[1]), sum(unit[2], by[2])])
    }

    #[inline]
    fn halfway(a: Self::Unit, b: Self::Unit) -> Option<Self::Unit> {
        F::halfway(a, b)
    }

    #[inline]
    fn lobe(a: Self::Unit, b: Self::Unit, exponent_q2: u16) -> U16F16 {
        F::lobe(a, b, exponent_q2)
    }

    #[inline]
    fn fresnel(cosine: U16F16, r0: u16) -> U16F16 {
        F::fresnel(cosine, r0)
    }

    /// As in 14 bits: with the difference scaled to 31 bits its square is in [2^60, 3 * 2^62), and the quotient in
    /// (2^22, 2^27], within 2^-22 of true.
    #[inline]
    fn faded(light: Radiance, from: Self::Point, to: Self::Point, reach: &Reach) -> Radiance {
        let v = sub(to, from);
        let bits = bits(v);
        if bits == 0 || reach.mantissa == 0 {
            return light;
        }
        let v = if bits > 31 { v.map(|c| round_shift(c, bits - 31)) } else { v.map(|c| c << (31 - bits)) };
        let square: u64 = v.iter().map(|&c| (c * c) as u64).sum();
        // mantissa / square in Q71; `max` says that the denominator is not 0.
        let factor = ((u64::from(reach.mantissa) << 47) / (square >> 24).max(1)) as u32;
        let units = 2 * (31 - bits as i32 + POINT_BITS as i32);
        faded(light, factor, units + i32::from(reach.exponent) + 32 - 71)
    }

    #[inline]
    fn altitude(unit: Self::Unit) -> [U16F16; 2] {
        let y_q16 = round_shift(i64::from(unit[1].to_bits()), F::U32 - 16);
        let up_q17 = ((1 << 16) + y_q16).clamp(0, 1 << 17) as u32;
        [(1 << 16) - (up_q17 >> 1), up_q17 >> 1].map(U16F16::from_bits)
    }

    #[inline]
    fn longest(unit: Self::Unit) -> usize {
        let [x, y, z] = unit.map(|c| c.to_bits().unsigned_abs());
        if x >= y && x >= z { 0 } else { usize::from(y < z) + 1 }
    }

    /// A cube is 2^63 in a word that wraps. A point is below 2^38: half a unit of the step makes it 2^-26 of a cube.
    #[inline]
    fn is_odd(point: Self::Point, across: usize, checker: &Checker) -> bool {
        let place = |axis: usize| {
            let moved = (point[axis] as u64).wrapping_mul(checker.step_q63).wrapping_add(checker.start_q63[axis]);
            moved.wrapping_add(u64::from(raised_q31(axis == across)) << 32)
        };
        (place(0) ^ place(1) ^ place(2)) >> 63 == 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn q31_saturates_at_one_and_keeps_minus_one() {
        let axis = |c: i64| GridQ31::towards([0; 3], [c, 0, 0]).unwrap().map(FixedI32::to_bits);
        for length in [1, 3, 1 << 20, (1 << 38) + 1] {
            // Within 2^-28, and never beyond the format.
            assert!(axis(length)[0] >= i32::MAX - 8 && axis(-length)[0] <= i32::MIN + 8, "{length}");
        }
        let one = GridQ31::unit_from_q30([1 << 30, 0, -1 << 30]);
        assert_eq!(one.map(FixedI32::to_bits), [i32::MAX, 0, i32::MIN]);
        assert_eq!(GridQ31::negate(one).map(FixedI32::to_bits), [-i32::MAX, 0, i32::MAX]);
    }

    /// The largest sums that interpolation and a cosine can make, where overflow would be trapped.
    #[test]
    fn q31_holds_the_largest_sums() {
        let corner = GridQ31::unit_from_q30([-1 << 30, 0, 0]);
        let (zero, most) = (FixedI32::from_bits(0), FixedI32::from_bits(i32::MAX));
        for (u, v) in [(zero, zero), (most, zero), (zero, most)] {
            let found = GridQ31::interpolate([corner; 3], u, v).unwrap();
            assert!(found[0].to_bits() <= i32::MIN + 8, "{found:?}");
        }
        assert_eq!(GridQ31::cosine(corner, corner), Some(U16F16::ONE));
        let diagonal = GridQ31::towards([0; 3], [1, 1, 1]).unwrap();
        assert_eq!(GridQ31::cosine(diagonal, diagonal), Some(U16F16::ONE));
        assert_eq!(GridQ31::cosine(diagonal, GridQ31::negate(diagonal)), None);
    }
}
