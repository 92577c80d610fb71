//! The prefix, the header and the checksum.

use serde::{Deserialize, Serialize};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use super::{BlobError, decode};
use crate::arithmetic::Arithmetic;
use crate::camera::{CameraHeader, Use};
use crate::colour::{Radiance, Transfer};
use crate::format::Format;
use crate::paint::PaintCounts;
use crate::profile::{Need, Needs, Prefer};
use crate::section::{ALIGN, Reader};

/// How a blob begins. The first byte is no text; the line end shows a transfer that changed line ends.
pub const MAGIC: [u8; 8] = *b"\x89intray\n";

/// The format's version.
pub const VERSION: u16 = 2;

/// What stands before the header and never changes its layout, so that every version can be told.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Prefix {
    /// [`MAGIC`].
    pub magic: [u8; 8],
    /// [`VERSION`].
    pub version: u16,
    /// [`Kernel::ID`](crate::kernel::Kernel::ID).
    pub kernel: u16,
    /// The bytes of the header that follows; padding to a multiple of 8 comes after it.
    pub header_size: u32,
    /// The bytes of the whole blob, a multiple of 8.
    pub total_size: u32,
    /// Zero.
    pub reserved: u32,
}

/// The size of a [`Prefix`].
pub const PREFIX_SIZE: usize = size_of::<Prefix>();

/// Behind the sections: four bytes of zero, and the CRC-32 of all that stands before it.
pub const TRAILER_SIZE: usize = 8;

/// The number of records in each section.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Tree nodes.
    pub nodes: u32,
    /// Triangles, and their ids.
    pub triangles: u32,
    /// Vertices that triangles share: none where they have records.
    pub vertices: u32,
    /// Spheres, and their ids behind those.
    pub spheres: u32,
    /// Triangles with normal indices: none or all.
    pub smooth: u32,
    /// Unit normals.
    pub normals: u32,
    /// Textures and colours of vertices.
    pub paint: PaintCounts,
    /// Materials.
    pub materials: u32,
    /// What is more than matt of them.
    pub lustres: u32,
    /// Patterns of cubes.
    pub checkers: u32,
    /// Lights.
    pub lights: u32,
}

/// How the grid lies in the scene: `scene = origin + grid / scale`. For the host; the device does not read it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SourceGrid {
    /// The bits of the f64 origin.
    pub origin_bits: [u64; 3],
    /// The bits of the f64 scale, grid units per scene unit.
    pub scale_bits: u64,
}

/// What the sections cannot say, by postcard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// What the scene needs.
    pub needs: Needs,
    /// Width and height of the picture.
    pub size: [u16; 2],
    /// The camera.
    pub camera: CameraHeader,
    /// What a ray that hits nothing sees: straight down, and straight up.
    pub background: [Radiance; 2],
    /// Light that reaches everything.
    pub ambient: Radiance,
    /// How pixels are encoded.
    pub transfer: Transfer,
    /// How they lie in memory.
    pub format: Format,
    /// Camera rays a pixel, from 1 to [`MAX_SAMPLES`](crate::samples::MAX_SAMPLES).
    pub samples: u16,
    /// How often rays go on from surfaces: the branches that a pixel's tree may have waiting.
    pub max_depth: u8,
    /// The root of the tree, packed.
    pub root: u32,
    /// The levels of nodes: the stack that a traversal needs.
    pub depth: u8,
    /// Section sizes.
    pub counts: Counts,
    /// Triangles in the file, degenerate ones included: their ids are below this.
    pub file_triangles: u32,
    /// Spheres in the file, too small ones included: their ids follow those of triangles.
    pub file_spheres: u32,
    /// How many bits of a record's material number are that; the others are the triangle's id, where ids are not apart.
    pub material_bits: u8,
    /// What the kernel computes with.
    pub arithmetic: Arithmetic,
    /// Where the grid came from.
    pub source: SourceGrid,
}

