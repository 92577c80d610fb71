//! How fast pictures by paths come nearer to the truth: by the square root of the number of samples, where these are independent,
//! until the kernel's own error shows.

use std::ops::{Range, RangeInclusive};

use core_rt::path::Sum;
use core_rt::render::Tile;
use glam::DVec3;
use host_tools::engine::Engine;
use host_tools::model::{Background, Light, LightKind, Material, MaterialKind, Model, Projection, Sphere};
use host_tools::prepare::Options;
use host_tools::reference::Reference;
use host_tools::report::page::fit;
use host_tools::stage::Stage;
use host_tools::{builtin, import};
use rayon::prelude::*;

/// The exponents of the error over the number of samples that count as -1/2.
pub const ALLOWED: RangeInclusive<f64> = -0.55..=-0.45;

/// The root of the mean square of the difference, over all channels: linear light, of which white is 1.
///
/// # Panics
/// If the pictures are not of one size, or empty.
#[must_use]
pub fn rmse(found: &[DVec3], truth: &[DVec3]) -> f64 {
    assert!(found.len() == truth.len() && !found.is_empty(), "pictures of different sizes");
    let sum: f64 = found.iter().zip(truth).map(|(a, b)| (*a - *b).length_squared()).sum();
    libm::sqrt(sum / (3 * found.len()) as f64)
}

/// The exponent of the power of the number of samples that is nearest to errors.
///
/// # Panics
/// If there is no error at all, or only one.
#[must_use]
pub fn exponent(errors: &[(u32, f64)]) -> f64 {
    let errors: Vec<(f64, f64)> = errors.iter().map(|&(samples, error)| (f64::from(samples), error)).collect();
    fit::exponent(&errors).expect("errors that are not zero")
}

/// The built-in scene by paths, its mirrors rough, in a picture of a size.
///
/// # Panics
/// If it cannot be read.
#[must_use]
pub fn scene(size: [u32; 2]) -> Model {
    let mut model =
        import::load_from(&import::Embedded(builtin::FILES), "scene.toml").expect("the built-in scene").model;
    (model.render.size, model.render.paths) = (size, true);
    for material in &mut model.materials {
        material.roughness = match material.name.as_str() {
            "mirror" => 0.1,
            "knot" => 0.4,
            _ => 0.0,
        };
    }
    model
}

/// Of a colour, diffuse and mirrored shares of it, and how rough its mirror is; nothing else.
#[must_use]
pub fn material(colour: DVec3, weights: [f64; 2], roughness: f64) -> Material {
    let [diffuse, mirrored] = weights;
    Material {
        kind: MaterialKind::Mirror,
        colour,
        roughness,
        weights: Some([diffuse, 0.0, mirrored, 0.0]),
        ..Material::default()
    }
}

/// A matt ball, a rough and a half mirror and one that shines, close to each other: what `docs/SHADING.md` says of them is all that
/// the tracer of 1994 knows too, since nothing is shadowed.
#[must_use]
pub fn spheres(size: [u32; 2]) -> Model {
    let shining = Material { emission: DVec3::new(0.9, 0.7, 0.3), ..material(DVec3::splat(0.1), [1.0, 0.0], 0.0) };
    let mut model = Model {
        materials: vec![
            material(DVec3::new(0.9, 0.4, 0.2), [1.0, 0.0], 0.0),
            material(DVec3::new(0.7, 0.8, 0.9), [0.0, 1.0], 0.3),
            material(DVec3::new(0.5, 0.9, 0.6), [0.5, 0.4], 0.0),
            shining,
        ],
        spheres: [[-1.05, -0.2, 0.0, 1.0], [1.0, 0.0, -0.3, 1.0], [0.1, 0.2, 1.5, 0.6], [0.0, 1.6, 0.4, 0.7]]
            .into_iter()
            .zip(0..)
            .map(|([x, y, z, radius], material)| Sphere { centre: DVec3::new(x, y, z), radius, material })
            .collect(),
        lights: vec![Light::new(LightKind::Directional(DVec3::new(0.5, -1.0, -1.0)), DVec3::splat(0.6))],
        background: Background::Colour(DVec3::new(0.2, 0.3, 0.5)),
        ..Model::default()
    };
    model.camera.position = DVec3::new(0.0, 0.5, 6.0);
    model.camera.projection = Projection::Perspective { fov_y: 0.8 };
    let render = &mut model.render;
    (render.size, render.paths, render.shadows, render.max_depth) = (size, true, false, 6);
    model
}

/// The reference's picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Truth {
    /// Linear light, row by row.
    pub picture: Vec<DVec3>,
    /// How far it is from one of endlessly many samples, as [`rmse`] measures.
    pub noise: f64,
}

/// The reference's picture of so many samples a pixel, an even number: the mean of two halves, which say by their difference what
/// the noise is.
#[must_use]
pub fn truth(model: &Model, samples: u32) -> Truth {
    let reference = Reference::new(model);
    let [width, _] = model.render.size;
    let half = |paths: Range<u32>| -> Vec<DVec3> {
        let count = f64::from(samples / 2);
        let pixels = (0..width * model.render.size[1]).into_par_iter();
        pixels.map(|i| reference.path_sum(model.render.size, i % width, i / width, paths.clone()) / count).collect()
    };
    let [first, second] = [half(0..samples / 2), half(samples / 2..samples)];
    let noise = rmse(&first, &second) / 2.0;
    Truth { picture: first.into_iter().zip(second).map(|(a, b)| (a + b) / 2.0).collect(), noise }
}

/// The errors of a kernel's pictures of so many samples a pixel, more each time. `range` says which samples are added on the way
/// from one number to the next: all between them.
///
/// # Panics
/// If the kernel cannot hold the scene, or draws it otherwise than by paths.
#[must_use]
pub fn errors(
    engine: &dyn Engine,
    model: &Model,
    truth: &[DVec3],
    counts: &[u32],
    range: impl Fn(Range<u16>) -> Vec<Range<u16>>,
) -> Vec<(u32, f64)> {
    let blob = engine.prepare(model, &Options::default()).expect("a scene that fits").blob;
    let stage = engine.stage(blob.bytes()).expect("a blob of this kernel");
    assert!(stage.follows_paths(), "a scene without paths");
    let [width, height] = model.render.size.map(|side| side as u16);
    let tiles: Vec<Tile> = Tile::of([width, height], [16, 16]).collect();
    let mut sums: Vec<Vec<Sum>> = tiles.iter().map(|tile| vec![Sum::default(); tile.pixels()]).collect();
    let mut before = 0;
    let one = |&count: &u32| {
        for samples in range(before..count as u16) {
            add(stage.as_ref(), &tiles, samples, &mut sums);
        }
        before = count as u16;
        let mut picture = vec![DVec3::ZERO; truth.len()];
        for (place, sum) in tiles.iter().zip(&sums).flat_map(|(tile, sums)| tile.places().zip(sums)) {
            let pixel = usize::from(place[1]) * usize::from(width) + usize::from(place[0]);
            picture[pixel] = DVec3::from_array(sum.map(f64::from)) / (f64::from(stage.white()) * f64::from(count));
        }
        (count, rmse(&picture, truth))
    };
    counts.iter().map(one).collect()
}

fn add(stage: &dyn Stage, tiles: &[Tile], samples: Range<u16>, sums: &mut [Vec<Sum>]) {
    tiles.par_iter().zip(sums).for_each(|(tile, sums)| {
        stage.add_samples(*tile, samples.clone(), sums);
    });
}
