//! Light in words of 12 bits, and shares of it.
//!
//! Light is linear, 0 to [`LIGHT_MAX`]; a share has 11 bits below its point, 0 to [`SHARE_ONE`]. Products of the two have 23
//! bits and are rounded to nearest.

use crate::widths::Widths;

/// Linear red, green and blue, each in [0, [`LIGHT_MAX`]].
pub type Light = [u16; 3];

/// Bits of a share below its point.
pub const SHARE_BITS: u32 = 11;

/// All of the light, 1.0, as a share.
pub const SHARE_ONE: u16 = 1 << SHARE_BITS;

/// White.
pub const LIGHT_MAX: u16 = (1 << 12) - 1;

/// What a surface sends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Surface {
    /// Under the light, where it falls straight: at most [`LIGHT_MAX`].
    pub lit: Light,
    /// Whatever the light does: at most [`LIGHT_MAX`].
    pub own: Light,
    /// The shares of what it reflects: at most [`SHARE_ONE`].
    pub mirror: [u16; 3],
}

impl Surface {
    /// Whether all is within its range.
    #[must_use]
    pub(crate) fn is_in_range(&self) -> bool {
        self.lit.iter().chain(&self.own).all(|&c| c <= LIGHT_MAX) && self.mirror.iter().all(|&c| c <= SHARE_ONE)
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

/// The cosine between a normal and the direction to the light, as a share, from `normal . light` as a product: the normal is as
/// long as the radius, the light's vector as [`Widths::coordinate_max`].
///
/// The dot product has bits of both; the division takes the radius's away. A normal that is longer than the radius, as
/// rounding makes it, is no brighter than 1.
#[inline(always)]
pub(crate) fn cosine(normal_dot_light: i32, radius: i32, widths: Widths) -> i32 {
    // Below 2^14, in units of the light's length: brought to 11 bits by a shift to either side.
    let along = (normal_dot_light.max(0) / radius.max(1)).min(widths.coordinate_max());
    let bits = widths.coordinate() - 1;
    let share = if bits > SHARE_BITS { along >> (bits - SHARE_BITS) } else { along << (SHARE_BITS - bits) };
    share.min(SHARE_ONE.into())
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
        let surface = Surface { lit: [LIGHT_MAX; 3], own: [0, 1, LIGHT_MAX], mirror: [SHARE_ONE; 3] };
        assert!(surface.is_in_range());
        assert_eq!([0, 1, 2].map(|channel| surface.sent(channel, one)), [white; 3]);
        assert_eq!([0, 1, 2].map(|channel| surface.sent(channel, 0)), [0, 1, white]);
        assert!(!Surface { own: [0, 0, LIGHT_MAX + 1], ..surface }.is_in_range());
        assert!(!Surface { mirror: [SHARE_ONE + 1, 0, 0], ..surface }.is_in_range());
    }

    #[test]
    fn cosines_run_from_none_to_all_of_the_light_in_every_width() {
        for coordinate in Widths::COORDINATE {
            let widths = Widths::new(coordinate, 31, 62, 0).unwrap();
            let (length, most) = (widths.coordinate_max(), i32::from(SHARE_ONE));
            for radius in [1, length / 2, length] {
                assert_eq!(cosine(-radius * length, radius, widths), 0);
                assert_eq!(cosine(0, radius, widths), 0);
                // The light's vector is a unit short of a power of two.
                let straight = cosine(radius * length, radius, widths);
                assert!(straight < most && straight >= most - (most >> (coordinate - 1)).max(1), "{coordinate}");
                assert_eq!(cosine(i32::MAX, radius, widths), straight);
            }
        }
    }
}
