//! The ends of every range that a blob may reach: what is accepted there must render without an overflow.

use core_rt::blob::BlobError;
use core_rt::bvh::Child;
use core_rt::colour::Radiance;
use core_rt::kernel::{Bounds, Kernel, Vertices};
use core_rt::profile::{Full, Need};
use core_rt::record::{Checker, Light, Lustre, Reach};
use core_rt::scene::Scene;
use tests::blobs::{Draft, corners, sample};

use crate::{for_every_kernel, verdict};

for_every_kernel!(at_the_ends_of_all_ranges, just_beyond_them);

/// One of the eight combinations of a low and a high value.
fn corner(index: u32, low: i32, high: i32) -> [i32; 3] {
    [0, 1, 2].map(|axis| if index >> axis & 1 == 0 { low } else { high })
}

/// Where vertices may be, and where the eye and lights may be if vertices are everywhere.
fn ranges<K: Kernel>() -> ([i32; 2], [i32; 2]) {
    let (low, high) = (K::MARGIN, (1 << K::GRID_BITS) - 1 - K::MARGIN);
    ([low, high], [high - K::SPAN, low + K::SPAN])
}

/// Every triangle between corners of the grid; lights at all corners of what they may reach and along all axes; all of it
/// as bright as can be.
fn largest<K: Kernel>(smooth: bool) -> Draft<K> {
    let ([low, high], [near, far]) = ranges::<K>();
    let mut draft = Draft::<K>::read(sample::<K>(smooth).bytes()).expect("a good blob");
    let brightest = Radiance { mantissa: [u16::MAX; 3], exponent: *Radiance::EXPONENTS.end() };
    (draft.header.ambient, draft.header.background) = (brightest, [brightest; 2]);
    for material in &mut draft.materials {
        (material.albedo, material.emission) = ([u16::MAX; 3], brightest);
    }
    let points = (0..8).map(|index| (Light::POINT, corner(index, near, far)));
    let directions = (0..6).map(|index| {
        let mut direction = [0; 3];
        direction[index / 2] = if index.is_multiple_of(2) { 1 << 30 } else { -(1 << 30) };
        (Light::DIRECTIONAL, direction)
    });
    let light = |(kind, place)| Light { kind, place, radiance: brightest, reach: Reach::default() };
    draft.lights = points.chain(directions).map(light).collect();
    let all = (0..8).flat_map(|a| (a + 1..8).flat_map(move |b| (b + 1..8).map(move |c| [a, b, c])));
    let vertices = all.map(|triple| -> Vertices { triple.map(|index| corner(index, low, high)) });
    draft.triangles = vertices.map(|triangle| draft.triangle(&triangle, 1).expect("it has an area")).collect();
    let count = draft.triangles.len() as u32;
    draft.ids = (0..count).collect();
    draft.normal_indices =
        if smooth { (0..3 * count).map(|i| i % draft.header.counts.normals).collect() } else { vec![] };
    let whole = Bounds { low: [low; 3], high: [high; 3] };
    let halves = [0, count / 2].map(|first| Child::Leaf { first, count: count / 2 }.pack());
    draft.nodes = vec![K::node([whole; 2], halves)];
    let header = &mut draft.header;
    (header.root, header.depth, header.file_triangles) = (Child::Node(0).pack(), 1, count);
    header.counts.nodes = 1;
    header.counts.triangles = count;
    header.counts.smooth = if smooth { count } else { 0 };
    header.counts.lights = draft.lights.len() as u32;
    draft
}

/// Laws of shading at the ends of what they may say: glass both ways, metal, highlights.
fn lustres() -> [Lustre; 4] {
    let all = [u16::MAX; 3];
    let glass = |eta_q28, exponent_q2, flags| Lustre {
        eta_q28,
        specular: all,
        reflected: all,
        mirrored: all,
        refracted: all,
        shadow: all,
        exponent_q2,
        gain: 15,
        flags,
        r0: u16::MAX,
        roughness: u16::MAX,
    };
    let both = Lustre::FRESNEL | Lustre::METAL;
    [
        glass([1, u32::MAX], 0, 0),
        glass([u32::MAX, 1], u16::MAX, Lustre::PHONG),
        glass([1 << 28; 2], 4, both),
        glass([u32::MAX; 2], 4, both | Lustre::PHONG),
    ]
}

