//! Everything that the light of a scene may need fits 8 KiB of RAM with tiles of 16x16 pixels: variables, and the stack at
//! its deepest, the check of the blob included.
//!
//! Boards that cannot be emulated here are skipped, with a line that says so.

use std::sync::Arc;
use std::time::Duration;

use core_rt::profile::{Need, Needs, Prefer};
use firmware_rt::board::MICROBIT;
use firmware_rt::build::Traits;
use glam::{DVec2, DVec3};
use host_tools::emulate::Run;
use host_tools::emulate::firmware::{self, Wanted};
use host_tools::emulate::probe::{Probe, WHITTED, WHOLE};
use host_tools::model::{Background, Checker, Falloff, Light, LightKind, Lobe, MaterialKind, Model, Specular, Texture};
use host_tools::{engine, prepare::Options};
use tests::boards::boards;
use tests::scenes;
use tests::stack::bound;

/// Of a tile.
const PIXELS: usize = 16 * 16;

const LIMIT: Duration = Duration::from_secs(300);

/// What all of it may take, bytes.
const MOST: u64 = 8 << 10;

/// The built-in scene, with all that it lacks.
fn everything() -> Model {
    let mut model = scenes::named("demo", [32, 24]).expect("the built-in scene");
    let centre = model.positions.iter().sum::<DVec3>() / model.positions.len() as f64;
    let mut lamp = Light::new(LightKind::Point(model.camera.position), DVec3::ONE);
    lamp.falloff = Falloff::InverseSquare { reach: 1.0 };
    model.lights.extend([lamp, Light::new(LightKind::Directional(centre - model.camera.position), DVec3::ONE)]);
    (model.render.ambient, model.render.samples, model.render.max_depth) = (DVec3::splat(0.1), 2, 10);
    model.background = Background::Sky { bottom: DVec3::ZERO, top: DVec3::ONE };
    model.colours = vec![DVec3::X; model.positions.len()];
    model.uvs = vec![Some([DVec2::ZERO; 3]); model.triangles.len()];
    for (number, material) in model.materials.iter_mut().enumerate() {
        let lobe = if number % 2 == 0 { Lobe::Phong } else { Lobe::BlinnPhong };
        material.specular = Some(Specular { lobe, exponent: 50, colour: DVec3::ONE });
        material.texture = Some(Arc::new(Texture { size: [1, 1], texels: vec![[255; 3]] }));
        material.checker = Some(Checker { size: 1.0, other: DVec3::ONE });
        material.emission = DVec3::splat(0.01);
        material.kind = [MaterialKind::Dielectric, MaterialKind::Metal][number % 2];
        (material.weights, material.tinted_shadow) = (None, true);
    }
    model
}

/// What no run can go beyond, by the instructions of a program of rendering code alone: its stack, on which are those of the
/// traversal and of the rays that wait, and a tile's hits and pixels.
#[test]
fn no_run_can_take_more() {
    if firmware::check_board(&MICROBIT).is_err() {
        println!("skipped: the compiler has no library for {}", MICROBIT.target);
        return;
    }
    for prefer in [Prefer::Speed, Prefer::Size] {
        let probe = Probe { board: &MICROBIT, program: WHOLE, prefer, blob: None, needs: Some(WHITTED) };
        let stack = bound(probe.provide().expect("it can be built").bytes(), "_start").expect("it has a bound");
        let all = stack + (PIXELS * (4 + Needs::pixel_bytes(WHITTED))) as u64;
        println!("for {prefer:?}: at most {all} bytes of RAM, {stack} of them stack");
        assert!((1 << 10..=MOST).contains(&all), "{all}");
    }
}

#[test]
fn everything_fits_eight_kibibytes() {
    let engine = engine::by_name("exact14").expect("a kernel of this name");
    let blob = engine.prepare(&everything(), &Options::default()).expect("it fits").blob;
    let needs = Needs::from_bits(Traits::of(blob.bytes()).expect("a blob just made").needs);
    let lacking: Vec<Need> = WHITTED.iter().filter(|&need| !needs.has(need)).collect();
    assert!(lacking.is_empty(), "{lacking:?}");
    for board in boards() {
        for prefer in [Prefer::Speed, Prefer::Size] {
            let wanted = Wanted { board, blob: blob.bytes(), hits: None, count: false };
            let elf = wanted.provide_for(prefer).expect("it can be built");
            let run = Run { board, elf: &elf, blob: Some(blob.bytes()), counter: None, limit: LIMIT };
            let stack = u64::from(run.perform(&mut Vec::new()).expect("it goes well").report.stack_bytes);
            let all = elf.static_bytes + stack;
            println!("{} for {prefer:?}: {all} bytes of RAM, {stack} of them stack", board.name);
            assert!(all <= MOST, "{}: {all}", board.name);
        }
    }
}
