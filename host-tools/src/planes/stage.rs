//! Spheres whose camera moves: their words are made anew for each, which takes no time.

use std::ops::Range;

use core_rt::path::Sum;
use core_rt::render::Tile;
use core_rt::stats::Counts;
use planes_rt::colour::{LIGHT_MAX, encode, mean};
use planes_rt::pixel;
use planes_rt::scene::{Sample, Scene};

use super::scene::{Options, Planes};
use crate::grid::Grid;
use crate::model::{Model, Transfer};
use crate::prepare::transfer;
use crate::stage::Stage;

/// A blob's scene, or that of the model that was last looked at.
#[derive(Debug)]
pub(crate) struct Staged<'a> {
    first: (Scene<'a>, Grid),
    moved: Option<Planes>,
    encoding: Transfer,
}

impl<'a> Staged<'a> {
    pub(crate) fn new(scene: Scene<'a>, place: Grid, encoding: Transfer) -> Self {
        Self { first: (scene, place), moved: None, encoding }
    }

    /// What is looked at: it was checked.
    fn scene(&self) -> Scene<'_> {
        self.moved.as_ref().and_then(|planes| planes.scene().ok()).unwrap_or(self.first.0)
    }
}

impl Stage for Staged<'_> {
    fn grid(&self) -> Grid {
        self.moved.as_ref().map_or(self.first.1, Planes::place)
    }

    fn look(&mut self, model: &Model) -> bool {
        let Ok(planes) = Planes::new(model, &Options::default()) else { return false };
        if planes.scene().is_err() {
            return false;
        }
        (self.moved, self.encoding) = (Some(planes), model.render.transfer);
        true
    }

    fn tile(&self, tile: Tile) -> (Vec<[u8; 3]>, Counts) {
        let scene = self.scene();
        let mut counts = Counts::default();
        let pixels = tile.places().map(|place| {
            counts.primary_rays += u64::from(scene.settings().samples);
            encode(pixel::trace(&scene, place), transfer(self.encoding))
        });
        (pixels.collect(), counts)
    }

    fn follows_paths(&self) -> bool {
        self.scene().settings().paths
    }

    fn white(&self) -> u32 {
        LIGHT_MAX.into()
    }

    fn add_samples(&self, tile: Tile, samples: Range<u16>, sums: &mut [Sum]) -> Counts {
        let scene = self.scene();
        let mut counts = Counts::default();
        if !scene.settings().paths {
            return counts;
        }
        for (sum, place) in sums.iter_mut().zip(tile.places()) {
            for number in samples.clone() {
                counts.primary_rays += 1;
                let light = pixel::trace_telling(&scene, place, Sample::numbered(number), |met| {
                    counts.reflection_rays += u64::from(met.is_seen);
                });
                // Less than 2^16 of them are below 2^28.
                for (sum, light) in sum.iter_mut().zip(light) {
                    *sum = sum.saturating_add(light.into());
                }
            }
        }
        counts
    }

    fn mean(&self, tile: Tile, sums: &[Sum], samples: u16) -> Vec<[u8; 3]> {
        if !self.follows_paths() {
            return self.tile(tile).0;
        }
        sums.iter().map(|&sum| encode(mean(sum, samples), transfer(self.encoding))).collect()
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::engine::PLANES12;
    use crate::model::Sphere;
    use crate::prepare;

    #[test]
    fn what_is_looked_at_is_what_a_blob_for_it_shows() {
        let sphere = Sphere { centre: DVec3::ZERO, radius: 0.5, material: 0 };
        let mut model = Model { spheres: vec![sphere], ..Model::default() };
        model.render.size = [16, 12];
        let blob = |model: &Model| PLANES12.prepare(model, &prepare::Options::default()).unwrap().blob;
        let first = blob(&model);
        let mut stage = PLANES12.stage(first.bytes()).unwrap();
        model.camera.position = DVec3::new(0.4, 0.3, 1.5);
        assert!(stage.look(&model));
        let tile = Tile { x: 0, y: 0, width: 16, height: 12 };
        let expected = PLANES12.render(blob(&model).bytes(), [8, 8], &|_| ()).unwrap().picture;
        assert_eq!(stage.tile(tile).0, expected.pixels());
        assert!(!stage.look(&Model { spheres: Vec::new(), ..model }));
    }

    #[test]
    fn samples_of_paths_add_up_to_the_picture_of_all_of_them() {
        let sphere = |x| Sphere { centre: DVec3::new(x, 0.0, 0.0), radius: 0.5, material: 0 };
        let mut model = Model { spheres: vec![sphere(-0.6), sphere(0.6)], ..Model::default() };
        (model.render.size, model.render.samples, model.render.paths) = ([16, 12], 11, true);
        model.background = DVec3::splat(0.5).into();
        model.camera.position = DVec3::new(0.0, 0.0, 3.0);
        let blob = PLANES12.prepare(&model, &prepare::Options::default()).unwrap().blob;
        let stage = PLANES12.stage(blob.bytes()).unwrap();
        let tile = Tile { x: 3, y: 2, width: 9, height: 8 };
        let mut sums = vec![[0; 3]; tile.pixels()];
        for samples in [0..1, 1..7, 7..11] {
            stage.add_samples(tile, samples, &mut sums);
        }
        let expected = stage.tile(tile).0;
        assert_eq!(stage.mean(tile, &sums, 11), expected);
        // Those of others are another picture.
        sums.fill([0; 3]);
        stage.add_samples(tile, 11..22, &mut sums);
        assert_ne!(stage.mean(tile, &sums, 11), expected);
        assert!(sums.iter().flatten().all(|&sum| sum <= 11 * stage.white()));
    }
}
