//! Pictures: RGB888 in memory, PNG on disk.

use crate::files::{self, FileError};
use image::{ExtendedColorType, ImageEncoder, ImageFormat, ImageReader, Limits, codecs::png::PngEncoder};
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// The longest side of a picture, pixels.
pub const MAX_SIDE: u32 = 1 << 14;

/// The most pixels in a picture: 8192 x 8192.
pub const MAX_PIXELS: u64 = 1 << 26;

/// Both, for a message.
pub const SIZES: &str = "a picture has 1 to 16384 pixels a side, and at most 67108864 in all";

/// What every PNG begins with.
const PNG_SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// The CRC-32 of PNG, zip and Ethernet.
const CRC_32: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_ISO_HDLC);

/// A picture of 8 bits a channel, as encoded for display; rows from top to bottom, pixels from left to right.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    width: u32,
    height: u32,
    rgb: Vec<[u8; 3]>,
}

/// Why a picture could not be read or written. Each message names the file.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// The file itself.
    #[error(transparent)]
    File(#[from] FileError),
    /// It does not begin as a PNG does.
    #[error("{}: not a PNG; pictures are read and written as PNG only", .0.display())]
    NotPng(PathBuf),
    /// A PNG that cannot be decoded.
    #[error("{}: a PNG that is damaged or cut short ({reason}); make it anew", path.display())]
    Damaged {
        /// The file.
        path: PathBuf,
        /// The decoder's reason.
        reason: String,
    },
    /// Larger than [`MAX_SIDE`] or [`MAX_PIXELS`], or empty.
    #[error("{}: {width} x {height} pixels; {SIZES}", path.display())]
    Size {
        /// The file.
        path: PathBuf,
        /// Pixels across.
        width: u32,
        /// Pixels down.
        height: u32,
    },
}

/// A width and a height as `WxH` has them; those that are too large or negative are 0.
#[must_use]
pub fn parse_size(text: &str) -> Option<[u32; 2]> {
    let (width, height) = text.split_once(['x', 'X'])?;
    let side = |side: &str| Some(u32::try_from(side.trim().parse::<i64>().ok()?).unwrap_or(0));
    Some([side(width)?, side(height)?])
}

/// Whether a picture may have this size: sides of 1 to [`MAX_SIDE`], at most [`MAX_PIXELS`] pixels.
pub const fn size_is_allowed(width: u32, height: u32) -> bool {
    let sides = width >= 1 && width <= MAX_SIDE && height >= 1 && height <= MAX_SIDE;
    sides && width as u64 * height as u64 <= MAX_PIXELS
}

impl Picture {
    /// A black picture of `width` x `height` pixels.
    pub fn new(width: u32, height: u32) -> Self {
        Self { width, height, rgb: vec![[0; 3]; width as usize * height as usize] }
    }

    /// The picture whose pixel in column `x` and row `y` is `pixel(x, y)`, asked for row by row.
    pub fn from_fn(width: u32, height: u32, mut pixel: impl FnMut(u32, u32) -> [u8; 3]) -> Self {
        let rgb = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect();
        Self { width, height, rgb }
    }

    /// Pixels across.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Pixels down.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// The pixels, `width * height` of them, row by row from the top.
    pub fn pixels(&self) -> &[[u8; 3]] {
        &self.rgb
    }

    /// The pixels, to be written.
    pub fn pixels_mut(&mut self) -> &mut [[u8; 3]] {
        &mut self.rgb
    }

    /// The IEEE CRC-32 of the RGB888 bytes, row by row: the `image_crc32` of every report.
    pub fn crc32(&self) -> u32 {
        CRC_32.checksum(self.rgb.as_flattened())
    }

