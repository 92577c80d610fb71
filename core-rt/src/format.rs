//! Formats of pixels, as a sink takes them.
//!
//! **RGB565** has fewer levels than the eye. Each channel is raised by a threshold that depends on the pixel's place and then
//! cut off, so that over 8 x 8 pixels the mean is right (B. E. Bayer, "An Optimum Method for Two-Level Rendition of
//! Continuous-Tone Pictures", 1973). With n levels above black, the level of a byte v is `floor(n v / 255 + (2b + 1) / 128)`,
//! with b the matrix's number, 0 to 63: less than one level off, and black and white are exact. Over a whole matrix the mean
//! is within a 128th of a level.
//!
//! **Gray** is luminance, by the weights that belong to sRGB's primaries (ITU-R BT.709), in linear light: the gray that is as
//! bright as the colour was. Weights on encoded values are for those who have nothing else.

use serde::{Deserialize, Serialize};

use crate::colour::{Colour, Rgb888, Transfer};
use crate::profile::{Need, Needs};

/// How pixels lie in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Format {
    /// Red, green, blue, a byte each.
    Rgb888,
    /// `red << 11 | green << 5 | blue` in 16 bits, little-endian, dithered.
    Rgb565,
    /// Luminance, a byte.
    Gray8,
}

impl Format {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Rgb888, Self::Rgb565, Self::Gray8];

    /// Of one pixel.
    #[inline]
    #[must_use]
    pub const fn bytes(self) -> usize {
        match self {
            Self::Rgb888 => 3,
            Self::Rgb565 => 2,
            Self::Gray8 => 1,
        }
    }

    /// What a scene in this format needs.
    #[must_use]
    pub const fn need(self) -> Need {
        match self {
            Self::Rgb888 => Need::Rgb888,
            Self::Rgb565 => Need::Rgb565,
            Self::Gray8 => Need::Gray8,
        }
    }

    /// The format of a number, as it stands in a header.
    #[must_use]
    pub fn from_number(number: u16) -> Option<Self> {
        Self::ALL.get(usize::from(number)).copied()
    }

    /// The number in a header.
    #[must_use]
    pub const fn number(self) -> u16 {
        self as u16
    }

    /// Writes a pixel's colour to the first bytes of `pixel`, of which there are [`Format::bytes`].
    #[inline]
    pub(crate) fn put(self, colour: impl Colour, transfer: Transfer, [x, y]: [u16; 2], pixel: &mut [u8]) {
        match self {
            Self::Rgb888 => write(pixel, colour.encode(transfer)),
            Self::Rgb565 => write(pixel, rgb565(colour.encode(transfer), [x, y]).to_le_bytes()),
            Self::Gray8 => write(pixel, [colour.encode_gray(transfer)]),
        }
    }
}

#[inline]
fn write<const N: usize>(pixel: &mut [u8], bytes: [u8; N]) {
    if let Some(pixel) = pixel.first_chunk_mut() {
        *pixel = bytes;
    }
}

impl Needs {
    /// The only format of the set; `None` where there are several, or none.
    #[inline]
    pub(crate) const fn format(self) -> Option<Format> {
        match (self.has(Need::Rgb888), self.has(Need::Rgb565), self.has(Need::Gray8)) {
            (true, false, false) => Some(Format::Rgb888),
            (false, true, false) => Some(Format::Rgb565),
            (false, false, true) => Some(Format::Gray8),
            _ => None,
        }
    }

    /// The bytes that a pixel takes at most.
    #[must_use]
    pub const fn pixel_bytes(self) -> usize {
        match (self.has(Need::Rgb888), self.has(Need::Rgb565)) {
            (true, _) => Format::Rgb888.bytes(),
            (false, true) => Format::Rgb565.bytes(),
            (false, false) => Format::Gray8.bytes(),
        }
    }
}

/// `(2b + 1) / 128` in 255ths, rounded down: 0 to 253. What the rounding takes away is no level, since the rest of the sum is
/// whole.
const THRESHOLDS: [[u8; 8]; 8] = {
    let mut thresholds = [[0; 8]; 8];
    let mut place = 0;
    while place < 64 {
        let (x, y) = (place & 7, place >> 3);
        // Of the matrix that is defined by its quarters, the lowest bits of the place weigh the most.
        let (a, mut bit, mut b) = (x ^ y, 0, 0);
        while bit < 3 {
            b = b << 2 | (a >> bit & 1) << 1 | (y >> bit & 1);
            bit += 1;
        }
        thresholds[y][x] = ((2 * b + 1) * 255 / 128) as u8;
        place += 1;
    }
    thresholds
};

/// A pixel in 16 bits, dithered by its place in the picture.
#[inline]
#[must_use]
pub fn rgb565(rgb: Rgb888, [x, y]: [u16; 2]) -> u16 {
    let threshold = u16::from(THRESHOLDS[usize::from(y & 7)][usize::from(x & 7)]);
    let level = |byte: u8, most: u16| {
        // At most 63 * 255 + 253.
        let sum_255 = u16::from(byte) * most + threshold;
        // Divided by 255, exactly below 2^16 - 1.
        (sum_255 + 1 + (sum_255 >> 8)) >> 8
    };
    let [red, green, blue] = rgb;
    level(red, 31) << 11 | level(green, 63) << 5 | level(blue, 31)
}
