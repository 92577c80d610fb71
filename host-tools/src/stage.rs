//! A scene whose camera moves: a blob checked once, and drawn tile by tile from wherever one looks.
//!
//! Grid, tree and records do not depend on the camera but for how fine the grid can be, since the camera has to be on it too.
//! So a camera that the grid of a blob reaches needs no new blob, and where the grid is the one that the kernel would
//! have for that camera, the picture is that of a blob made for it, bit for bit.

use std::ops::Range;

use core_rt::blob::Header;
use core_rt::camera::{Camera, Use};
use core_rt::kernel::{Bounds, Kernel};
use core_rt::path::{self, Sum};
use core_rt::profile::{Full, Need};
use core_rt::record::Light;
use core_rt::render::Tile;
use core_rt::scene::{MAX_DEPTH, Scene, Shading};
use core_rt::stats::Counts;

use crate::grid::Grid;
use crate::model::{Model, Projection};
use crate::pixels::rgb888;
use crate::prepare;
use crate::render::one_tile;
use crate::trace::source_grid;

/// Whatever draws a blob's scene through other cameras than its own.
pub trait Stage: Send + Sync + std::fmt::Debug {
    /// The grid that the blob was made on.
    fn grid(&self) -> Grid;

    /// Looks through the camera of a model, in its size and with its number of samples; lights are where it has them. All
    /// else of the model is what the blob was made from.
    ///
    /// False, and nothing is changed, where the grid does not reach so far, or the model's rays are not of the blob's kind.
    fn look(&mut self, model: &Model) -> bool;

    /// The pixels of a tile, row by row, and the work that they took. The tile lies in the picture of the last
    /// [`look`](Stage::look).
    fn tile(&self, tile: Tile) -> (Vec<[u8; 3]>, Counts);

    /// Whether it draws by paths, and so samples can be summed.
    fn follows_paths(&self) -> bool {
        false
    }

    /// What a white sample adds to a sum: a kernel sums in its own words.
    fn white(&self) -> u32 {
        1 << 16
    }

    /// Adds samples, by their numbers, of each pixel of a tile to sums, row by row, a sum a pixel; and the work that they took.
    /// Sums do not depend on the ranges that samples are added in. Nothing is added where no paths are followed.
    fn add_samples(&self, tile: Tile, samples: Range<u16>, sums: &mut [Sum]) -> Counts {
        let _ = (tile, samples, sums);
        Counts::default()
    }

    /// The pixels of a tile whose sums are of so many samples: after `0..n` samples those of [`tile`](Stage::tile) for a
    /// model with n. Where no paths are followed, those as they are.
    fn mean(&self, tile: Tile, sums: &[Sum], samples: u16) -> Vec<[u8; 3]> {
        let _ = (sums, samples);
        self.tile(tile).0
    }
}

/// A blob's scene, drawn by its kernel.
#[derive(Debug)]
pub(crate) struct Staged<'a, K: Kernel> {
    scene: Scene<'a, Full<K>>,
    lights: Vec<Light>,
    grid: Grid,
    bounds: Bounds,
}

impl<'a, K: Kernel> Staged<'a, K> {
    /// A checked scene; `None` where its header places its grid nowhere.
    pub(crate) fn new(scene: Scene<'a, Full<K>>, header: &Header) -> Option<Self> {
        let bounds = scene.bvh.bounds().reduce(|a, b| a.union(&b))?;
        Some(Self { lights: scene.shading.lights.to_vec(), grid: source_grid(&header.source)?, scene, bounds })
    }

    /// With the lights where they are now.
    fn scene(&self) -> Scene<'_, Full<K>> {
        Scene { shading: Shading { lights: &self.lights, ..self.scene.shading }, ..self.scene }
    }
}

