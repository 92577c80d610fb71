//! The document's table of what a reader checks, row by row, against the core's own reader.

use core_rt::blob::BlobError;
use core_rt::exact::{Exact14, Exact29};
use core_rt::kernel::Kernel;
use core_rt::profile::{Full, Need, Needs, Profile};
use core_rt::scene::Scene;
use host_tools::prepare;

use crate::reader::{Blob, crc32, read};
use crate::{built_in, prepare};

/// Leaves out smooth normals.
#[derive(Clone, Copy, Debug, Default)]
struct Flat;

impl Profile for Flat {
    type Kernel = Exact14;
    const NEEDS: Needs = Needs::from_bits(Needs::ALL.bits() & !(Need::SmoothNormals as u32));
}

/// A blob's bytes, and what is where in them.
struct Sample {
    bytes: Vec<u8>,
    read: Blob,
}

impl Sample {
    fn new(kernel: &str) -> Self {
        let bytes = prepare(&built_in(), kernel).blob.bytes().to_vec();
        let read = read(&bytes);
        Self { bytes, read }
    }

    /// What the core says of the bytes after a change, with a checksum that fits them.
    fn after<P: Profile>(&self, change: impl Fn(&mut Vec<u8>)) -> Result<(), BlobError> {
        let mut bytes = self.bytes.clone();
        change(&mut bytes);
        let covered = bytes.len() - 4;
        let checksum = crc32(&bytes[..covered]);
        bytes[covered..].copy_from_slice(&checksum.to_le_bytes());
        verdict::<P>(&bytes)
    }

    /// The same, with a 16-bit word added to at an offset in a part.
    fn plus<P: Profile>(&self, part: usize, offset: usize, add: u16) -> Result<(), BlobError> {
        let at = self.read.parts[part].start + offset;
        self.after::<P>(|bytes| {
            let word = u16::from_le_bytes([bytes[at], bytes[at + 1]]).wrapping_add(add);
            bytes[at..at + 2].copy_from_slice(&word.to_le_bytes());
        })
    }
}

fn verdict<P: Profile>(bytes: &[u8]) -> Result<(), BlobError> {
    Scene::<P>::new_checked(prepare::Blob::from_bytes(bytes).bytes()).map(drop)
}

const HEADER: usize = 0;
const NODES: usize = 1;
const TRIANGLES: usize = 2;
const IDS: usize = 3;
const CORNERS: usize = 4;
const NORMALS: usize = 5;
const MATERIALS: usize = 6;
const LIGHTS: usize = 7;

#[test]
fn the_prefix_and_the_checksum() {
    let sample = Sample::new("exact14");
    let bytes = &sample.bytes;
    let cut = |length: usize| verdict::<Full<Exact14>>(&bytes[..length]);
    assert_eq!(cut(bytes.len()), Ok(()));
    assert!(matches!(cut(3), Err(BlobError::Truncated { .. })));
    assert!(matches!(cut(23), Err(BlobError::Truncated { .. })));
    assert!(matches!(cut(bytes.len() - 1), Err(BlobError::Truncated { .. })));
    let long: Vec<u8> = bytes.iter().copied().chain([0]).collect();
    assert!(matches!(verdict::<Full<Exact14>>(&long), Err(BlobError::Oversized { .. })));
    assert_eq!(verdict::<Full<Exact14>>(b"\x89inTray\n"), Err(BlobError::Foreign));
    let changed = |at: usize| sample.after::<Full<Exact14>>(|bytes| bytes[at] ^= 1);
    assert_eq!(changed(1), Err(BlobError::Foreign));
    assert_eq!(changed(8), Err(BlobError::Version { found: 0 }));
    assert_eq!(changed(10), Err(BlobError::Kernel { found: 15, expected: Exact14::ID }));
    assert_eq!(changed(12), Err(BlobError::Header));
    assert_eq!(verdict::<Full<Exact29>>(bytes), Err(BlobError::Kernel { found: 14, expected: Exact29::ID }));
    let mut damaged = bytes.clone();
    damaged[200] ^= 1;
    assert!(matches!(verdict::<Full<Exact14>>(&damaged), Err(BlobError::Checksum { .. })));
}

#[test]
fn the_address() {
    let sample = Sample::new("exact14");
    let mut moved = vec![0_u64; sample.bytes.len() / 8 + 1];
    let moved = zerocopy::IntoBytes::as_mut_bytes(&mut moved[..]);
    for offset in 1..8 {
        moved[offset..][..sample.bytes.len()].copy_from_slice(&sample.bytes);
        let found = Scene::<Full<Exact14>>::new_checked(&moved[offset..][..sample.bytes.len()]);
        assert_eq!(found.map(drop), Err(BlobError::Misaligned), "{offset}");
    }
}

