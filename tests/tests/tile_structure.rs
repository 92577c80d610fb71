//! The grain of paths has no structure at the edges of tiles, and none that comes again in every tile.
//!
//! A plane under a sky is seen by parallel rays: each pixel's light is then drawn from the same distribution, and what a good
//! generator gives is as independent from pixel to pixel as if it was thrown by dice. Each statistic is in standard
//! deviations of what that would give, by the central limit: thousands of terms each, that are bounded. The bound is 6, so one
//! would be beyond it by chance in 5 x 10^8; less than 500 are looked at. Nothing is drawn anew, so a test passes always or never.

use core_rt::path::Sum;
use core_rt::random::Sample;
use core_rt::render::Tile;
use glam::DVec3;
use host_tools::engine::{self, Engine};
use host_tools::model::{Background, Camera, Material, Model, Projection, RenderSettings, Sphere, Triangle};
use host_tools::prepare::Options;

const SIGMAS: f64 = 6.0;

/// Pixels a side.
const SIDE: usize = 256;

/// Light by pixel, row by row, in units of its standard deviation from its mean.
struct Noise(Vec<f64>);

impl Noise {
    fn new(light: impl IntoIterator<Item = f64>) -> Self {
        let mut light: Vec<f64> = light.into_iter().collect();
        assert_eq!(light.len(), SIDE * SIDE);
        let count = light.len() as f64;
        let mean = light.iter().sum::<f64>() / count;
        let deviation = (light.iter().map(|l| (l - mean).powi(2)).sum::<f64>() / count).sqrt();
        light.iter_mut().for_each(|l| *l = (*l - mean) / deviation);
        Self(light)
    }

    /// Along a row, or down a column.
    fn at(&self, along: usize, across: usize, is_row: bool) -> f64 {
        let (x, y) = if is_row { (along, across) } else { (across, along) };
        self.0[y * SIDE + x]
    }
}

/// Mean and variance of the mean.
fn mean(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (mean, values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / count / (count - 1.0))
}

/// Each statistic by its name, for tiles of a side.
fn statistics(noise: &Noise, tile: usize) -> Vec<(String, f64)> {
    let mut all = Vec::new();
    for is_row in [true, false] {
        let way = if is_row { "right" } else { "down" };
        // Differences of pairs that have no pixel in common: an odd place and the next.
        let (mut across, mut within) = (Vec::new(), Vec::new());
        for line in 0..SIDE {
            for place in (1..SIDE - 1).step_by(2) {
                let difference = noise.at(place + 1, line, is_row) - noise.at(place, line, is_row);
                let pairs = if (place + 1).is_multiple_of(tile) { &mut across } else { &mut within };
                pairs.push(difference);
            }
        }
        let (step, of_step) = mean(&across);
        all.push((format!("step to the tile {way}"), step / of_step.sqrt()));
        let sizes = |pairs: &[f64]| mean(&pairs.iter().map(|d| d.abs()).collect::<Vec<_>>());
        let ((a, of_a), (b, of_b)) = (sizes(&across), sizes(&within));
        all.push((format!("contrast to the tile {way}"), (a - b) / (of_a + of_b).sqrt()));
        // Products of two independent deviates have mean 0 and variance 1.
        for (name, lag) in [("tile", tile), ("pixel", 1)] {
            let products: Vec<f64> = (0..SIDE)
                .flat_map(|line| (0..SIDE - lag).map(move |place| (place, line)))
                .map(|(place, line)| noise.at(place, line, is_row) * noise.at(place + lag, line, is_row))
                .collect();
            let count = products.len() as f64;
            all.push((format!("correlation with the {name} {way}"), products.iter().sum::<f64>() / count.sqrt()));
        }
    }
    // The mean of one place in all tiles: the sum of squares over places, by Wilson and Hilferty's cube root.
    let tiles = ((SIDE / tile) * (SIDE / tile)) as f64;
    let mut places = vec![0.0; tile * tile];
    for (pixel, light) in noise.0.iter().enumerate() {
        places[pixel / SIDE % tile * tile + pixel % SIDE % tile] += light;
    }
    let freedom = places.len() as f64 - 1.0;
    let square: f64 = places.iter().map(|sum| sum * sum / tiles).sum();
    let spread = 2.0 / (9.0 * freedom);
    all.push(("place in a tile".into(), (libm::cbrt(square / freedom) - 1.0 + spread) / spread.sqrt()));
    all
}

/// What is beyond the bound.
fn beyond(noise: &Noise, tile: usize) -> Vec<String> {
    let told = |(name, off): (String, f64)| (off.abs() > SIGMAS).then(|| format!("{name}: {off:.1}"));
    statistics(noise, tile).into_iter().filter_map(told).collect()
}

/// A plane that fills the picture, under a sky, seen at an angle.
fn plane(size: u32) -> Model {
    let corner = |x: f64, z: f64| DVec3::new(50.0 * x, 0.0, 50.0 * z);
    let white = Material { colour: DVec3::splat(0.9), ..Material::default() };
    Model {
        positions: vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)],
        triangles: [[0, 2, 1], [0, 3, 2]].map(|vertices| Triangle { vertices, normals: None, material: 0 }).into(),
        materials: vec![white],
        camera: Camera {
            position: DVec3::new(1.0, 9.0, 6.0),
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 8.0 },
        },
        background: Background::Sky { bottom: DVec3::ZERO, top: DVec3::ONE },
        render: RenderSettings { size: [size; 2], paths: true, ..RenderSettings::default() },
        ..Model::default()
    }
}

