//! Eights as a way to walk, for everything that draws.

use core_rt::bvh::{Bvh, Intersect, Stack, Walk};
use core_rt::camera::Camera;
use core_rt::exact::{Exact29, Ray, Width29};
use core_rt::profile::{Need, Needs, Profile};
use core_rt::render::Tile;
use core_rt::scene::Scene;
use core_rt::stats::Stats;

use crate::Tree;

/// Everything, by `exact29`, by eights where there is a tree for them.
#[derive(Clone, Copy, Debug, Default)]
pub struct ByEights;

impl Profile for ByEights {
    type Kernel = Exact29;
    type Walk<'a> = Eights<'a>;
    const NEEDS: Needs = Needs::ALL;
}

/// What rays walk: the tree as it stands, and by eights what goes that way.
#[derive(Clone, Copy, Debug, Default)]
pub struct Eights<'a> {
    tree: Option<&'a Tree>,
    /// Whether surfaces between a point and a light are asked about in the order of the blob's tree: the tints of several are
    /// multiplied with rounding.
    is_ordered: bool,
    /// Whether tiles of camera rays walk the blob's tree together.
    has_tiles: bool,
}

impl<'a> Eights<'a> {
    /// Tiles of camera rays walk together where there are so many pixels a triangle or more. Rays in ns on the shared
    /// scenes, together and by eights, by pixels a triangle: 0.6 (coffee): 690, 150; 2.1 (bunny): 300, 220; 2.2
    /// (sponza): 240, 720; 23 (teapot): 16, 136.
    const TILE_PIXELS: usize = 2;

    /// For a scene, by the tree that was made of it, if one was.
    #[must_use]
    pub fn new(tree: Option<&'a Tree>, scene: &Scene<'_, ByEights>) -> Self {
        let pixels = scene.frame.size.map(usize::from).iter().product::<usize>();
        Self {
            tree,
            is_ordered: scene.frame.needs.has(Need::TintedShadow),
            has_tiles: pixels >= Self::TILE_PIXELS * scene.bvh.triangles.len() as usize,
        }
    }
}

impl<P: Profile<Kernel = Exact29>> Walk<P> for Eights<'_> {
    #[inline]
    fn over<'w>(&'w self, bvh: &'w Bvh<'w, P>) -> impl Intersect<Exact29> + 'w {
        Over { way: *self, bvh }
    }
}

struct Over<'w, P: Profile> {
    way: Eights<'w>,
    bvh: &'w Bvh<'w, P>,
}

impl<P: Profile<Kernel = Exact29>> Intersect<Exact29> for Over<'_, P> {
    #[inline]
    fn closest(&self, ray: &Ray<Width29>, stack: &mut Stack<Exact29>, stats: &mut impl Stats) -> u32 {
        match self.way.tree {
            Some(tree) => tree.closest(self.bvh, ray, stack, stats),
            None => self.bvh.closest(ray, stack, stats),
        }
    }

    #[inline]
    fn any(
        &self,
        ray: &Ray<Width29>,
        stack: &mut Stack<Exact29>,
        stats: &mut impl Stats,
        blocks: impl FnMut(u32) -> bool,
    ) -> bool {
        match self.way.tree.filter(|_| !self.way.is_ordered) {
            Some(tree) => tree.any(self.bvh, ray, stack, stats, blocks),
            None => self.bvh.any(ray, stack, stats, blocks),
        }
    }

    fn closest_tile(
        &self,
        camera: Option<&Camera<i64>>,
        ray: impl Fn([u16; 2]) -> Option<Ray<Width29>>,
        tile: Tile,
        hits: &mut [u32],
        room: &mut [u8],
        stack: &mut Stack<Exact29>,
        stats: &mut impl Stats,
    ) {
        if self.way.tree.is_none() || (self.way.has_tiles && camera.is_some()) {
            return self.bvh.closest_tile(camera, ray, tile, hits, room, stack, stats);
        }
        for (hit, place) in hits.iter_mut().zip(tile.places()) {
            *hit = ray(place).map_or(core_rt::kernel::NONE, |ray| self.closest(&ray, stack, stats));
        }
    }
}