#[test]
fn the_header() {
    let sample = Sample::new("exact14");
    let header = &sample.read.parts[HEADER];
    // The scale's last group of bits, told to go on, runs out of the header.
    assert_eq!(sample.after::<Full<Exact14>>(|bytes| bytes[header.end - 1] |= 0x80), Err(BlobError::Header));
    assert_eq!(sample.after::<Full<Exact14>>(|bytes| bytes[12..16].fill(0xff)), Err(BlobError::Header));
    // The needs take one byte here, so the width begins at the second or third.
    let needs_size = if sample.read.header.needs < 128 { 1 } else { 2 };
    let width = header.start + needs_size;
    assert_eq!(sample.read.header.size[0] >> 7, u64::from(sample.bytes[width + 1]));
    let no_width = sample.after::<Full<Exact14>>(|bytes| bytes[width..width + 2].copy_from_slice(&[0x80, 0]));
    assert_eq!(no_width, Err(BlobError::Header));
    // Twice the width brings the right-hand corners out of the range of directions.
    let twice = sample.after::<Full<Exact14>>(|bytes| bytes[width + 1] *= 4);
    assert_eq!(twice, Err(BlobError::Header));
    assert_eq!(sample.after::<Flat>(|_| ()), Err(BlobError::Missing(Need::SmoothNormals)));
    // Without the bit of smooth triangles there are normals all the same.
    let unneeded = sample.after::<Full<Exact14>>(|bytes| bytes[header.start] ^= 8);
    assert_eq!(unneeded, Err(BlobError::Sections));
    let none = sample.after::<Full<Exact14>>(|bytes| {
        let at = sample.read.parts[IDS].end;
        assert!(at % 8 != 0, "the ids are padded");
        bytes[at] = 1;
    });
    assert_eq!(none, Err(BlobError::Sections));
}

#[test]
fn the_tree() {
    let sample = Sample::new("exact14");
    // A reference's index plus one; a box's greatest coordinate less one hundred.
    assert_eq!(sample.plus::<Full<Exact14>>(NODES, 24, 1), Err(BlobError::Tree { node: 0 }));
    let first_leaf = sample.read.nodes.iter().position(|node| node.children[0] >> 31 == 1).unwrap();
    let leaf_box = 32 * first_leaf + 6;
    let bounds = sample.plus::<Full<Exact14>>(NODES, leaf_box, 0_u16.wrapping_sub(100));
    assert_eq!(bounds, Err(BlobError::Bounds { node: first_leaf as u32 }));
    // The depth is one byte, before the counts, the number of triangles and four numbers of the grid.
    let header = &sample.read.header;
    let varint_size = |value: u64| (64 - (value | 1).leading_zeros() as usize).div_ceil(7);
    let behind = header.counts.iter().map(|&count| varint_size(count as u64)).sum::<usize>()
        + varint_size(header.file_triangles)
        + header.origin.iter().chain([&header.scale]).map(|c| varint_size(c.to_bits())).sum::<usize>();
    let at = sample.read.parts[HEADER].end - behind - 1;
    assert_eq!(sample.bytes[at], header.depth);
    let stating = |depth: u8| sample.after::<Full<Exact14>>(|bytes| bytes[at] = depth);
    assert_eq!(stating(header.depth - 1), Err(BlobError::Depth { stated: header.depth - 1 }));
    assert_eq!(stating(65), Err(BlobError::Depth { stated: 65 }));
    assert_eq!(stating(64), Ok(()));
}

#[test]
fn triangles_and_shading() {
    let sample = Sample::new("exact14");
    let plus = |part, offset, add| sample.plus::<Full<Exact14>>(part, offset, add);
    let triangle = Err(BlobError::Triangle { index: 0 });
    assert_eq!(plus(TRIANGLES, 18, 1), triangle, "n");
    assert_eq!(plus(TRIANGLES, 24, 1), triangle, "shift");
    assert_eq!(plus(TRIANGLES, 24, 4095 << 4), triangle, "material");
    assert_eq!(plus(IDS, 0, 0_u16.wrapping_sub(sample.read.ids[0] as u16 + 1)), triangle, "id");
    let smooth = sample.read.corners.iter().position(Option::is_some).unwrap();
    let index = sample.read.corners[smooth].unwrap()[1] as u16;
    let beyond = (sample.read.normals.len() as u16).wrapping_sub(index);
    assert_eq!(plus(CORNERS, 6 * smooth + 2, beyond), Err(BlobError::Triangle { index: smooth as u32 }));
    let shading = Err(BlobError::Shading);
    let largest = (0..3).max_by_key(|&axis| sample.read.normals[0][axis].abs()).unwrap();
    assert_eq!(plus(NORMALS, 2 * largest, 1 << 14), shading, "length");
    assert_eq!(plus(MATERIALS, 6, 0x4000), shading, "exponent");
    assert_eq!(plus(MATERIALS, 14, 1), shading, "reserved");
    assert_eq!(plus(LIGHTS, 0, 1), shading, "a kind that the needs lack");
    assert_eq!(plus(LIGHTS, 4, 1 << 15), shading, "place");
}
