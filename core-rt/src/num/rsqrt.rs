//! Inverse square roots without a division: a table look-up and Newton-Raphson steps,
//! y' = y (3 - x y^2) / 2 (Warren, Hacker's Delight, 2nd ed., 11-1; Ercegovac & Lang, Digital Arithmetic).
//!
//! Normalising a vector is one of these and three products; with a square root and three divisions it is
//! slower on a Cortex-M0 than soft float.

use super::BitLength;

/// The table is indexed by the 7 leading bits of x in [2^30, 2^32): 32 to 127.
const TABLE: [u16; 96] = {
    let mut table = [0; 96];
    let mut i = 0;
    while i < table.len() {
        // The middle of the bin, m = (i + 32 + 1/2) 2^25; the entry is 2^31 / sqrt(m), below 2^16.
        let m = (2 * (i as u128) + 65) << 24;
        // 2^31 / sqrt(m) = sqrt(2^62 / m).
        table[i] = ((1u128 << 62) / m).isqrt() as u16;
        i += 1;
    }
    table
};

#[inline(always)]
fn seed(leading: u32) -> u32 {
    // `leading` is x >> 25 for a normalised x, so 32..128; the mask and `get` keep the panic path away.
    TABLE.get((leading as usize).wrapping_sub(32)).copied().unwrap_or(u16::MAX).into()
}

/// `2^31 / sqrt(x)` for x in [2^30, 2^32): in (2^15, 2^16], relative error below 2^-13.
///
/// With X = x / 2^30 and Y = y / 2^16, Y = 1 / sqrt(X) in (1/2, 1]. The seed is within 2^-6.9 (half a bin is at
/// most 1/65 of x, and the square root halves that); the step leaves 1.5 times its square, 2^-13.2, low; the
/// rounding of X and the truncation of Y^2 to 16 bits take at most 2^-14 of X Y^2, half of which reaches Y, high;
/// the two last roundings are 2^-16 each.
#[inline]
pub fn inverse_sqrt_u32(x: u32) -> u32 {
    debug_assert!(x >= 1 << 30);
    let y_q16 = seed(x >> 25);
    let x_q14 = ((x >> 15) + 1) >> 1; // at most 2^16, and then Y^2 is near 1/4
    let xyy_q30 = x_q14 * ((y_q16 * y_q16) >> 16); // near 2^30
    let factor_q15 = ((3u32 << 30) - xyy_q30 + (1 << 15)) >> 16; // (3 - X Y^2) / 2, near 1
    (y_q16 * factor_q15 + (1 << 14)) >> 15
}

/// `2^63 / sqrt(x)` for x in [2^62, 2^64): in (2^31, 2^32], relative error below 2^-28.
///
/// As [`inverse_sqrt_u32`], with three steps: the seed's 2^-6.9 becomes 2^-13.2, 2^-25.8, 2^-51, so that what is
/// left are the truncations of X, Y^2 and their product, each at most 2^-30 of X Y^2.
#[inline]
pub fn inverse_sqrt_u64(x: u64) -> u64 {
    debug_assert!(x >= 1 << 62);
    let x_q30 = x >> 32;
    let mut y_q32 = u64::from(seed((x >> 57) as u32)) << 16;
    for _ in 0..3 {
        // Y exceeds 1 by truncation at most, where X is 1: its square still fits.
        let yy_q32 = (y_q32.min(u32::MAX.into()) * y_q32.min(u32::MAX.into())) >> 32;
        let xyy_q30 = (x_q30 * yy_q32) >> 32; // near 2^30
        let factor_q31 = (3u64 << 30) - xyy_q30; // (3 - X Y^2) / 2, near 1, below 1.5
        y_q32 = (y_q32 * factor_q31) >> 31; // below 2^32.6 * 2^31
    }
    y_q32
}

/// `sqrt(x)`, relative error below 2^-12 and rounded down; any x.
#[inline]
pub fn sqrt_u32(x: u32) -> u32 {
    if x == 0 {
        return 0;
    }
    let half_shift = (u32::BITS - x.bit_length()) / 2;
    let normal = x << (2 * half_shift);
    // sqrt = x / sqrt(x): below 2^16 2^16, and where x is largest its inverse is half of that.
    (((normal >> 16) * inverse_sqrt_u32(normal)) >> 15) >> half_shift
}

/// `sqrt(x)`, relative error below 2^-27 and rounded down; any x.
#[inline]
pub fn sqrt_u64(x: u64) -> u64 {
    if x == 0 {
        return 0;
    }
    let half_shift = (u64::BITS - x.bit_length()) / 2;
    let normal = x << (2 * half_shift);
    (((normal >> 32) * inverse_sqrt_u64(normal)) >> 31) >> half_shift
}

