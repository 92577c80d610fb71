//! On AVX2.

mod collapse;
mod exact29;
mod float32;
mod product;
mod search;
mod sphere29;
mod tree;
mod walk;

use core_rt::bvh::{Bvh, Intersect, Stack};
use core_rt::exact::{Exact29, Ray, Width29};
use core_rt::profile::Profile;
use core_rt::stats::Stats;
use float_rt::Float32;

use tree::Wide;

/// A scene of `exact29` with eight children a node. Made only where the processor has AVX2 ([`unit`](crate::unit)).
#[derive(Clone, Debug)]
pub struct Tree(Wide<i32, { exact29::ROWS }>);

impl Tree {
    /// Of the tree of a checked scene; `None` where the processor lacks what it takes.
    #[must_use]
    pub fn new<P: Profile<Kernel = Exact29>>(bvh: &Bvh<'_, P>) -> Option<Self> {
        crate::unit().map(|_| Self(Wide::new(bvh)))
    }

    /// The nearest hit in the scene that it was made of: [`Intersect::closest`]'s. Boxes and triangles are counted as the lanes
    /// are that test them.
    pub fn closest<P: Profile<Kernel = Exact29>>(
        &self,
        bvh: &Bvh<'_, P>,
        ray: &Ray<Width29>,
        stack: &mut Stack<Exact29>,
        stats: &mut impl Stats,
    ) -> u32 {
        if !exact29::holds(ray) {
            return bvh.closest(ray, stack, stats);
        }
        // SAFETY: the field is private, and `new` makes it only where the processor has AVX2, which is all that the function
        // asks for.
        #[allow(unsafe_code)]
        unsafe {
            exact29::closest((&self.0, bvh), ray, stats)
        }
    }

    /// Whether anything that is hit blocks: [`Intersect::any`]'s, asked in another order.
    pub fn any<P: Profile<Kernel = Exact29>>(
        &self,
        bvh: &Bvh<'_, P>,
        ray: &Ray<Width29>,
        stack: &mut Stack<Exact29>,
        stats: &mut impl Stats,
        blocks: impl FnMut(u32) -> bool,
    ) -> bool {
        if !exact29::holds(ray) {
            return bvh.any(ray, stack, stats, blocks);
        }
        // SAFETY: as above.
        #[allow(unsafe_code)]
        unsafe {
            exact29::any((&self.0, bvh), ray, stats, blocks)
        }
    }
}

/// A scene of `f32` in the same layout. Made only where the processor has AVX2 ([`unit`](crate::unit)).
#[derive(Clone, Debug)]
pub struct Tree32(Wide<f32, { float32::ROWS }>);

impl Tree32 {
    /// Of the tree of a checked scene; `None` where the processor lacks what it takes.
    #[must_use]
    pub fn new<P: Profile<Kernel = Float32>>(bvh: &Bvh<'_, P>) -> Option<Self> {
        crate::unit().map(|_| Self(Wide::new(bvh)))
    }

    /// The nearest hit in the scene that it was made of.
    pub fn closest<P: Profile<Kernel = Float32>>(
        &self,
        bvh: &Bvh<'_, P>,
        ray: &float_rt::Ray<f32>,
        stats: &mut impl Stats,
    ) -> u32 {
        // SAFETY: as for `Tree`.
        #[allow(unsafe_code)]
        unsafe {
            float32::closest((&self.0, bvh), ray, stats)
        }
    }
}
