//! Textures: picture files to bytes.

use std::io::Cursor;

use image::{ImageReader, Limits};

use super::error::{excerpt, reason};
use super::source::Source;
use crate::model::Texture;

/// Texels a side at most.
const LARGEST_SIDE: u32 = core_rt::texture::LARGEST_SIDE as u32;
/// Bytes that reading one may take: the largest, in the widest format of texels.
const LARGEST_FILE: u64 = (LARGEST_SIDE as u64).pow(2) * 8 + (1 << 20);

/// Reads a texture of any size up to [`LARGEST_SIDE`] a side; transparency is left out.
///
/// # Errors
/// Says why there is none.
pub(super) fn read(source: &dyn Source, name: &str) -> Result<Texture, String> {
    let bytes = source.read(name).map_err(|error| reason(&error))?;
    let mut limits = Limits::default();
    limits.max_image_width = Some(LARGEST_SIDE);
    limits.max_image_height = Some(LARGEST_SIDE);
    limits.max_alloc = Some(LARGEST_FILE);
    let mut reader = ImageReader::new(Cursor::new(bytes)).with_guessed_format().map_err(|error| reason(&error))?;
    reader.limits(limits);
    let image = reader.decode().map_err(|error| match error {
        image::ImageError::Unsupported(_) => "not a PNG file".into(),
        image::ImageError::Limits(_) => format!("over {LARGEST_SIDE} texels a side"),
        error => excerpt(&error.to_string()),
    })?;
    let image = image.into_rgb8();
    let size = [image.width(), image.height()];
    Ok(Texture { size, texels: image.pixels().map(|pixel| pixel.0).collect() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::Embedded;
    use image::{DynamicImage, ImageFormat};

    fn png(image: DynamicImage) -> Vec<u8> {
        let mut bytes = Cursor::new(Vec::new());
        image.write_to(&mut bytes, ImageFormat::Png).unwrap();
        bytes.into_inner()
    }

    fn decoded(bytes: &[u8]) -> Result<Texture, String> {
        read(&Embedded(&[("x.png", bytes)]), "x.png")
    }

    #[test]
    fn every_kind_of_texel_is_read_and_odd_sizes_too() {
        let grey = png(DynamicImage::ImageLuma8(image::GrayImage::from_raw(3, 1, vec![0, 128, 255]).unwrap()));
        assert_eq!(decoded(&grey), Ok(Texture { size: [3, 1], texels: vec![[0; 3], [128; 3], [255; 3]] }));
        let clear = png(DynamicImage::ImageRgba8(image::RgbaImage::from_raw(1, 1, vec![1, 2, 3, 0]).unwrap()));
        assert_eq!(decoded(&clear), Ok(Texture { size: [1, 1], texels: vec![[1, 2, 3]] }));
    }

    #[test]
    fn what_is_no_texture_says_why() {
        let good = png(DynamicImage::new_rgb8(8, 8));
        assert!(decoded(&good[..good.len() / 2]).is_err());
        assert_eq!(decoded(b"hello"), Err("not a PNG file".into()));
        assert_eq!(decoded(b"\xff\xd8\xff\xe0\0\x10JFIF\0"), Err("not a PNG file".into()));
        assert_eq!(decoded(&png(DynamicImage::new_luma8(4097, 1))), Err("over 4096 texels a side".into()));
        assert_eq!(read(&Embedded(&[]), "x.png"), Err("no such file".into()));
    }
}
