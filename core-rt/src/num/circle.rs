//! Points of the unit circle, by turns: a quarter by its number, and within it, an eighth of a turn to either side of its
//! middle, the series of sine and cosine (Abramowitz & Stegun, Handbook of Mathematical Functions, 4.3.65 and 4.3.66).
//!
//! Nested, `1 - x^2/6 (1 - x^2/20 (1 - ...))`, every term is at most 1, and an error is less by each step out.

use super::{Word, round_shift};

/// pi/4, Q30.
const EIGHTH_Q30: i64 = 843_314_857;

/// 1/2, 1/12, 1/30, ... 1/(n (n - 1)) for the cosine, and 1/6, 1/20, ... for the sine, Q30.
const COSINE_Q30: [i32; 6] = [536_870_912, 89_478_485, 35_791_394, 19_173_961, 11_930_465, 8_134_408];
const SINE_Q30: [i32; 5] = [178_956_971, 53_687_091, 25_565_282, 14_913_081, 9_761_289];

/// The same, Q15.
const COSINE_Q15: [i32; 3] = [1 << 14, 2731, 1092];
const SINE_Q15: [i32; 2] = [5461, 1638];

/// `1 - x^2 a (1 - x^2 b (1 - ...))` in so many fractional bits, for x^2 of at most 1 and factors of at most 1/2.
#[inline(always)]
fn series<T: Word>(square: T, factors: &[i32], bits: u32) -> T {
    let one = T::ONE << bits;
    let mut sum = one;
    for &factor in factors.iter().rev() {
        sum = one - round_shift(round_shift(square * sum, bits) * T::from_i32(factor), bits);
    }
    sum
}

/// The point of a quarter that is `[cosine, sine]` from its middle.
#[inline(always)]
fn turned<T: Word>(quarter: u32, [cosine, sine]: [T; 2]) -> [T; 2] {
    match quarter & 3 {
        0 => [cosine, sine],
        1 => [-sine, cosine],
        2 => [-cosine, -sine],
        _ => [sine, -cosine],
    }
}

/// The point at a turn and half a unit, less an eighth of a turn, Q15: each component within two units.
#[inline]
#[must_use]
pub fn on_circle_q15(turn_q16: u16) -> [i32; 2] {
    let turn = u32::from(turn_q16);
    // An odd number of 2^-14 of an eighth of a turn, so below 1; the product is below 2^29.
    let part_q14 = (2 * (turn & 0x3fff) + 1) as i32 - (1 << 14);
    let x = round_shift(part_q14 * (EIGHTH_Q30 >> 15) as i32, 14);
    let square = round_shift(x * x, 15);
    let sine = round_shift(x * series(square, &SINE_Q15, 15), 15);
    turned(turn >> 14, [series(square, &COSINE_Q15, 15), sine])
}

/// The same, Q30, within two units.
#[inline]
#[must_use]
pub fn on_circle_q30(turn_q32: u32) -> [i64; 2] {
    let part_q30 = i64::from(2 * (turn_q32 & 0x3fff_ffff) + 1) - (1 << 30);
    let x = round_shift(part_q30 * EIGHTH_Q30, 30);
    let square = round_shift(x * x, 30);
    let sine = round_shift(x * series(square, &SINE_Q30, 30), 30);
    turned(turn_q32 >> 30, [series(square, &COSINE_Q30, 30), sine])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both against the circle: no floats here, so by what makes a point one of it. That it is the right one a test in f64
    /// says, which measures whole directions.
    #[test]
    fn points_are_on_the_circle() {
        let mut worst = [0u64; 2];
        for turn in 0..=u16::MAX {
            let square = |[x, y]: [i64; 2]| (x * x + y * y).unsigned_abs();
            worst[0] = worst[0].max(square(on_circle_q15(turn).map(i64::from)).abs_diff(1 << 30) >> 15);
            for low in [0, 0x7fff, u16::MAX] {
                let turn = u32::from(turn) << 16 | u32::from(low);
                worst[1] = worst[1].max(square(on_circle_q30(turn)).abs_diff(1 << 60) >> 30);
            }
        }
        assert!(worst[0] <= 6 && worst[1] <= 8, "{worst:?}");
    }

    #[test]
    fn quarters_follow_each_other() {
        for turn in [0u32, 0x1234_5678, 0x3fff_ffff] {
            let at = |quarter: u32| on_circle_q30(turn | quarter << 30);
            let [x, y] = at(0);
            assert!(x > 0 && at(1) == [-y, x] && at(2) == [-x, -y] && at(3) == [y, -x], "{turn:#x}");
        }
        let [low, high] = [0, 0x3fff_ffff].map(on_circle_q30);
        assert!(low[1] < 0 && high[1] > 0 && low[0] == high[0] && low[1] == -high[1], "symmetrical about the middle");
    }
}
