//! Powers of cosines for highlights: (1 - x)^n = 2^(n log2(1 - x)), by two tables and linear interpolation.
//!
//! A highlight of exponent n is as wide as 1 / sqrt(n), so that everything happens where the cosine is near 1, and a cosine
//! in 16 bits has lost it: repeated squaring of it (Warren, Hacker's Delight, 11-3, which the 2009 report uses) is a
//! staircase from n = 1,000 on, and from 10,000 a cliff. So the argument is the versine x = 1 - cos, which a caller gets
//! from the chord between two unit vectors, |a - b|^2 / 2, with all its bits.

use super::BitLength;

/// One in Q60, in which the tables are made.
const ONE: u128 = 1 << 60;

/// `-ln(1 - x) / x = 1 + x/2 + x^2/3 + ...` in Q60, for x in Q60 up to 1/2.
const fn log_ratio(x: u128) -> u128 {
    let (mut sum, mut power, mut k) = (0, ONE, 1);
    while k <= 64 {
        sum += power / k;
        power = (power * x) >> 60;
        k += 1;
    }
    sum
}

/// ln 2: -ln(1 - 1/2).
const LN_2: u128 = log_ratio(ONE / 2) / 2;

/// `-log2(1 - x) / x` in Q15 for x = i / 128; the last, 2, is one unit low so that it fits.
const LOG: [u16; 65] = {
    let mut table = [0; 65];
    let mut i = 0;
    while i < table.len() {
        let ratio_q15 = (log_ratio(i as u128 * ONE / 128) << 15) / LN_2;
        table[i] = if ratio_q15 > 0xffff { 0xffff } else { ratio_q15 as u16 };
        i += 1;
    }
    table
};

/// `2^-(i / 32)` in Q15.
const EXP: [u16; 33] = {
    let mut table = [0; 33];
    let mut i = 0;
    while i < table.len() {
        // The series of exp(-z), z = i / 32 ln 2 up to 0.7.
        let z = LN_2 * i as u128 / 32;
        let (mut plus, mut minus, mut power, mut k) = (0, 0, ONE, 1);
        while k <= 24 {
            if k % 2 == 1 {
                plus += power;
            } else {
                minus += power;
            }
            power = ((power * z) >> 60) / k;
            k += 1;
        }
        table[i] = ((plus - minus + (1 << 44)) >> 45) as u16;
        i += 1;
    }
    table
};

/// The entry at an index that is in range by what it was made of; `get` keeps the panic path away.
#[inline(always)]
fn entry(table: &[u16], index: u32) -> u32 {
    table.get(index as usize).copied().unwrap_or(0).into()
}

/// `-log2(1 - x)` in Q26 for x in Q30, below 1: within 2^-14 of itself, and 2^-25.
#[inline]
fn log2(versine_q30: u32) -> u32 {
    // 1 - x = m / 2^k with m in (1/2, 1], so that what is left of x is at most 1/2. k is 0 to 30.
    let cosine_q30 = (1 << 30) - versine_q30;
    let k = 30 - (cosine_q30 - 1).bit_length();
    let x_q30 = (1 << 30) - (cosine_q30 << k); // below 2^29
    let (low, high) = (entry(&LOG, x_q30 >> 23), entry(&LOG, (x_q30 >> 23) + 1));
    let part_q16 = (x_q30 >> 7) & 0xffff;
    let ratio_q15 = low + (((high - low) * part_q16) >> 16); // up to 2^16, the differences below 2^11
    // x ratio in Q45, by halves: (2^13 2^16) >> 3 and (2^16 2^16) >> 19.
    (k << 26) + (((x_q30 >> 16) * ratio_q15) >> 3) + (((x_q30 & 0xffff) * ratio_q15) >> 19)
}

/// `(1 - x)^n` in Q16 for a versine x in Q30 and an exponent n in Q2, rounded to nearest.
///
/// Within 2^-10 of itself where x n is up to 8, and 2^-16; 0 from x = 1 on, 1 for n = 0. Every argument is good.
#[inline]
#[must_use]
pub fn power(versine_q30: u32, exponent_q2: u16) -> u32 {
    if versine_q30 >= 1 << 30 {
        return 0;
    }
    let (log_q26, n_q2) = (log2(versine_q30), u32::from(exponent_q2));
    // n log in Q28, by halves, to Q12: log is at most 30 2^26 < 2^31, so the high product is below 2^15 2^16.
    let y_q12 = (log_q26 >> 16) * n_q2 + (((log_q26 & 0xffff) * n_q2) >> 16);
    let whole = y_q12 >> 12;
    if whole > 17 {
        return 0;
    }
    let index = (y_q12 >> 7) & 31;
    let (high, low) = (entry(&EXP, index), entry(&EXP, index + 1));
    let part_q7 = y_q12 & 127;
    let value_q22 = (high << 7) - (high - low) * part_q7; // 2^-f in Q22
    (value_q22 + (1 << (whole + 5))) >> (whole + 6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_ends() {
        for n_q2 in [0, 1, 4, u16::MAX] {
            assert_eq!(power(0, n_q2), 1 << 16);
            assert_eq!(power(1 << 30, n_q2), 0);
            assert_eq!(power(u32::MAX, n_q2), 0);
            let mut last = 1 << 16;
            for versine in (0..1 << 30).step_by(9973) {
                let found = power(versine, n_q2);
                assert!(found <= last + 1, "{versine:#x} {n_q2}: a highlight falls off");
                last = found;
            }
        }
        assert_eq!(power((1 << 30) - 1, 4), 0);
        assert_eq!((power((1 << 30) - 1, 0), power(1 << 29, 4), power(1 << 29, 8)), (1 << 16, 1 << 15, 1 << 14));
    }
}