impl Header {
    /// What is done with the camera, under a profile that has all needs. What the profile lacks is known to be left out when
    /// the code is compiled.
    #[inline(always)]
    #[must_use]
    pub fn camera_use(&self, profile: Needs) -> Use {
        let has = |need| profile.has(need) && self.needs.has(need);
        Use {
            size: self.size,
            parallel: has(Need::Orthographic),
            sampled: has(Need::Supersampling) || has(Need::Paths),
        }
    }
}

/// CRC-32 (ISO-HDLC: as in PNG and zlib).
#[must_use]
pub fn crc32(bytes: &[u8]) -> u32 {
    // One table of 1 KiB: the slicing tables of the default would take 16 KiB of flash.
    const CRC: crc::Crc<u32, crc::Table<1>> = crc::Crc::<u32, crc::Table<1>>::new(&crc::CRC_32_ISO_HDLC);
    CRC.checksum(bytes)
}

impl Prefix {
    /// Reads and checks the prefix. Any alignment.
    ///
    /// # Errors
    /// Foreign bytes, another version, a wrong length.
    pub fn read(bytes: &[u8]) -> Result<Self, BlobError> {
        let found = bytes.len() as u64;
        let magic = MAGIC.get(..bytes.len().min(MAGIC.len())).unwrap_or_default();
        if !bytes.starts_with(magic) {
            return Err(BlobError::Foreign);
        }
        let Ok((prefix, _)) = Self::read_from_prefix(bytes) else {
            return Err(BlobError::Truncated { expected: (PREFIX_SIZE + TRAILER_SIZE) as u64, found });
        };
        if prefix.version != VERSION {
            return Err(BlobError::Version { found: prefix.version });
        }
        let expected = u64::from(prefix.total_size);
        match expected.cmp(&found) {
            core::cmp::Ordering::Greater => Err(BlobError::Truncated { expected, found }),
            core::cmp::Ordering::Less => Err(BlobError::Oversized { expected, found }),
            core::cmp::Ordering::Equal => Ok(prefix),
        }
    }
}

/// [`crc32`], without a table: that costs eight steps a byte, once a start.
fn crc32_in_place(bytes: &[u8]) -> u32 {
    const CRC: crc::Crc<u32, crc::NoTable> = crc::Crc::<u32, crc::NoTable>::new(&crc::CRC_32_ISO_HDLC);
    CRC.checksum(bytes)
}

/// The header and the sections of a blob whose prefix and checksum are right.
// Out of line: what decodes a header has it twice on the stack.
#[inline(never)]
pub(crate) fn open(bytes: &[u8], kernel: u16, prefer: Prefer) -> Result<(Header, &[u8]), BlobError> {
    let prefix = Prefix::read(bytes)?;
    if prefix.kernel != kernel {
        return Err(BlobError::Kernel { found: prefix.kernel, expected: kernel });
    }
    let (summed, stated) = bytes.split_last_chunk::<4>().ok_or(BlobError::Header)?;
    let (stated, computed) = (
        u32::from_le_bytes(*stated),
        match prefer {
            Prefer::Speed => crc32(summed),
            Prefer::Size => crc32_in_place(summed),
        },
    );
    if stated != computed {
        return Err(BlobError::Checksum { stated, computed });
    }
    if !bytes.as_ptr().addr().is_multiple_of(ALIGN) {
        return Err(BlobError::Misaligned);
    }
    let (body, zero) = summed.split_last_chunk::<4>().ok_or(BlobError::Header)?;
    if prefix.reserved != 0 || *zero != [0; 4] {
        return Err(BlobError::Header);
    }
    let mut reader = Reader { bytes: body.get(PREFIX_SIZE..).ok_or(BlobError::Header)? };
    let encoded = reader.records(prefix.header_size).ok_or(BlobError::Header)?;
    let header = decode(encoded).ok_or(BlobError::Header)?;
    Ok((header, reader.bytes))
}
