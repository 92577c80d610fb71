//! Pixels as a renderer makes them, as colours of 8 bits a channel.

use core_rt::format::Format;

/// The colours of pixels in some format; an incomplete one at the end is left out.
///
/// The levels of RGB565 are widened by repeating their upper bits, so that black and white are what they were; gray is spread
/// over the channels.
#[must_use]
pub fn rgb888(format: Format, pixels: &[u8]) -> Vec<[u8; 3]> {
    match format {
        Format::Rgb888 => pixels.as_chunks().0.to_vec(),
        Format::Rgb565 => pixels.as_chunks().0.iter().map(|&pixel| wide(u16::from_le_bytes(pixel))).collect(),
        Format::Gray8 => pixels.iter().map(|&gray| [gray; 3]).collect(),
    }
}

/// A pixel of 16 bits in 24.
fn wide(pixel: u16) -> [u8; 3] {
    let (red, green, blue) = (pixel >> 11, pixel >> 5 & 63, pixel & 31);
    [red << 3 | red >> 2, green << 2 | green >> 4, blue << 3 | blue >> 2].map(|channel| channel as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_format_has_its_colours() {
        assert_eq!(rgb888(Format::Rgb888, &[1, 2, 3, 4, 5, 6, 7]), [[1, 2, 3], [4, 5, 6]]);
        assert_eq!(rgb888(Format::Gray8, &[0, 9]), [[0; 3], [9; 3]]);
        let pixels = [0u16, 0xffff, 1 << 11, 1 << 5, 1, 0x8410].map(u16::to_le_bytes);
        let expected = [[0; 3], [255; 3], [8, 0, 0], [0, 4, 0], [0, 0, 8], [132, 130, 132]];
        assert_eq!(rgb888(Format::Rgb565, pixels.as_flattened()), expected);
    }
}
