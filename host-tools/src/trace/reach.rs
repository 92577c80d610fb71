//! Where a ray that starts anywhere enters the box of origins that a kernel can hold.

use core_rt::kernel::Bounds;
use glam::DVec3;

use crate::grid::Grid;

/// The origins that a kernel can hold for a scene. No geometry is near its faces, so a ray that starts on one still has
/// all its hits before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    pub(super) grid: Grid,
    /// Grid units, inclusive.
    low: DVec3,
    high: DVec3,
}

impl Reach {
    /// A box in units of a grid.
    pub(super) fn new(grid: Grid, bounds: &Bounds) -> Self {
        let corner = |c: [i32; 3]| DVec3::from_array(c.map(f64::from));
        Self { grid, low: corner(bounds.low), high: corner(bounds.high) }
    }

    /// The first point of a ray within the box, grid units, and how many steps it is from the origin; `None` where
    /// there is no such point. Origin and step are in scene units; the largest component of the step is in [1/2, 1).
    pub(super) fn enter(&self, origin: DVec3, step: DVec3) -> Option<(DVec3, f64)> {
        let start = self.on_grid(origin);
        if start.cmpge(self.low).all() && start.cmple(self.high).all() {
            return Some((start, 0.0));
        }
        let (nearer, skipped) = self.approach(origin, step);
        let start = self.on_grid(nearer);
        // Slabs, in grid units; what they round is far below one, since the ray is by now as near as it is long.
        let (mut entry, mut exit) = (0.0_f64, f64::INFINITY);
        for axis in 0..3 {
            let (to_low, to_high) = (self.low[axis] - start[axis], self.high[axis] - start[axis]);
            if step[axis] != 0.0 {
                let (a, b) = (to_low / step[axis], to_high / step[axis]);
                (entry, exit) = (entry.max(a.min(b)), exit.min(a.max(b)));
            } else if to_low > 0.0 || to_high < 0.0 {
                return None;
            }
        }
        let point = (start + step * entry).clamp(self.low, self.high);
        (entry <= exit).then_some((point, skipped + entry / self.grid.scale))
    }

    fn on_grid(&self, point: DVec3) -> DVec3 {
        (point - self.grid.origin) * self.grid.scale
    }

    /// Where a ray that is still before the box, along its major axis, comes to it, and after how many steps. However
    /// far away it starts, the point is right within a few ulps of its own coordinates and of the box's: for x, with
    /// z the major axis, `x' = (x dz - z dx + dx plane) / dz`, and nothing but the determinant cancels.
    fn approach(&self, origin: DVec3, step: DVec3) -> (DVec3, f64) {
        let major = step.abs().max_position();
        let face = if step[major] > 0.0 { self.low } else { self.high };
        let plane = self.grid.origin[major] + face[major] / self.grid.scale;
        let steps = (plane - origin[major]) / step[major];
        if steps <= 0.0 {
            return (origin, 0.0);
        }
        let moved = |axis: usize| {
            let moment = determinant(origin[axis], step[major], origin[major], step[axis]);
            libm::fma(step[axis], plane, moment) / step[major]
        };
        let mut point = DVec3::new(moved(0), moved(1), moved(2));
        point[major] = plane;
        (point, steps)
    }
}

/// `a b - c d` within 3/2 ulp of the result (Jeannerod, Louvet & Muller, "Further Analysis of Kahan's Algorithm for the
/// Accurate Computation of 2 x 2 Determinants", 2013).
fn determinant(a: f64, b: f64, c: f64, d: f64) -> f64 {
    let product = c * d;
    let error = libm::fma(-c, d, product);
    libm::fma(a, b, -product) + error
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The box from (-1, -1, -1) to (3, 3, 3) in scene units.
    fn reach() -> Reach {
        let grid = Grid { origin: DVec3::splat(1.0), scale: 1024.0 };
        Reach::new(grid, &Bounds { low: [-2048; 3], high: [2048; 3] })
    }

    fn entered(origin: [f64; 3], step: [f64; 3]) -> Option<([f64; 3], f64)> {
        reach().enter(origin.into(), step.into()).map(|(point, steps)| (point.to_array(), steps))
    }

    #[test]
    fn inside_nothing_moves() {
        for origin in [[1.0; 3], [-1.0, 3.0, 0.25]] {
            let expected = origin.map(|c| (c - 1.0) * 1024.0);
            assert_eq!(entered(origin, [0.5, -0.25, 0.0]), Some((expected, 0.0)));
        }
    }

    #[test]
    fn outside_it_moves_along_the_ray() {
        assert_eq!(entered([-5.0, 0.0, 2.0], [0.5, 0.0, 0.0]), Some(([-2048.0, -1024.0, 1024.0], 8.0)));
        assert_eq!(entered([5.0, 5.0, 1.0], [-0.5, -0.5, 0.0]), Some(([2048.0, 2048.0, 0.0], 4.0)));
        // By the minor axis.
        assert_eq!(entered([0.0, -2.0, 1.0], [0.5, 0.25, 0.0]), Some(([1024.0, -2048.0, 0.0], 4.0)));
        assert_eq!(entered([-5.0, 0.0, 2.0], [-0.5, 0.0, 0.0]), None, "away from it");
        assert_eq!(entered([-5.0, 4.0, 2.0], [0.5, 0.0, 0.0]), None, "beside it");
        assert_eq!(entered([-5.0, 0.0, 2.0], [0.5, 0.5, 0.0]), None, "past its corner");
        assert_eq!(entered([5.0, 0.0, 2.0], [0.5, 0.0, 0.0]), None, "behind it");
    }

    #[test]
    fn far_away_nothing_is_lost() {
        for distance in [1e6, 1e17, 1e120, f64::MAX] {
            let (point, steps) = entered([distance, -distance, 0.5], [-0.5, 0.5, 0.0]).unwrap();
            assert_eq!(point, [0.0, -2048.0, -512.0], "{distance}");
            assert!(steps >= distance);
        }
    }

    #[test]
    fn far_away_and_past_it_is_a_miss() {
        for distance in [1e6, 1e120, f64::MAX] {
            assert_eq!(entered([distance, -distance, 0.5], [-0.5, 0.49, 0.0]), None);
            assert_eq!(entered([distance, -distance, 0.5], [-0.5, -0.5, 0.0]), None);
            assert_eq!(entered([distance; 3], [-0.5, -0.5, 0.0]), None);
        }
        assert_eq!(entered([1e300, 0.0, 0.5], [-0.5, f64::from_bits(1), 0.0]).map(|(point, _)| point[0]), Some(2048.0));
    }

    #[test]
    fn determinants_do_not_cancel() {
        let e = libm::ldexp(1.0, -30);
        assert_eq!((1.0 + e) * (1.0 - e) - 1.0, 0.0);
        assert_eq!(determinant(1.0 + e, 1.0 - e, 1.0, 1.0), -e * e);
    }
}
