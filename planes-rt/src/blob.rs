//! A scene as bytes, read in place: a blob of the kernel [`KERNEL`].
//!
//! `core_rt`'s prefix; a [`Header`]; the spheres, 34 bytes each; zeros up to a multiple of 8; four bytes of zero and the CRC-32 of all
//! that stands before it. All numbers are little-endian, and so is every machine that reads them in place.

use core::fmt::{Display, Formatter};

use core_rt::blob::{BlobError, PREFIX_SIZE, Prefix, TRAILER_SIZE, crc32};
use core_rt::colour::Transfer;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::camera::Camera;
use crate::scene::{Outline, Scene, SceneError, Settings, Sphere};
use crate::widths::{Widths, WidthsError};

#[cfg(not(target_endian = "little"))]
compile_error!("spheres are read in place, where their numbers are little-endian");

/// The kernel's number.
pub const KERNEL: u16 = 12;

/// What stands between the prefix and the spheres.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Header {
    /// The bits of the f64 place in the scene that components of zero stand for. For the host; the device does not read it.
    pub middle_bits: [u64; 3],
    /// The bits of the f64 number of components' units a scene unit, likewise.
    pub scale_bits: u64,
    /// Where rays begin, and where they go.
    pub camera: Camera,
    /// Of components, products, the determinant and the fraction of t.
    pub widths: [u8; 4],
    /// Width and height of the picture.
    pub size: [u16; 2],
    /// How many spheres a ray meets at most.
    pub generations: u16,
    /// Towards the light.
    pub light: [i16; 3],
    /// What is seen behind all spheres.
    pub background: [u16; 3],
    /// How many spheres there are.
    pub spheres: u16,
    /// Samples of a pixel.
    pub samples: u16,
    /// 1 where the outline is the literal one, else 0.
    pub is_literal: u8,
    /// 1 where the picture's bytes are in proportion to light, 0 for sRGB.
    pub is_linear: u8,
    /// 1 where paths are followed, else 0.
    pub follows_paths: u8,
    /// Zero.
    pub reserved: [u8; 3],
}

/// Why bytes are no scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadError {
    /// They are not a blob for this kernel, or a damaged one.
    Blob(BlobError),
    /// It is for words that there is no arithmetic for.
    Widths(WidthsError),
    /// The scene exceeds its words.
    Scene(SceneError),
}

impl Display for ReadError {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Blob(error) => error.fmt(f),
            Self::Widths(error) => error.fmt(f),
            Self::Scene(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for ReadError {}

impl From<BlobError> for ReadError {
    fn from(error: BlobError) -> Self {
        Self::Blob(error)
    }
}

impl Header {
    /// For a scene whose components lie at `middle + component / scale`, by the bits of these f64.
    #[must_use]
    pub fn new(scene: &Scene<'_>, transfer: Transfer, middle_bits: [u64; 3], scale_bits: u64) -> Self {
        let Settings { widths, size, generations, outline, samples, paths } = scene.settings;
        let bits = [widths.coordinate(), widths.product(), widths.determinant(), widths.t_fraction()];
        Self {
            middle_bits,
            scale_bits,
            camera: scene.camera,
            widths: bits.map(|bits| bits as u8),
            size,
            generations,
            light: scene.light,
            background: scene.background,
            // There are no more numbers.
            spheres: scene.spheres.len() as u16,
            samples,
            is_literal: (outline == Outline::Literal).into(),
            is_linear: (transfer == Transfer::Linear).into(),
            follows_paths: paths.into(),
            reserved: [0; 3],
        }
    }

    /// That of a blob, unchecked; `None` where there is none.
    #[must_use]
    pub fn of(blob: &[u8]) -> Option<&Self> {
        Self::ref_from_prefix(blob.get(PREFIX_SIZE..)?).ok().map(|(header, _)| header)
    }

    /// The prefix of its blob.
    #[must_use]
    pub fn prefix(&self) -> Prefix {
        let body = size_of::<Self>() + usize::from(self.spheres) * size_of::<Sphere>();
        Prefix {
            magic: core_rt::blob::MAGIC,
            version: core_rt::blob::VERSION,
            kernel: KERNEL,
            header_size: size_of::<Self>() as u32,
            // At most 2^15 spheres.
            total_size: ((PREFIX_SIZE + body).next_multiple_of(8) + TRAILER_SIZE) as u32,
            reserved: 0,
        }
    }
}

/// The scene in a blob, and how its pictures become bytes.
///
/// # Errors
/// Where there is none for this kernel.
pub fn read(blob: &[u8]) -> Result<(Scene<'_>, Transfer), ReadError> {
    let prefix = Prefix::read(blob)?;
    if prefix.kernel != KERNEL {
        return Err(BlobError::Kernel { found: prefix.kernel, expected: KERNEL }.into());
    }
    let (summed, stated) = blob.split_last_chunk::<4>().ok_or(BlobError::Header)?;
    let (stated, computed) = (u32::from_le_bytes(*stated), crc32(summed));
    if stated != computed {
        return Err(BlobError::Checksum { stated, computed }.into());
    }
    let body = blob.get(PREFIX_SIZE..).ok_or(BlobError::Header)?;
    let (header, rest) = Header::ref_from_prefix(body).map_err(|_| BlobError::Header)?;
    let flags = [header.is_literal, header.is_linear, header.follows_paths];
    if header.prefix() != prefix || flags.iter().any(|&flag| flag > 1) || header.reserved != [0; 3] {
        return Err(BlobError::Header.into());
    }
    let (spheres, padding) =
        <[Sphere]>::ref_from_prefix_with_elems(rest, header.spheres.into()).map_err(|_| BlobError::Sections)?;
    let zeros = padding.split_last_chunk::<4>().map_or(padding, |(zeros, _)| zeros);
    if zeros.iter().any(|&byte| byte != 0) {
        return Err(BlobError::Sections.into());
    }
    let [coordinate, product, determinant, t_fraction] = header.widths.map(u32::from);
    let settings = Settings {
        widths: Widths::new(coordinate, product, determinant, t_fraction).map_err(ReadError::Widths)?,
        size: header.size,
        generations: header.generations,
        outline: if header.is_literal == 1 { Outline::Literal } else { Outline::Nearest },
        samples: header.samples,
        paths: header.follows_paths == 1,
    };
    let scene = Scene::new_checked(spheres, header.light, header.background, header.camera, settings);
    let transfer = if header.is_linear == 1 { Transfer::Linear } else { Transfer::Srgb };
    Ok((scene.map_err(ReadError::Scene)?, transfer))
}
