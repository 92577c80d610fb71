//! Spheres that no scene has, and those at the ends of what the kernels hold.

use core_rt::blob::BlobError;
use core_rt::bvh::{Child, InPlace};
use core_rt::kernel::{Bounds, Kernel};
use core_rt::profile::{Full, Need, Needs, Profile};
use core_rt::record::Light;
use core_rt::scene::Scene;
use core_rt::sphere::Ball;
use tests::blobs::{Draft, corners, sample_with_spheres};
use zerocopy::FromZeros;

use crate::{for_every_kernel, refused_of, verdict};

for_every_kernel!(broken_spheres, a_profile_without_them, at_the_ends_of_all_ranges);

/// Makes a sphere of another centre, radius or material, as far as its record holds it.
fn change<K: Kernel>(draft: &mut Draft<K>, place: usize, change: impl FnOnce(&mut Ball, &mut u32)) {
    let record = draft.spheres[place];
    let (mut ball, mut material) = (K::ball(&record), K::sphere_material(&record));
    change(&mut ball, &mut material);
    draft.spheres[place] = K::sphere(&ball, material).expect("the kernel holds it");
}

/// The place of a small sphere, and of the large one.
fn places<K: Kernel>(draft: &Draft<K>) -> [usize; 2] {
    let radii: Vec<i32> = draft.spheres.iter().map(|sphere| K::ball(sphere).radius).collect();
    let large = radii.iter().position(|radius| radius == radii.iter().max().expect("three")).expect("three");
    [(large + 1) % 3, large]
}

/// Changes the children of the node that holds the last leaf.
fn last_leaf<K: Kernel>(draft: &mut Draft<K>, leaf: Child) {
    let last = draft.nodes.len() - 1;
    let [first, _] = K::children(&draft.nodes[last]);
    draft.nodes[last] = K::node(K::boxes(&draft.nodes[last]), [first, leaf.pack()]);
}

fn broken_spheres<K: Kernel>() {
    let good = sample_with_spheres::<K>();
    assert_eq!(verdict::<K>(good.bytes()), Ok(()));
    let draft = Draft::<K>::read(good.bytes()).expect("a good blob");
    assert_eq!(draft.write(), good, "taken apart and put together");
    assert_eq!((draft.triangles.len(), draft.spheres.len(), draft.ids.len()), (5, 3, 8));
    let first = BlobError::Sphere { index: 0 };
    refused_of::<K>(
        &good,
        &[
            ("a material that does not exist", |d| change(d, 0, |_, material| *material = 2), first),
            ("an id that is a triangle's", |d| d.ids[5] = d.header.file_triangles - 1, first),
            ("an id that is not in the file", |d| d.ids[5] = d.header.file_triangles + d.header.file_spheres, first),
            ("a file without spheres", |d| d.header.file_spheres = 0, first),
            ("a triangle with a sphere's id", |d| d.ids[2] = d.header.file_triangles, BlobError::Triangle { index: 2 }),
            ("spheres that are not declared", |d| d.header.needs = without(d.header.needs), BlobError::Sections),
            ("a sphere less", |d| d.header.counts.spheres -= 1, BlobError::Sections),
            ("spheres to the end of all numbers", |d| d.header.counts.spheres = u32::MAX, BlobError::Sections),
            (
                "spheres that are declared and not there",
                |d| {
                    (d.spheres, d.header.counts.spheres) = (Vec::new(), 0);
                    d.ids.truncate(5);
                },
                BlobError::Sections,
            ),
            (
                "a sphere of no leaf",
                |d| {
                    d.spheres.push(d.spheres[2]);
                    d.ids.push(d.ids[7]);
                    d.header.counts.spheres += 1;
                },
                BlobError::Tree { node: draft_nodes() },
            ),
        ],
    );
    // What the tree says before a record is looked at depends on where a sphere is.
    let said = |damage: &dyn Fn(&mut Draft<K>, [usize; 2])| {
        let mut draft = draft.clone();
        let places = places(&draft);
        damage(&mut draft, places);
        verdict::<K>(draft.write().bytes())
    };
    let is_bounds = |said| matches!(said, Err(BlobError::Bounds { .. }));
    assert!(is_bounds(said(&|d, [small, _]| change(d, small, |ball, _| ball.radius += 1))), "larger than its box");
    assert!(is_bounds(said(&|d, [small, _]| change(d, small, |ball, _| ball.centre[1] -= 1))), "beside its box");
    assert!(is_bounds(said(&|d, [_, large]| d.spheres[large] = K::Sphere::new_zeroed())), "off the grid");
    let is_tree = |said| matches!(said, Err(BlobError::Tree { .. }));
    for leaf in [
        Child::Leaf { first: 4, count: 2 },
        Child::Leaf { first: 5, count: 4 },
        Child::Leaf { first: 7, count: 2 },
        Child::Leaf { first: Child::INDEX_END - 1, count: 64 },
    ] {
        assert!(is_tree(said(&|d, _| last_leaf(d, leaf))), "{leaf:?}");
    }
    // Smaller than any kernel holds, in a box that holds it.
    let mut draft = draft.clone();
    let [small, _] = places(&draft);
    draft.spheres[small] = K::Sphere::new_zeroed();
    let (low, high) = (K::MARGIN, (1 << K::GRID_BITS) - 1 - K::MARGIN);
    let whole = Bounds { low: [low; 3], high: [high; 3] };
    draft.nodes = draft.nodes.iter().map(|node| K::node([whole; 2], K::children(node))).collect();
    assert!(is_bounds(verdict::<K>(draft.write().bytes())), "zeros are off the grid");
}

