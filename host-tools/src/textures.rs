//! Textures that fit: with fewer texels, and with fewer bytes a texel.
//!
//! Nothing filters a texture that is seen from far away, so one of more texels than the picture shows of it costs flash and
//! flickers; averages over areas, in linear light, are what is seen of it then.

use std::sync::Arc;

use core_rt::texture;

use crate::model::{Format, Model, Texture};

/// How texels are stored. A texture of grays alone has a byte a texel in any of them, which loses nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, clap::ValueEnum)]
pub enum Texels {
    /// Three bytes, as they are in the file.
    #[default]
    Rgb888,
    /// 16 bits: a byte is off by up to 4 in red and blue, and 2 in green.
    Rgb565,
    /// A byte: the luminance (ITU-R BT.709).
    Gray8,
}

impl Texels {
    /// The format of the output's pixels: what is finer is not seen.
    #[must_use]
    pub const fn of(format: Format) -> Self {
        match format {
            Format::Rgb888 => Self::Rgb888,
            Format::Rgb565 => Self::Rgb565,
            Format::Gray8 => Self::Gray8,
        }
    }

    /// The number of the format in which a texture is stored, and its texels, the bottom row first.
    pub(crate) fn encode(self, texture: &Texture) -> (u16, Vec<u8>) {
        let is_gray = texture.texels.iter().all(|[red, green, blue]| red == green && green == blue);
        let rows = || texture.texels.chunks(texture.size[0] as usize).rev().flatten();
        match self {
            _ if is_gray => (texture::Texture::GRAY8, rows().map(|texel| texel[0]).collect()),
            Self::Rgb888 => (texture::Texture::RGB888, rows().flatten().copied().collect()),
            Self::Rgb565 => (texture::Texture::RGB565, rows().flat_map(|&texel| rgb565(texel).to_le_bytes()).collect()),
            Self::Gray8 => (texture::Texture::GRAY8, rows().map(|&texel| gray(texel)).collect()),
        }
    }
}

/// The nearest value of 5, 6 and 5 bits.
fn rgb565([red, green, blue]: [u8; 3]) -> u16 {
    let nearest = |byte: u8, most: u16| (u16::from(byte) * most + 127) / 255;
    nearest(red, 31) << 11 | nearest(green, 63) << 5 | nearest(blue, 31)
}

/// The byte of a texel's luminance.
fn gray([red, green, blue]: [u8; 3]) -> u8 {
    byte(0.2126 * light(red) + 0.7152 * light(green) + 0.0722 * light(blue))
}

/// Brings every texture of a model to at most `side` texels a side.
pub fn shrink(model: &mut Model, side: u32) {
    let mut known: Vec<(Arc<Texture>, Arc<Texture>)> = Vec::new();
    for texture in model.materials.iter_mut().filter_map(|material| material.texture.as_mut()) {
        // What materials share stays shared.
        let place = known.iter().position(|(old, _)| Arc::ptr_eq(old, texture)).unwrap_or_else(|| {
            known.push((texture.clone(), Arc::new(shrunk(texture, side))));
            known.len() - 1
        });
        *texture = known[place].1.clone();
    }
}

/// The texture with at most `side` texels a side, its shape kept as well as whole texels can; each is the mean of what it
/// covers of the old ones, in linear light.
fn shrunk(texture: &Texture, side: u32) -> Texture {
    let [width, height] = texture.size;
    let longest = width.max(height);
    if longest <= side {
        return texture.clone();
    }
    let scaled =
        |length: u32| ((2 * u64::from(length) * u64::from(side) / u64::from(longest)).div_ceil(2) as u32).max(1);
    let size = [scaled(width), scaled(height)];
    let (columns, rows) = (covers(width, size[0]), covers(height, size[1]));
    let old = |x: usize, y: usize| texture.texels[y * width as usize + x].map(light);
    let mut texels = Vec::with_capacity(rows.len() * columns.len());
    for row in &rows {
        for column in &columns {
            let mut sum = [0.0; 3];
            for &(y, share_y) in row {
                for &(x, share_x) in column {
                    let share = share_x * share_y;
                    for (sum, light) in sum.iter_mut().zip(old(x, y)) {
                        *sum += share * light;
                    }
                }
            }
            texels.push(sum.map(byte));
        }
    }
    Texture { size, texels }
}

