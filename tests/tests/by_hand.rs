//! A scene that needs nothing more is not slowed by what others need: the smallest profile takes no more instructions than
//! a loop that never had anything else, `firmware-rt/src/by_hand.rs`.
//!
//! Boards on which nothing can be counted are skipped, with a line that says so.

use std::path::Path;
use std::time::Duration;

use core_rt::profile::Needs;
use firmware_rt::build::Traits;
use host_tools::emulate::firmware::Wanted;
use host_tools::emulate::probe::SMALLEST;
use host_tools::emulate::{Outcome, Run};
use host_tools::model::{Background, Light, LightKind, Model, RenderSettings, Transfer};
use host_tools::{engine, import, prepare::Options};
use tests::boards::counted;
use tests::scenes;

const LIMIT: Duration = Duration::from_secs(120);

/// A mesh that is seen from outside, flat, matt, under one light without shadows.
fn smallest(mut model: Model, size: [u32; 2]) -> Model {
    model = scenes::matt(model);
    model.triangles.iter_mut().for_each(|triangle| triangle.normals = None);
    model.materials.iter_mut().for_each(|material| material.emission = glam::DVec3::ZERO);
    model.lights = vec![Light::new(LightKind::Point(model.camera.position), glam::DVec3::ONE)];
    model.background = Background::Colour(glam::DVec3::splat(0.1));
    model.render = RenderSettings { size, shadows: false, transfer: Transfer::Linear, ..RenderSettings::default() };
    model
}

#[test]
fn the_smallest_profile_costs_no_more_than_a_loop_for_it_alone() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/bench-1k/scene.toml");
    let bench = import::load(&path).expect("a scene of the repository").model;
    let flat = scenes::named("flat", [48, 40]).expect("a small scene");
    let engine = engine::by_name("exact14").expect("a kernel of this name");
    for (board, counter) in counted() {
        for model in [smallest(bench.clone(), [48, 40]), smallest(flat.clone(), [48, 40])] {
            let blob = engine.prepare(&model, &Options::default()).expect("it fits").blob;
            let traits = Traits::of(blob.bytes()).expect("a blob just made");
            assert_eq!(Needs::from_bits(traits.needs), SMALLEST);
            let wanted = Wanted { board, blob: blob.bytes(), hits: None, count: false };
            let run = |elf| -> Outcome {
                let run = Run { board, elf: &elf, blob: Some(blob.bytes()), counter: Some(&counter), limit: LIMIT };
                run.perform(&mut Vec::new()).expect("it goes well")
            };
            let product = run(wanted.provide().expect("it can be built"));
            let by_hand = run(wanted.provide_by_hand().expect("it can be built"));
            assert!(product.picture == by_hand.picture, "{}: they do not draw the same", board.name);
            let [product, by_hand] =
                [product, by_hand].map(|outcome| outcome.counts.expect("they were counted").instructions);
            println!("{}: {product} instructions, and {by_hand} by hand", board.name);
            assert!(product <= by_hand, "{}: {product} > {by_hand}", board.name);
        }
    }
}
