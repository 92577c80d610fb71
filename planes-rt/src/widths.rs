//! Words: how wide they are, and what they hold where a value is wider.
//!
//! A word of n bits is signed and symmetric: it holds magnitudes up to 2^(n-1) - 1, and what exceeds that becomes the nearest
//! that it holds. The determinant has no sign: a ray for which it is negative misses, and its processor is turned off.

use core::fmt::{Display, Formatter};
use core::ops::RangeInclusive;

use crate::root::BITS_MAX;

/// The widths of a tracer's words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Widths {
    /// Bits of a component of a position, a direction or a normal.
    coordinate: u32,
    /// Bits of a sum of products of two components, and of t.
    product: u32,
    /// Bits of the determinant, without a sign.
    determinant: u32,
    /// Bits of t below its binary point.
    t_fraction: u32,
}

/// A width that there is no arithmetic for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WidthsError {
    /// Of what.
    pub what: &'static str,
    /// The width that was asked for.
    pub bits: u32,
    /// Those that there are.
    pub range: (u32, u32),
}

impl Display for WidthsError {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        let Self { what, bits, range: (least, most) } = self;
        write!(f, "{what} of {bits} bits; there are {least} to {most}")
    }
}

impl core::error::Error for WidthsError {}

impl Widths {
    /// Those of the text.
    pub const PIXEL_PLANES: Self = Self { coordinate: 12, product: 24, determinant: 36, t_fraction: 6 };
    /// Of a component: magnitudes up to 2^14, so that a sum of three products stays below 2^30.
    pub const COORDINATE: RangeInclusive<u32> = 4..=15;
    /// Of a sum of products: magnitudes up to 2^30, so that a difference of two of their products stays below 2^61.
    pub const PRODUCT: RangeInclusive<u32> = 4..=31;
    /// Of the determinant: its root is worked out in 32 bits.
    pub const DETERMINANT: RangeInclusive<u32> = 4..=BITS_MAX;
    /// Of t below the binary point: a product that is shifted so far stays below 2^41.
    pub const T_FRACTION: RangeInclusive<u32> = 0..=10;

    /// Widths of components, of sums of their products, of the determinant, and of the fraction of t.
    ///
    /// # Errors
    /// Where there is no arithmetic for one of them.
    pub fn new(coordinate: u32, product: u32, determinant: u32, t_fraction: u32) -> Result<Self, WidthsError> {
        for (what, bits, range) in [
            ("components", coordinate, Self::COORDINATE),
            ("products", product, Self::PRODUCT),
            ("a determinant", determinant, Self::DETERMINANT),
            ("a fraction of t", t_fraction, Self::T_FRACTION),
        ] {
            if !range.contains(&bits) {
                return Err(WidthsError { what, bits, range: (*range.start(), *range.end()) });
            }
        }
        Ok(Self { coordinate, product, determinant, t_fraction })
    }

    /// Bits of a component.
    #[inline(always)]
    #[must_use]
    pub const fn coordinate(self) -> u32 {
        self.coordinate
    }

    /// Bits of a sum of products of components.
    #[inline(always)]
    #[must_use]
    pub const fn product(self) -> u32 {
        self.product
    }

    /// Bits of the determinant.
    #[inline(always)]
    #[must_use]
    pub const fn determinant(self) -> u32 {
        self.determinant
    }

    /// Bits of t below its binary point.
    #[inline(always)]
    #[must_use]
    pub const fn t_fraction(self) -> u32 {
        self.t_fraction
    }

    /// The largest component: below 2^14.
    #[inline(always)]
    #[must_use]
    pub const fn coordinate_max(self) -> i32 {
        (1 << (self.coordinate - 1)) - 1
    }

    /// The largest sum of products: below 2^30.
    #[inline(always)]
    #[must_use]
    pub const fn product_max(self) -> i32 {
        (1 << (self.product - 1)) - 1
    }

    /// The largest determinant: below 2^58.
    #[inline(always)]
    #[must_use]
    pub const fn determinant_max(self) -> i64 {
        (1 << self.determinant) - 1
    }

    /// A value as a component.
    #[inline(always)]
    #[must_use]
    pub fn saturate_coordinate(self, value: i32) -> i16 {
        saturate(value, self.coordinate_max()) as i16
    }

    /// A value as a sum of products.
    #[inline(always)]
    #[must_use]
    pub fn saturate_product(self, value: i32) -> i32 {
        saturate(value, self.product_max())
    }
}

/// The nearest value of magnitude `most` or less. `clamp` would ask whether `most` is negative, and panic.
#[inline(always)]
fn saturate(value: i32, most: i32) -> i32 {
    value.max(-most).min(most)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_hold_what_they_say_and_saturate_beyond() {
        let text = Widths::PIXEL_PLANES;
        assert_eq!(
            (text.coordinate_max(), text.product_max(), text.determinant_max()),
            (2047, 8_388_607, 0xf_ffff_ffff)
        );
        for (value, held) in [(0, 0), (2047, 2047), (2048, 2047), (-2047, -2047), (-2048, -2047), (i32::MIN, -2047)] {
            assert_eq!(text.saturate_coordinate(value), held);
        }
        for (value, held) in
            [(8_388_607, 8_388_607), (8_388_608, 8_388_607), (i32::MAX, 8_388_607), (-9_000_000, -8_388_607)]
        {
            assert_eq!(text.saturate_product(value), held);
        }
    }

    #[test]
    fn widths_beyond_their_range_are_refused_by_name() {
        assert_eq!(Widths::new(12, 24, 36, 6), Ok(Widths::PIXEL_PLANES));
        assert!(Widths::new(4, 4, 4, 0).is_ok() && Widths::new(15, 31, 58, 10).is_ok());
        for (refused, what) in [
            (Widths::new(16, 24, 36, 6), "components of 16 bits; there are 4 to 15"),
            (Widths::new(12, 32, 36, 6), "products of 32 bits; there are 4 to 31"),
            (Widths::new(12, 24, 59, 6), "a determinant of 59 bits; there are 4 to 58"),
            (Widths::new(12, 24, 36, 11), "a fraction of t of 11 bits; there are 0 to 10"),
        ] {
            assert_eq!(refused.map_err(|error| std::format!("{error}")), Err(what.into()));
        }
    }

    extern crate std;
}