/// The nodes of the sample: eight leaves of one primitive each.
const fn draft_nodes() -> u32 {
    7
}

fn without(needs: Needs) -> Needs {
    Needs::from_bits(needs.bits() & !(Need::Spheres as u64))
}

/// A profile that has everything but spheres.
#[derive(Clone, Copy, Debug, Default)]
struct Flat<K>(core::marker::PhantomData<K>);

impl<K: Kernel> Profile for Flat<K> {
    type Kernel = K;
    type Walk<'a> = InPlace;
    const NEEDS: Needs = Needs::from_bits(Needs::ALL.bits() & !(Need::Spheres as u64));
}

fn a_profile_without_them<K: Kernel>() {
    let blob = sample_with_spheres::<K>();
    let said = |bytes: &[u8]| Scene::<Flat<K>>::new_checked(bytes).map(|_| ());
    assert_eq!(said(blob.bytes()), Err(BlobError::Missing(Need::Spheres)));
    let mut draft = Draft::<K>::read(blob.bytes()).expect("a good blob");
    draft.header.needs = without(draft.header.needs);
    assert_eq!(said(draft.write().bytes()), Err(BlobError::Sections));
}

/// The largest sphere and the smallest ones in all corners, seen and lit from wherever eye and lights may be.
fn at_the_ends_of_all_ranges<K: Kernel>() {
    let (low, high) = (K::MARGIN, (1 << K::GRID_BITS) - 1 - K::MARGIN);
    let (near, far) = (high - K::SPAN, low + K::SPAN);
    let corner = |i: i32, low: i32, high: i32| [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { low } else { high });
    let (least, most) = (K::RADIUS_MIN, (high - low) / 2);
    let largest = (0..8).map(|i| Ball { centre: corner(i, low + most, high - most), radius: most });
    let smallest = (0..8).map(|i| Ball { centre: corner(i, low + least, high - least), radius: least });
    let mut draft = Draft::<K>::read(sample_with_spheres::<K>().bytes()).expect("a good blob");
    draft.spheres = largest.chain(smallest).map(|ball| K::sphere(&ball, 0).expect("it is held")).collect();
    (draft.triangles, draft.normal_indices, draft.normals) = (Vec::new(), Vec::new(), Vec::new());
    draft.ids = (0..16).collect();
    let whole = Bounds { low: [low; 3], high: [high; 3] };
    draft.nodes = vec![K::node([whole; 2], [0, 8].map(|first| Child::Leaf { first, count: 8 }.pack()))];
    let light = |i| Light { kind: Light::POINT, place: corner(i, near, far), ..draft.lights[0] };
    draft.lights = (0..8).map(light).collect();
    let header = &mut draft.header;
    (header.root, header.depth, header.file_triangles, header.file_spheres) = (Child::Node(0).pack(), 1, 0, 16);
    header.counts.nodes = 1;
    (header.counts.triangles, header.counts.spheres) = (0, 16);
    (header.counts.smooth, header.counts.normals, header.counts.lights) = (0, 0, 8);
    let absent = [Need::SmoothNormals, Need::DirectionalLight, Need::WholeTriangles];
    let bits = absent.iter().fold(header.needs.bits(), |bits, &need| bits & !(need as u64));
    header.needs = Needs::from_bits(bits);
    let largest = (1i64 << (K::DIRECTION_BITS + 4)) - 9;
    for eye in (0..8).map(|i| corner(i, near, far)).chain([[(low + high) / 2; 3]]) {
        for view in 0..8 {
            let camera = &mut draft.header.camera;
            (camera.eye, camera.fraction_bits) = (eye, 4);
            camera.first = corner(view, -1, 1).map(|side| i64::from(side) * largest);
            camera.right = camera.first.map(|c| -c / 8);
            camera.down = [camera.right[0], 0, 0];
            (camera.right[0], draft.header.size) = (0, [8, 8]);
            let blob = draft.write();
            let scene = Scene::<Full<K>>::new_checked(blob.bytes()).expect("all is in range");
            corners(&scene);
        }
    }
    let mut beyond = draft.clone();
    beyond.header.camera.eye[0] = far + 1;
    assert_eq!(verdict::<K>(beyond.write().bytes()), Err(BlobError::Origin));
    // One leaf is the whole tree: what is spanned is read from the spheres.
    draft.nodes.clear();
    (draft.header.counts.nodes, draft.header.depth) = (0, 0);
    draft.header.root = Child::Leaf { first: 0, count: 16 }.pack();
    assert_eq!(verdict::<K>(draft.write().bytes()), Ok(()));
    draft.header.camera.eye[0] = far + 1;
    assert_eq!(verdict::<K>(draft.write().bytes()), Err(BlobError::Origin));
}
