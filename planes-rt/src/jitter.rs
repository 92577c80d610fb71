//! Rough mirrors: reflected rays that are strewn at random, the text's "statistically-based random jittering of reflection rays".
//!
//! As `docs/SHADING.md` has it, a ray mirrored in the direction m goes on along m + r |m| s, s evenly on the unit sphere, for
//! a roughness r; brought back to the length of m, since t is counted in it; and mirrored once more at the surface where it would
//! go into it. Numbers are a hash of pixel, sample and generation, so that processors need no generator of their own and no edge
//! of a tile or a renderer shows.

use core::array::from_fn;

use core_rt::num::on_circle_q15;
use core_rt::random::Sample;

use crate::colour::SHARE_BITS;
use crate::root::root;
use crate::step::{product, reflection};
use crate::widths::Widths;

/// The most samples of a pixel: their light adds up to less than 2^22.
pub const SAMPLES_MAX: u16 = 1024;

/// Fractional bits of the sum of a direction and its jitter: where little is left of the two, its length still has digits.
const SUM_BITS: u32 = 6;

/// Fractional bits of the quotient of two lengths, the second in the sum's.
const QUOTIENT_BITS: u32 = 30;

/// A point of the unit sphere, Q15: evenly between its poles, and evenly about them.
#[inline(always)]
fn on_sphere_q15(pixel: [u16; 2], sample: u16, generation: u16) -> [i32; 3] {
    let [height, turn, ..] = Sample { pixel, number: sample }.numbers(generation.into());
    // An odd number of magnitude below 2^15.
    let z = (2 * (height >> 17) + 1) as i32 - (1 << 15);
    let across = root(i64::from((1 << 30) - z * z), 30);
    let [x, y] = on_circle_q15((turn >> 16) as u16).map(|c| (across * c + (1 << 14)) >> 15);
    [x, y, z]
}

/// Where a ray goes on that a surface of a roughness, as a share, mirrors in the direction `mirrored`.
///
/// Components are below 2^14, so that a length is below 2^15. The sum of m and the jitter has components below 2^22, in its
/// fractional bits, and its square is below 2^46; the quotient is below 2^45, and so is its product with a component, which is at
/// most |m| in the quotient's bits. What does not fit its words after that is saturated, as everywhere.
#[inline(always)]
pub(crate) fn strewn(
    mirrored: [i16; 3],
    normal: [i16; 3],
    roughness: u16,
    [pixel_x, pixel_y, sample, generation]: [u16; 4],
    widths: Widths,
) -> [i16; 3] {
    let square = |triple: [i32; 3]| triple.iter().map(|&c| i64::from(c) * i64::from(c)).sum::<i64>();
    let m = mirrored.map(i32::from);
    let length = root(square(m), 30);
    let reach = (length * i32::from(roughness) + (1 << (SHARE_BITS - 1))) >> SHARE_BITS;
    let s = on_sphere_q15([pixel_x, pixel_y], sample, generation);
    let sum = from_fn(|axis| (m[axis] << SUM_BITS) + ((reach * s[axis] + (1 << (14 - SUM_BITS))) >> (15 - SUM_BITS)));
    let whole = root(square(sum), 46);
    // Where nothing is left, the mirrored ray itself.
    let is_left = whole != 0;
    let (sum, whole) = if is_left { (sum, whole) } else { (m, length.max(1)) };
    let quotient = ((u64::from(length.unsigned_abs()) << QUOTIENT_BITS) / u64::from(whole.unsigned_abs())) as i64;
    let direction: [i16; 3] = from_fn(|axis| {
        let scaled = i64::from(sum[axis]) * quotient + (1 << (QUOTIENT_BITS - 1));
        widths.saturate_coordinate((scaled >> QUOTIENT_BITS) as i32)
    });
    let above = reflection(direction, normal, widths);
    if product(direction, normal, widths) < 0 { above } else { direction }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTHS: Widths = Widths::PIXEL_PLANES;

    #[test]
    fn points_are_on_the_sphere_and_spread_over_it() {
        let mut sums = [0_i64; 3];
        for sample in 0..SAMPLES_MAX {
            let point = on_sphere_q15([3, 7], sample, 1);
            let square: i32 = point.iter().map(|c| c * c / 2).sum();
            assert!((square - (1 << 29)).abs() < 1 << 17, "{point:?}");
            for (sum, c) in sums.iter_mut().zip(point) {
                *sum += i64::from(c);
            }
        }
        // Four standard deviations of the mean: 4 / sqrt(3 1024) of the unit.
        assert!(sums.iter().all(|sum| sum.abs() < 1024 * (1 << 15) * 4 / 55), "{sums:?}");
    }

    #[test]
    fn directions_keep_their_length_and_stay_above_the_surface() {
        let (mirrored, normal) = ([300, 400, 20], [0, 100, -90]);
        for roughness in [0, 1, 200, 1024, 2048] {
            for sample in 0..200 {
                let found = strewn(mirrored, normal, roughness, [5, 9, sample, 2], WIDTHS);
                let square: i32 = found.map(|c| i32::from(c) * i32::from(c)).iter().sum();
                let length = root(square.into(), 30);
                assert!((length - 500).abs() <= 2, "{found:?}");
                assert!(product(found, normal, WIDTHS) >= -200, "{found:?}");
                assert!(roughness > 0 || found == mirrored);
            }
        }
    }

    #[test]
    fn the_ends_of_words_do_not_overflow() {
        let wide = Widths::new(15, 31, 58, 10).unwrap();
        for m in [[16_383; 3], [-16_383; 3], [0; 3], [1, 0, 0]] {
            for n in [[16_383; 3], [-16_383, 16_383, -16_383], [0; 3]] {
                for sample in 0..100 {
                    strewn(m, n, 2048, [u16::MAX, u16::MAX, sample, u16::MAX], wide);
                }
            }
        }
    }
}
