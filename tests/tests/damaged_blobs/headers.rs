//! Headers with values out of range, and what they say of the sections.

use core_rt::blob::{BlobError, Header, PREFIX_SIZE};
use core_rt::bvh::InPlace;
use core_rt::kernel::Kernel;
use core_rt::profile::{Need, Needs, Profile};
use core_rt::scene::Scene;
use tests::blobs::{Draft, repaired, sample};

use crate::{for_every_kernel, refused, verdict};

for_every_kernel!(broken_headers, broken_counts, broken_padding, undeclared_needs);

fn broken_headers<K: Kernel>() {
    const FIELDS: [fn(&mut Header) -> &mut [i64; 3]; 3] =
        [|h| &mut h.camera.first, |h| &mut h.camera.right, |h| &mut h.camera.down];
    refused::<K>(
        false,
        &[
            ("an eye too far off", |d| d.header.camera.eye[1] += K::SPAN, BlobError::Origin),
            ("an eye beyond all", |d| d.header.camera.eye[0] = i32::MAX, BlobError::Origin),
            ("an eye below all", |d| d.header.camera.eye[2] = i32::MIN, BlobError::Origin),
            ("a picture of no width", |d| d.header.size[0] = 0, BlobError::Header),
            ("a picture of no height", |d| d.header.size[1] = 0, BlobError::Header),
            ("a picture as wide as can be", |d| d.header.size[0] = u16::MAX, BlobError::Header),
            ("fractional bits beyond any word", |d| d.header.camera.fraction_bits = 255, BlobError::Header),
            ("more fractional bits than fit", |d| d.header.camera.fraction_bits = (62 - K::DIRECTION_BITS) as u8, {
                BlobError::Header
            }),
            ("fewer fractional bits than there are", |d| d.header.camera.fraction_bits -= 1, BlobError::Header),
            ("a need from the future", |d| d.header.needs = Needs::from_bits(1 << 40), BlobError::Header),
        ],
    );
    let good = Draft::<K>::read(sample::<K>(false).bytes()).expect("a good blob");
    for extreme in [i64::MIN, i64::MIN + 1, i64::MAX] {
        for axis in 0..3 {
            for coefficients in FIELDS {
                let mut draft = good.clone();
                coefficients(&mut draft.header)[axis] = extreme;
                assert_eq!(verdict::<K>(draft.write().bytes()), Err(BlobError::Header));
            }
        }
    }
    // A picture one pixel wide never takes a step to the right: what does not fit the word is refused all the same.
    let mut draft = good;
    draft.header.size = [1, 1];
    for step in [i64::from(i32::MAX), i64::MAX] {
        (draft.header.camera.right, draft.header.camera.down) = ([step; 3], [-step; 3]);
        let fits = step == i64::from(i32::MAX) || size_of::<K::Word>() == 8;
        let expected = if fits { Ok(()) } else { Err(BlobError::Header) };
        assert_eq!(verdict::<K>(draft.write().bytes()), expected, "{step}");
    }
}

fn broken_counts<K: Kernel>() {
    let counts: [fn(&mut Header) -> &mut u32; 6] = [
        |header| &mut header.counts.nodes,
        |header| &mut header.counts.triangles,
        |header| &mut header.counts.smooth,
        |header| &mut header.counts.normals,
        |header| &mut header.counts.materials,
        |header| &mut header.counts.lights,
    ];
    for smooth in [false, true] {
        let good = Draft::<K>::read(sample::<K>(smooth).bytes()).expect("a good blob");
        for (index, count) in counts.iter().enumerate() {
            for wrong in [0, 1, u32::MAX / 3, u32::MAX / 3 + 1, u32::MAX - 1, u32::MAX] {
                let mut draft = good.clone();
                let count = count(&mut draft.header);
                if *count != wrong {
                    *count = wrong;
                    let said = verdict::<K>(draft.write().bytes());
                    assert_eq!(said, Err(BlobError::Sections), "count {index} is {wrong}");
                }
            }
        }
    }
    refused::<K>(
        true,
        &[("no normals where some are needed", |d| d.header.needs = without(d, Need::SmoothNormals), {
            BlobError::Sections
        })],
    );
}

