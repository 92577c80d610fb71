//! Nearest hits of rays against the reference's: a hit is right if some ray that starts and ends within what the grid moves
//! points by has it too.

use glam::DVec3;
use rayon::prelude::*;

use super::promise::Promise;
use crate::grid::Grid;
use crate::reference::{Hit, Reference};
use crate::trace::Trace;

/// How many rays beside one are asked for.
const BESIDE: u32 = 4096;

/// What is wrong with hits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct StrayRays {
    /// Rays whose hit no ray beside them has.
    pub(super) rays: u64,
    /// Those of them that hit nothing where every ray beside them hits something.
    pub(super) holes: u64,
}

/// The rays of a case whose hits stray, in a scene of an extent, where directions that are rounded move a ray by as much as
/// `turned` across the grid; scene units.
pub(super) fn stray(
    rays: &[[DVec3; 2]],
    tracer: &dyn Trace,
    reference: &Reference<'_>,
    promise: &Promise,
    grid: &Grid,
    [extent, turned]: [f64; 2],
) -> StrayRays {
    let all = rays.par_iter().map(|&[origin, direction]| {
        let found = tracer.nearest(origin, direction);
        let expected = reference.nearest(origin, direction);
        // Its far end: behind the hits, and across the scene where it starts on one.
        let far = [expected, found].into_iter().flatten().map(|hit| hit.t).fold(extent / direction.length(), f64::max);
        // Both ends of the ray, and the triangles' corners.
        let off = (promise.seen + 1.0) / grid.scale;
        let mut depths = [f64::INFINITY, f64::NEG_INFINITY];
        let mut is_hole = found.is_none();
        let mut random = Steps(1);
        for beside in 0..BESIDE {
            let moved = |by: f64, random: &mut Steps| DVec3::new(random.next(), random.next(), random.next()) * by;
            let (start, end) = match beside {
                0 => (origin, origin + direction * far),
                _ => (origin + moved(off, &mut random), origin + direction * far + moved(off + turned, &mut random)),
            };
            let hit = reference.nearest(start, (end - start) / far);
            is_hole &= hit.is_some();
            match (found, hit) {
                (None, None) => return StrayRays::default(),
                (Some(found), Some(hit)) if same_or_tied(&found, &hit, reference, start, (end - start) / far) => {
                    depths = [depths[0].min(hit.t), depths[1].max(hit.t)];
                    // Along the ray a point is off by as much again, and by f64's own roundings.
                    let slack = off / direction.length() + turned / direction.length() + 1e-12 * far.abs();
                    if (depths[0] - slack..=depths[1] + slack).contains(&found.t) {
                        return StrayRays::default();
                    }
                }
                _ => {}
            }
        }
        StrayRays { rays: 1, holes: u64::from(is_hole) }
    });
    all.reduce(StrayRays::default, |a, b| StrayRays { rays: a.rays + b.rays, holes: a.holes + b.holes })
}

/// Whether two hits are of one primitive, or of two that lie in one place.
fn same_or_tied(found: &Hit, hit: &Hit, reference: &Reference<'_>, start: DVec3, direction: DVec3) -> bool {
    found.prim == hit.prim
        || reference.candidates(start, direction, 1e-9).iter().any(|candidate| candidate.prim == found.prim)
}

/// Numbers in [-1, 1], often an end or the middle: the corners of what a point may be moved to come first.
struct Steps(u64);

impl Steps {
    fn next(&mut self) -> f64 {
        // Knuth's MMIX generator.
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let bits = (self.0 >> 40) as u32;
        match bits & 3 {
            0 => -1.0,
            1 => 1.0,
            _ => f64::from(bits >> 2) / f64::from(1 << 21) - 1.0,
        }
    }
}
