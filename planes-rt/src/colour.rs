//! Light in words of 12 bits, and shares of it.
//!
//! Light is linear, 0 to [`LIGHT_MAX`]; a share has 11 bits below its point, 0 to [`SHARE_ONE`]. Products of the two have 23
//! bits and are rounded to nearest.

use core_rt::colour::{Colour, Radiance, Rgb16, Rgb888, Transfer};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::widths::Widths;

/// Linear red, green and blue, each in [0, [`LIGHT_MAX`]].
pub type Light = [u16; 3];

/// Bits of a share below its point.
pub const SHARE_BITS: u32 = 11;

/// All of the light, 1.0, as a share.
pub const SHARE_ONE: u16 = 1 << SHARE_BITS;

/// White.
pub const LIGHT_MAX: u16 = (1 << 12) - 1;

/// Light as a pixel's bytes.
#[inline(always)]
#[must_use]
pub fn encode(light: Light, transfer: Transfer) -> Rgb888 {
    // 12 bits in 16, so that white stays white.
    let mantissa = light.map(|channel| channel << 4 | channel >> 8);
    Rgb16::constant(&Radiance { mantissa, exponent: 0 }).encode(transfer)
}

/// What a surface sends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Surface {
    /// Under the light, where it falls straight: at most [`LIGHT_MAX`].
    pub lit: Light,
    /// Whatever the light does: at most [`LIGHT_MAX`].
    pub own: Light,
    /// The shares of what it reflects: at most [`SHARE_ONE`].
    pub mirror: [u16; 3],
    /// How far what it reflects is strewn, as a share: 0 is a sharp mirror.
    pub roughness: u16,
    /// The shares of what it sends on in all directions, of paths alone: at most [`SHARE_ONE`].
    pub matt: [u16; 3],
}

impl Surface {
    /// Whether all is within its range.
    #[must_use]
    pub(crate) fn is_in_range(&self) -> bool {
        self.lit.iter().chain(&self.own).all(|&c| c <= LIGHT_MAX)
            && self.mirror.iter().chain(&self.matt).chain([&self.roughness]).all(|&c| c <= SHARE_ONE)
    }

    /// What a channel sends under a cosine, both as in [`cosine`]: at most [`LIGHT_MAX`].
    #[inline(always)]
    pub(crate) fn sent(&self, channel: usize, cosine: i32) -> i32 {
        let lit = share_of(i32::from(self.lit[channel]), cosine);
        (i32::from(self.own[channel]) + lit).min(LIGHT_MAX.into())
    }
}

/// A share of light, or of a share: factors up to 2^12 and 2^11.
#[inline(always)]
pub(crate) fn share_of(light: i32, share: i32) -> i32 {
    (light * share + (1 << (SHARE_BITS - 1))) >> SHARE_BITS
}

/// The mean of the light of so many samples, from 1, rounded to nearest: sums of 2^16 of them are below 2^28.
#[inline(always)]
#[must_use]
pub fn mean(sum: [u32; 3], samples: u16) -> Light {
    let count = u32::from(samples.max(1));
    sum.map(|channel| ((channel + count / 2) / count) as u16)
}

/// Bits of the two factors of a [`Cosine`]: their product stays below 2^31.
pub const PART_BITS: u32 = 15;

/// The division of `normal . light` by a radius, for normals as long as that and a light's vector as long as
/// [`Widths::coordinate_max`]: the cosine between them, as a share.
///
/// The divisor is the same for a whole sphere: one reciprocal serves all of its pixels. With n = `normal . light`, both factors of
/// `(n / 2^shift) (2^(13 + b) / radius)` are cut to 15 bits, where b is the bits of the radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cosine {
    /// Taken from the dot product.
    shift: u32,
    /// `floor(2^(13 + b) / radius)`, in (2^13, 2^14].
    reciprocal: i32,
    /// Taken from the product.
    last_shift: u32,
}

