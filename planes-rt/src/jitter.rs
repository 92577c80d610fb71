//! Directions at random: of what rough mirrors reflect, the text's "statistically-based random jittering of reflection rays", and of
//! what is matt.
//!
//! As `docs/SHADING.md` has it, a ray mirrored in the direction m goes on along m + r |m| s, s evenly on the unit sphere, for
//! a roughness r; brought back to the length of m, since t is counted in it; and mirrored once more at the surface where it would
//! go into it. A path that goes on diffusely does so along n + |n| s, for a normal n, brought to the length that the ray had: as often
//! as the cosine is large. Numbers are a hash of pixel, sample and generation, so that processors need no generator of their own and no edge
//! of a tile or a renderer shows.

use core::array::from_fn;

use core_rt::num::on_circle_q15;

use crate::colour::SHARE_BITS;
use crate::root::root;
use crate::step::{product, reflection};
use crate::widths::Widths;

/// Fractional bits of the sum of a direction and its jitter: where little is left of the two, its length still has digits.
const SUM_BITS: u32 = 6;

/// Fractional bits of the quotient of two lengths, the second in the sum's.
const QUOTIENT_BITS: u32 = 30;

/// A point of the unit sphere, Q15: evenly between its poles, and evenly about them.
#[inline(always)]
fn on_sphere_q15([height, turn]: [u32; 2]) -> [i32; 3] {
    // An odd number of magnitude below 2^15.
    let z = (2 * (height >> 17) + 1) as i32 - (1 << 15);
    let across = root(i64::from((1 << 30) - z * z), 30);
    let [x, y] = on_circle_q15((turn >> 16) as u16).map(|c| (across * c + (1 << 14)) >> 15);
    [x, y, z]
}

/// Below 3 2^28 for components.
#[inline(always)]
fn square(triple: [i32; 3]) -> i64 {
    triple.iter().map(|&c| i64::from(c) * i64::from(c)).sum()
}

/// Where a ray goes on that a surface of a roughness, as a share, mirrors in the direction `mirrored`, by two random numbers.
///
/// Components are below 2^14, so that a length is below 2^15. The sum of m and the jitter has components below 2^22, in its
/// fractional bits.
#[inline(always)]
pub(crate) fn strewn(
    mirrored: [i16; 3],
    normal: [i16; 3],
    roughness: u16,
    numbers: [u32; 2],
    widths: Widths,
) -> [i16; 3] {
    let m = mirrored.map(i32::from);
    let length = root(square(m), 30);
    let reach = (length * i32::from(roughness) + (1 << (SHARE_BITS - 1))) >> SHARE_BITS;
    let s = on_sphere_q15(numbers);
    let sum = from_fn(|axis| (m[axis] << SUM_BITS) + ((reach * s[axis] + (1 << (14 - SUM_BITS))) >> (15 - SUM_BITS)));
    // Where nothing is left, the mirrored ray itself.
    brought(sum, m, length, normal, widths)
}

/// Where a ray that came along `direction` goes on from a matt surface, by two random numbers.
///
/// The square of a normal is below 2^30: in the sum's bits its length is below 2^21, and the sum below 2^22.
#[inline(always)]
pub(crate) fn diffuse(direction: [i16; 3], normal: [i16; 3], numbers: [u32; 2], widths: Widths) -> [i16; 3] {
    let n = normal.map(i32::from);
    let reach = i64::from(root(square(n) << (2 * SUM_BITS), 30 + 2 * SUM_BITS));
    let s = on_sphere_q15(numbers);
    let sum = from_fn(|axis| (n[axis] << SUM_BITS) + ((reach * i64::from(s[axis]) + (1 << 14)) >> 15) as i32);
    // A small normal's length is mostly fraction.
    let n = n.map(|c| c << SUM_BITS);
    brought(sum, n, root(square(direction.map(i32::from)), 30), normal, widths)
}

