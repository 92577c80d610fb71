//! Spheres whose camera moves: their words are made anew for each, which takes no time.

use core_rt::render::Tile;
use core_rt::stats::Counts;
use planes_rt::colour::encode;
use planes_rt::pixel;
use planes_rt::scene::Scene;

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
        let moved = self.moved.as_ref().and_then(|planes| planes.scene().ok());
        let scene = moved.as_ref().unwrap_or(&self.first.0);
        let mut counts = Counts::default();
        let pixels = tile.places().map(|place| {
            counts.primary_rays += 1;
            encode(pixel::trace(scene, place), transfer(self.encoding))
        });
        (pixels.collect(), counts)
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
}