    /// Reads a PNG of any colour type and depth. 16 bits are rounded to 8, gray is spread over the three
    /// channels, alpha is left out; `gAMA` and colour profiles are not looked at.
    ///
    /// # Errors
    /// [`PictureError`] where there is no such file, it is no PNG, cut short, damaged or too large.
    pub fn read_png(path: &Path) -> Result<Self, PictureError> {
        let bytes = files::read(path)?;
        if !bytes.starts_with(PNG_SIGNATURE) {
            return Err(PictureError::NotPng(path.into()));
        }
        let damaged = |error: image::ImageError| PictureError::Damaged { path: path.into(), reason: error.to_string() };
        // The claimed size, from its place in the header, before the decoder allocates for it.
        if let [_, _, _, _, width, height, ..] = bytes.as_chunks().0 {
            let (width, height) = (u32::from_be_bytes(*width), u32::from_be_bytes(*height));
            if !size_is_allowed(width, height) {
                return Err(PictureError::Size { path: path.into(), width, height });
            }
        }
        // Twice what the largest picture takes at 16 bits and four channels.
        let mut limits = Limits::no_limits();
        limits.max_alloc = Some(16 * MAX_PIXELS);
        let mut decoder = ImageReader::with_format(Cursor::new(&bytes), ImageFormat::Png);
        decoder.limits(limits);
        let decoded = decoder.decode().map_err(damaged)?.into_rgb8();
        let (width, height) = decoded.dimensions();
        Ok(Self { width, height, rgb: decoded.as_raw().as_chunks().0.to_vec() })
    }

    /// The bytes of an 8-bit PNG, gray where every pixel is and RGB otherwise; `None` where the size is not allowed.
    pub fn to_png(&self) -> Option<Vec<u8>> {
        let (width, height) = (self.width, self.height);
        if !size_is_allowed(width, height) {
            return None;
        }
        let mut bytes = Vec::new();
        let encoder = PngEncoder::new(&mut bytes);
        let encoded = if self.rgb.iter().all(|[r, g, b]| r == g && g == b) {
            let gray: Vec<u8> = self.rgb.iter().map(|pixel| pixel[0]).collect();
            encoder.write_image(&gray, width, height, ExtendedColorType::L8)
        } else {
            encoder.write_image(self.rgb.as_flattened(), width, height, ExtendedColorType::Rgb8)
        };
        encoded.ok().map(|()| bytes)
    }

    /// Writes [`Self::to_png`], whole or not at all.
    ///
    /// # Errors
    /// [`PictureError`] where the folder does not exist or cannot be written to, or the size is not allowed.
    pub fn write_png(&self, path: &Path) -> Result<(), PictureError> {
        let bytes = self.to_png().ok_or_else(|| PictureError::Size {
            path: path.into(),
            width: self.width,
            height: self.height,
        })?;
        Ok(files::write_atomically(path, &bytes)?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::ColorType;
    use std::fs;

    fn gradient() -> Picture {
        Picture::from_fn(7, 5, |x, y| [x as u8 * 30, y as u8 * 50, (x * y) as u8])
    }

    fn png(bytes: &[u8], width: u32, height: u32, colour: ColorType) -> Vec<u8> {
        let mut png = Vec::new();
        PngEncoder::new(&mut png).write_image(bytes, width, height, colour.into()).unwrap();
        png
    }

    fn read(bytes: &[u8]) -> Result<Picture, PictureError> {
        let file = tempfile::NamedTempFile::new().unwrap();
        fs::write(file.path(), bytes).unwrap();
        Picture::read_png(file.path())
    }

    #[test]
    fn a_picture_survives_the_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        gradient().write_png(&path).unwrap();
        assert_eq!(Picture::read_png(&path).unwrap(), gradient());
    }

    #[test]
    fn what_is_gray_is_written_in_one_channel() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let mut picture = Picture::from_fn(7, 5, |x, y| [(x * y) as u8; 3]);
        let channels = |picture: &Picture| {
            picture.write_png(&path).unwrap();
            assert_eq!(Picture::read_png(&path).unwrap(), *picture);
            image::open(&path).unwrap().color()
        };
        assert_eq!(channels(&picture), ColorType::L8);
        picture.pixels_mut()[34][1] += 1;
        assert_eq!(channels(&picture), ColorType::Rgb8);
    }

