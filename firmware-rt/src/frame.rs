//! Frames: how the picture comes from the chip to the host.
//!
//! A frame is a [`Head`], as many bytes as it says, and the CRC-32 of both. A picture is one [`Begin`], its tiles, each a
//! [`TileHead`] with pixels behind it, row by row, in the format that was said, and one [`Report`]. All numbers are little-endian.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// The name of the channel that frames are written to, in [`digits`](crate::digits), by RTT.
pub const CHANNEL: &str = "picture";

/// The file that frames are written to, under semihosting.
pub const FILE: &core::ffi::CStr = c"intray.frames";

/// How a frame begins.
pub const MAGIC: [u8; 2] = *b"iF";

/// The most bytes between head and checksum.
pub const MOST_BYTES: u32 = 1 << 16;

/// The checksum, as in PNG, by one table of 1 KiB.
pub const CRC_32: crc::Crc<u32, crc::Table<1>> = crc::Crc::<u32, crc::Table<1>>::new(&crc::CRC_32_ISO_HDLC);

/// What stands before a frame's bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Head {
    /// [`MAGIC`].
    pub magic: [u8; 2],
    /// What the bytes are: [`Begin::KIND`] and the like.
    pub kind: u16,
    /// How many there are, at most [`MOST_BYTES`].
    pub length: u32,
}

/// The blob is accepted; a picture of this size follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Begin {
    /// Pixels across.
    pub width: u16,
    /// Pixels down.
    pub height: u16,
    /// The number of the pixels' [`Format`](core_rt::format::Format).
    pub format: u16,
}

/// A tile; its pixels follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct TileHead {
    /// The left column.
    pub x: u16,
    /// The top row.
    pub y: u16,
    /// Columns.
    pub width: u16,
    /// Rows.
    pub height: u16,
}

/// What a whole picture took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Report {
    /// The deepest that the stack was, bytes.
    pub stack_bytes: u32,
    /// 1 where work was counted.
    pub counted: u32,
    /// Camera rays.
    pub primary_rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Mirrored rays.
    pub reflection_rays: u64,
    /// Rays through surfaces.
    pub refraction_rays: u64,
    /// Ray-box tests.
    pub box_tests: u64,
    /// Ray-triangle tests.
    pub triangle_tests: u64,
}

impl Begin {
    /// In a [`Head`].
    pub const KIND: u16 = 1;
}

impl TileHead {
    /// In a [`Head`].
    pub const KIND: u16 = 2;
}

impl Report {
    /// In a [`Head`].
    pub const KIND: u16 = 3;
}

/// Gives a frame's bytes, which are those of `parts` in order, to `write`.
///
/// # Errors
/// That of `write`.
pub fn write<E>(kind: u16, parts: &[&[u8]], mut write: impl FnMut(&[u8]) -> Result<(), E>) -> Result<(), E> {
    let length = parts.iter().map(|part| part.len() as u32).sum();
    let head = Head { magic: MAGIC, kind, length };
    let mut sum = CRC_32.digest();
    for &part in [head.as_bytes()].iter().chain(parts) {
        sum.update(part);
        write(part)?;
    }
    write(&sum.finalize().to_le_bytes())
}
