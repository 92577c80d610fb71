//! Shading beside a 14-bit grid, in 32 bits: unit vectors and barycentrics in Q14, points in Q4.
//!
//! Nothing here multiplies or divides in 64 bits, so that a Cortex-M0 shades at the price of `muls`.

use core::num::NonZeroU32;

use fixed::types::{I2F14, U16F16};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use super::{Space, faded, fresnel_q16, is_unit_q30, raised_q31};
use crate::colour::{Radiance, Rgb16};
use crate::num::{
    BitLength, Triple, bits, dot, inverse_sqrt_u32, on_circle_q15, power, reciprocal, round_shift, sqrt_u32, sub,
};
use crate::record::{Checker, Reach};

/// The space of 14-bit grids.
#[derive(Clone, Copy, Debug, Default)]
pub struct Grid14;

/// Fractional bits of a point: the grid is subdivided by 16.
pub(crate) const POINT_BITS: u32 = 4;

/// A unit vector in Q14 in three half-words.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Normal14(pub [i16; 3]);

/// `v` scaled so that its largest component has 15 bits, rounded to nearest (and so to 2^15 at most) where it has more, and
/// how many bits it has; `None` for zero.
#[inline(always)]
fn in_15_bits(v: Triple<i32>) -> Option<(Triple<i32>, u32)> {
    // The highest bit of all magnitudes is that of the largest.
    let [x, y, z] = v.map(i32::unsigned_abs);
    let all = NonZeroU32::new(x | y | z)?.get();
    let zeros = u32::BITS - all.bit_length();
    let v = match zeros.checked_sub(17) {
        Some(up) => v.map(|c| c << up),
        None => {
            let down = 16 - zeros; // after a halving, for the sum with the rounding half to fit
            let half = 1 << down >> 1;
            v.map(|c| ((c >> 1) + half) >> down)
        }
    };
    Some((v, u32::BITS - zeros))
}

/// `v` with length 1, each component within 2^-12.5 of true; `None` for zero. Any `v` that does not hold -2^31.
///
/// `v` is scaled to 15 bits (rounded where it has more), so that its squares sum to less than 2^32. That sum, shifted
/// left by an even number of bits, is in the range of [`inverse_sqrt_u32`], whose error is 2^-13; the rounding of v is
/// 2^-15 a component. (v <= 2^15) * (y <= 2^15) fits.
#[inline]
pub(crate) fn normalise(v: Triple<i32>) -> Option<Triple<I2F14>> {
    let (v, _) = in_15_bits(v)?;
    let square: u32 = v.iter().map(|&c| (c * c) as u32).sum();
    let half_shift = u32::from(square < 1 << 30); // the square is at least 2^28
    let y_q15 = (inverse_sqrt_u32(square << (2 * half_shift)) >> 1) as i32;
    // v / sqrt(square) = v y 2^half_shift / 2^30; to Q14.
    let unit = |c: i32| I2F14::from_bits(round_shift(c * y_q15, 16 - half_shift) as i16);
    Some([unit(v[0]), unit(v[1]), unit(v[2])])
}

impl Space for Grid14 {
    type Point = Triple<i32>;
    type Unit = Triple<I2F14>;
    type Fraction = I2F14;
    type Colour = Rgb16;
    type Normal = Normal14;

    #[inline]
    fn unit(normal: &Normal14) -> Self::Unit {
        normal.0.map(I2F14::from_bits)
    }

    fn is_unit(normal: &Normal14) -> bool {
        is_unit_q30(normal.0.map(|c| i32::from(c) << 16))
    }

    fn normal(unit_q30: Triple<i32>) -> Normal14 {
        Normal14(Self::unit_from_q30(unit_q30).map(I2F14::to_bits))
    }

    #[inline]
    fn unit_from_q30(unit_q30: Triple<i32>) -> Self::Unit {
        // |c| <= 2^30, so the sum with the rounding half fits.
        unit_q30.map(|c| I2F14::from_bits(round_shift(c, 16) as i16))
    }