    #[test]
    fn the_checksum_is_the_catalogued_one() {
        // "123456789", the check value of CRC-32/ISO-HDLC; then one bit more.
        let mut picture = Picture::from_fn(3, 1, |x, _| [0x31, 0x32, 0x33].map(|byte| byte + 3 * x as u8));
        assert_eq!(picture.crc32(), 0xcbf4_3926);
        picture.pixels_mut()[2][2] ^= 1;
        assert_ne!(picture.crc32(), 0xcbf4_3926);
    }

    #[test]
    fn every_colour_type_is_read_as_rgb() {
        let pixels = |bytes: &[u8], colour| read(&png(bytes, 1, 1, colour)).unwrap().pixels().to_vec();
        assert_eq!(pixels(&[9], ColorType::L8), [[9; 3]]);
        assert_eq!(pixels(&[9, 0], ColorType::La8), [[9; 3]]);
        assert_eq!(pixels(&[1, 2, 3], ColorType::Rgb8), [[1, 2, 3]]);
        assert_eq!(pixels(&[1, 2, 3, 0], ColorType::Rgba8), [[1, 2, 3]]);
        // 16 bits are rounded: 1.5 * 257 lies between 385 and 386. Samples in native byte order.
        let wide: Vec<u8> = [385u16, 386, 65535].iter().flat_map(|sample| sample.to_ne_bytes()).collect();
        assert_eq!(pixels(&wide, ColorType::Rgb16), [[1, 2, 255]]);
        assert_eq!(pixels(&wide[2..4], ColorType::L16), [[2; 3]]);
    }

    #[test]
    fn a_file_cut_anywhere_is_refused() {
        let whole = png(gradient().rgb.as_flattened(), 7, 5, ColorType::Rgb8);
        assert!(read(&whole).is_ok());
        // The last 16 bytes are a checksum and the end mark; the picture is complete before them.
        for length in 0..whole.len() - 16 {
            let message = read(&whole[..length]).unwrap_err().to_string();
            let expected = if length < 8 { "not a PNG" } else { "damaged or cut short" };
            assert!(message.contains(expected), "{length}: {message}");
        }
    }

    #[test]
    fn what_is_not_a_picture_is_named() {
        assert!(read(b"P6 1 1 255 abc").unwrap_err().to_string().contains("not a PNG"));
        assert!(Picture::read_png(Path::new("no/such.png")).unwrap_err().to_string().contains("no such file"));
        assert!(Picture::read_png(Path::new(".")).unwrap_err().to_string().contains("is a folder"));
        let unwritable = gradient().write_png(Path::new("no/such.png")).unwrap_err().to_string();
        assert!(unwritable.contains("there is no folder no;"), "{unwritable}");
    }

    #[test]
    fn a_claimed_size_is_checked_before_memory_is_taken() {
        // A header that claims 2^30 x 2^30, with its right checksum.
        let mut huge = png(&[0], 1, 1, ColorType::L8);
        huge[16..24].copy_from_slice(&[0x40, 0, 0, 0, 0x40, 0, 0, 0]);
        let sum = CRC_32.checksum(&huge[12..29]).to_be_bytes();
        huge[29..33].copy_from_slice(&sum);
        let message = read(&huge).unwrap_err().to_string();
        assert!(message.contains("1073741824 x 1073741824 pixels"), "{message}");
        assert!(Picture::new(0, 3).write_png(Path::new("unwritten.png")).is_err());
        assert!(size_is_allowed(1, 1) && size_is_allowed(8192, 8192) && size_is_allowed(MAX_SIDE, 4096));
        assert!(SIZES.contains(&format!("1 to {MAX_SIDE} pixels")) && SIZES.contains(&format!("most {MAX_PIXELS} in")));
        assert!(!size_is_allowed(0, 1) && !size_is_allowed(8192, 8193) && !size_is_allowed(MAX_SIDE + 1, 1));
    }
}
