//! The golden model: nearest hits of rays in scene units, by any kernel.
//!
//! A ray is brought to what the kernel computes with, and the hit back:
//!
//! - The origin becomes the nearest grid point. Where the kernel cannot hold that, the origin is first moved along the
//!   ray to the box of those that it can, which holds the whole grid and no geometry at its faces; a ray that misses
//!   the box misses. Beyond the move along the ray that is less than one grid unit.
//! - The direction is scaled by the power of two for which its largest component has all bits that the kernel takes,
//!   and rounded to nearest (below 2^[`DIRECTION_BITS`](Kernel::DIRECTION_BITS), so less than one unit off). Where the
//!   significant bits of its components fit, nothing is lost. Any length but zero will do.
//! - What the kernel finds (exactly, where it is an exact one) becomes f64 by one division, and `t` the one for which
//!   `point = origin + t direction`, of the direction that was given, is nearest, the rounding of the origin aside. A
//!   `t` that f64 cannot hold is infinite.

mod measure;
mod reach;
mod rows;

pub use measure::{Measure, Measured};
pub use rows::{HITS_HEADER, RAYS_HEADER, Rays, RaysError, write_hit};

use core_rt::blob::SourceGrid;
use core_rt::bvh::Intersect;
use core_rt::kernel::{Bounds, Kernel, NONE};
use core_rt::num::{Triple, Word};
use core_rt::profile::Full;
use core_rt::scene::{MAX_DEPTH, Scene};
use core_rt::stats::NoStats;
use glam::DVec3;

use crate::grid::Grid;
use crate::reference::{Hit, Reference};
use reach::Reach;

/// Whatever finds the nearest hit of a ray given in scene units.
pub trait Trace: Sync {
    /// The nearest hit; `None` for a miss, and for a ray that is not finite or has no direction.
    fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit>;
}

/// The undiscretised scene.
impl Trace for Reference<'_> {
    fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        Reference::nearest(self, origin, direction)
    }
}

/// A blob's scene, traced by its kernel.
#[derive(Clone, Debug)]
pub struct Tracer<'a, K: Kernel> {
    scene: Scene<'a, Full<K>>,
    reach: Reach,
}

impl<'a, K: Measure> Tracer<'a, K> {
    const DIRECTION_MAX: DVec3 = DVec3::splat(((1u64 << K::DIRECTION_BITS) - 1) as f64);

    /// A checked scene, and where its header places its grid; `None` where that is nowhere.
    #[must_use]
    pub fn new(scene: Scene<'a, Full<K>>, source: &SourceGrid) -> Option<Self> {
        let grid = source_grid(source)?;
        let whole = scene.bvh.bounds().reduce(|a, b| a.union(&b))?;
        // Primitives keep the margin from the ends of the grid, and the span is the grid less one margin.
        let origins = Bounds { low: whole.high.map(|c| c - K::SPAN), high: whole.low.map(|c| c + K::SPAN) };
        Some(Self { scene, reach: Reach::new(grid, &origins) })
    }
}

impl<K: Measure> Trace for Tracer<'_, K> {
    fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let Scaled { step, exponent } = Scaled::new(direction)?;
        let (start, skipped) = self.reach.enter(Some(origin).filter(|o| o.is_finite())?, step)?;
        let direction = step * (1u64 << K::DIRECTION_BITS) as f64;
        let rounded = (direction + 0.5).floor().clamp(-Self::DIRECTION_MAX, Self::DIRECTION_MAX);
        let ray = K::ray(self.scene.settings, words::<K>((start + 0.5).floor())?, words::<K>(rounded)?, NONE)?;

        let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
        let bvh = &self.scene.bvh;
        let index = bvh.closest(&ray, &mut stack, &mut NoStats);
        let hit = match bvh.sphere(index) {
            Some(sphere) => K::measure_sphere(&ray, sphere)?,
            None => bvh.triangles.of(index, |triangle| K::measure(&ray, triangle))??,
        };
        // How often the direction goes into the kernel's, which is exactly 1 where they are the same.
        let share = hit.direction.dot(direction) / direction.length_squared();
        let steps = libm::ldexp(hit.t * share / self.reach.grid.scale, K::DIRECTION_BITS as i32);
        Some(Hit { t: libm::ldexp(skipped + steps, -exponent), prim: bvh.id(index), u: hit.u, v: hit.v })
    }
}

/// Whole numbers as a kernel's words.
fn words<K: Kernel>(whole: DVec3) -> Option<Triple<K::Word>> {
    let [x, y, z] = whole.to_array().map(|c| K::Word::from_i64(c as i64));
    Some([x?, y?, z?])
}

/// A direction as `step * 2^exponent`, with the largest component of `step` in [1/2, 1).
struct Scaled {
    step: DVec3,
    exponent: i32,
}

impl Scaled {
    fn new(direction: DVec3) -> Option<Self> {
        if direction == DVec3::ZERO || !direction.is_finite() {
            return None;
        }
        let (_, exponent) = libm::frexp(direction.abs().max_element());
        Some(Self { step: DVec3::from_array(direction.to_array().map(|c| libm::ldexp(c, -exponent))), exponent })
    }
}

/// The grid that a header says a blob was made on; `None` where that is none.
pub(crate) fn source_grid(source: &SourceGrid) -> Option<Grid> {
    let grid = Grid {
        origin: DVec3::from_array(source.origin_bits.map(f64::from_bits)),
        scale: f64::from_bits(source.scale_bits),
    };
    (grid.origin.is_finite() && grid.scale.is_finite() && grid.scale > 0.0).then_some(grid)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_length_of_a_direction_is_scaled_exactly() {
        let least = f64::from_bits(1);
        for (direction, step, exponent) in [
            ([1.0, 0.0, -0.5], [0.5, 0.0, -0.25], 1),
            ([-3.0, 1.0, 2.0], [-0.75, 0.25, 0.5], 2),
            ([0.0, least, 0.0], [0.0, 0.5, 0.0], -1073),
            (
                [f64::MAX, 0.0, libm::ldexp(1.0, 1000)],
                [f64::MAX / libm::ldexp(1.0, 1023) / 2.0, 0.0, libm::ldexp(1.0, -24)],
                1024,
            ),
        ] {
            let found = Scaled::new(DVec3::from_array(direction)).unwrap();
            assert_eq!((found.step.to_array(), found.exponent), (step, exponent), "{direction:?}");
        }
        for bad in [[0.0, -0.0, 0.0], [1.0, f64::NAN, 0.0], [0.0, 0.0, f64::INFINITY]] {
            assert!(Scaled::new(DVec3::from_array(bad)).is_none(), "{bad:?}");
        }
    }

    #[test]
    fn a_grid_that_is_none_is_refused() {
        let source = |origin: f64, scale: f64| SourceGrid {
            origin_bits: [0.0, origin, 0.0].map(f64::to_bits),
            scale_bits: scale.to_bits(),
        };
        assert_eq!(source_grid(&source(-7.5, 3.0)), Some(Grid { origin: DVec3::new(0.0, -7.5, 0.0), scale: 3.0 }));
        for (origin, scale) in [(f64::NAN, 1.0), (f64::INFINITY, 1.0), (0.0, 0.0), (0.0, -1.0), (0.0, f64::NAN)] {
            assert_eq!(source_grid(&source(origin, scale)), None, "{origin} {scale}");
        }
    }
}