/// `floor(sqrt(x))`, exactly, without a division; any x.
///
/// With n = x 2^(2k) in [2^62, 2^64) and y from [`inverse_sqrt_u32`], 1 / sqrt(n) is y / 2^47 within 2^-13 of itself. So n y is
/// within 2^-12, which is 2^20 units, and each remainder times y / 2^48 takes off all of the error but 2^-13 of it and what
/// is cut off: 2^5 units and more at first, so 2^8 are left, then less than one. What is left after the division by 2^k is a
/// step or two, in whole numbers: a square is multiplied out three times in all, and nothing else is wider than a word.
#[inline]
pub fn isqrt_u64(x: u64) -> u64 {
    if x == 0 {
        return 0;
    }
    let half_shift = (u64::BITS - x.bit_length()) / 2;
    let n = x << (2 * half_shift);
    let high = (n >> 32) as u32;
    let y = inverse_sqrt_u32(high);
    // Below 2^63, since either root is within 2^-11 of the other.
    let remainder = |n: u64, root: u32| n.wrapping_sub(u64::from(root) * u64::from(root)).cast_signed();
    // 2^16 2^15 at most, and y is least where n is largest; the rest is as sqrt_u32's.
    let root = ((high >> 16) * y).min(u32::MAX >> 1) << 1;
    let root = root.saturating_add_signed(((remainder(n, root) >> 38) as i32 * (y >> 1) as i32) >> 9);
    let root = root.saturating_add_signed(((remainder(n, root) >> 26) as i32 * (y >> 1) as i32) >> 21);
    let mut root = root >> half_shift;
    let mut rest = remainder(x, root);
    while rest < 0 {
        root -= 1;
        rest += 2 * i64::from(root) + 1;
    }
    while rest > 2 * i64::from(root) {
        rest -= 2 * i64::from(root) + 1;
        root += 1;
    }
    root.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_roots_are_exact() {
        let roots =
            (0..100_000u64).chain((0..2_000_000).map(|i| i * 1518 + i % 7)).chain((1..32).map(|i| (1 << i) - 1));
        for root in roots.chain([3_037_000_498, 3_037_000_499]) {
            let square = root * root;
            for x in [square, square + root, square + 2 * root].into_iter().filter(|&x| x < 1 << 63) {
                assert_eq!(isqrt_u64(x), root, "{x}");
            }
        }
        assert_eq!(isqrt_u64((1 << 63) - 1), 3_037_000_499);
    }

    #[test]
    fn roots_are_within_the_stated_error() {
        assert_eq!((sqrt_u32(0), sqrt_u64(0)), (0, 0));
        for x in leading_words().flat_map(|x| (0..32).step_by(3).map(move |shift| x >> shift)).filter(|&x| x > 0) {
            // The root's own relative error is half of its square's; and it is rounded down.
            let root = u64::from(sqrt_u32(x));
            assert!(root * root <= u64::from(x) + (u64::from(x) >> 11), "{x:#x}: {root:#x}");
            assert!((root + 1) * (root + 1) >= u64::from(x) - (u64::from(x) >> 11), "{x:#x}: {root:#x}");
            let wide = u128::from(x) << 32;
            let root = u128::from(sqrt_u64(wide as u64));
            assert!(root * root <= wide + (wide >> 26) && (root + 1) * (root + 1) >= wide - (wide >> 26), "{x:#x}");
        }
    }

    /// Inputs at the ends of the range, at the ends of every table bin, and spread between.
    fn leading_words() -> impl Iterator<Item = u32> {
        let bins = (32..128u32).flat_map(|i| [i << 25, (i << 25) | 0x1ff_ffff]);
        let spread = (0..1u32 << 20).map(|i| (1 << 30) + i.wrapping_mul(3_221_225) % (3 << 30));
        bins.chain(spread).chain([u32::MAX])
    }

    #[test]
    fn u32_is_within_the_stated_error() {
        for x in leading_words() {
            let y = u128::from(inverse_sqrt_u32(x));
            // (y / y_true)^2 = x y^2 / 2^62, in Q60.
            let square = (u128::from(x) * y * y) >> 2;
            let one = 1u128 << 60;
            assert!(square.abs_diff(one) < 2 * (one >> 13), "{x:#x}: {y:#x}");
        }
    }

    #[test]
    fn u64_is_within_the_stated_error() {
        for high in leading_words() {
            for low in [0, u32::MAX] {
                let x = (u64::from(high) << 32) | u64::from(low);
                let y = u128::from(inverse_sqrt_u64(x));
                // x y^2 / 2^126 in Q60, by two halvings so that it fits.
                let square = (((u128::from(x) * y) >> 34) * y) >> 32;
                let one = 1u128 << 60;
                assert!(square.abs_diff(one) < 2 * (one >> 28), "{x:#x}: {y:#x}");
            }
        }
    }
}
