//! Shading beside a 29-bit grid, in 64 bits: unit vectors and barycentrics in Q30, points in Q8.

use fixed::types::{I2F30, U16F16};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use super::{Space, is_unit_q30};
use crate::colour::Rgb16;
use crate::num::{Triple, bits, dot, inverse_sqrt_u64, round_shift, sub};

/// The space of 29-bit grids.
#[derive(Clone, Copy, Debug, Default)]
pub struct Grid29;

/// Fractional bits of a point: the grid is subdivided by 256.
pub(crate) const POINT_BITS: u32 = 8;

/// A unit vector in Q30.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Normal29(pub [i32; 3]);

/// `v` with length 1, each component within 2^-28 of true; `None` for zero. Any `v` below 2^62.
///
/// As in 14 bits: `v` scaled to 31 bits, its squares sum to less than 2^64, [`inverse_sqrt_u64`] has 2^-28.
/// (v <= 2^31) * (y <= 2^31) fits.
#[inline]
pub(crate) fn normalise(v: Triple<i64>) -> Option<Triple<I2F30>> {
    let bits = bits(v);
    if bits == 0 {
        return None;
    }
    let v = if bits > 31 { v.map(|c| round_shift(c, bits - 31)) } else { v.map(|c| c << (31 - bits)) };
    let square: u64 = v.iter().map(|&c| (c * c) as u64).sum();
    let half_shift = square.leading_zeros() / 2; // 0 or 1: the square is at least 2^60
    let y_q31 = (inverse_sqrt_u64(square << (2 * half_shift)) >> 1) as i64;
    // v / sqrt(square) = v y 2^half_shift / 2^62; to Q30.
    Some(v.map(|c| I2F30::from_bits(round_shift(c * y_q31, 32 - half_shift) as i32)))
}

impl Space for Grid29 {
    type Point = Triple<i64>;
    type Unit = Triple<I2F30>;
    type Fraction = I2F30;
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
        unit_q30.map(I2F30::from_bits)
    }

    #[inline]
    fn point(grid: Triple<i32>) -> Self::Point {
        grid.map(|c| i64::from(c) << POINT_BITS)
    }

    #[inline]
    fn towards(from: Self::Point, to: Self::Point) -> Option<Self::Unit> {
        normalise(sub(to, from)) // both below 2^39
    }

    /// Weights sum to 1 in Q30 and units are at most 1 in Q30: each sum is at most 2^60.
    #[inline]
    fn interpolate(normals: [Self::Unit; 3], u: I2F30, v: I2F30) -> Option<Self::Unit> {
        let (u, v) = (i64::from(u.to_bits()), i64::from(v.to_bits()));
        let w = (1 << 30) - u - v;
        let [n0, n1, n2] = normals.map(|n| n.map(|c| i64::from(c.to_bits())));
        normalise([
            w * n0[0] + u * n1[0] + v * n2[0],
            w * n0[1] + u * n1[1] + v * n2[1],
            w * n0[2] + u * n1[2] + v * n2[2],
        ])
    }

    #[inline]
    fn negate(unit: Self::Unit) -> Self::Unit {
        unit.map(|c| -c) // a unit vector's components are in [-1, 1], and Q30 goes to -2
    }

    #[inline]
    fn aligned(a: Self::Unit, b: Self::Unit) -> bool {
        dot_q60(a, b) >= 0
    }

    #[inline]
    fn cosine(a: Self::Unit, b: Self::Unit) -> Option<U16F16> {
        let cosine_q60 = dot_q60(a, b);
        (cosine_q60 > 0).then(|| U16F16::from_bits((round_shift(cosine_q60, 44) as u32).min(1 << 16)))
    }
}

/// At most 3 * 2^60, in practice little over 2^60.
#[inline]
fn dot_q60(a: Triple<I2F30>, b: Triple<I2F30>) -> i64 {
    dot(a.map(|c| i64::from(c.to_bits())), b.map(|c| i64::from(c.to_bits())))
}
