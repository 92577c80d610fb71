//! How far the integer pictures are from the f64 reference on undiscretised geometry, and why where they differ.

use host_tools::compare::{compare, difference};
use host_tools::engine::{self, Engine};
use host_tools::import;
use host_tools::model::Model;
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::reference::Reference;
use tests::shared;

/// The model at a picture size.
fn model(name: &str, size: [u32; 2]) -> Option<Model> {
    let mut model = import::load(&shared::scene(name)?).expect("a real model").model;
    model.render.size = size;
    Some(model)
}

fn picture(engine: &dyn Engine, model: &Model) -> Picture {
    let prepared = engine.prepare(model, &Options::default()).expect("it fits");
    engine.render(prepared.blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture
}

fn reference(model: &Model) -> Picture {
    let [width, height] = model.render.size;
    let (pixels, _) = Reference::new(model).render([width, height], &|_| {});
    Picture::from_fn(width, height, |x, y| pixels[(y * width + x) as usize])
}

/// Whether the nearest surface, or the nearest from the point to a light, is one of two that lie in one place.
fn is_tie(model: &Model, reference: &Reference<'_>, x: u32, y: u32) -> bool {
    let (origin, direction) = reference.camera_ray(model.render.size, f64::from(x) + 0.5, f64::from(y) + 0.5);
    reference.candidates(origin, direction, 1e-7).len() > 1
}

const SCENES: [&str; 6] = [
    "cornell-box/scene.toml",
    "sponza-dabrovic/scene.toml",
    "suzanne/suzanne.obj",
    "teapot/teapot.obj",
    "bunny/bunny_smooth.obj",
    "coffee/coffee.obj",
];

#[test]
fn exact29_has_no_pixel_over_64_that_is_not_a_tie() {
    let engine = engine::by_name("exact29").expect("it exists");
    for name in SCENES {
        let Some(model) = model(name, [1024, 1024]) else { continue };
        let (ours, truth) = (picture(engine, &model), reference(&model));
        let apart = compare(&ours, &truth).expect("one size");
        let tracer = Reference::new(&model);
        let gray = difference(&ours, &truth).expect("one size");
        let mut ties = 0;
        let mut unexplained = Vec::new();
        for y in 0..1024 {
            for x in 0..1024 {
                if gray.pixels()[(y * 1024 + x) as usize][0] > 64 {
                    if is_tie(&model, &tracer, x, y) { ties += 1 } else { unexplained.push((x, y)) }
                }
            }
        }
        println!(
            "{name}: over 64 {} ({ties} ties), over 4 {}, over 1 {}, {:?} dB; unexplained {unexplained:?}",
            apart.over_64, apart.over_4, apart.over_1, apart.psnr
        );
    }
}

#[test]
fn exact14_is_good_enough_for_a_small_picture() {
    let engine = engine::by_name("exact14").expect("it exists");
    for name in SCENES {
        let Some(model) = model(name, [160, 128]) else { continue };
        let apart = compare(&picture(engine, &model), &reference(&model)).expect("one size");
        let share = apart.over_64 as f64 / (160.0 * 128.0);
        println!("{name}: over 64 {} ({:.3} %), over 4 {}, over 1 {}", apart.over_64, share * 100.0, apart.over_4, apart.over_1);
    }
}