impl<K: Kernel> Stage for Staged<'_, K> {
    fn grid(&self) -> Grid {
        self.grid
    }

    fn look(&mut self, model: &Model) -> bool {
        let needs = self.scene.frame.needs;
        let [Ok(width), Ok(height)] = model.render.size.map(u16::try_from) else { return false };
        let Ok(samples) = u16::try_from(model.render.samples) else { return false };
        let parallel = matches!(model.camera.projection, Projection::Orthographic { .. });
        let paths = needs.has(Need::Paths);
        let used = Use { size: [width, height], parallel, sampled: samples > 1 || paths };
        if used.parallel != needs.has(Need::Orthographic)
            || model.render.paths != paths
            || samples > 1 && !paths && !needs.has(Need::Supersampling)
            || used.size.contains(&0)
            || samples == 0
        {
            return false;
        }
        let header = prepare::camera::<K>(model, &self.grid);
        let Some(camera) = Camera::new::<K>(&header, used) else { return false };
        let lights: Vec<Light> = model.lights.iter().map(|light| prepare::light(light, &self.grid)).collect();
        let kind = |light: &Light| light.kind;
        let reached = |light: &Light| light.kind != Light::POINT || self.bounds.spanned_from(light.place, K::SPAN);
        if !lights.iter().map(kind).eq(self.lights.iter().map(kind))
            || !lights.iter().all(reached)
            || !header.starts_within(used, &self.bounds, K::SPAN)
        {
            return false;
        }
        (self.scene.camera, self.lights) = (camera, lights);
        (self.scene.frame.size, self.scene.frame.samples) = (used.size, samples);
        true
    }

    fn tile(&self, tile: Tile) -> (Vec<[u8; 3]>, Counts) {
        let scene = self.scene();
        let mut counts = Counts::default();
        let pixels = one_tile(&scene, tile, &mut counts);
        (rgb888(scene.frame.format, &pixels), counts)
    }

    fn follows_paths(&self) -> bool {
        self.scene.follows_paths()
    }

    fn add_samples(&self, tile: Tile, samples: Range<u16>, sums: &mut [Sum]) -> Counts {
        let mut counts = Counts::default();
        let mut stack = heapless::Vec::<(u32, K::Distance), MAX_DEPTH>::new();
        let added = path::add_samples(&self.scene(), tile, samples, &mut stack, sums, &mut counts);
        // The stack is as deep as any tree.
        debug_assert!(added.is_ok());
        counts
    }

    fn mean(&self, tile: Tile, sums: &[Sum], samples: u16) -> Vec<[u8; 3]> {
        if !self.follows_paths() {
            return self.tile(tile).0;
        }
        let format = self.scene.frame.format;
        let mut pixels = vec![0; tile.pixels() * format.bytes()];
        path::show(&self.scene, tile, sums, samples, &mut pixels);
        rgb888(format, &pixels)
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::engine::{ENGINES, Engine};
    use crate::model::{Camera, LightKind};
    use crate::picture::Picture;
    use crate::prepare::{Blob, Options};
    use crate::render::TILE;
    use crate::{builtin, import};

    fn model(samples: u32) -> Model {
        let mut model = import::load_from(&import::Embedded(builtin::FILES), "scene.toml").unwrap().model;
        (model.render.size, model.render.samples) = ([24, 18], samples);
        model
    }

    fn seen_from(model: &Model, position: [f64; 3]) -> Model {
        let camera = Camera { position: position.into(), ..model.camera };
        Model { camera, ..model.clone() }
    }

    fn blob(engine: &dyn Engine, model: &Model) -> Blob {
        engine.prepare(model, &Options::default()).unwrap().blob
    }

    fn drawn(stage: &dyn Stage, model: &Model) -> Picture {
        let [width, height] = model.render.size;
        let mut picture = Picture::new(width, height);
        for tile in Tile::of([width as u16, height as u16], [7, 5]) {
            for ([x, y], pixel) in tile.places().zip(stage.tile(tile).0) {
                picture.pixels_mut()[usize::from(y) * width as usize + usize::from(x)] = pixel;
            }
        }
        picture
    }

    #[test]
    fn on_one_grid_the_picture_is_that_of_a_blob_for_the_camera() {
        for (samples, format) in [(1, crate::model::Format::Rgb888), (2, crate::model::Format::Rgb565)] {
            let mut model = model(samples);
            model.render.format = format;
            for engine in ENGINES {
                let blob_of_all = blob(engine, &model);
                let mut stage = engine.stage(blob_of_all.bytes()).unwrap();
                let mut on_one_grid = 0;
                for (position, size) in
                    [([0.1, 1.1, 3.0], [24, 18]), ([0.5, 0.7, 0.2], [9, 30]), ([0.0, 1.0, 3.82], [1, 1])]
                {
                    let mut moved = seen_from(&model, position);
                    moved.render.size = size;
                    moved.lights[0].kind = LightKind::Point(DVec3::from(position) * 0.9);
                    assert!(stage.look(&moved), "{} {position:?}", engine.name());
                    if engine.grid(&moved, None).unwrap() == stage.grid() {
                        let expected = engine.render(blob(engine, &moved).bytes(), TILE, &|_| ()).unwrap().picture;
                        assert_eq!(drawn(stage.as_ref(), &moved), expected, "{} {position:?}", engine.name());
                        on_one_grid += 1;
                    }
                }
                assert!(on_one_grid > 0, "{}", engine.name());
            }
        }
    }

    #[test]
    fn what_is_out_of_reach_is_refused_and_changes_nothing() {
        let model = model(2);
        for engine in ENGINES {
            let blob = blob(engine, &model);
            let mut stage = engine.stage(blob.bytes()).unwrap();
            assert!(stage.look(&model));
            let before = drawn(stage.as_ref(), &model);
            let far = seen_from(&model, [0.0, 1.0, 1e4]);
            let mut lit_from_afar = model.clone();
            lit_from_afar.lights[0].kind = LightKind::Point(DVec3::splat(-1e4));
            let mut lit_otherwise = model.clone();
            lit_otherwise.lights[0].kind = LightKind::Directional(DVec3::NEG_Y);
            let mut parallel = model.clone();
            parallel.camera.projection = Projection::Orthographic { height: 1.0 };
            let mut empty = model.clone();
            empty.render.size = [0, 9];
            for other in [far, lit_from_afar, lit_otherwise, parallel, empty] {
                assert!(!stage.look(&other), "{}", engine.name());
                assert_eq!(drawn(stage.as_ref(), &model), before, "{}", engine.name());
            }
            // Fewer samples are possible, more are not where the blob says there is one.
            assert!(stage.look(&self::model(1)));
        }
        let blob = blob(ENGINES[0], &self::model(1));
        assert!(!ENGINES[0].stage(blob.bytes()).unwrap().look(&model));
    }
}