    #[inline]
    fn point(grid: Triple<i32>) -> Self::Point {
        grid.map(|c| c << POINT_BITS)
    }

    #[inline]
    fn towards(from: Self::Point, to: Self::Point) -> Option<Self::Unit> {
        normalise(sub(to, from)) // both below 2^20
    }

    /// Weights sum to 1 in Q14 and units are at most 1 in Q14: each sum is at most 2^28.
    #[inline]
    fn interpolate(normals: [Self::Unit; 3], u: I2F14, v: I2F14) -> Option<Self::Unit> {
        let (u, v) = (i32::from(u.to_bits()), i32::from(v.to_bits()));
        let w = (1 << 14) - u - v;
        let [n0, n1, n2] = normals.map(|n| n.map(|c| i32::from(c.to_bits())));
        normalise([
            w * n0[0] + u * n1[0] + v * n2[0],
            w * n0[1] + u * n1[1] + v * n2[1],
            w * n0[2] + u * n1[2] + v * n2[2],
        ])
    }

    /// Differences are scaled to 15 bits, so that a dot product is below 3 * 2^29 and, in units of the scaled difference, little
    /// over 2^15 * 3^(1/2); with a normal below 2^31, with a weight below 2^31 again.
    fn lift(
        point: Self::Point,
        corners: [Self::Point; 3],
        normals: [Self::Unit; 3],
        [u, v]: [I2F14; 2],
        [low, high]: [Self::Point; 2],
    ) -> Self::Point {
        let (u, v) = (i32::from(u.to_bits()), i32::from(v.to_bits()));
        let mut lifted = point;
        for ((corner, normal), weight_q14) in corners.into_iter().zip(normals).zip([(1 << 14) - u - v, u, v]) {
            let away = sub(point, corner);
            let shift = bits(away).saturating_sub(15);
            let normal = normal.map(bits_of);
            let height = round_shift(dot(away.map(|c| c >> shift), normal), 14);
            if height < 0 {
                for (lifted, n_q14) in lifted.iter_mut().zip(normal) {
                    *lifted -= round_shift(round_shift(height * n_q14, 14) * weight_q14, 14) << shift;
                }
            }
        }
        // Not `clamp`, which would panic if the range had no inside.
        let within = |axis: usize| lifted[axis].max(low[axis]).min(high[axis]);
        [within(0), within(1), within(2)]
    }

    #[inline]
    fn near(a: Self::Unit, b: Self::Unit) -> bool {
        dot_q28(a, b) > 1 << 26
    }

    /// By the differences, which are below 2^30, rounded to 15 bits and shifted by at most 15: within half a unit and 2^-15 of
    /// the largest of them. Their products with weights of at most 2^14 are at most 2^29, and their sum 2^30. No hit's weights
    /// sum to more than 1 + 2^-11; what the shift to the left would lose of a larger sum is lost.
    #[cfg_attr(not(prefer_size), inline)]
    #[cfg_attr(prefer_size, inline(never))]
    fn blend([a, b, c]: Triple<i32>, u: I2F14, v: I2F14) -> i32 {
        let (p, q) = (b - a, c - a);
        let shift = bits([p, q, 0]).saturating_sub(15);
        let sum_q14 = round_shift(p, shift) * bits_of(u) + round_shift(q, shift) * bits_of(v);
        a.wrapping_add(if shift < 14 { round_shift(sum_q14, 14 - shift) } else { sum_q14 << (shift - 14) })
    }

    #[inline]
    fn negate(unit: Self::Unit) -> Self::Unit {
        unit.map(|c| -c) // a unit vector's components are in [-1, 1], and Q14 goes to -2
    }

    #[inline]
    fn aligned(a: Self::Unit, b: Self::Unit) -> bool {
        dot_q28(a, b) >= 0
    }

