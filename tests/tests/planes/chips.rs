//! The tracer of 1994 on chips: the host's pictures, bit for bit, and what they take.
//!
//! Boards that cannot be emulated here are skipped, with a line that says so.

use std::path::Path;
use std::time::Duration;

use core_rt::colour::Transfer;
use firmware_rt::status::Status;
use glam::DVec3;
use host_tools::emulate::counter::Counter;
use host_tools::emulate::machine::Machine;
use host_tools::emulate::{EmulateError, Outcome, Run, planes};
use host_tools::grid::Grid;
use host_tools::planes::blob::blob;
use host_tools::planes::scene::{Options, Planes};
use host_tools::planes::{Way, light, picture};
use host_tools::prepare::Blob;
use host_tools::{import, model};
use planes_rt::blob::{ReadError, read};
use planes_rt::scene::SceneError;
use tests::boards::boards;
use tests::random::SplitMix64;

use crate::scenes;

const LIMIT: Duration = Duration::from_secs(120);

/// What a pixel may take on a Cortex-M0, with 8 spheres and 3 generations.
const INSTRUCTIONS_A_PIXEL: u64 = 3000;

#[test]
fn boards_draw_the_host_s_picture_within_their_instructions() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/planes/scene.toml");
    let mut model = import::load(&path).unwrap().model;
    (model.render.size, model.render.max_depth) = ([64, 48], 2);
    let spheres = Planes::new(&model, &Options::default()).unwrap();
    let scene = spheres.scene().unwrap();
    assert_eq!((scene.spheres().len(), scene.settings().generations), (8, 3));
    let expected = picture(&scene, &light(&scene, Way::Pixels, &|_| ()), model::Transfer::Srgb);
    let blob = blob(&scene, &spheres.place(), Transfer::Srgb);
    for board in boards() {
        let elf = planes::provide(board).unwrap();
        let counter = Counter::provide(&Machine::of(board).unwrap()).ok();
        let run = Run { board, elf: &elf, blob: Some(blob.bytes()), counter: counter.as_ref(), limit: LIMIT };
        let Outcome { picture, counts, .. } = run.perform(&mut Vec::new()).unwrap();
        assert_eq!(picture, expected, "{}", board.name);
        let Some(counts) = counts else { continue };
        let a_pixel = counts.instructions / (64 * 48);
        assert!(a_pixel <= INSTRUCTIONS_A_PIXEL, "{}: {a_pixel} instructions a pixel", board.name);
    }
}

#[test]
fn boards_draw_scenes_of_all_widths_outlines_mirrors_and_paths_as_the_host_does() {
    let mut random = SplitMix64(6);
    let place = Grid { origin: DVec3::ZERO, scale: 1.0 };
    for board in boards() {
        let elf = planes::provide(board).unwrap();
        for number in 0..6 {
            // Tiles and lanes beyond the picture are cut off.
            let mut parts = scenes::scene(&mut random, 9, [19, 21]);
            match number % 3 {
                1 => scenes::roughen(&mut random, &mut parts),
                2 => scenes::follow_paths(&mut random, &mut parts),
                _ => (),
            }
            let scene = parts.scene();
            let expected = picture(&scene, &light(&scene, Way::Pixels, &|_| ()), model::Transfer::Linear);
            let blob = blob(&scene, &place, Transfer::Linear);
            let run = Run { board, elf: &elf, blob: Some(blob.bytes()), counter: None, limit: LIMIT };
            let outcome = run.perform(&mut Vec::new()).unwrap();
            assert_eq!(outcome.picture, expected, "{} {:?}", board.name, parts.settings);
        }
    }
}

#[test]
fn a_blob_is_read_as_it_was_written_and_refused_where_a_bit_is_not() {
    let mut random = SplitMix64(9);
    let place = Grid { origin: DVec3::new(-1.0, 2.5, 0.0), scale: 7.0 };
    for number in 0..20 {
        let mut parts = scenes::scene(&mut random, 9, [16, 8]);
        if number % 2 == 0 {
            scenes::roughen(&mut random, &mut parts);
        } else {
            scenes::follow_paths(&mut random, &mut parts);
        }
        let scene = parts.scene();
        let blob = blob(&scene, &place, Transfer::Linear);
        let (found, transfer) = read(blob.bytes()).unwrap();
        assert_eq!(
            (found.spheres(), found.settings(), transfer),
            (scene.spheres(), scene.settings(), Transfer::Linear)
        );
        assert_eq!((found.light(), found.background()), (scene.light(), scene.background()));
        let pixels = crate::pixels();
        assert!({ pixels }.all(|pixel| found.ray(pixel) == scene.ray(pixel)));
        let bytes = blob.bytes();
        for place in 0..bytes.len() {
            let mut damaged = bytes.to_vec();
            damaged[place] ^= 1 << random.below(8);
            assert!(read(Blob::from_bytes(&damaged).bytes()).is_err(), "byte {place}");
            assert!(read(Blob::from_bytes(&bytes[..place]).bytes()).is_err(), "cut at {place}");
        }
    }
}

#[test]
fn what_goes_on_diffusely_is_refused_where_no_paths_are_followed() {
    let mut random = SplitMix64(11);
    let mut parts = scenes::scene(&mut random, 9, [16, 8]);
    scenes::follow_paths(&mut random, &mut parts);
    parts.spheres[0].surface.matt = [0, 0, 1];
    let place = Grid { origin: DVec3::ZERO, scale: 1.0 };
    let mut bytes = blob(&parts.scene(), &place, Transfer::Srgb).bytes().to_vec();
    assert!(read(Blob::from_bytes(&bytes).bytes()).is_ok());
    // The flag, behind the prefix; then the sum of all.
    let flag = size_of::<core_rt::blob::Prefix>() + 132;
    assert_eq!(core::mem::replace(&mut bytes[flag], 0), 1);
    let summed = bytes.len() - 4;
    let sum = core_rt::blob::crc32(&bytes[..summed]);
    bytes[summed..].copy_from_slice(&sum.to_le_bytes());
    assert_eq!(read(Blob::from_bytes(&bytes).bytes()).err(), Some(ReadError::Scene(SceneError::Sphere(0))));
}

#[test]
fn firmware_refuses_a_damaged_blob() {
    let parts = scenes::scene(&mut SplitMix64(1), 4, [16, 8]);
    let place = Grid { origin: DVec3::ZERO, scale: 1.0 };
    let mut bytes = blob(&parts.scene(), &place, Transfer::Srgb).bytes().to_vec();
    bytes[60] ^= 4;
    for board in boards() {
        let elf = planes::provide(board).unwrap();
        let run = Run { board, elf: &elf, blob: Some(&bytes), counter: None, limit: LIMIT };
        let error = run.perform(&mut Vec::new()).unwrap_err();
        assert!(matches!(error, EmulateError::Firmware { status: Status::Refused, .. }), "{error}");
    }
}
