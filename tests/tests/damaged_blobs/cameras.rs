//! Cameras of parallel rays, samples and formats: what no scene has is refused, and the ends of all ranges render.

use core_rt::blob::BlobError;
use core_rt::format::Format;
use core_rt::kernel::{Bounds, Kernel};
use core_rt::profile::{Full, Need};
use core_rt::samples::MAX_SAMPLES;
use core_rt::scene::Scene;
use tests::blobs::{Draft, corners, sample};

use crate::{for_every_kernel, refused, verdict};

for_every_kernel!(samples_and_formats, parallel_rays, planes_at_the_ends);

/// Makes room for half a pixel more.
fn closer<K: Kernel>(draft: &mut Draft<K>) {
    let camera = &mut draft.header.camera;
    for coefficients in [&mut camera.first, &mut camera.right, &mut camera.down] {
        *coefficients = coefficients.map(|c| c / 2);
    }
}

fn samples_and_formats<K: Kernel>() {
    refused::<K>(
        false,
        &[
            ("no samples", |d| d.header.samples = 0, BlobError::Header),
            (
                "too many samples",
                |d| {
                    closer(d);
                    d.header.samples = MAX_SAMPLES + 1;
                },
                BlobError::Header,
            ),
            (
                "samples where the middles of pixels are at the end of the range",
                |d| d.header.needs = d.header.needs.with(Need::Supersampling, true),
                BlobError::Header,
            ),
            (
                "samples that are not declared",
                |d| {
                    closer(d);
                    d.header.samples = 2;
                },
                BlobError::Undeclared(Need::Supersampling),
            ),
            ("a format that is not declared", |d| d.header.format = Format::Gray8, BlobError::Undeclared(Need::Gray8)),
            ("another", |d| d.header.format = Format::Rgb565, BlobError::Undeclared(Need::Rgb565)),
            ("a direction of all rays in perspective", |d| d.header.camera.along[1] = 1, BlobError::Header),
        ],
    );
    for (format, need) in [(Format::Rgb565, Need::Rgb565), (Format::Gray8, Need::Gray8), (Format::Rgb888, Need::Rgb888)]
    {
        for samples in [1, 2, MAX_SAMPLES] {
            let mut draft = Draft::<K>::read(sample::<K>(true).bytes()).expect("a good blob");
            closer(&mut draft);
            (draft.header.format, draft.header.samples) = (format, samples);
            draft.header.needs = draft.header.needs.with(need, true).with(Need::Supersampling, samples > 1);
            assert_eq!(verdict::<K>(draft.write().bytes()), Ok(()), "{format:?}, {samples}");
        }
    }
}

/// Everything that the tree holds.
fn whole<K: Kernel>(draft: &Draft<K>) -> Bounds {
    let [a, b] = K::boxes(&draft.nodes[0]);
    a.union(&b)
}

/// The sample by parallel rays, from the whole plane that it can be seen from: across the axes after `axis`, along this or
/// against it.
fn outermost<K: Kernel>(axis: usize, against: bool, sampled: bool) -> Draft<K> {
    let mut draft = Draft::<K>::read(sample::<K>(false).bytes()).expect("a good blob");
    let whole = whole(&draft);
    let header = &mut draft.header;
    header.size = [9, 7];
    header.samples = if sampled { 5 } else { 1 };
    header.needs = header.needs.with(Need::Orthographic, true).with(Need::Supersampling, sampled);
    // The most that the kernel's word holds; see docs/BLOB.md.
    let fraction_bits = if size_of::<K::Word>() == 4 { 14 } else { 60 - K::GRID_BITS };
    let (right, down) = ((axis + 1) % 3, (axis + 2) % 3);
    let near = [0, 1, 2].map(|a| whole.high[a] - K::SPAN);
    let far = [0, 1, 2].map(|a| whole.low[a] + K::SPAN);
    let camera = &mut header.camera;
    camera.fraction_bits = fraction_bits as u8;
    camera.eye = near;
    camera.eye[axis] = if against { far[axis] } else { near[axis] };
    camera.along = [0; 3];
    camera.along[axis] = ((1i64 << K::DIRECTION_BITS) - 1) as i32 * if against { -1 } else { 1 };
    (camera.first, camera.right, camera.down) = ([0; 3], [0; 3], [0; 3]);
    let across = |a: usize| (i64::from(far[a]) - i64::from(near[a])) << fraction_bits;
    if sampled {
        // Two units of the coefficients are left on either side, and the middles are half a pixel from the edge.
        (camera.right[right], camera.down[down]) = ((across(right) - 4) / 9, (across(down) - 4) / 7);
        camera.first[right] = camera.right[right] / 2 + 2;
        camera.first[down] = camera.down[down] / 2 + 2;
    } else {
        (camera.right[right], camera.down[down]) = (across(right) / 8, across(down) / 6);
    }
    draft
}

fn planes_at_the_ends<K: Kernel>() {
    for sampled in [false, true] {
        for axis in 0..3 {
            for against in [false, true] {
                let draft = outermost::<K>(axis, against, sampled);
                let blob = draft.write();
                let scene = Scene::<Full<K>>::new_checked(blob.bytes());
                corners(&scene.unwrap_or_else(|error| panic!("{sampled} {axis} {against}: {error}")));
                // A unit more, on either side of each axis.
                for (a, step) in [0, 1, 2].into_iter().flat_map(|a| [(a, 1), (a, -1)]) {
                    let mut other = draft.clone();
                    other.header.camera.eye[a] += step;
                    let found = verdict::<K>(other.write().bytes());
                    let is_flat = a == axis;
                    // In a plane across the axis there is room on the one side of it.
                    let fits = is_flat && (step < 0) == against;
                    // What is rounded may leave a unit.
                    let expected = if fits { Ok(()) } else { Err(BlobError::Origin) };
                    assert!(found == expected || (!is_flat && found.is_ok() && step > 0), "{a} {step}: {found:?}");
                }
            }
        }
    }
}

fn parallel_rays<K: Kernel>() {
    let refused = |damage: &dyn Fn(&mut Draft<K>), expected| {
        let mut draft = outermost::<K>(2, false, false);
        damage(&mut draft);
        assert_eq!(verdict::<K>(draft.write().bytes()), Err(expected));
    };
    refused(&|d| d.header.camera.along[0] = i32::MIN, BlobError::Header);
    refused(&|d| d.header.camera.fraction_bits += 1, BlobError::Header);
    refused(&|d| d.header.camera.fraction_bits = 255, BlobError::Header);
    refused(&|d| d.header.camera.right = [i64::MAX; 3], BlobError::Header);
    refused(&|d| d.header.camera.first[1] = i64::MIN, BlobError::Header);
    refused(&|d| d.header.camera.eye = [i32::MAX; 3], BlobError::Origin);
    refused(&|d| d.header.camera.eye[1] = i32::MIN, BlobError::Origin);
    refused(&|d| d.header.camera.first[2] = -1 << d.header.camera.fraction_bits, BlobError::Origin);
    refused(&|d| d.header.needs = core_rt::profile::Needs::from_bits(d.header.needs.bits() & !(1 << 19)), {
        BlobError::Header
    });
    // A direction of zero sees the background, as in perspective.
    let mut draft = outermost::<K>(2, false, false);
    draft.header.camera.along = [0; 3];
    assert_eq!(verdict::<K>(draft.write().bytes()), Ok(()));
}
