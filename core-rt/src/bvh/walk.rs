//! How rays find what they hit: by the tree of the blob, or by what a host made of it.

use core::fmt::Debug;

use super::{Bvh, Intersect, Stack};
use crate::camera::Camera;
use crate::kernel::Kernel;
use crate::profile::Profile;
use crate::render::Tile;
use crate::stats::Stats;

/// How the rays of a profile find what they hit: in the tree as it stands in the blob, or in what was made of it beforehand.
///
/// What they find is the same.
pub trait Walk<P: Profile>: Copy + Debug + Default + Send + Sync {
    /// What finds it.
    fn over<'w>(&'w self, bvh: &'w Bvh<'w, P>) -> impl Intersect<P::Kernel> + 'w;
}

/// In the tree as it stands.
#[derive(Clone, Copy, Debug, Default)]
pub struct InPlace;

impl<P: Profile> Walk<P> for InPlace {
    #[inline(always)]
    fn over<'w>(&'w self, bvh: &'w Bvh<'w, P>) -> impl Intersect<P::Kernel> + 'w {
        bvh
    }
}

impl<K: Kernel, T: Intersect<K>> Intersect<K> for &T {
    #[inline(always)]
    fn closest(&self, ray: &K::Ray, stack: &mut Stack<K>, stats: &mut impl Stats) -> u32 {
        (**self).closest(ray, stack, stats)
    }

    #[inline(always)]
    fn any(&self, ray: &K::Ray, stack: &mut Stack<K>, stats: &mut impl Stats, blocks: impl FnMut(u32) -> bool) -> bool {
        (**self).any(ray, stack, stats, blocks)
    }

    #[inline(always)]
    fn closest_tile(
        &self,
        camera: Option<&Camera<K::Word>>,
        ray: impl Fn([u16; 2]) -> Option<K::Ray>,
        tile: Tile,
        hits: &mut [u32],
        room: &mut [u8],
        stack: &mut Stack<K>,
        stats: &mut impl Stats,
    ) {
        (**self).closest_tile(camera, ray, tile, hits, room, stack, stats);
    }
}
