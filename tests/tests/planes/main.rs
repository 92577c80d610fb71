//! The tracer of 1994 against integers without a width, against itself in lockstep, and its scenes.

mod chips;
mod exact;
mod machine;
mod model;
mod paths;
mod scenes;

use num::BigInt;
use planes_rt::colour::Light;
use planes_rt::pixel::{self, Met};
use planes_rt::scene::{Outline, Sample, Scene, Settings};
use planes_simd::Lockstep;
use tests::effort;
use tests::random::SplitMix64;

const SIZE: [u16; 2] = [16, 8];

fn pixels() -> impl Iterator<Item = [u16; 2]> {
    (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]))
}

fn way(scene: &Scene<'_>, pixel: [u16; 2]) -> (Light, Vec<Met>) {
    let mut way = Vec::new();
    let light = pixel::trace_telling(scene, pixel, Sample::numbered(0), |met| way.push(met));
    (light, way)
}

#[test]
fn every_ray_goes_the_way_that_exact_integers_go() {
    let mut random = SplitMix64(1994);
    let mut met = [0; 4];
    for _ in 0..500 * effort() {
        let parts = scenes::scene(&mut random, 12, SIZE);
        let scene = parts.scene();
        for pixel in pixels() {
            let (origin, direction) = scene.ray(pixel);
            let expected = exact::way(&parts.spheres, &parts.settings, origin, direction);
            let (_, way) = way(&scene, pixel);
            // A ray of which nothing is seen goes no further.
            for (met, expected) in way.iter().zip(&expected) {
                let found = (met.sphere, met.t.into(), met.point.map(BigInt::from), met.direction.map(BigInt::from));
                assert_eq!(found, *expected, "{pixel:?} {:?}", parts.settings);
            }
            let is_dark = way.iter().any(|met| parts.spheres[met.sphere].surface.mirror.contains(&0));
            assert!(way.len() == expected.len() || is_dark || dims(&parts, &way));
            met[way.len().min(3)] += 1;
        }
    }
    assert!(met.iter().all(|&count| count > 1000), "too few ways of some length: {met:?}");
}

/// Whether the shares of what is left round to nothing.
fn dims(parts: &scenes::Parts, way: &[Met]) -> bool {
    (0..3).all(|channel| {
        let share =
            |share: f64, met: &Met| share * f64::from(parts.spheres[met.sphere].surface.mirror[channel]) / 2048.0;
        way.iter().fold(1.0, share) < 0.01
    })
}

#[test]
fn an_oracle_of_another_scene_is_told_apart() {
    let mut random = SplitMix64(3);
    let differs = |parts: &scenes::Parts| {
        let scene = parts.scene();
        let mut moved = parts.spheres.clone();
        moved.iter_mut().for_each(|sphere| sphere.centre[0] += 1);
        pixels().any(|pixel| {
            let (origin, direction) = scene.ray(pixel);
            let expected = exact::way(&moved, &parts.settings, origin, direction);
            let (_, way) = way(&scene, pixel);
            way.iter().zip(&expected).any(|(met, expected)| met.direction.map(BigInt::from) != expected.3)
        })
    };
    let told = (0..50).filter(|_| differs(&scenes::scene(&mut random, 12, SIZE))).count();
    // Many rays meet nothing, or move by less than their words tell.
    assert!(told > 10, "{told}");
}

/// All pixels by tiles of N lanes, one after the other in rows.
fn by_lanes<const N: usize>(scene: &Scene<'_>, unit: Lockstep) -> Vec<Light> {
    let all: Vec<[u16; 2]> = pixels().collect();
    let tiles = all.chunks(N).flat_map(|chunk| {
        // What is left of the last tile is traced with the rest of it out of the picture.
        let tile = std::array::from_fn(|lane| chunk.get(lane).copied().unwrap_or([u16::MAX; 2]));
        unit.trace::<N>(scene, &tile).into_iter().take(chunk.len())
    });
    tiles.collect()
}

#[test]
fn lanes_in_lockstep_have_the_light_of_pixels_one_by_one() {
    let mut random = SplitMix64(5);
    let mut lit = 0;
    for _ in 0..400 * effort() {
        let parts = scenes::scene(&mut random, 40, SIZE);
        let scene = parts.scene();
        let expected: Vec<Light> = pixels().map(|pixel| pixel::trace(&scene, pixel)).collect();
        for unit in [Lockstep::PORTABLE, Lockstep::detected()] {
            let tiles = [by_lanes::<1>, by_lanes::<3>, by_lanes::<8>, by_lanes::<16>, by_lanes::<32>];
            for (number, tile) in tiles.into_iter().enumerate() {
                assert_eq!(tile(&scene, unit), expected, "{} {number} {:?}", unit.name(), parts.settings);
            }
        }
        lit += expected.iter().filter(|&&light| light != scenes::BACKGROUND).count();
    }
    assert!(lit > 10_000, "{lit}");
}

#[test]
fn rough_mirrors_are_the_same_in_lockstep_and_one_by_one() {
    let mut random = SplitMix64(12);
    let mut strewn = 0;
    for _ in 0..100 * effort() {
        let mut parts = scenes::scene(&mut random, 12, SIZE);
        let sharp: Vec<Light> = pixels().map(|pixel| pixel::trace(&parts.scene(), pixel)).collect();
        scenes::roughen(&mut random, &mut parts);
        let scene = parts.scene();
        let expected: Vec<Light> = pixels().map(|pixel| pixel::trace(&scene, pixel)).collect();
        for unit in [Lockstep::PORTABLE, Lockstep::detected()] {
            for tile in [by_lanes::<1>, by_lanes::<3>, by_lanes::<32>] {
                assert_eq!(tile(&scene, unit), expected, "{} {:?}", unit.name(), parts.settings);
            }
        }
        strewn += expected.iter().zip(&sharp).filter(|(light, sharp)| light != sharp).count();
    }
    assert!(strewn > 500, "{strewn}");
}

#[test]
fn the_literal_outline_ends_at_the_first_sphere_and_the_corrected_one_at_the_nearest() {
    let mut random = SplitMix64(7);
    let (mut differ, mut same_way) = (0, 0);
    for _ in 0..100 * effort() {
        let mut parts = scenes::scene(&mut random, 12, SIZE);
        let of = |parts: &mut scenes::Parts, outline| {
            parts.settings = Settings { outline, ..parts.settings };
            pixels().map(|pixel| way(&parts.scene(), pixel).1.first().copied()).collect::<Vec<_>>()
        };
        let literal = of(&mut parts, Outline::Literal);
        let nearest = of(&mut parts, Outline::Nearest);
        for (literal, nearest) in literal.iter().zip(&nearest) {
            let (Some(literal), Some(nearest)) = (literal, nearest) else {
                assert_eq!(literal, nearest, "both meet something, or neither does");
                continue;
            };
            assert!(literal.sphere <= nearest.sphere && literal.t >= nearest.t);
            if literal.sphere == nearest.sphere { same_way += 1 } else { differ += 1 }
        }
        // With the spheres from near to far for the first ray, it is the same for that one.
        let Some(first) = nearest[0] else { continue };
        parts.spheres.swap(0, first.sphere);
        assert_eq!(of(&mut parts, Outline::Literal)[0].map(|met| met.t), Some(first.t));
    }
    assert!(differ > 500 && same_way > 500, "{differ} {same_way}");
}
