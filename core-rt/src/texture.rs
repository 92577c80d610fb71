//! Textures: texture coordinates to albedos, by the nearest texel or between four (Blinn & Newell, "Texture and Reflection in
//! Computer Generated Images", 1976; Heckbert, "Survey of Texture Mapping", 1986).
//!
//! Coordinates are in repeats, Q20, and what is left of the whole ones is what counts. Times the side, at most 2^12 texels,
//! they are 32 bits: the place in texels, with 20 bits below one. Texels are sRGB, as files and most outputs have them, and
//! become linear light before anything is computed with them.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::colour::Albedo;
use crate::srgb;

/// Fractional bits of a texture coordinate: a 4096th of a texel of the usual 256, a 256th of the least of [`LARGEST_SIDE`].
pub const UV_BITS: u32 = 20;

/// Texture coordinates in a blob are from 0 to below this, so a triangle has at most 1023 repeats.
pub const UV_END: i32 = 1 << 30;

/// Texels a side at most.
pub const LARGEST_SIDE: u16 = 1 << 12;

/// A texture coordinate: to the right and up, Q20.
pub type Uv = [i32; 2];

/// The texture of a material: where its texels are. All zero for a material without one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Texture {
    /// The place of the texel at the bottom left in the bytes of all textures. Rows follow each other upwards.
    pub first: u32,
    /// Width and height, texels.
    pub size: [u16; 2],
    /// [`Texture::RGB888`] and so on.
    pub format: u16,
    /// Zero.
    pub reserved: u16,
}

impl Texture {
    /// Red, green and blue, a byte each.
    pub const RGB888: u16 = 0;
    /// 5, 6 and 5 bits, red the highest, in two bytes, the lower one first.
    pub const RGB565: u16 = 1;
    /// A byte for all three.
    pub const GRAY8: u16 = 2;

    /// The bytes of a texel; `None` for a format that is not known.
    #[must_use]
    pub const fn texel_size(format: u16) -> Option<u32> {
        match format {
            Self::RGB888 => Some(3),
            Self::RGB565 => Some(2),
            Self::GRAY8 => Some(1),
            _ => None,
        }
    }

    /// Whether there is none, or one of sides that are allowed that ends within so many bytes.
    #[must_use]
    pub fn is_within(&self, bytes: usize) -> bool {
        if *self == Self::default() {
            return true;
        }
        let [width, height] = self.size;
        let sides = (1..=LARGEST_SIDE).contains(&width) && (1..=LARGEST_SIDE).contains(&height);
        let size = Self::texel_size(self.format).map(|size| u64::from(width) * u64::from(height) * u64::from(size));
        sides && self.reserved == 0 && size.is_some_and(|size| u64::from(self.first) + size <= bytes as u64)
    }

    /// The albedo at a coordinate, the texture repeated; `None` where there is no texture. `texels` are those of all.
    #[must_use]
    pub fn look_up(&self, texels: &[u8], [u, v]: Uv, bilinear: bool) -> Option<Albedo> {
        if self.size.contains(&0) {
            return None;
        }
        let (x, y) = (place(u, self.size[0]), place(v, self.size[1]));
        if !bilinear {
            return self.texel(texels, x >> UV_BITS, y >> UV_BITS);
        }
        let (x, y) = (Middles::around(x, self.size[0]), Middles::around(y, self.size[1]));
        let row = |y: u32| Some(mix(&self.texel(texels, x.low, y)?, &self.texel(texels, x.high, y)?, x.share_q15));
        Some(mix(&row(y.low)?, &row(y.high)?, y.share_q15))
    }

    /// A texel, from the left and from below. Sides are at most 2^12, so its number is below 2^24.
    #[inline]
    fn texel(&self, texels: &[u8], column: u32, row: u32) -> Option<Albedo> {
        let number = row * u32::from(self.size[0]) + column;
        let at = |size: u32| texels.get(self.first as usize + (number * size) as usize..);
        let [red, green, blue] = match self.format {
            Self::GRAY8 => [*at(1)?.first()?; 3],
            Self::RGB565 => {
                let [low, high, ..] = *at(2)? else { return None };
                let bits = u16::from_le_bytes([low, high]);
                // The highest bits again below the lowest, so that the ends are 0 and 255.
                let five = |bits: u16| ((bits & 31) << 3 | (bits & 31) >> 2) as u8;
                let six = (bits >> 5 & 63) as u8;
                [five(bits >> 11), six << 2 | six >> 4, five(bits)]
            }
            _ => {
                let [red, green, blue, ..] = *at(3)? else { return None };
                [red, green, blue]
            }
        };
        Some([srgb::decode(red), srgb::decode(green), srgb::decode(blue)])
    }
}

/// The place in texels, Q20, of what a coordinate is beyond a whole number: 20 bits times a side of at most 2^12.
#[inline]
fn place(coordinate_q20: i32, side: u16) -> u32 {
    (coordinate_q20 as u32 & ((1 << UV_BITS) - 1)) * u32::from(side)
}

/// The texels whose middles a place is between, and how far it is from one to the other.
struct Middles {
    low: u32,
    high: u32,
    share_q15: i32,
}