/// The same of spheres: so small a part of a matt one that all of its pixels see as much of another one that shines.
fn spheres(size: u32) -> Model {
    let shining = Material { emission: DVec3::ONE, colour: DVec3::ZERO, ..Material::default() };
    let sphere = |x, material| Sphere { centre: DVec3::new(x, 0.0, 0.0), radius: 1.0, material };
    let mut model = plane(size);
    (model.spheres, model.triangles, model.positions) = (vec![sphere(-1.1, 0), sphere(1.1, 1)], vec![], vec![]);
    model.materials.push(shining);
    model.background = DVec3::ZERO.into();
    model.camera.position = DVec3::new(-0.5, 0.0, 3.0);
    model.camera.look_at = DVec3::new(-0.5, 0.0, 0.0);
    model.camera.projection = Projection::Orthographic { height: 0.004 };
    model
}

/// The light of samples of a picture that is rendered tile by tile.
fn rendered(engine: &dyn Engine, model: &Model, samples: std::ops::Range<u16>, tile: u16) -> Vec<f64> {
    let size = model.render.size.map(|side| side as u16);
    let blob = engine.prepare(model, &Options::default()).expect("it fits").blob;
    let stage = engine.stage(blob.bytes()).expect("a blob just made");
    let mut light = vec![0.0; usize::from(size[0]) * usize::from(size[1])];
    for tile in Tile::of(size, [tile; 2]) {
        let mut sums = vec![Sum::default(); tile.pixels()];
        stage.add_samples(tile, samples.clone(), &mut sums);
        for (sum, [x, y]) in sums.iter().zip(tile.places()) {
            light[usize::from(y) * usize::from(size[0]) + usize::from(x)] = f64::from(sum[0]);
        }
    }
    light
}

#[test]
fn no_edge_of_a_tile_shows() {
    let (plane, spheres) = (plane(SIDE as u32), spheres(SIDE as u32));
    for kernel in ["exact14", "exact29", "hanika-cons", "f32", "planes12"] {
        let engine = engine::by_name(kernel).expect("a kernel of this name");
        let model = if kernel == "planes12" { &spheres } else { &plane };
        for samples in [0..1, 1..2, 0..4] {
            let noise = Noise::new(rendered(engine, model, samples.clone(), 32));
            for tile in [8, 16, 32] {
                let beyond = beyond(&noise, tile);
                assert!(beyond.is_empty(), "{kernel}, samples {samples:?}, tiles of {tile}: {beyond:?}");
            }
        }
    }
}

/// A renderer whose numbers begin anew in every tile: what it draws is one tile, again and again.
#[test]
fn seeds_that_are_the_same_in_every_tile_are_found() {
    let engine = engine::by_name("exact29").expect("a kernel of this name");
    for tile in [8usize, 16, 32] {
        let one = rendered(engine, &plane(tile as u32), 0..1, tile as u16);
        let repeated = |pixel: usize| one[pixel / SIDE % tile * tile + pixel % SIDE % tile];
        let found = beyond(&Noise::new((0..SIDE * SIDE).map(repeated)), tile);
        println!("{tile}: {found:?}");
        for name in ["place in a tile", "correlation with the tile right", "correlation with the tile down"] {
            assert!(found.iter().any(|told| told.starts_with(name)), "{tile}, {name}: {found:?}");
        }
    }
}

/// A renderer with another seed for each tile, which spreads its numbers well within one: the seams are where it does not.
#[test]
fn seeds_of_tiles_with_a_sequence_each_are_found() {
    for tile in [8usize, 16, 32] {
        let light = |pixel: usize| {
            let (x, y) = (pixel % SIDE, pixel / SIDE);
            let of = Sample { pixel: [(x / tile) as u16, (y / tile) as u16], number: 0 };
            // The golden ratio's multiples, from a random start.
            let number = ((y % tile) * tile + x % tile) as u32;
            f64::from(of.numbers(1)[1].wrapping_add(number.wrapping_mul(0x9e37_79b9)))
        };
        let found = beyond(&Noise::new((0..SIDE * SIDE).map(light)), tile);
        println!("{tile}: {found:?}");
        for name in ["contrast to the tile right", "correlation with the pixel right"] {
            assert!(found.iter().any(|told| told.starts_with(name)), "{tile}, {name}: {found:?}");
        }
    }
}

/// Every other column of tiles is brighter, by half of the grain's deviation.
#[test]
fn tiles_of_their_own_brightness_are_found() {
    let engine = engine::by_name("exact29").expect("a kernel of this name");
    let fair = Noise::new(rendered(engine, &plane(SIDE as u32), 0..1, 32));
    let step = |(pixel, light): (usize, &f64)| light + if pixel % SIDE % 32 < 16 { 0.5 } else { 0.0 };
    let found = beyond(&Noise::new(fair.0.iter().enumerate().map(step)), 16);
    assert!(found.iter().any(|told| told.starts_with("correlation with the tile right")), "{found:?}");
}
