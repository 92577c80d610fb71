//! Reciprocals without a division: a table look-up and one Newton-Raphson step (Knuth, TAOCP 2, 4.3.3).
//!
//! A division costs about 180 instructions on a Cortex-M0 and this about 50. It serves as the reciprocal
//! of a ray's direction in the box test, and wherever a quotient may be low by a known amount.

use super::BitLength;

/// `1 / d` as `mantissa / 2^(16 + log2_d)`, never above the true value, and below it by less than one
/// part in `2^RECIPROCAL_ERROR_BITS`. See [`reciprocal`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Reciprocal16 {
    /// In `[2^15 - 2, 2^16)`.
    pub mantissa: u32,
    /// `floor(log2 d)`.
    pub log2_d: u32,
}

/// The relative error of [`reciprocal`] is below 2 to the minus this.
pub const RECIPROCAL_ERROR_BITS: u32 = 14;

/// The table is indexed by the 7 bits under the leading one, and holds 2^31 / x at each bin's middle.
const INDEX_BITS: u32 = 7;

const TABLE: [u16; 1 << INDEX_BITS] = {
    let mut table = [0; 1 << INDEX_BITS];
    let mut i = 0;
    while i < table.len() {
        // The middle of the bin, doubled to stay an integer: x = 2^15 + (i + 1/2) 2^8.
        let x_2 = (1u64 << 16) + (2 * i as u64 + 1) * (1 << 8);
        table[i] = ((1u64 << 32) / x_2) as u16;
        i += 1;
    }
    table
};

/// `1 / d` for `1 <= d < 2^31` (0 is answered as 1 is, so that no input is an error).
///
/// With x in [2^15, 2^16) the leading 16 bits of d (truncated for d >= 2^16, which the caller allows for),
/// r0 = table is within 2^-8 of 2^31 / x, so e = 2^31 - x r0 is below 2^23 in magnitude, and
/// r1 = r0 (1 + e / 2^31) is low by (e / 2^31)^2 < 2^-16, and its rounding is half a unit either way: one unit is
/// taken off so that the result is never high. The test goes through every d < 2^16.
#[cfg_attr(not(prefer_size), inline)]
#[cfg_attr(prefer_size, inline(never))]
pub fn reciprocal(d: u32) -> Reciprocal16 {
    let log2_d = (d | 1).bit_length() - 1;
    let x = if log2_d <= 15 { (d | (d == 0) as u32) << (15 - log2_d) } else { d >> (log2_d - 15) };
    Reciprocal16 { mantissa: mantissa(x), log2_d }
}

/// `2^31 / x` for x in [2^15, 2^16), as in [`reciprocal`].
#[inline(always)]
pub fn mantissa(x: u32) -> u32 {
    let index = (x >> (15 - INDEX_BITS)) as usize & ((1 << INDEX_BITS) - 1);
    let r0 = TABLE[index] as i32; // masked to the table's length: no check, no panic
    // x r0 is within 2^23 of 2^31 and may pass it; the wrapped difference is exact.
    let e = (1u32 << 31).wrapping_sub(x * r0 as u32) as i32;
    let r1 = r0 + ((r0 * (e >> 15) + (1 << 15)) >> 16);
    (r1 - 1) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn never_high_and_low_by_less_than_stated() {
        for d in 1..1u32 << 16 {
            let r = reciprocal(d);
            assert!((1 << 15) - 2 <= r.mantissa && r.mantissa < 1 << 16, "{d}: {r:?}");
            // mantissa d against 2^(16 + log2_d).
            let product = u64::from(r.mantissa) * u64::from(d);
            let one = 1u64 << (16 + r.log2_d);
            assert!(product <= one, "{d} is high: {r:?}");
            assert!((one - product) << RECIPROCAL_ERROR_BITS < one, "{d} is low: {r:?}");
        }
    }

    #[test]
    fn wider_arguments_are_truncated_to_16_bits() {
        for d in [1 << 16, (1 << 16) + 1, 0x1234_5678, (1 << 31) - 1] {
            let log2_d = 31 - u32::leading_zeros(d);
            let leading = d >> (log2_d - 15);
            assert_eq!(reciprocal(d).mantissa, reciprocal(leading).mantissa);
            assert_eq!(reciprocal(d).log2_d, log2_d);
        }
        assert_eq!(reciprocal(0), reciprocal(1));
    }
}