    #[cfg_attr(not(prefer_size), inline)]
    #[cfg_attr(prefer_size, inline(never))]
    fn cosine(a: Self::Unit, b: Self::Unit) -> Option<U16F16> {
        let cosine_q28 = dot_q28(a, b);
        (cosine_q28 > 0).then(|| U16F16::from_bits((round_shift(cosine_q28, 12) as u32).min(1 << 16)))
    }

    /// 2 (d . n) is little over 2 in Q14, and its product with n below 2^30.
    #[inline]
    fn reflect(along: Self::Unit, normal: Self::Unit) -> Self::Unit {
        let twice_q14 = round_shift(dot_q28(along, normal), 13);
        let mirrored = |d: I2F14, n: I2F14| narrow(i32::from(d.to_bits()) - round_shift(twice_q14 * bits_of(n), 14));
        [mirrored(along[0], normal[0]), mirrored(along[1], normal[1]), mirrored(along[2], normal[2])]
    }

    /// The part along the surface is (d + c n) eta, c = -(d . n), and the rest is left for the normal: sqrt(1 - part^2).
    /// eta is below 16, so 16 bits in Q12, and its product with what is at most 1 in Q14 below 2^31.
    #[inline]
    fn refract(along: Self::Unit, normal: Self::Unit, eta_q28: u32) -> Option<Self::Unit> {
        let eta_q12 = (eta_q28 >> 16) as i32;
        let cosine_q14 = -round_shift(dot_q28(along, normal), 14);
        let part = |d: I2F14, n: I2F14| {
            let across_q14 = i32::from(d.to_bits()) + round_shift(cosine_q14 * bits_of(n), 14);
            round_shift(across_q14.clamp(-(1 << 14), 1 << 14) * eta_q12, 12)
        };
        let part = [part(along[0], normal[0]), part(along[1], normal[1]), part(along[2], normal[2])];
        if bits(part) > 15 {
            return None; // at least 2
        }
        let square_q28: u32 = part.iter().map(|&c| (c * c) as u32).sum(); // at most 3 * 2^30
        let behind_q14 = sqrt_u32((1u32 << 28).checked_sub(square_q28)?) as i32;
        let bent = |part: i32, n: I2F14| narrow(part - round_shift(behind_q14 * bits_of(n), 14));
        Some([bent(part[0], normal[0]), bent(part[1], normal[1]), bent(part[2], normal[2])])
    }

    /// Upper halves of the numbers: 2^16 heights, from -1 to 1 and a unit of 2^-16 off those, and as many turns. A height z in Q16
    /// is odd, so that (1 - z) (1 + z) is below 2^32; its root, below 2^16, is halved for the product with the circle's Q15.
    fn anywhere([height, turn]: [u32; 2]) -> Self::Unit {
        let up_q16 = 2 * (height >> 16) + 1;
        let across_q15 = ((sqrt_u32(((1 << 17) - up_q16) * up_q16) + 1) >> 1) as i32;
        let [x, y] = on_circle_q15((turn >> 16) as u16).map(|c_q15| narrow(round_shift(across_q15 * c_q15, 16)));
        [x, y, narrow(round_shift(up_q16 as i32 - (1 << 16), 2))]
    }

    /// The share is rounded down to Q15, in which 65535 is 1; each product is at most 2^29.
    fn strewn(unit: Self::Unit, by: Self::Unit, share: u16) -> Option<Self::Unit> {
        let share_q15 = (i32::from(share) + i32::from(share >> 15)) >> 1;
        let sum = |a: I2F14, b: I2F14| (bits_of(a) << 15) + bits_of(b) * share_q15;
        normalise([sum(unit[0], by[0]), sum(unit[1], by[1]), sum(unit[2], by[2])])
    }

    #[inline]
    fn halfway(a: Self::Unit, b: Self::Unit) -> Option<Self::Unit> {
        let sum = |a: I2F14, b: I2F14| bits_of(a) + bits_of(b);
        normalise([sum(a[0], b[0]), sum(a[1], b[1]), sum(a[2], b[2])])
    }

