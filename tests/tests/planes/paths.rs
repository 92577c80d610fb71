//! Paths and places of samples: the same by all ways of taking pixels, and what they gather where one can say what that is.

use std::ops::Range;

use core_rt::render::Tile;
use glam::DVec3;
use host_tools::compare::compare;
use host_tools::engine::PLANES12;
use host_tools::model::{Material, Model, Projection, Sphere, Transfer};
use host_tools::planes::scene::{Options, Planes};
use host_tools::planes::{Way, light, picture};
use host_tools::prepare;
use host_tools::reference::Reference;
use planes_rt::colour::{LIGHT_MAX, Light as Words};
use planes_rt::pixel;
use planes_simd::Lockstep;
use tests::convergence::{ALLOWED, Truth, errors, exponent, material, rmse, spheres, truth};
use tests::effort;
use tests::random::SplitMix64;

use crate::{SIZE, by_lanes, pixels, scenes};

#[test]
fn paths_and_places_are_the_same_in_lockstep_and_one_by_one() {
    let mut random = SplitMix64(1986);
    let (mut differ, mut clamped) = (0, 0);
    for number in 0..200 * effort() {
        let mut parts = scenes::scene(&mut random, 12, SIZE);
        let plain: Vec<Words> = pixels().map(|pixel| pixel::trace(&parts.scene(), pixel)).collect();
        if number % 4 == 0 {
            parts.settings.samples = 2 + random.below(5) as u16;
        } else {
            scenes::follow_paths(&mut random, &mut parts);
        }
        let scene = parts.scene();
        let expected: Vec<Words> = pixels().map(|pixel| pixel::trace(&scene, pixel)).collect();
        for unit in [Lockstep::PORTABLE, Lockstep::detected()] {
            for tile in [by_lanes::<1>, by_lanes::<3>, by_lanes::<32>] {
                assert_eq!(tile(&scene, unit), expected, "{} {:?}", unit.name(), parts.settings);
            }
        }
        differ += expected.iter().zip(&plain).filter(|(light, plain)| light != plain).count();
        clamped += expected.iter().flatten().filter(|&&channel| channel == LIGHT_MAX).count();
    }
    assert!(differ > 5000 && clamped > 500, "{differ} {clamped}");
}

/// Balls in light of 1 from everywhere, as much of which they send on as their material says.
fn furnace(balls: &[Sphere], material: Material) -> Model {
    let mut model =
        Model { spheres: balls.to_vec(), materials: vec![material], background: DVec3::ONE.into(), ..Model::default() };
    // So far that the balls are small enough for the text's determinant.
    model.camera.position = DVec3::new(0.0, 0.0, 12.0);
    model.camera.projection = Projection::Perspective { fov_y: 0.08 };
    let render = &mut model.render;
    (render.size, render.samples, render.paths, render.max_depth) = ([24, 24], 16, true, 64);
    render.transfer = Transfer::Linear;
    model
}

fn ball(x: f64) -> Sphere {
    Sphere { centre: DVec3::new(x, 0.0, 0.0), radius: 1.0, material: 0 }
}

fn gathered(model: &Model) -> Vec<Words> {
    let planes = Planes::new(model, &Options::default()).unwrap();
    assert_eq!(planes.warnings, [""; 0]);
    light(&planes.scene().unwrap(), Way::Lanes(Lockstep::detected()), &|_| ())
}

/// A ball alone sends what it says, in every sample, whichever way a path goes on: light and shares have no more rounding than half
/// a unit each. Where there are two ways, a factor of two shares is rounded.
#[test]
fn a_ball_alone_is_as_bright_as_it_says() {
    let grey = DVec3::new(0.75, 0.5, 0.25);
    for (weights, roughness) in [([1.0, 0.0], 0.0), ([0.0, 1.0], 0.0), ([0.0, 1.0], 0.6), ([0.5, 0.5], 0.2)] {
        let found = gathered(&furnace(&[ball(0.0)], material(grey, weights, roughness)));
        let expected = grey.to_array().map(|c| (c * f64::from(LIGHT_MAX)).round() as u16);
        for light in &found {
            let is_near = light.iter().zip(expected).all(|(&found, meant)| found.abs_diff(meant) <= 2);
            assert!(is_near, "{weights:?} {roughness}: {light:?}, {expected:?}");
        }
    }
}

/// What is white is not seen where all is white: nothing is lost between two balls but by paths that are still between them after
/// 64 surfaces, which none is.
#[test]
fn nothing_is_seen_in_a_white_furnace() {
    for (weights, roughness) in [([1.0, 0.0], 0.0), ([0.0, 1.0], 0.5), ([0.5, 0.5], 0.0)] {
        let mut model = furnace(&[ball(-1.01), ball(1.01)], material(DVec3::ONE, weights, roughness));
        model.camera.projection = Projection::Perspective { fov_y: 0.25 };
        assert!(gathered(&model).iter().flatten().all(|&channel| channel == LIGHT_MAX), "{weights:?}");
        // A surface that keeps a hundredth is.
        model.materials[0].colour *= 0.99;
        assert!(gathered(&model).iter().flatten().any(|&channel| channel < LIGHT_MAX - 40), "{weights:?}");
    }
}