/// Gives all surfaces a law, cubes as large and as small as there are, and all lights a reach.
fn glossy<K: Kernel>(draft: &mut Draft<K>, choice: usize) {
    let needs = [
        Need::BlinnPhong,
        Need::Phong,
        Need::Reflection,
        Need::Refraction,
        Need::Schlick,
        Need::TintedShadow,
        Need::Checker,
        Need::Falloff,
        Need::Sky,
        Need::Bounces,
        Need::Roughness,
    ];
    draft.header.needs = needs.into_iter().fold(draft.header.needs, |needs, need| needs.with(need, true));
    draft.header.max_depth = 2;
    draft.lustres = vec![lustres()[choice % 4]];
    let ends = [0, u64::MAX];
    draft.checkers = vec![Checker {
        step_q63: ends[choice % 2],
        start_q63: [ends[choice / 2 % 2]; 3],
        other: [u16::MAX; 3],
        reserved: 0,
    }];
    (draft.header.counts.lustres, draft.header.counts.checkers) = (1, 1);
    (draft.materials[1].lustre, draft.materials[1].checker) = (1, 1);
    let reaches = [(u16::MAX, 256), (1 << 15, -256), (1 << 15, 0)];
    for (light, (mantissa, exponent)) in draft.lights.iter_mut().zip(reaches.into_iter().cycle()) {
        light.reach = Reach { mantissa, exponent };
    }
}

/// Brings the largest directions that there are into a picture of 9x7 pixels: the view's axis is one of six.
fn look<K: Kernel>(draft: &mut Draft<K>, view: usize) {
    // The most that the kernel's word holds; see docs/BLOB.md.
    let fraction_bits = if size_of::<K::Word>() == 4 { 17 } else { 61 - K::DIRECTION_BITS };
    let largest = (1i64 << (K::DIRECTION_BITS + fraction_bits)) - (1 << (fraction_bits - 1)) - 1;
    let (ahead, right, down) = (view / 2, (view / 2 + 1) % 3, (view / 2 + 2) % 3);
    let camera = &mut draft.header.camera;
    camera.fraction_bits = fraction_bits as u8;
    (camera.first, camera.right, camera.down) = ([-largest; 3], [0; 3], [0; 3]);
    camera.first[ahead] = if view.is_multiple_of(2) { largest } else { -largest };
    (camera.right[right], camera.down[down]) = (largest / 4, largest / 3);
    draft.header.size = [9, 7];
}

fn at_the_ends_of_all_ranges<K: Kernel>() {
    let (_, [near, far]) = ranges::<K>();
    let mut lit = 0;
    for smooth in [false, true] {
        let mut draft = largest::<K>(smooth);
        for eye in 0..8 {
            for view in 0..6 {
                glossy(&mut draft, eye as usize + view);
                draft.header.camera.eye = corner(eye, near, far);
                look(&mut draft, view);
                let blob = draft.write();
                let scene = Scene::<Full<K>>::new_checked(blob.bytes()).expect("all is in range");
                lit += corners(&scene).iter().filter(|pixel| **pixel == [255; 3]).count();
            }
        }
    }
    assert_eq!(lit, 2 * 8 * 6 * 2 * 8 * 7, "nothing is darker than the background");
}

fn just_beyond_them<K: Kernel>() {
    let ([low, high], [near, far]) = ranges::<K>();
    let refused = |change: &dyn Fn(&mut Draft<K>), expected| {
        let mut draft = largest::<K>(false);
        look(&mut draft, 0);
        draft.header.camera.eye = [near; 3];
        assert_eq!(verdict::<K>(draft.write().bytes()), Ok(()));
        change(&mut draft);
        assert_eq!(verdict::<K>(draft.write().bytes()), Err(expected));
    };
    refused(&|draft| draft.header.camera.eye[0] = near - 1, BlobError::Origin);
    refused(&|draft| draft.header.camera.eye[1] = far + 1, BlobError::Origin);
    refused(&|draft| draft.lights[0].place[2] = near - 1, BlobError::Origin);
    refused(&|draft| draft.lights[7].place[0] = far + 1, BlobError::Origin);
    refused(&|draft| draft.header.camera.first[0] += 2, BlobError::Header);
    refused(&|draft| draft.header.camera.fraction_bits += 1, BlobError::Header);
    let bounds = |low, high| Bounds { low: [low; 3], high: [high; 3] };
    for boxes in [[bounds(low - 1, high), bounds(low, high)], [bounds(low, high), bounds(low, high + 1)]] {
        let node = move |draft: &mut Draft<K>| draft.nodes[0] = K::node(boxes, K::children(&draft.nodes[0]));
        refused(&node, BlobError::Bounds { node: 0 });
    }
}