    /// The chord is little over 2 at most, its square below 2^31 in Q28: twice that is the versine in Q30.
    #[inline]
    fn lobe(a: Self::Unit, b: Self::Unit, exponent_q2: u16) -> U16F16 {
        let square = |a: I2F14, b: I2F14| {
            let chord = bits_of(a) - bits_of(b);
            (chord * chord) as u32
        };
        let square_q28 = square(a[0], b[0]) + square(a[1], b[1]) + square(a[2], b[2]);
        U16F16::from_bits(power(square_q28.min(1 << 30) << 1, exponent_q2))
    }

    #[inline]
    fn fresnel(cosine: U16F16, r0: u16) -> U16F16 {
        U16F16::from_bits(fresnel_q16(cosine.to_bits(), r0.into()))
    }

    /// With the difference scaled to 15 bits its square s is in [2^28, 3 * 2^30), and within 2^-13 of true. The reciprocal of
    /// s / 2 is `mantissa / 2^(16 + log2_d)`, low by up to 2^-14 and high by 2^-15 since s is truncated to 16 bits.
    #[inline]
    fn faded(light: Radiance, from: Self::Point, to: Self::Point, reach: &Reach) -> Radiance {
        if reach.mantissa == 0 {
            return light;
        }
        let Some((v, bits)) = in_15_bits(sub(to, from)) else { return light };
        let square: u32 = v.iter().map(|&c| (c * c) as u32).sum();
        let r = reciprocal(square >> 1);
        let factor_q32 = u32::from(reach.mantissa) * r.mantissa;
        let units = 2 * (15 - bits as i32 + POINT_BITS as i32);
        faded(light, factor_q32, units + i32::from(reach.exponent) + 15 - r.log2_d as i32)
    }

    #[inline]
    fn altitude(unit: Self::Unit) -> [U16F16; 2] {
        let up_q16 = ((1 << 14) + bits_of(unit[1])).clamp(0, 1 << 15) as u32 * 2;
        [(1 << 16) - up_q16, up_q16].map(U16F16::from_bits)
    }

    #[inline]
    fn longest(unit: Self::Unit) -> usize {
        let [x, y, z] = unit.map(|c| bits_of(c).unsigned_abs());
        if x >= y && x >= z { 0 } else { usize::from(y < z) + 1 }
    }

    /// A cube is 2^31 in a word that wraps, so that whether one is odd is its highest bit: one multiplication an axis. A point
    /// is below 2^19, and half a unit of the step makes it 2^-13 of a cube.
    #[inline]
    fn is_odd(point: Self::Point, across: usize, checker: &Checker) -> bool {
        let step_q31 = (((checker.step_q63 >> (31 - (8 - POINT_BITS))) + 1) >> 1) as u32;
        let place = |axis: usize| {
            let start_q31 = (checker.start_q63[axis] >> 32) as u32;
            let moved = (point[axis] as u32).wrapping_mul(step_q31).wrapping_add(start_q31);
            moved.wrapping_add(raised_q31(axis == across))
        };
        (place(0) ^ place(1) ^ place(2)) >> 31 == 1
    }
}

#[inline(always)]
fn bits_of(c: I2F14) -> i32 {
    c.to_bits().into()
}

/// A component that is little over 1 at most.
#[inline(always)]
fn narrow(c_q14: i32) -> I2F14 {
    I2F14::from_bits(c_q14.clamp(-(1 << 15), (1 << 15) - 1) as i16)
}

/// At most 3 * 2^28, in practice little over 2^28.
#[inline]
fn dot_q28(a: Triple<I2F14>, b: Triple<I2F14>) -> i32 {
    dot(a.map(|c| i32::from(c.to_bits())), b.map(|c| i32::from(c.to_bits())))
}
