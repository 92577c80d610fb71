//! How long a board takes, by its firmware in an emulator; skipped where that cannot be built or run, with a line that says so.

use std::sync::Arc;

use firmware_rt::board::{HIFIVE1, MICROBIT};
use glam::DVec3;
use host_tools::engine;
use host_tools::model::{Format, Model, Sphere};
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::render::TILE;
use host_tools::{builtin, emulate, import};
use view::chip::{Job, TARGETS, effort};
use view::kernels::{self, KERNELS};
use view::painter::{Scene, View};

const SIZE: [u32; 2] = [24, 16];

/// The built-in scene, and a job to time it: on a board, by a kernel.
fn job(board: &str, kernel: &str) -> (Scene, Job) {
    let model = import::load_from(&import::Embedded(builtin::FILES), "scene.toml").unwrap().model;
    job_of(model, board, kernel)
}

fn job_of(model: Model, board: &str, kernel: &str) -> (Scene, Job) {
    let scene = Scene { model: Arc::new(model), has_headlight: false };
    let place = kernels::place(kernel).unwrap();
    let view = View { camera: scene.model.camera, size: SIZE, kernel: place, format: Format::Rgb565 };
    let blob = engine::by_name(kernel).unwrap().prepare(&view.of(&scene), &Options::default()).unwrap().blob;
    let picture = KERNELS[place].render(blob.bytes(), TILE, &|_| ()).unwrap().picture;
    let target = TARGETS.iter().position(|target| target.board.name == board).unwrap();
    (scene, Job { serial: 1, view, picture, target })
}

#[test]
fn instructions_are_counted_and_the_picture_is_the_same() {
    for board in [&MICROBIT, &HIFIVE1] {
        if let Err(error) = emulate::check(board) {
            println!("skipped: {error}");
            return;
        }
    }
    let found = |board: &str| {
        let (scene, job) = job(board, "exact14");
        (effort(&scene, &job).unwrap(), job.picture.pixels().len() as u64)
    };
    let [(microbit, pixels), (hifive1, _), (pico, _)] = ["microbit", "hifive1", "pico"].map(found);
    assert!(microbit.is_same && hifive1.is_same && pico.is_same);
    // Some rays a pixel, some thousand instructions a ray.
    assert!((1000..1_000_000).contains(&(microbit.instructions / pixels)), "{microbit:?}");
    assert_eq!(microbit.seconds, microbit.cycles as f64 / 16e6);
    assert_eq!((hifive1.cycles, hifive1.seconds), (hifive1.instructions, hifive1.instructions as f64 / 320e6));
    assert_eq!((pico.instructions, pico.blob_bytes), (microbit.instructions, microbit.blob_bytes));
    assert!(pico.cycles < microbit.cycles && microbit.instructions < pico.cycles);
    assert_eq!(pico.seconds, pico.cycles as f64 / 125e6);

    // Another picture is seen to be another.
    let (scene, mut other) = job("microbit", "exact14");
    other.picture = Picture::new(SIZE[0], SIZE[1]);
    assert!(!effort(&scene, &other).unwrap().is_same);
}

#[test]
fn the_tracer_of_spheres_is_counted_too() {
    if let Err(error) = emulate::check(&MICROBIT) {
        println!("skipped: {error}");
        return;
    }
    let sphere = Sphere { centre: DVec3::ZERO, radius: 0.5, material: 0 };
    let (scene, job) = job_of(Model { spheres: vec![sphere], ..Model::default() }, "microbit", "planes12");
    let effort = effort(&scene, &job).unwrap();
    assert!(effort.is_same && effort.instructions > 0, "{effort:?}");
}

#[test]
fn why_there_is_no_time_is_said() {
    let (scene, job) = job("microbit", "f64");
    let blob = KERNELS[job.view.kernel].prepare(&job.view.of(&scene), &Options::default()).unwrap().blob;
    let expected = format!(
        "the scene has {} bytes, and microbit has room for {}",
        blob.bytes().len(),
        MICROBIT.blob(u16::MAX).length
    );
    assert_eq!(effort(&scene, &job), Err(expected));
}
