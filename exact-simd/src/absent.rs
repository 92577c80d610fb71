//! For machines of which no vector units are known here.

use core_rt::bvh::{Bvh, Stack};
use core_rt::exact::{Exact29, Ray, Width29};
use core_rt::profile::Profile;
use core_rt::stats::Stats;
use float_rt::Float32;

/// There is none.
#[derive(Clone, Copy, Debug)]
pub enum Tree {}

impl Tree {
    /// None.
    #[must_use]
    pub fn new<P: Profile<Kernel = Exact29>>(_: &Bvh<'_, P>) -> Option<Self> {
        None
    }

    /// Never called.
    pub fn closest<P: Profile<Kernel = Exact29>>(
        &self,
        _: &Bvh<'_, P>,
        _: &Ray<Width29>,
        _: &mut Stack<Exact29>,
        _: &mut impl Stats,
    ) -> u32 {
        match *self {}
    }

    /// Never called.
    pub fn any<P: Profile<Kernel = Exact29>>(
        &self,
        _: &Bvh<'_, P>,
        _: &Ray<Width29>,
        _: &mut Stack<Exact29>,
        _: &mut impl Stats,
        _: impl FnMut(u32) -> bool,
    ) -> bool {
        match *self {}
    }
}

/// There is none.
#[derive(Clone, Copy, Debug)]
pub enum Tree32 {}

impl Tree32 {
    /// None.
    #[must_use]
    pub fn new<P: Profile<Kernel = Float32>>(_: &Bvh<'_, P>) -> Option<Self> {
        None
    }

    /// Never called.
    pub fn closest<P: Profile<Kernel = Float32>>(
        &self,
        _: &Bvh<'_, P>,
        _: &float_rt::Ray<f32>,
        _: &mut impl Stats,
    ) -> u32 {
        match *self {}
    }
}