const COUNTS: [u32; 5] = [1, 4, 16, 64, 256];

#[test]
fn the_error_falls_as_the_inverse_square_root_of_the_samples() {
    let model = spheres([24, 18]);
    let Truth { picture, noise } = truth(&model, 4096);
    let all = |range: Range<u16>| vec![range];
    let found = errors(PLANES12, &model, &picture, &COUNTS, all);
    println!("{found:?}, noise {noise}");
    // To where its words show: 12 bits of light and shares, and normals and directions in hundreds of units.
    let slope = exponent(&found[..4]);
    assert!(ALLOWED.contains(&slope), "{slope} by {found:?}");
    // Against its own mean of other samples nothing shows but their number.
    let mean = own(&model, 30_000..62_000);
    let found = errors(PLANES12, &model, &mean, &COUNTS, all);
    println!("{found:?}");
    let slope = exponent(&found);
    assert!(ALLOWED.contains(&slope), "{slope} by {found:?}");
    // Samples that are the same tell nothing new.
    let again = |range: Range<u16>| range.map(|_| 0..1).collect();
    let slope = exponent(&errors(PLANES12, &model, &mean, &COUNTS, again));
    assert!(!ALLOWED.contains(&slope), "{slope}");
}

/// The mean of samples by their numbers.
fn own(model: &Model, samples: Range<u16>) -> Vec<DVec3> {
    let blob = PLANES12.prepare(model, &prepare::Options::default()).unwrap().blob;
    let stage = PLANES12.stage(blob.bytes()).unwrap();
    let [width, height] = model.render.size.map(|side| side as u16);
    let tile = Tile { x: 0, y: 0, width, height };
    let mut sums = vec![[0; 3]; tile.pixels()];
    stage.add_samples(tile, samples.clone(), &mut sums);
    let white = f64::from(stage.white()) * samples.len() as f64;
    sums.iter().map(|sum| DVec3::from_array(sum.map(f64::from)) / white).collect()
}

/// What no number of samples takes away is that of the words, and the reference's noise with it.
#[test]
fn paths_gather_what_the_reference_gathers() {
    let mut model = spheres([24, 18]);
    let apart = |model: &Model, picture: &[DVec3]| {
        let off: Vec<DVec3> = own(model, 0..8192).into_iter().zip(picture).map(|(a, b)| a - *b).collect();
        let mean = off.iter().copied().sum::<DVec3>() / off.len() as f64;
        (rmse(&off, &vec![DVec3::ZERO; off.len()]), mean)
    };
    let Truth { picture, noise } = truth(&model, 8192);
    let (error, mean) = apart(&model, &picture);
    println!("{error} with a noise of {noise}, {mean} in the mean");
    assert!(error < 0.004 && mean.abs().max_element() < 0.001, "{error} {mean}");
    // Each of what paths are made of is seen to be missing.
    let plain = |change: &dyn Fn(&mut Model)| {
        let mut model = model.clone();
        change(&mut model);
        apart(&model, &picture).1.abs().max_element()
    };
    for (name, off) in [
        ("whatever goes on", plain(&|model| model.render.max_depth = 0)),
        ("the matt way", plain(&|model| model.materials[0].weights = Some([0.5, 0.0, 0.5, 0.0]))),
        ("what shines", plain(&|model| model.materials[3].emission *= 0.8)),
    ] {
        assert!(off > 0.004, "{name}: {off}");
    }
    model.materials[1].roughness = 0.0;
    let (sharp, _) = apart(&model, &picture);
    assert!(sharp > 1.4 * error, "{sharp} {error}");
}

/// Samples all over a pixel: edges are as the reference's of as many samples, and one sample's are not.
#[test]
fn several_samples_are_in_places_all_over_the_pixel() {
    let mut model = spheres([24, 18]);
    (model.render.paths, model.render.size, model.render.samples) = (false, [96, 72], 16);
    model.materials.iter_mut().for_each(|material| {
        material.roughness = 0.0;
        material.weights = Some([1.0, 0.0, 0.0, 0.0]);
    });
    let truth = Reference::new(&model).picture(&|_| ());
    let by = |samples| {
        let mut model = model.clone();
        model.render.samples = samples;
        let planes = Planes::new(&model, &Options::default()).unwrap();
        let scene = planes.scene().unwrap();
        let way = Way::Lanes(Lockstep::detected());
        compare(&picture(&scene, &light(&scene, way, &|_| ()), model.render.transfer), &truth).unwrap()
    };
    let (one, many) = (by(1), by(16));
    println!("{} {} {} {}", one.over_64, one.mean_abs, many.over_64, many.mean_abs);
    assert!(many.over_64 * 10 < one.over_64 && many.mean_abs < one.mean_abs / 2.0, "{one:?} {many:?}");
}
