//! How directions are mirrored, bent and compared where there are 29 bits: what the kernels of the 2009 report do their own way.

use fixed::FixedI32;
use fixed::types::U16F16;
use fixed::types::extra::{LeEqU32, U30};

use super::{from_q30, normalise, q30, wide};
use crate::num::{Triple, bits, dot, power, round_shift, sqrt_u64, sub};
use crate::space::fresnel_q16;

/// The operations of [`Space`](crate::space::Space) of these names, for unit vectors with so many fractional bits.
pub trait Optics: LeEqU32 + Copy + Default + core::fmt::Debug + Send + Sync + 'static {
    /// See [`Space::reflect`](crate::space::Space::reflect).
    fn reflect(along: Triple<FixedI32<Self>>, normal: Triple<FixedI32<Self>>) -> Triple<FixedI32<Self>>;
    /// See [`Space::refract`](crate::space::Space::refract).
    fn refract(
        along: Triple<FixedI32<Self>>,
        normal: Triple<FixedI32<Self>>,
        eta_q28: u32,
    ) -> Option<Triple<FixedI32<Self>>>;
    /// See [`Space::halfway`](crate::space::Space::halfway).
    fn halfway(a: Triple<FixedI32<Self>>, b: Triple<FixedI32<Self>>) -> Option<Triple<FixedI32<Self>>>;
    /// See [`Space::lobe`](crate::space::Space::lobe).
    fn lobe(a: Triple<FixedI32<Self>>, b: Triple<FixedI32<Self>>, exponent_q2: u16) -> U16F16;
    /// See [`Space::fresnel`](crate::space::Space::fresnel).
    fn fresnel(cosine: U16F16, r0: u16) -> U16F16;
}

type Unit = Triple<FixedI32<U30>>;

impl Optics for U30 {
    #[inline]
    fn reflect(along: Unit, normal: Unit) -> Unit {
        let (d, n) = (q30(along), q30(normal));
        let twice_q30 = round_shift(dot(d, n), 29); // little over 2 at most
        let mirrored = |d: i64, n: i64| from_q30(d - round_shift(twice_q30 * n, 30));
        [mirrored(d[0], n[0]), mirrored(d[1], n[1]), mirrored(d[2], n[2])]
    }

    /// As in 14 bits; eta is below 16, and its product with what is at most 1 in Q30 below 2^62.
    #[inline]
    fn refract(along: Unit, normal: Unit, eta_q28: u32) -> Option<Unit> {
        let (d, n) = (q30(along), q30(normal));
        let cosine_q30 = -round_shift(dot(d, n), 30);
        let part = |d: i64, n: i64| {
            let across_q30 = d + round_shift(cosine_q30 * n, 30);
            round_shift(across_q30.clamp(-(1 << 30), 1 << 30) * i64::from(eta_q28), 28)
        };
        let part = [part(d[0], n[0]), part(d[1], n[1]), part(d[2], n[2])];
        if bits(part) > 31 {
            return None; // at least 2
        }
        let square_q60: u64 = part.iter().map(|&c| (c * c) as u64).sum(); // at most 3 * 2^62
        let behind_q30 = sqrt_u64((1u64 << 60).checked_sub(square_q60)?) as i64;
        let bent = |part: i64, n: i64| from_q30(part - round_shift(behind_q30 * n, 30));
        Some([bent(part[0], n[0]), bent(part[1], n[1]), bent(part[2], n[2])])
    }

    #[inline]
    fn halfway(a: Unit, b: Unit) -> Option<Unit> {
        let (a, b) = (wide(a), wide(b));
        normalise([a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    }

    /// The chord is little over 2 at most, its square below 2^63 in Q60; half of it is the versine.
    #[inline]
    fn lobe(a: Unit, b: Unit, exponent_q2: u16) -> U16F16 {
        let square_q60: u64 = sub(q30(a), q30(b)).iter().map(|&c| (c * c) as u64).sum();
        U16F16::from_bits(power((square_q60 >> 31) as u32, exponent_q2))
    }

    #[inline]
    fn fresnel(cosine: U16F16, r0: u16) -> U16F16 {
        U16F16::from_bits(fresnel_q16(cosine.to_bits(), r0.into()))
    }
}