impl Middles {
    /// The first texel is beside the last. The share is cut to 15 bits, so it is low by less than a 2^15th of a texel.
    #[inline]
    fn around(place_q20: u32, side: u16) -> Self {
        const HALF: u32 = 1 << (UV_BITS - 1);
        let last = u32::from(side).saturating_sub(1);
        let low = if place_q20 < HALF { last } else { (place_q20 - HALF) >> UV_BITS };
        let high = if low == last { 0 } else { low + 1 };
        let share_q20 = place_q20.wrapping_sub(HALF) & ((1 << UV_BITS) - 1);
        Self { low, high, share_q15: (share_q20 >> (UV_BITS - 15)) as i32 }
    }
}

/// The albedo between two, rounded to nearest. Differences are below 2^16 in magnitude and shares below 2^15; the product,
/// at most (2^16 - 1) (2^15 - 1), has room for the rounding half.
#[inline]
fn mix(a: &Albedo, b: &Albedo, share_q15: i32) -> Albedo {
    let channel = |a: u16, b: u16| {
        let (a, b) = (i32::from(a), i32::from(b));
        (a + (((b - a) * share_q15 + (1 << 14)) >> 15)) as u16
    };
    [channel(a[0], b[0]), channel(a[1], b[1]), channel(a[2], b[2])]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ONE: i32 = 1 << UV_BITS;

    /// Green and white below, red and black above.
    const FOUR: [u8; 12] = [0, 255, 0, 255, 255, 255, 255, 0, 0, 0, 0, 0];

    fn four() -> Texture {
        Texture { size: [2, 2], ..Texture::default() }
    }

    #[test]
    fn nearest_texels_have_v_up_and_repeat() {
        let at = |u: i32, v: i32| four().look_up(&FOUR, [u, v], false).unwrap();
        assert_eq!(at(0, 0), [0, 65_535, 0]);
        assert_eq!(at(ONE / 2 - 1, ONE / 2), [65_535, 0, 0]);
        assert_eq!(at(ONE / 2, ONE - 1), [0; 3]);
        assert_eq!(at(-1, -ONE), [65_535; 3]);
        assert_eq!(at(UV_END - 1, UV_END - 1), at(-1, -1));
    }

    #[test]
    fn between_texels_light_is_mixed_and_the_edges_meet() {
        let at = |u: i32, v: i32| four().look_up(&FOUR, [u, v], true).unwrap();
        assert_eq!(at(ONE / 4, ONE / 4), [0, 65_535, 0]);
        assert_eq!(at(ONE / 4, ONE / 2), [32_768, 32_768, 0]);
        assert_eq!(at(0, ONE / 4), [32_768, 65_535, 32_768], "the last column is beside the first");
        assert_eq!(at(ONE / 2, ONE / 2), [32_768, 32_768, 16_384]);
    }

    #[test]
    fn the_largest_and_the_smallest() {
        let texels = vec_of_white();
        let one = Texture { size: [1, 1], format: Texture::GRAY8, ..Texture::default() };
        for uv in [[0, 0], [-1, ONE / 2], [i32::MIN, i32::MAX]] {
            for bilinear in [false, true] {
                assert_eq!(one.look_up(&texels, uv, bilinear), Some([65_535; 3]));
                let row = Texture { size: [LARGEST_SIDE, 1], ..one };
                assert_eq!(row.look_up(&texels, uv, bilinear), Some([65_535; 3]));
                assert_eq!(Texture::default().look_up(&texels, uv, bilinear), None);
            }
        }
    }

    fn vec_of_white() -> [u8; LARGEST_SIDE as usize] {
        [255; LARGEST_SIDE as usize]
    }

    #[test]
    fn formats_meet_at_the_ends() {
        let at = |format: u16, texels: &[u8]| {
            Texture { size: [1, 1], format, ..Texture::default() }.look_up(texels, [0; 2], false)
        };
        assert_eq!(at(Texture::RGB565, &[0xff, 0xff]), Some([65_535; 3]));
        assert_eq!(at(Texture::RGB565, &[0, 0xf8]), Some([65_535, 0, 0]));
        assert_eq!(at(Texture::RGB565, &[0xe0, 0x07]), Some([0, 65_535, 0]));
        assert_eq!(at(Texture::RGB565, &[0x1f, 0]), Some([0, 0, 65_535]));
        assert_eq!(at(Texture::GRAY8, &[188]), at(Texture::RGB888, &[188; 3]));
        assert_eq!(at(Texture::RGB888, &[0, 0]), None);
    }

    #[test]
    fn a_texture_is_within_its_bytes_or_is_none() {
        let texture = Texture { first: 5, size: [3, 2], ..Texture::default() };
        assert!(texture.is_within(23) && !texture.is_within(22) && Texture::default().is_within(0));
        for bad in [
            Texture { size: [0, 2], ..texture },
            Texture { size: [3, 0], ..texture },
            Texture { size: [LARGEST_SIDE + 1, 1], ..texture },
            Texture { format: 3, ..texture },
            Texture { reserved: 1, ..texture },
            Texture { first: u32::MAX, ..texture },
        ] {
            assert!(!bad.is_within(1 << 20), "{bad:?}");
        }
    }
}