/// A sum as a direction of a length, or `other` where nothing is left of it: above the surface.
///
/// Components of a sum are below 2^22, and its square below 2^46; the quotient is below 2^45, and so is its product with a component,
/// which is at most the length in the quotient's bits. What does not fit its words after that is saturated, as everywhere.
#[inline(always)]
fn brought(sum: [i32; 3], other: [i32; 3], length: i32, normal: [i16; 3], widths: Widths) -> [i16; 3] {
    let whole = root(square(sum), 46);
    let (sum, whole) = if whole != 0 { (sum, whole) } else { (other, root(square(other), 42).max(1)) };
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
    extern crate std;

    use core_rt::random::Sample;

    use super::*;

    const WIDTHS: Widths = Widths::PIXEL_PLANES;

    /// The numbers of a sample at its second surface.
    fn numbers(sample: u16) -> [u32; 2] {
        let [height, turn, ..] = Sample { pixel: [3, 7], number: sample }.numbers(2);
        [height, turn]
    }

    fn length(triple: [i16; 3]) -> i32 {
        root(square(triple.map(i32::from)), 30)
    }

    #[test]
    fn points_are_on_the_sphere_and_spread_over_it() {
        let mut sums = [0_i64; 3];
        for sample in 0..1024 {
            let point = on_sphere_q15(numbers(sample));
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
        for sample in 0..200 {
            for roughness in [0, 1, 200, 1024, 2048] {
                let found = strewn(mirrored, normal, roughness, numbers(sample), WIDTHS);
                assert!((length(found) - 500).abs() <= 2, "{found:?}");
                assert!(product(found, normal, WIDTHS) >= -200, "{found:?}");
                assert!(roughness > 0 || found == mirrored);
            }
            let found = diffuse(mirrored, normal, numbers(sample), WIDTHS);
            assert!((length(found) - 500).abs() <= 2, "{found:?}");
            assert!(product(found, normal, WIDTHS) >= -200, "{found:?}");
        }
    }

    /// Where the cosine is the density, a third of the directions has cosines up to the root of a third, the mean of the cosine is 2/3
    /// and of its square 1/2; nothing favours a side. Bounds are four standard deviations of the mean of 4096.
    #[test]
    fn matt_surfaces_send_rays_as_often_as_the_cosine_is_large() {
        for normal in [[0, 0, 200], [60, -80, 0], [-3, 5, 4], [1200, 700, -900]] {
            let (mut cosines, mut squares, mut low, mut aside) = (0.0, 0.0, 0, 0.0);
            for sample in 0..4096 {
                let found = diffuse([500, -30, 20], normal, numbers(sample), WIDTHS).map(f64::from);
                let n = normal.map(f64::from);
                let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
                let unit = dot(found, found).sqrt();
                let cosine = dot(found, n) / unit / dot(n, n).sqrt();
                let across = [n[1], -n[0], 0.0];
                let across = if across == [0.0; 3] { [1.0, 0.0, 0.0] } else { across };
                (cosines, squares) = (cosines + cosine, squares + cosine * cosine);
                low += i32::from(cosine * cosine < 1.0 / 3.0);
                aside += dot(found, across) / unit / dot(across, across).sqrt();
            }
            let off = [cosines / 4096.0 - 2.0 / 3.0, squares / 4096.0 - 0.5, f64::from(low) / 4096.0 - 1.0 / 3.0];
            assert!(off.iter().all(|off| off.abs() < 4.0 * 0.5 / 64.0), "{normal:?}: {off:?}");
            assert!((aside / 4096.0).abs() < 4.0 * 0.5 / 64.0, "{normal:?}: {aside}");
        }
    }

    #[test]
    fn the_ends_of_words_do_not_overflow() {
        let wide = Widths::new(15, 31, 58, 10).unwrap();
        for m in [[16_383; 3], [-16_383; 3], [0; 3], [1, 0, 0]] {
            for n in [[16_383; 3], [-16_383, 16_383, -16_383], [0; 3], [0, -1, 0]] {
                for sample in 0..100 {
                    strewn(m, n, 2048, numbers(sample), wide);
                    diffuse(m, n, numbers(sample), wide);
                }
                // The poles, where a normal and its jitter add up to twice the one, or to nothing.
                for height in [0, u32::MAX] {
                    strewn(m, n, 2048, [height, 0], wide);
                    diffuse(m, n, [height, u32::MAX], wide);
                }
            }
        }
    }

    #[test]
    fn where_nothing_is_left_the_normal_is_the_direction() {
        // The lowest point of the sphere is all but the opposite of the normal: with few bits it is that.
        assert_eq!(diffuse([0, 300, -400], [0, 0, 1], [0, 0], WIDTHS), [0, 0, 500]);
        assert_eq!(diffuse([0, 300, -400], [0; 3], [0, 0], WIDTHS), [0; 3]);
    }
}