impl Cosine {
    /// For a radius below 2^14.
    #[inline(always)]
    #[must_use]
    pub fn new(radius: i32, widths: Widths) -> Self {
        let radius = radius.max(1);
        let bits = u32::BITS - radius.unsigned_abs().leading_zeros();
        // Of the brightest dot product.
        let most = bits + widths.coordinate() - 1;
        let shift = most.saturating_sub(PART_BITS);
        let reciprocal = (1 << (PART_BITS - 2 + bits)) / radius;
        // The product is the cosine times 2^(coordinate - 1 - shift + 13 + bits), with the share's 11 bits left over.
        let last_shift = (widths.coordinate() - 1 + PART_BITS - 2 + bits).saturating_sub(shift + SHARE_BITS);
        Self { shift, reciprocal, last_shift }
    }

    /// Bits that are taken from the dot product.
    #[must_use]
    pub const fn shift(self) -> u32 {
        self.shift
    }

    /// What the rest is multiplied by, at most 2^14.
    #[must_use]
    pub const fn reciprocal(self) -> i32 {
        self.reciprocal
    }

    /// Bits that are taken from their product.
    #[must_use]
    pub const fn last_shift(self) -> u32 {
        self.last_shift
    }

    /// The cosine, at most 1: a normal may be longer than the radius by what was rounded.
    #[inline(always)]
    pub(crate) fn of(self, normal_dot_light: i32) -> i32 {
        let part = (normal_dot_light.max(0) >> self.shift).min(1 << PART_BITS);
        ((part * self.reciprocal) >> self.last_shift).min(SHARE_ONE.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_are_rounded_and_stay_in_their_words() {
        let (white, one) = (i32::from(LIGHT_MAX), i32::from(SHARE_ONE));
        assert_eq!(share_of(white, one), white);
        assert_eq!((share_of(white, 0), share_of(0, one)), (0, 0));
        assert_eq!((share_of(1, one / 2), share_of(1, one / 2 - 1)), (1, 0));
        let surface = Surface {
            lit: [LIGHT_MAX; 3],
            own: [0, 1, LIGHT_MAX],
            mirror: [SHARE_ONE; 3],
            roughness: SHARE_ONE,
            matt: [SHARE_ONE; 3],
        };
        assert!(surface.is_in_range());
        assert_eq!([0, 1, 2].map(|channel| surface.sent(channel, one)), [white; 3]);
        assert_eq!([0, 1, 2].map(|channel| surface.sent(channel, 0)), [0, 1, white]);
        assert!(!Surface { own: [0, 0, LIGHT_MAX + 1], ..surface }.is_in_range());
        assert!(!Surface { mirror: [SHARE_ONE + 1, 0, 0], ..surface }.is_in_range());
        assert!(!Surface { roughness: SHARE_ONE + 1, ..surface }.is_in_range());
        assert!(!Surface { matt: [0, 0, SHARE_ONE + 1], ..surface }.is_in_range());
    }

    #[test]
    fn cosines_are_within_two_units_in_every_width() {
        for coordinate in Widths::COORDINATE {
            let widths = Widths::new(coordinate, 31, 58, 0).unwrap();
            let length = widths.coordinate_max();
            for radius in [1, 2, 3, 5, length / 2, length - 1, length] {
                let cosine = Cosine::new(radius, widths);
                assert_eq!((cosine.of(-radius * length), cosine.of(i32::MIN), cosine.of(0)), (0, 0, 0));
                assert_eq!(cosine.of(i32::MAX), i32::from(SHARE_ONE));
                let dots = (0..=1000).map(|step| (i64::from(radius * length) * step / 1000) as i32);
                for dot in dots.chain([1, radius * length - 1]) {
                    // In the unit of a share; the light's length stands for a power of two.
                    let exact = i64::from(dot) << (SHARE_BITS + 10);
                    let unit = i64::from(radius) << (coordinate - 1 + 10);
                    let error = (i64::from(cosine.of(dot)) * unit - exact) as f64 / unit as f64;
                    assert!((-2.0..=0.0).contains(&error), "{coordinate} {radius} {dot}: {error}");
                }
            }
        }
    }
}
