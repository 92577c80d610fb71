//! Camera rays: an origin and a direction for each pixel, both linear in its place.
//!
//! In a perspective all rays have one origin, in a parallel projection one direction: the other's steps are zero.

use core::array::from_fn;

use core_rt::samples::PLACE_BITS;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::widths::Widths;

/// Bits of coefficients below a component's unit: over 2^14 pixels the rounding of a step adds up to half a unit.
pub const FRACTION_BITS: u32 = 14;

/// A triple that is linear in the pixel, in components times 2^[`FRACTION_BITS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Linear {
    /// Of the first pixel, in the upper left corner.
    pub first: [i32; 3],
    /// What a pixel to the right adds.
    pub right: [i32; 3],
    /// What a pixel down adds.
    pub down: [i32; 3],
}

impl Linear {
    /// The same triple for all pixels.
    #[must_use]
    pub fn constant(triple: [i16; 3]) -> Self {
        Self { first: triple.map(|c| i32::from(c) << FRACTION_BITS), ..Self::default() }
    }

    /// Whether every pixel of a picture has components of magnitude 2^14 or less.
    ///
    /// Then [`Linear::at`] stays in 32 bits: the corners are the extremes, and are at most 2^28; `x right`, `y down` and their
    /// sum are differences of two corners, so at most 2^29.
    pub(crate) fn holds(&self, size: [u16; 2]) -> bool {
        let last = size.map(|side| i64::from(side.max(1)) - 1);
        [[0, 0], [last[0], 0], [0, last[1]], last].iter().all(|[x, y]| {
            (0..3).all(|axis| {
                let [first, right, down] = [self.first, self.right, self.down].map(|triple| i64::from(triple[axis]));
                (first + x * right + y * down).abs() <= 1 << (14 + FRACTION_BITS)
            })
        })
    }

    /// The triple of a pixel: rounded to nearest, halves up, and what does not fit its words saturated.
    #[inline(always)]
    pub(crate) fn at(&self, x: i32, y: i32, widths: Widths) -> [i16; 3] {
        from_fn(|axis| {
            let sum = self.first[axis] + (x * self.right[axis] + y * self.down[axis]);
            widths.saturate_coordinate((sum + (1 << (FRACTION_BITS - 1))) >> FRACTION_BITS)
        })
    }

    /// The triple of a place so far off a pixel's middle, Q16 in [-2^15, 2^15): likewise, and in the middle the same.
    ///
    /// In 64 bits: in a picture of one column or row a step may be anything. Half of each step is at most 2^30, so that all
    /// together is below 2^32, and below 2^18 without its fraction.
    #[inline(always)]
    pub(crate) fn off_middle(&self, x: i32, y: i32, off_q16: [i32; 2], widths: Widths) -> [i16; 3] {
        let [off_x, off_y] = off_q16.map(i64::from);
        from_fn(|axis| {
            let [right, down] = [self.right, self.down].map(|triple| i64::from(triple[axis]));
            let part = (off_x * right + off_y * down + (1 << (PLACE_BITS - 1))) >> PLACE_BITS;
            let middle = self.first[axis] + (x * self.right[axis] + y * self.down[axis]);
            let sum = i64::from(middle) + part;
            widths.saturate_coordinate(((sum + (1 << (FRACTION_BITS - 1))) >> FRACTION_BITS) as i32)
        })
    }
}

/// Where rays begin, and where they go.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Camera {
    /// The origins of rays.
    pub origin: Linear,
    /// Their directions, of any length.
    pub direction: Linear,
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: i32 = 1 << FRACTION_BITS;

    #[test]
    fn rays_are_rounded_to_nearest_and_saturate() {
        let linear = Linear { first: [0, -UNIT, 5 * UNIT], right: [UNIT / 2, UNIT, 0], down: [0, 0, 2047 * UNIT] };
        assert!(linear.holds([4, 2]));
        let widths = Widths::PIXEL_PLANES;
        assert_eq!(linear.at(0, 0, widths), [0, -1, 5]);
        assert_eq!(linear.at(1, 0, widths), [1, 0, 5]);
        assert_eq!(linear.at(2, 1, widths), [1, 1, 2047]);
        assert_eq!(Linear::constant([-3, 2, 1]).at(9, 9, widths), [-3, 2, 1]);
    }

    #[test]
    fn places_off_the_middle_are_parts_of_a_step_away() {
        let linear = Linear { first: [0; 3], right: [UNIT * 8, 0, UNIT], down: [0, UNIT * -4, 0] };
        let widths = Widths::PIXEL_PLANES;
        assert_eq!(linear.off_middle(3, 2, [0, 0], widths), linear.at(3, 2, widths));
        // A quarter of a pixel to the right, three eighths up; half a unit is rounded up.
        assert_eq!(linear.off_middle(3, 2, [1 << 14, -3 << 13], widths), [26, -6, 3]);
        assert_eq!(linear.off_middle(0, 0, [-1 << 15, (1 << 15) - 1], widths), [-4, -2, 0]);
        let edge = UNIT << 14;
        let wide = Widths::new(15, 31, 58, 0).unwrap();
        for (step, last) in [(edge, 1), (i32::MAX, 0), (i32::MIN, 0)] {
            for first in [-edge, edge] {
                let [right, down] = [[step; 3]; 2];
                let linear = Linear { first: [first; 3], right, down };
                for [x, y] in [[-1 << 15; 2], [(1 << 15) - 1; 2]] {
                    let far = linear.off_middle(last, 0, [x, y], wide);
                    let exact = f64::from(first)
                        + f64::from(last) * f64::from(step)
                        + f64::from(step) * f64::from(x + y) / 65_536.0;
                    let exact = (exact / f64::from(UNIT)).clamp(-16_383.0, 16_383.0);
                    assert!((f64::from(far[0]) - exact).abs() <= 0.51, "{far:?} {exact}");
                }
            }
        }
    }

    #[test]
    fn what_any_corner_exceeds_is_not_held() {
        let edge = 1 << 14;
        let linear =
            |first: i32, right, down| Linear { first: [0, first, 0], right: [0, right, 0], down: [0, down, 0] };
        assert!(linear(edge * UNIT, 0, 0).holds([1, 1]) && !linear(edge * UNIT + 1, 0, 0).holds([1, 1]));
        assert!(linear(0, UNIT, 0).holds([u16::MAX >> 2, 1]));
        assert!(!linear(1, UNIT, 0).holds([16_385, 1]) && !linear(0, 0, -2 * UNIT).holds([1, 16_384]));
        assert!(!linear(i32::MAX, i32::MIN, i32::MIN).holds([u16::MAX; 2]));
        // A picture of one column never steps.
        assert!(linear(0, i32::MAX, 0).holds([1, 9]));
    }

    #[test]
    fn the_ends_of_what_is_held_do_not_overflow() {
        let edge = UNIT << 14;
        // From one corner to its opposite, by both steps.
        let linear = Linear { first: [-edge; 3], right: [edge; 3], down: [edge; 3] };
        assert!(linear.holds([2, 2]));
        let widths = Widths::new(15, 31, 58, 0).unwrap();
        assert_eq!(linear.at(1, 1, widths), [16_383; 3]);
        assert_eq!(linear.at(0, 0, widths), [-16_383; 3]);
    }
}
