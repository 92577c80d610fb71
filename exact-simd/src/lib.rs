//! x
mod collapse;
mod exact29;
mod float32;
mod search;
mod tree;
mod walk;

use core_rt::bvh::Bvh;
use core_rt::exact::{Exact29, Ray, Width29};
use core_rt::profile::Profile;
use core_rt::stats::Stats;

/// T.
#[derive(Clone, Debug)]
pub struct Tree(tree::Wide<i32, { exact29::ROWS }>);

impl Tree {
    /// N.
    pub fn new<P: Profile<Kernel = Exact29>>(bvh: &Bvh<'_, P>) -> Option<Self> {
        if !std::arch::is_x86_feature_detected!("avx2") {
            return None;
        }
        let (tree, _waiting) = tree::Wide::new(bvh);
        Some(Self(tree))
    }
    /// C.
    pub fn closest<P: Profile<Kernel = Exact29>>(&self, bvh: &Bvh<'_, P>, ray: &Ray<Width29>, stats: &mut impl Stats) -> u32 {
        unsafe { exact29::closest((&self.0, bvh), ray, stats) }
    }
    /// A.
    pub fn any<P: Profile<Kernel = Exact29>>(&self, bvh: &Bvh<'_, P>, ray: &Ray<Width29>, stats: &mut impl Stats, blocks: impl FnMut(u32) -> bool) -> bool {
        unsafe { exact29::any((&self.0, bvh), ray, stats, blocks) }
    }
}

/// F.
#[derive(Clone, Debug)]
pub struct Tree32(tree::Wide<f32, { float32::ROWS }>);

impl Tree32 {
    /// N.
    pub fn new<P: Profile<Kernel = float_rt::Float32>>(bvh: &Bvh<'_, P>) -> Option<Self> {
        if !std::arch::is_x86_feature_detected!("avx2") {
            return None;
        }
        Some(Self(tree::Wide::new(bvh).0))
    }
    /// C.
    pub fn closest<P: Profile<Kernel = float_rt::Float32>>(&self, bvh: &Bvh<'_, P>, ray: &float_rt::Ray<f32>, stats: &mut impl Stats) -> u32 {
        unsafe { float32::closest((&self.0, bvh), ray, stats) }
    }
}
