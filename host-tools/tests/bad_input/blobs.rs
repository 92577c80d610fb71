//! Blobs that are damaged, foreign, or for something else. `tests/damaged_blobs` goes through every byte.

use core_rt::blob::{Header, PREFIX_SIZE, crc32};
use host_tools::engine::ENGINES;

use crate::command::Folder;

/// A folder with `scene.blob`, the triangle at 6x4 pixels for a kernel.
fn folder(kernel: &str) -> Folder {
    let folder = Folder::with_triangle();
    folder.succeeds(&format!("prep scene.obj --size 6x4 --kernel {kernel} -o scene.blob"), "");
    folder
}

/// Changes a blob and makes its checksum right again.
fn signed(mut blob: Vec<u8>, change: impl FnOnce(&mut Vec<u8>)) -> Vec<u8> {
    change(&mut blob);
    let size = blob.len();
    let sum = crc32(&blob[..size - 4]);
    blob[size - 4..].copy_from_slice(&sum.to_le_bytes());
    blob
}

/// Expects every verb that takes a scene to refuse `scene.blob`.
#[track_caller]
fn refused(folder: &Folder, message: &str) {
    for line in ["render scene.blob -o out.png", "prep scene.blob -o out.blob", "inspect scene.blob --json"] {
        folder.refuses(line, &format!("error: scene.blob: {message}\n"));
    }
}

#[test]
fn a_good_one_is_a_scene() {
    let folder = folder("exact14");
    folder.succeeds("render scene.blob -o out.png", "");
    folder.succeeds("render scene.obj --size 6x4 --kernel exact14 -o other.png", "");
    assert_eq!(folder.read("out.png"), folder.read("other.png"));
    folder.succeeds("render scene.blob --kernel exact14 --size 6x4 -o out.png", "");
    folder.succeeds("prep scene.blob -o same.blob", "");
    assert_eq!(folder.read("same.blob"), folder.read("scene.blob"));
}

#[test]
fn cut_and_damaged() {
    let folder = folder("exact29");
    let whole = folder.read("scene.blob");
    let size = whole.len();
    for length in [0, 1, 8, 23] {
        folder.write("scene.blob", &whole[..length]);
        refused(
            &folder,
            &format!("the blob is cut short: {length} bytes where 32 are expected; make it anew with `intray prep`"),
        );
    }
    for length in [24, size / 2, size - 1] {
        folder.write("scene.blob", &whole[..length]);
        refused(
            &folder,
            &format!(
                "the blob is cut short: {length} bytes where {size} are expected; make it anew with `intray prep`"
            ),
        );
    }
    folder.write("scene.blob", &[whole.as_slice(), b"\r\n"].concat());
    refused(
        &folder,
        &format!(
            "the blob is followed by something else: {} bytes where {size} are expected; make it anew with `intray prep`",
            size + 2
        ),
    );
    let mut flipped = whole.clone();
    flipped[size / 2] ^= 0x10;
    let (has, should) = (crc32(&flipped[..size - 4]), crc32(&whole[..size - 4]));
    folder.write("scene.blob", &flipped);
    refused(
        &folder,
        &format!(
            "the blob is damaged: its CRC-32 is {has:08x} and should be {should:08x}; make it anew with `intray prep`"
        ),
    );
    folder.write("scene.blob", &signed(whole, |blob| blob[PREFIX_SIZE..][..5].fill(0xff)));
    refused(&folder, "the blob's header is damaged; make it anew with `intray prep`");
}

#[test]
fn foreign() {
    let cases: [&[u8]; 4] = [b"solid stl\n", b"\x89PNG\r\n\x1a\n", &[0; 64], b"\x89intrax\n"];
    for contents in cases {
        let folder = Folder::new(&[("scene.blob", contents)]);
        refused(&folder, "not a scene; that is a .toml or .obj file by its name, or a blob that `intray prep` made");
    }
}

#[test]
fn of_another_version_or_kernel() {
    let folder = folder("exact29");
    let whole = folder.read("scene.blob");
    folder.write("scene.blob", &signed(whole.clone(), |blob| blob[8] = 1));
    refused(
        &folder,
        "the blob has format version 1, and this program reads version 2; make it anew with `intray prep`",
    );
    folder.write("scene.blob", &signed(whole.clone(), |blob| blob[10] = 77));
    // Such as: exact29 (29), exact14 (14).
    let known = ENGINES.map(|engine| format!("{} ({})", engine.name(), engine.id())).join(", ");
    refused(
        &folder,
        &format!(
            "the blob is for a kernel of number 77, and this program has {known}; make it anew with `intray prep`"
        ),
    );
    // The records of one kernel are not those of another, whatever the prefix says.
    folder.write("scene.blob", &signed(whole, |blob| blob[10] = 14));
    refused(&folder, "the blob's header is damaged; make it anew with `intray prep`");
}

#[test]
fn for_something_else_than_was_asked() {
    let folder = folder("exact14");
    folder.refuses(
        "render scene.blob --kernel exact29 -o out.png",
        "error: scene.blob: the blob is for exact14, not for exact29; leave out --kernel, or give the scene it was made \
         from\n",
    );
    let options = [
        "--size 7x4",
        "--samples 4",
        "--paths",
        "--depth 3",
        "--format gray8",
        "--leaf 2",
        "--prefer size",
        "--grid-bits 10",
        "--triangles 1",
        "--edge-shift 10",
        "--texture-size 8",
        "--texels gray8",
    ];
    for option in options {
        folder.refuses(
            &format!("render scene.blob {option} -o out.png"),
            "error: scene.blob: the blob is for 6x4 pixels, and its tree is built; --size, --samples, --paths, \
             --depth, --format, --leaf, --prefer, --grid-bits, --triangles, --texture-size, --texels and the knobs of its arithmetic need the scene that \
             it was made from\n",
        );
    }
}

/// A blob may ask for any picture; memory for it is not to be taken.
#[test]
fn of_a_picture_too_large() {
    let folder = folder("exact14");
    let whole = folder.read("scene.blob");
    let old_size = u32::from_le_bytes([whole[12], whole[13], whole[14], whole[15]]) as usize;
    let (mut header, _) = postcard::take_from_bytes::<Header>(&whole[PREFIX_SIZE..]).unwrap();
    header.size = [u16::MAX; 2];
    // Every pixel looks the same way, as wide a picture as that can only.
    (header.camera.right, header.camera.down) = ([0; 3], [0; 3]);
    let mut encoded = postcard::to_stdvec(&header).unwrap();
    let mut prefix = whole[..PREFIX_SIZE].to_vec();
    prefix[12..16].copy_from_slice(&(encoded.len() as u32).to_le_bytes());
    encoded.resize(encoded.len().next_multiple_of(8), 0);
    let larger = [&prefix, &encoded, &whole[PREFIX_SIZE + old_size.next_multiple_of(8)..]].concat();
    let total = larger.len() as u32;
    folder.write("scene.blob", &signed(larger, |blob| blob[16..20].copy_from_slice(&total.to_le_bytes())));
    refused(
        &folder,
        "the blob is for 65535x65535 pixels; a picture has 1 to 16384 pixels a side, and at most 67108864 in all",
    );
}
