//! A scene whose camera moves: a blob checked once, and drawn tile by tile from wherever one looks.
//!
//! Grid, tree and records do not depend on the camera but for how fine the grid can be, since the camera has to be on it too.
//! So a camera that the grid of a blob reaches needs no new blob, and where the grid is the one that the kernel would
//! have for that camera, the picture is that of a blob made for it, bit for bit.

use core_rt::blob::Header;
use core_rt::camera::{Camera, Use};
use core_rt::kernel::{Bounds, Kernel};
use core_rt::profile::{Full, Need};
use core_rt::record::Light;
use core_rt::render::Tile;
use core_rt::scene::{Scene, Shading};
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
        let used = Use { size: [width, height], parallel, sampled: samples > 1 };
        if used.parallel != needs.has(Need::Orthographic)
            || used.sampled && !needs.has(Need::Supersampling)
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
        let scene = Scene { shading: Shading { lights: &self.lights, ..self.scene.shading }, ..self.scene };
        let mut counts = Counts::default();
        let pixels = one_tile(&scene, tile, &mut counts);
        (rgb888(scene.frame.format, &pixels), counts)
    }
}
