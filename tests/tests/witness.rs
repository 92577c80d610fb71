//! What a kernel and the reference say that the rays behind a pixel saw: the same, where they drew the same.

use glam::DVec3;
use host_tools::engine;
use host_tools::model::{LightKind, Model};
use host_tools::prepare::Options;
use host_tools::reference::Reference;
use host_tools::witness::Seen;
use tests::scenes;

fn of_kernel(name: &str, model: &Model) -> Vec<Seen> {
    let engine = engine::by_name(name).expect("a kernel of this name");
    let prepared = engine.prepare(model, &Options::default()).expect("it fits");
    let bytes = prepared.blob.bytes();
    let (rendered, seen) = engine.witness(bytes, [32, 16], &|_| {}).expect("a blob just made");
    let plain = engine.render(bytes, [16, 32], &|_| {}).expect("a blob just made");
    assert_eq!(rendered.picture.pixels(), plain.picture.pixels(), "{name}: being watched changes nothing");
    assert_eq!(rendered.counts, plain.counts);
    seen
}

fn of_reference(model: &Model) -> Vec<Seen> {
    let reference = Reference::new(model);
    let (pixels, seen) = reference.witness(model.render.size, &|_| {});
    assert_eq!(pixels, reference.render(model.render.size, &|_| {}).0, "the reference is one");
    seen
}

/// Pixels whose [first surface, camera rays, other rays, lights] differ.
fn apart(a: &[Seen], b: &[Seen]) -> [usize; 4] {
    assert_eq!(a.len(), b.len());
    let count = |differ: fn(&Seen, &Seen) -> bool| a.iter().zip(b).filter(|(a, b)| differ(a, b)).count();
    [
        count(|a, b| a.first != b.first),
        count(|a, b| a.camera != b.camera),
        count(|a, b| a.secondary != b.secondary),
        count(|a, b| a.shadows != b.shadows),
    ]
}

fn demo() -> Model {
    let (_, model) = scenes::all().swap_remove(0);
    model
}

/// Mirrors, glass and shadows, with one sample and with several.
#[test]
fn a_kernel_without_a_grid_sees_what_the_reference_sees() {
    for samples in [1, 4] {
        let mut model = demo();
        model.render.samples = samples;
        let truth = of_reference(&model);
        let apart = apart(&of_kernel("f64", &model), &truth);
        println!("demo, {samples} samples: of {} pixels apart {apart:?}", truth.len());
        let [first, camera, secondary, shadows] = apart;
        assert_eq!([first, camera], [0, 0]);
        // Rays on through many surfaces part sooner or later, and rays that few would see are dropped sooner here.
        assert!(secondary * 20 < truth.len(), "{secondary}");
        assert!(shadows * 20 < truth.len(), "{shadows}");
    }
}

/// What changes in a scene shows in its own digest.
#[test]
fn a_change_is_seen_for_what_it_is() {
    let model = scenes::matt(demo());
    let before = of_reference(&model);
    assert!(before.iter().any(|seen| seen.first != u32::MAX));

    let mut other = model.clone();
    for light in &mut other.lights {
        if let LightKind::Point(position) = &mut light.kind {
            *position += DVec3::new(2.0, 0.0, 0.0);
        }
    }
    let [first, camera, secondary, shadows] = apart(&of_reference(&other), &before);
    assert_eq!([first, camera, secondary], [0; 3], "no surface has moved");
    assert!(shadows > before.len() / 100, "{shadows}");

    let mut other = demo();
    let mirrors = of_reference(&other);
    other.render.max_depth = 1;
    let [first, camera, secondary, _] = apart(&of_reference(&other), &mirrors);
    assert_eq!([first, camera], [0; 2], "camera rays go as before");
    assert!(secondary > 0);

    let mut other = model.clone();
    other.positions[0] += DVec3::new(0.3, 0.3, 0.0);
    let [first, camera, ..] = apart(&of_reference(&other), &before);
    assert!(first > 0 && camera >= first, "{first} {camera}");
}