fn broken_padding<K: Kernel>() {
    let size_of_header = |good: &[u8]| u32::from_le_bytes([good[12], good[13], good[14], good[15]]) as usize;
    let mut blob = sample::<K>(true);
    if size_of_header(blob.bytes()).is_multiple_of(8) {
        // A larger number takes a byte more, and then there is padding.
        let mut draft = Draft::<K>::read(blob.bytes()).expect("a good blob");
        draft.header.file_triangles <<= 7;
        blob = draft.write();
    }
    let good = blob.bytes();
    let header_size = size_of_header(good);
    assert_ne!(header_size % 8, 0, "this sample shows nothing: its header has no padding");
    let with = |place: usize, value: &[u8]| {
        let mut bytes = good.to_vec();
        bytes[place..place + value.len()].copy_from_slice(value);
        verdict::<K>(repaired(&bytes, K::ID).bytes())
    };
    assert_eq!(with(20, &[1]), Err(BlobError::Header), "what is reserved in the prefix");
    assert_eq!(with(PREFIX_SIZE + header_size, &[1]), Err(BlobError::Header), "behind the header");
    assert_eq!(with(good.len() - 8, &[1]), Err(BlobError::Header), "before the checksum");
    for size in [0, 1, header_size as u32 - 1, header_size as u32 + 1, good.len() as u32, u32::MAX] {
        assert_eq!(with(12, &size.to_le_bytes()), Err(BlobError::Header), "a header of {size} bytes");
    }
    let longer = [&good[..PREFIX_SIZE + header_size], &[0; 8], &good[PREFIX_SIZE + header_size..]].concat();
    let mut longer = longer;
    longer[12..16].copy_from_slice(&(header_size as u32 + 8).to_le_bytes());
    assert_eq!(verdict::<K>(repaired(&longer, K::ID).bytes()), Err(BlobError::Header), "a header and more");
    // Three indices for each of five triangles in 16 bits leave two bytes.
    let draft = Draft::<K>::read(good).expect("a good blob");
    let behind = size_of_val(&*draft.normals).next_multiple_of(8)
        + size_of_val(&*draft.materials).next_multiple_of(8)
        + size_of_val(&*draft.lights).next_multiple_of(8)
        + 8;
    assert_eq!(with(good.len() - behind - 2, &[1]), Err(BlobError::Sections), "behind a section");
}

/// The needs of a draft but for one.
fn without<K: Kernel>(draft: &Draft<K>, need: Need) -> Needs {
    Needs::from_bits(draft.header.needs.bits() & !(need as u64))
}

/// A profile that has everything but directional lights.
#[derive(Clone, Copy, Debug, Default)]
struct Smaller<K>(core::marker::PhantomData<K>);

impl<K: Kernel> Profile for Smaller<K> {
    type Kernel = K;
    type Walk<'a> = InPlace;
    const NEEDS: Needs = Needs::from_bits(Needs::ALL.bits() & !(Need::DirectionalLight as u64));
}

fn undeclared_needs<K: Kernel>() {
    let blob = sample::<K>(false);
    let good = Draft::<K>::read(blob.bytes()).expect("a good blob");
    for need in [
        Need::PointLight,
        Need::DirectionalLight,
        Need::SeveralLights,
        Need::Emission,
        Need::Ambient,
        Need::Srgb,
        Need::Rgb888,
    ] {
        let mut draft = good.clone();
        draft.header.needs = without(&draft, need);
        assert_eq!(verdict::<K>(draft.write().bytes()), Err(BlobError::Undeclared(need)));
    }
    let refused = Scene::<Smaller<K>>::new_checked(blob.bytes()).map(|_| ());
    assert_eq!(refused, Err(BlobError::Missing(Need::DirectionalLight)));
}
