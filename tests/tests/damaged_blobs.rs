//! Blobs that were cut, flipped, added to or made up: each is refused by name, or it is a scene that renders.
//!
//! Overflow checks are on in the profile that tests run under: where an accepted scene makes the core compute beyond
//! its ranges, the test fails.

use core_rt::blob::{BlobError, Header, PREFIX_SIZE};
use core_rt::bvh::Child;
use core_rt::exact::{Exact14, Exact29};
use core_rt::kernel::Kernel;
use core_rt::profile::{Full, Need, Needs, Profile};
use core_rt::record::Light;
use core_rt::scene::{MAX_DEPTH, Scene};
use core_rt::space::Space;
use host_tools::prepare::Blob;
use tests::blobs::{Draft, corners, repaired, sample};
use zerocopy::{FromZeros, IntoBytes};

/// Makes a test of a function that is generic over the kernel, for each of them.
macro_rules! for_every_kernel {
    ($($name:ident),* $(,)?) => {
        mod exact14 { $(#[test] fn $name() { super::$name::<super::Exact14>(); })* }
        mod exact29 { $(#[test] fn $name() { super::$name::<super::Exact29>(); })* }
    };
}

for_every_kernel! {
    samples_are_good,
    cut_anywhere,
    every_byte_flipped,
    every_byte_flipped_and_signed_again,
    followed_by_something,
    misaligned,
    broken_trees,
    broken_triangles,
    broken_shading,
    broken_headers,
    broken_counts,
    broken_padding,
    undeclared_needs,
    the_deepest_tree,
}

/// What is said of a blob; of an accepted one, after it has rendered.
fn verdict<K: Kernel>(bytes: &[u8]) -> Result<(), BlobError> {
    let scene = Scene::<Full<K>>::new_checked(bytes)?;
    corners(&scene);
    Ok(())
}

fn samples<K: Kernel>() -> [Blob; 2] {
    [sample::<K>(false), sample::<K>(true)]
}

/// Asserts what is said of the sample with each of some changes made to it.
fn refused<K: Kernel>(smooth: bool, cases: &[(&str, fn(&mut Draft<K>), BlobError)]) {
    let good = sample::<K>(smooth);
    for (name, damage, expected) in cases {
        let mut draft = Draft::read(good.bytes()).expect("a good blob");
        damage(&mut draft);
        assert_eq!(verdict::<K>(draft.write().bytes()), Err(*expected), "{name}");
    }
}

fn samples_are_good<K: Kernel>() {
    for blob in samples::<K>() {
        assert_eq!(verdict::<K>(blob.bytes()), Ok(()));
        let draft = Draft::<K>::read(blob.bytes()).expect("a good blob");
        assert_eq!(draft.write(), blob, "taken apart and put together");
        assert_eq!((draft.nodes.len(), draft.triangles.len(), draft.lights.len()), (4, 5, 2));
    }
}

fn cut_anywhere<K: Kernel>() {
    for blob in samples::<K>() {
        let whole = blob.bytes();
        for length in 0..whole.len() {
            let expected = if length < PREFIX_SIZE { 32 } else { whole.len() as u64 };
            let cut = Blob::from_bytes(&whole[..length]);
            assert_eq!(verdict::<K>(cut.bytes()), Err(BlobError::Truncated { expected, found: length as u64 }));
            let signed = repaired(&whole[..length], K::ID);
            let said = verdict::<K>(signed.bytes());
            assert!(matches!(said, Err(BlobError::Header | BlobError::Sections)), "{length}: {said:?}");
        }
    }
}

/// The bytes with one of them changed, in the nine ways that are tried.
fn flips(bytes: &[u8]) -> impl Iterator<Item = (usize, Vec<u8>)> {
    let masks = (0..8).map(|bit| 1 << bit).chain([0xff]);
    (0..bytes.len()).flat_map(move |place| {
        masks.clone().map(move |mask: u8| {
            let mut flipped = bytes.to_vec();
            flipped[place] ^= mask;
            (place, flipped)
        })
    })
}

fn every_byte_flipped<K: Kernel>() {
    for blob in samples::<K>() {
        for (place, flipped) in flips(blob.bytes()) {
            let said = verdict::<K>(Blob::from_bytes(&flipped).bytes());
            let as_expected = match (place, said) {
                (0..8, said) => said == Err(BlobError::Foreign),
                (8..10, Err(BlobError::Version { .. })) => true,
                (10..12, Err(BlobError::Kernel { expected, .. })) => expected == K::ID,
                (16..20, Err(BlobError::Truncated { .. } | BlobError::Oversized { .. })) => true,
                (12..16 | 20.., Err(BlobError::Checksum { stated, computed })) => stated != computed,
                _ => false,
            };
            assert!(as_expected, "byte {place}: {said:?}");
        }
    }
}

fn every_byte_flipped_and_signed_again<K: Kernel>() {
    for blob in samples::<K>() {
        let mut accepted = 0;
        for (_, flipped) in flips(blob.bytes()) {
            accepted += u32::from(verdict::<K>(repaired(&flipped, K::ID).bytes()).is_ok());
        }
        // A colour may be any, and what was repaired is as it was; geometry may be hardly anything else.
        assert!((100..4_000).contains(&accepted), "{accepted} were accepted");
    }
}

fn followed_by_something<K: Kernel>() {
    for blob in samples::<K>() {
        for more in 1..=16 {
            let longer = [blob.bytes(), &vec![0; more]].concat();
            let (expected, found) = (blob.bytes().len() as u64, longer.len() as u64);
            let said = verdict::<K>(Blob::from_bytes(&longer).bytes());
            assert_eq!(said, Err(BlobError::Oversized { expected, found }));
            // The old checksum is then in a section's place, or in the trailer's.
            let said = verdict::<K>(repaired(&longer, K::ID).bytes());
            assert!(matches!(said, Err(BlobError::Header | BlobError::Sections)), "{more}: {said:?}");
        }
    }
}

fn misaligned<K: Kernel>() {
    let blob = sample::<K>(false);
    for offset in 1..8 {
        let moved = Blob::from_bytes(&[&vec![0; offset], blob.bytes()].concat());
        assert_eq!(verdict::<K>(&moved.bytes()[offset..]), Err(BlobError::Misaligned));
    }
}

/// Changes the children of a node.
fn set_children<K: Kernel>(draft: &mut Draft<K>, node: usize, change: impl FnOnce(&mut [u32; 2])) {
    let mut children = K::children(&draft.nodes[node]);
    change(&mut children);
    draft.nodes[node] = K::node(K::boxes(&draft.nodes[node]), children);
}

/// Adds to the high corner of a child's box, along x.
fn grow<K: Kernel>(draft: &mut Draft<K>, node: usize, child: usize, by: i32) {
    let mut boxes = K::boxes(&draft.nodes[node]);
    boxes[child].high[0] += by;
    draft.nodes[node] = K::node(boxes, K::children(&draft.nodes[node]));
}

/// A node under the root, and which child of the root it is.
fn second_node<K: Kernel>(draft: &Draft<K>) -> usize {
    let children = K::children(&draft.nodes[0]).map(Child::unpack);
    children.iter().position(|child| *child == Child::Node(1)).expect("five leaves take two levels")
}

fn broken_trees<K: Kernel>() {
    let past_the_end = Child::Leaf { first: 4, count: 2 };
    assert_eq!(past_the_end.pack() >> 31, 1);
    refused::<K>(
        false,
        &[
            (
                "a box that is larger than the one that holds it",
                |d| {
                    let held = second_node(d);
                    let limit = K::boxes(&d.nodes[0])[held].high[0];
                    let by = limit + 1 - K::boxes(&d.nodes[1])[0].high[0];
                    grow(d, 1, 0, by);
                },
                BlobError::Bounds { node: 1 },
            ),
            (
                "a root's box beyond the grid",
                |d| {
                    let by = (1 << K::GRID_BITS) - K::boxes(&d.nodes[0])[0].high[0];
                    grow(d, 0, 0, by);
                },
                BlobError::Bounds { node: 0 },
            ),
            (
                "a box that leaves out what it holds",
                |d| {
                    let node = d.nodes.len() - 1;
                    grow(d, node, 1, -1);
                },
                BlobError::Bounds { node: 3 },
            ),
            ("a cycle", |d| set_children(d, 0, |c| c[0] = Child::Node(0).pack()), BlobError::Tree { node: 0 }),
            ("a shared child", |d| set_children(d, 0, |c| c[1] = c[0]), BlobError::Tree { node: 0 }),
            ("swapped children", |d| set_children(d, 3, |c| c.swap(0, 1)), BlobError::Tree { node: 3 }),
            (
                "a node that does not exist",
                |d| set_children(d, 0, |c| c[0] = u32::MAX >> 1),
                BlobError::Tree { node: 0 },
            ),
            (
                "a leaf beyond the last triangle",
                |d| set_children(d, 3, |c| c[1] = Child::Leaf { first: 4, count: 2 }.pack()),
                BlobError::Tree { node: 3 },
            ),
            ("the largest word for a leaf", |d| set_children(d, 3, |c| c[1] = u32::MAX), BlobError::Tree { node: 3 }),
            ("the largest word for a root", |d| d.header.root = u32::MAX, BlobError::Tree { node: 0 }),
            (
                "nodes that nothing leads to",
                |d| d.header.root = Child::Leaf { first: 0, count: 5 }.pack(),
                BlobError::Tree { node: 0 },
            ),
            (
                "triangles in no leaf",
                |d| {
                    d.header.root = Child::Leaf { first: 0, count: 4 }.pack();
                    (d.nodes, d.header.counts.nodes) = (Vec::new(), 0);
                },
                BlobError::Tree { node: 0 },
            ),
            ("an understated depth", |d| d.header.depth -= 1, BlobError::Depth { stated: 2 }),
            ("no depth", |d| d.header.depth = 0, BlobError::Depth { stated: 0 }),
            ("a depth beyond all stacks", |d| d.header.depth = MAX_DEPTH as u8 + 1, BlobError::Header),
        ],
    );
}

fn broken_triangles<K: Kernel>() {
    let third = BlobError::Triangle { index: 2 };
    refused::<K>(
        true,
        &[
            (
                "a material that does not exist",
                |d| d.triangles[2] = K::triangle(&K::vertices(&d.triangles[2]), 2).expect("it can be packed"),
                third,
            ),
            ("no materials", |d| (d.materials, d.header.counts.materials) = (Vec::new(), 0), BlobError::Triangle {
                index: 0,
            }),
            (
                "a normal that is not that of its corners",
                |d| {
                    // v0, e1, e2, n and meta are thirteen numbers of one width; this is n's first.
                    let width = size_of::<K::Triangle>() / 13;
                    d.triangles[2].as_mut_bytes()[9 * width] ^= 1;
                },
                third,
            ),
            ("a normal beyond the last", |d| d.normal_indices[3 * 2 + 1] = d.header.counts.normals, third),
            ("one corner of three without a normal", |d| d.normal_indices[3 * 2] = u32::from(u16::MAX), third),
            ("an id that is not in the file", |d| d.ids[2] = d.header.file_triangles, third),
            ("a file without triangles", |d| d.header.file_triangles = 0, BlobError::Triangle { index: 0 }),
        ],
    );
    // Zeros have no area and lie in a corner of the grid, which some box must be made to hold.
    let mut draft = Draft::<K>::read(sample::<K>(false).bytes()).expect("a good blob");
    draft.triangles[2] = K::Triangle::new_zeroed();
    let said = verdict::<K>(draft.write().bytes());
    assert!(matches!(said, Err(BlobError::Bounds { .. } | BlobError::Triangle { index: 2 })), "{said:?}");
}

/// The place in the sample of the light of a kind.
fn light<K: Kernel>(draft: &mut Draft<K>, kind: u32) -> &mut Light {
    draft.lights.iter_mut().find(|light| light.kind == kind).expect("one of each")
}

fn broken_shading<K: Kernel>() {
    refused::<K>(
        true,
        &[
            ("a background too bright", |d| d.header.background.exponent = 16, BlobError::Shading),
            ("ambient light too dim", |d| d.header.ambient.exponent = -16, BlobError::Shading),
            ("an emission out of range", |d| d.materials[1].emission.exponent = i16::MAX, BlobError::Shading),
            ("a light out of range", |d| d.lights[0].radiance.exponent = i16::MIN, BlobError::Shading),
            ("a material from the future", |d| d.materials[0].reserved = 1, BlobError::Shading),
            ("a kind of light from the future", |d| d.lights[1].kind = 2, BlobError::Shading),
            ("a direction of length zero", |d| light(d, Light::DIRECTIONAL).place = [0; 3], BlobError::Shading),
            ("a direction too long", |d| light(d, Light::DIRECTIONAL).place = [i32::MIN; 3], BlobError::Shading),
            ("a direction of length 1.01", |d| light(d, Light::DIRECTIONAL).place = [0, 1_084_479_242, 0], {
                BlobError::Shading
            }),
            ("a light where no ray starts", |d| light(d, Light::POINT).place[2] = K::ORIGINS.end, BlobError::Shading),
            ("a light below all", |d| light(d, Light::POINT).place[0] = i32::MIN, BlobError::Shading),
            ("a normal of length zero", |d| d.normals[1] = K::Space::normal([0; 3]), BlobError::Shading),
            ("a normal of length 2", |d| d.normals[0] = K::Space::normal([0, i32::MAX, 0]), BlobError::Shading),
        ],
    );
}

fn broken_headers<K: Kernel>() {
    refused::<K>(
        false,
        &[
            ("an eye where no ray starts", |d| d.header.camera.eye[1] = K::ORIGINS.end, BlobError::Header),
            ("an eye below all", |d| d.header.camera.eye[0] = K::ORIGINS.start - 1, BlobError::Header),
            ("a picture of no width", |d| d.header.size[0] = 0, BlobError::Header),
            ("a picture of no height", |d| d.header.size[1] = 0, BlobError::Header),
            ("a picture as wide as can be", |d| d.header.size[0] = u16::MAX, BlobError::Header),
            ("fractional bits beyond any word", |d| d.header.camera.fraction_bits = 255, BlobError::Header),
            ("more fractional bits than fit", |d| d.header.camera.fraction_bits = 31, BlobError::Header),
            ("fewer fractional bits than there are", |d| d.header.camera.fraction_bits -= 1, BlobError::Header),
            ("a need from the future", |d| d.header.needs = Needs::from_bits(1 << 31), BlobError::Header),
        ],
    );
    let good = Draft::<K>::read(sample::<K>(false).bytes()).expect("a good blob");
    for extreme in [i64::MIN, i64::MIN + 1, i64::MAX] {
        for axis in 0..3 {
            for coefficients in [
                |header: &mut Header| &mut header.camera.first,
                |header: &mut Header| &mut header.camera.right,
                |header: &mut Header| &mut header.camera.down,
            ] {
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
        &[
            ("no normals where some are needed", |d| d.header.needs = without(d, Need::SmoothNormals), {
                BlobError::Sections
            }),
            ("ids of another width", |d| d.header.needs = d.header.needs.with(Need::WideIds, true), {
                // Both widths are written as the header has them; so is the number of bytes that it takes.
                BlobError::Triangle { index: 0 }
            }),
        ],
    );
}

fn broken_padding<K: Kernel>() {
    let blob = sample::<K>(true);
    let good = blob.bytes();
    let header_size = u32::from_le_bytes([good[12], good[13], good[14], good[15]]) as usize;
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
    Needs::from_bits(draft.header.needs.bits() & !(need as u32))
}

/// A profile that has everything but directional lights.
#[derive(Clone, Copy, Debug, Default)]
struct Smaller<K>(core::marker::PhantomData<K>);

impl<K: Kernel> Profile for Smaller<K> {
    type Kernel = K;
    const NEEDS: Needs = Needs::from_bits(Needs::ALL.bits() & !(Need::DirectionalLight as u32));
}

fn undeclared_needs<K: Kernel>() {
    let blob = sample::<K>(false);
    let good = Draft::<K>::read(blob.bytes()).expect("a good blob");
    for need in [
        Need::PointLight,
        Need::DirectionalLight,
        Need::Shadows,
        Need::Emission,
        Need::Ambient,
        Need::Srgb,
    ] {
        let mut draft = good.clone();
        draft.header.needs = without(&draft, need);
        assert_eq!(verdict::<K>(draft.write().bytes()), Err(BlobError::Undeclared(need)));
    }
    let refused = Scene::<Smaller<K>>::new_checked(blob.bytes()).map(|_| ());
    assert_eq!(refused, Err(BlobError::Missing(Need::DirectionalLight)));
}

/// As many levels as there may be: what waits on the stack at the lowest is all that it holds.
fn the_deepest_tree<K: Kernel>() {
    let mut shallow = Draft::<K>::read(sample::<K>(false).bytes()).expect("a good blob");
    let count = MAX_DEPTH + 1;
    // Sixty-four that look another way than the one that is seen, which the last leaf to be visited has.
    let boxes = [K::boxes(&shallow.nodes[0])[0], K::boxes(&shallow.nodes[0])[1]];
    let whole = core_rt::kernel::Bounds {
        low: [0, 1, 2].map(|axis| boxes[0].low[axis].min(boxes[1].low[axis])),
        high: [0, 1, 2].map(|axis| boxes[0].high[axis].max(boxes[1].high[axis])),
    };
    let triangles = shallow.triangles.clone();
    shallow.triangles = (0..count).map(|i| triangles[if i + 1 == count { 0 } else { 1 + i % 4 }]).collect();
    shallow.ids = (0..count as u32).collect();
    shallow.header.counts.triangles = count as u32;
    shallow.header.file_triangles = count as u32;
    shallow.nodes = vec![K::node([whole; 2], [0, 1].map(|half| Child::Leaf { first: 64 * half, count: 64 - 63 * half }.pack()))];
    shallow.header.counts.nodes = 1;
    (shallow.header.root, shallow.header.depth) = (Child::Node(0).pack(), 1);

    let mut deep = shallow.clone();
    let chain = |levels: u32| {
        (0..levels).map(move |node| {
            let last = node + 1 == levels;
            let below = if last { Child::Leaf { first: 0, count: 1 } } else { Child::Node(node + 1) };
            K::node([whole; 2], [below.pack(), Child::Leaf { first: levels - node, count: 1 }.pack()])
        })
    };
    deep.nodes = chain(MAX_DEPTH as u32).collect();
    deep.header.counts.nodes = MAX_DEPTH as u32;
    deep.header.depth = MAX_DEPTH as u8;

    let picture = |draft: &Draft<K>| corners(&Scene::<Full<K>>::new_checked(draft.write().bytes()).expect("a good blob"));
    assert_eq!(picture(&deep), picture(&shallow));

    deep.nodes = chain(MAX_DEPTH as u32 + 1).collect();
    deep.header.counts.nodes += 1;
    let (triangle, id) = (deep.triangles[0], deep.ids[0]);
    deep.triangles.push(triangle);
    deep.ids.push(id);
    deep.header.counts.triangles += 1;
    assert_eq!(verdict::<K>(deep.write().bytes()), Err(BlobError::Depth { stated: MAX_DEPTH as u8 }));
}
