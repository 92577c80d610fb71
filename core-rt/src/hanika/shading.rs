//! The 2009 report's own shading (section 2.5): Q31 throughout, vectors halved where a sum might overflow, products that are
//! truncated, an integer power by squaring (Warren, "Hacker's Delight"), an index of refraction in Q16.16.
//!
//! The report gives Schlick's law in full and describes the rest; what is marked *derived* is the plainest code that does
//! what it says. It is kept as it is to be compared with: "we often scale vectors to avoid overflow ... and these bits
//! cannot be recovered".

use fixed::FixedI32;
use fixed::types::U16F16;
use fixed::types::extra::U31;

use crate::num::{Triple, dot, sqrt_u64};
use crate::space::grid29::{Optics, normalise, saturated, wide};

type Unit = Triple<FixedI32<U31>>;

/// The product of two numbers of Q31, truncated; at most 1 each.
#[inline]
fn product_q31(a: i64, b: i64) -> i64 {
    (a * b) >> 31
}

/// Half of a vector, whose lowest bits are lost.
#[inline]
fn half(unit: Unit) -> Triple<i64> {
    wide(unit).map(|c| c >> 1)
}

impl Optics for U31 {
    /// V - 2 (N . V) N with V and N halved, so that all is in range: half of it is v - 8 (n . v) n. Derived.
    #[inline]
    fn reflect(along: Unit, normal: Unit) -> Unit {
        let (v, n) = (half(along), half(normal));
        let dot_q31 = dot(v, n) >> 31; // a quarter at most
        let mirrored = |v: i64, n: i64| saturated((v - product_q31(dot_q31 << 3, n)) << 1);
        [mirrored(v[0], n[0]), mirrored(v[1], n[1]), mirrored(v[2], n[2])]
    }

    /// eta V + (eta c - c') N with eta in Q16.16, which leaves 2^47 at most. Derived.
    #[inline]
    fn refract(along: Unit, normal: Unit, eta_q28: u32) -> Option<Unit> {
        let (v, n, eta_q16) = (wide(along), wide(normal), i64::from(eta_q28 >> 12));
        let cosine_q31 = (-(dot(v, n) >> 31)).clamp(0, 1 << 31);
        // The sine before the surface squared, times eta twice, in Q31: below 2^31 2^4 2^4.
        let sine2_q31 = (1 << 31) - product_q31(cosine_q31, cosine_q31);
        let behind2_q31 = (1 << 31) - ((((sine2_q31 * eta_q16) >> 16) * eta_q16) >> 16);
        let behind_q31 = sqrt_u64(u64::try_from(behind2_q31).ok()? << 31) as i64;
        let along_normal_q31 = ((cosine_q31 * eta_q16) >> 16) - behind_q31; // below 2^35
        let bent = |v: i64, n: i64| saturated(((v * eta_q16) >> 16) + (((along_normal_q31 >> 4) * n) >> 27));
        Some([bent(v[0], n[0]), bent(v[1], n[1]), bent(v[2], n[2])])
    }

    /// L - V, both halved, so that the sum is in range.
    #[inline]
    fn halfway(a: Unit, b: Unit) -> Option<Unit> {
        let (a, b) = (half(a), half(b));
        normalise([a[0] + b[0], a[1] + b[1], a[2] + b[2]])
    }

    /// (H . N)^n by squaring, truncated at each step, then to Q16: a whole exponent.
    #[inline]
    fn lobe(a: Unit, b: Unit, exponent_q2: u16) -> U16F16 {
        let mut base_q31 = (dot(wide(a), wide(b)) >> 31).clamp(0, (1 << 31) - 1);
        let (mut power_q31, mut exponent) = ((1 << 31) - 1, exponent_q2 >> 2);
        while exponent > 0 {
            if exponent & 1 == 1 {
                power_q31 = product_q31(power_q31, base_q31);
            }
            base_q31 = product_q31(base_q31, base_q31);
            exponent >>= 1;
        }
        U16F16::from_bits((power_q31 >> 15) as u32)
    }

    /// R0 + (1 - R0) k^5, k = 1 - cos, in Q31 and then shifted to the Q16 of colours.
    #[inline]
    fn fresnel(cosine: U16F16, r0: u16) -> U16F16 {
        let k_q31 = (1 << 31) - (i64::from(cosine.to_bits().min(1 << 16)) << 15);
        let k2_q31 = product_q31(k_q31, k_q31);
        let k4_q31 = product_q31(k2_q31, k2_q31);
        let k5_q16 = product_q31(k4_q31, k_q31) >> 15;
        U16F16::from_bits((i64::from(r0) + (((65_536 - i64::from(r0)) * k5_q16) >> 16)) as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::space::{GridQ31, Space};

    fn unit(c: [i64; 3]) -> Unit {
        GridQ31::towards([0; 3], c).unwrap()
    }

    fn close(found: Unit, meant: Unit, bits: u32) -> bool {
        wide(found).iter().zip(wide(meant)).all(|(f, m)| f.abs_diff(m) < 1 << bits)
    }

    #[test]
    fn mirrors_and_glass() {
        let (down, up) = (unit([3, -4, 0]), unit([0, 1, 0]));
        assert!(close(GridQ31::reflect(down, up), unit([3, 4, 0]), 5));
        // sin = 3/5, behind glass of 1.5: 2/5.
        let bent = GridQ31::refract(down, up, (1 << 29) / 3).unwrap();
        assert!(close(bent, unit([400_000, -916_515, 0]), 17), "Q16.16 keeps 2^-16 of the index");
        assert_eq!(GridQ31::refract(unit([4, -3, 0]), up, 3 << 27), None);
        assert!(close(GridQ31::halfway(unit([1, 0, 0]), up).unwrap(), unit([1, 1, 0]), 5));
    }

    #[test]
    fn powers_are_truncated() {
        let (x, tilted) = (unit([1, 0, 0]), unit([4, 3, 0]));
        assert_eq!(GridQ31::lobe(x, x, 4).to_bits(), 0xffff);
        let square = GridQ31::lobe(x, tilted, 8).to_bits();
        assert!((41_940..=41_943).contains(&square), "0.64: {square}");
        assert_eq!(GridQ31::lobe(x, unit([0, 1, 0]), 4).to_bits(), 0);
        assert_eq!(
            (GridQ31::fresnel(U16F16::ZERO, 0), GridQ31::fresnel(U16F16::ONE, 2621)),
            (U16F16::ONE, U16F16::from_bits(2621))
        );
    }
}
