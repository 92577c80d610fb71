//! Textures, coordinates and colours of vertices that no scene has.

use core_rt::blob::BlobError;
use core_rt::kernel::Kernel;
use core_rt::profile::{Full, Need, Needs};
use core_rt::scene::Scene;
use core_rt::texture::{LARGEST_SIDE, Texture, UV_END};
use tests::blobs::{Draft, corners};
use tests::painted::sample;

use crate::{Damage, for_every_kernel, verdict};

for_every_kernel!(the_sample_is_good, broken_paint, paint_at_the_ends_of_all_ranges, coordinates_without_a_texture);

/// The narrow index that stands for nothing.
const NONE: u32 = u16::MAX as u32;

fn the_sample_is_good<K: Kernel>() {
    let blob = sample::<K>();
    let draft = Draft::<K>::read(blob.bytes()).expect("a good blob");
    assert_eq!(draft.write(), blob, "taken apart and put together");
    assert_eq!(verdict::<K>(blob.bytes()), Ok(()));
    let flat: Vec<bool> = draft.uv_indices.chunks(3).map(|corners| corners == [NONE; 3]).collect();
    assert_eq!(flat.iter().filter(|&&none| none).count(), 2, "one has no coordinates and one no texture");
    assert_eq!((draft.textures.len(), draft.materials.len(), draft.texels.len()), (4, 4, 18 + 10));
    let formats = draft.textures.iter().map(|texture| (texture.first, texture.size, texture.format));
    let expected =
        [(0, [3, 2], Texture::RGB888), (18, [2, 5], Texture::GRAY8), (0, [3, 2], Texture::RGB888), (0, [0, 0], 0)];
    assert_eq!(formats.collect::<Vec<_>>(), expected);
    assert!(draft.uvs.as_flattened().iter().all(|c| (0..=5 << 20).contains(c)), "less the whole repeats");
}

/// Takes a need out of the header.
fn without<K: Kernel>(draft: &mut Draft<K>, need: Need) {
    draft.header.needs = Needs::from_bits(draft.header.needs.bits() & !(need as u64));
}

/// The first triangle with coordinates.
fn textured<K: Kernel>(draft: &Draft<K>) -> u32 {
    draft.uv_indices.chunks(3).position(|corners| corners != [NONE; 3]).expect("some have") as u32
}

fn broken_paint<K: Kernel>() {
    let cases: &[Damage<K>] = &[
        ("a coordinate below 0", |d| d.uvs[1][0] = -1, BlobError::Shading),
        ("a coordinate too large", |d| d.uvs[0][1] = UV_END, BlobError::Shading),
        ("a texture without columns", |d| d.textures[0].size[0] = 0, BlobError::Shading),
        ("a texture without rows", |d| d.textures[1].size[1] = 0, BlobError::Shading),
        ("a texture too wide", |d| d.textures[1].size = [LARGEST_SIDE + 1, 0], BlobError::Shading),
        ("a texture beyond the texels", |d| d.textures[1].first += 1, BlobError::Shading),
        ("a texture far beyond the texels", |d| d.textures[0].first = u32::MAX, BlobError::Shading),
        ("a texture of more texels than there are", |d| d.textures[0].size = [LARGEST_SIDE; 2], BlobError::Shading),
        ("a format from the future", |d| d.textures[0].format = 3, BlobError::Shading),
        ("a texture from the future", |d| d.textures[3].reserved = 1, BlobError::Shading),
        ("a place without a texture", |d| d.textures[3].first = 1, BlobError::Shading),
        ("no coordinates", |d| (d.uvs, d.header.counts.paint.uvs) = (Vec::new(), 0), BlobError::Sections),
        ("no texels", |d| (d.texels, d.header.counts.paint.texels) = (Vec::new(), 0), BlobError::Sections),
        ("no colours", |d| (d.colours, d.header.counts.paint.colours) = (Vec::new(), 0), BlobError::Sections),
        ("textures that are not declared", |d| without(d, Need::Texture), BlobError::Sections),
        ("colours that are not declared", |d| without(d, Need::VertexColours), BlobError::Sections),
        (
            "smooth textures that are none",
            |d| {
                without(d, Need::Texture);
                (d.uv_indices, d.uvs, d.textures, d.texels) = Default::default();
                (d.header.counts.paint.uvs, d.header.counts.paint.texels) = (0, 0);
            },
            BlobError::Sections,
        ),
        ("texels that are cut short", |d| d.header.counts.paint.texels += 8, BlobError::Sections),
    ];
    let good = sample::<K>();
    for (name, damage, expected) in cases {
        let mut draft = Draft::read(good.bytes()).expect("a good blob");
        damage(&mut draft);
        assert_eq!(verdict::<K>(draft.write().bytes()), Err(*expected), "{name}");
    }
    let refused = |damage: &dyn Fn(&mut Draft<K>, usize)| {
        let mut draft = Draft::<K>::read(good.bytes()).expect("a good blob");
        let index = textured(&draft);
        damage(&mut draft, 3 * index as usize);
        assert_eq!(verdict::<K>(draft.write().bytes()), Err(BlobError::Triangle { index }));
    };
    refused(&|d, at| d.uv_indices[at] = d.uvs.len() as u32);
    refused(&|d, at| d.uv_indices[at + 2] = NONE);
    refused(&|d, at| d.colour_indices[at + 1] = d.colours.len() as u32);
    refused(&|d, at| d.colour_indices[at..at + 3].fill(NONE));
}

/// Coordinates at both ends of their range, textures of the largest sides, of any format: nothing overflows.
fn paint_at_the_ends_of_all_ranges<K: Kernel>() {
    for (format, bytes) in [(Texture::RGB888, 3), (Texture::RGB565, 2), (Texture::GRAY8, 1)] {
        for size in [[LARGEST_SIDE, 1], [1, LARGEST_SIDE], [1, 1], [3, LARGEST_SIDE - 1]] {
            let mut draft = Draft::<K>::read(sample::<K>().bytes()).expect("a good blob");
            draft.texels = vec![255; usize::from(size[0]) * usize::from(size[1]) * bytes];
            draft.header.counts.paint.texels = draft.texels.len() as u32;
            draft.textures.fill(Texture { first: 0, size, format, reserved: 0 });
            for (i, uv) in draft.uvs.iter_mut().enumerate() {
                *uv = [0, 1].map(|axis| if i >> axis & 1 == 0 { UV_END - 1 } else { 0 });
            }
            for bilinear in [false, true] {
                without(&mut draft, Need::Bilinear);
                draft.header.needs = draft.header.needs.with(Need::Bilinear, bilinear);
                let blob = draft.write();
                let scene = Scene::<Full<K>>::new_checked(blob.bytes()).expect("all is in range");
                corners(&scene);
            }
        }
    }
}

/// A material without a texture may have triangles with coordinates: they mean nothing.
fn coordinates_without_a_texture<K: Kernel>() {
    let mut draft = Draft::<K>::read(sample::<K>().bytes()).expect("a good blob");
    draft.textures.fill(Texture::default());
    assert_eq!(verdict::<K>(draft.write().bytes()), Ok(()));
}