/// For each of `new` texels in a row, which of `old` ones it covers and what part of it each is.
fn covers(old: u32, new: u32) -> Vec<Vec<(usize, f64)>> {
    // In units of 1 / (old new) of the row a new texel is `old` long, and an old one `new`.
    let [old, new] = [old, new].map(u64::from);
    let cover = |i: u64| {
        let (begin, end) = (i * old, (i + 1) * old);
        let part = |j: u64| ((j + 1) * new).min(end) - (j * new).max(begin);
        (begin / new..end.div_ceil(new)).map(|j| (j as usize, part(j) as f64 / old as f64)).collect()
    };
    (0..new).map(cover).collect()
}

/// The linear light of an sRGB byte.
fn light(byte: u8) -> f64 {
    let encoded = f64::from(byte) / 255.0;
    if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

/// The sRGB byte of linear light.
fn byte(light: f64) -> u8 {
    let encoded = if light <= 0.003_130_8 { 12.92 * light } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 };
    (encoded * 255.0 + 0.5) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Material;

    #[test]
    fn bytes_are_what_they_were() {
        assert!((0..=255).all(|b| byte(light(b)) == b));
        assert!((0..=255).all(|b| gray([b; 3]) == b));
    }

    #[test]
    fn texels_are_averaged_in_linear_light() {
        let texture = Texture { size: [4, 2], texels: (0..8).map(|i| [if i % 2 == 0 { 0 } else { 255 }; 3]).collect() };
        let half = shrunk(&texture, 2);
        assert_eq!((half.size, half.texels.as_slice()), ([2, 1], &[[188; 3]; 2][..]));
        assert_eq!(shrunk(&texture, 4), texture);
        assert_eq!(shrunk(&texture, 1).size, [1, 1]);
        // Three to two: each of the new ones is one old and half of the middle one.
        let three = Texture { size: [3, 1], texels: vec![[255; 3], [0; 3], [0; 3]] };
        assert_eq!(shrunk(&three, 2).texels, [[byte(2.0 / 3.0); 3], [0; 3]]);
        let thin = Texture { size: [4096, 3], texels: vec![[7; 3]; 3 * 4096] };
        assert_eq!((shrunk(&thin, 64).size, shrunk(&thin, 64).texels[63]), ([64, 1], [7; 3]));
    }

    #[test]
    fn shared_textures_stay_shared() {
        let texture = Arc::new(Texture { size: [2, 2], texels: vec![[9; 3]; 4] });
        let material = Material { texture: Some(texture), ..Material::default() };
        let mut model = Model { materials: vec![material.clone(), Material::default(), material], ..Model::default() };
        shrink(&mut model, 1);
        let [a, b, c] = [0, 1, 2].map(|i| model.materials[i].texture.as_ref());
        assert!(Arc::ptr_eq(a.unwrap(), c.unwrap()) && b.is_none() && a.unwrap().size == [1, 1]);
    }

    #[test]
    fn texels_in_fewer_bytes() {
        let texture = Texture { size: [1, 2], texels: vec![[255, 0, 8], [0, 255, 0]] };
        assert_eq!(Texels::Rgb888.encode(&texture), (texture::Texture::RGB888, vec![0, 255, 0, 255, 0, 8]));
        assert_eq!(Texels::Rgb565.encode(&texture), (texture::Texture::RGB565, vec![0xe0, 0x07, 0x01, 0xf8]));
        assert_eq!(
            Texels::Gray8.encode(&texture),
            (texture::Texture::GRAY8, vec![byte(0.7152), byte(0.2126 + 0.0722 * light(8))])
        );
        let gray = Texture { size: [1, 2], texels: vec![[3; 3], [4; 3]] };
        for texels in [Texels::Rgb888, Texels::Rgb565, Texels::Gray8] {
            assert_eq!(texels.encode(&gray), (texture::Texture::GRAY8, vec![4, 3]), "the bottom row first");
        }
    }
}
