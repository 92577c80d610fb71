//! Rays: an origin in whole grid units, a direction of length 1 in Q31, so that t is in grid units too.

use super::boxes::Slab;
use super::{GRID_BITS, UNIT_BITS};
use crate::arithmetic::Arithmetic;
use crate::kernel::Surface;
use crate::num::{Triple, round_shift, sub};
use crate::space::grid29::{POINT_BITS, normalise};
use crate::space::{GridQ31, Space};

/// No hit is so far away. What lies within the grid's reach along each axis is at most sqrt(3) (2^29 + 2^7) away. The report
/// compares with the largest `int`, at which u and v would not fit 64 bits.
pub(super) const T_END: i32 = 1 << 30;

/// A rounded hit may lie off its triangle, and off the grid. Secondary origins are no farther outside than this, so that
/// their differences to vertices stay in range.
const OUTSIDE: i64 = 1 << 7;

/// A ray or a segment.
#[derive(Clone, Copy, Debug)]
pub struct Ray<S> {
    /// The origin, grid units.
    pub origin: Triple<i64>,
    /// The direction, Q31.
    pub direction: Triple<i64>,
    pub(super) slab: S,
    pub(super) edge_shift: u32,
    /// Only hits with a t below this count.
    pub reach: i32,
    /// The primitive that it starts on.
    pub skip: u32,
}

impl<S: Slab> Ray<S> {
    /// A ray without end in a direction of any length, or `None` where that is zero.
    #[inline]
    pub(super) fn new(settings: Arithmetic, origin: Triple<i64>, direction: Triple<i64>, skip: u32) -> Option<Self> {
        let unit: <GridQ31 as Space>::Unit = normalise(direction)?;
        Some(Self::of_unit(settings, origin, unit.map(|c| c.to_bits().into()), skip))
    }

    /// A ray without end in a direction of length 1, Q31.
    #[inline]
    pub(super) fn of_unit(settings: Arithmetic, origin: Triple<i64>, direction: Triple<i64>, skip: u32) -> Self {
        let slab = S::new(settings, direction);
        Self { origin, direction, slab, edge_shift: settings.edge_shift.into(), reach: T_END, skip }
    }

    /// The open segment between two points, or `None` where they are the same.
    #[inline]
    pub(super) fn segment(settings: Arithmetic, origin: Triple<i64>, to: Triple<i64>, skip: u32) -> Option<Self> {
        let difference = sub(to, origin); // at most 2^30 + 2^7: a light is that far from some triangle, and that is on the grid
        let ray = Self::new(settings, origin, difference, skip)?;
        let square: u64 = difference.iter().map(|&c| (c * c) as u64).sum(); // below 2^62
        // Below 2^31; what is beyond T_END is not hit anyway.
        Some(Self { reach: T_END.min(square.isqrt() as i32), ..ray })
    }
}

/// Where rays leave a surface: epsilon above it, rounded to the grid.
#[inline]
pub(super) fn stand_off(settings: Arithmetic, surface: &Surface<GridQ31>) -> Triple<i64> {
    let placed = |point_q8: i64, unit_q31: i64| {
        // One rounding: the sum in Q31, the point being below 2^31 grid units.
        let sum = (point_q8 << (UNIT_BITS - POINT_BITS)) + i64::from(settings.epsilon) * unit_q31;
        round_shift(sum, UNIT_BITS).clamp(-OUTSIDE, (1 << GRID_BITS) + OUTSIDE)
    };
    let n = surface.normal.map(|c| i64::from(c.to_bits()));
    [placed(surface.point[0], n[0]), placed(surface.point[1], n[1]), placed(surface.point[2], n[2])]
}

#[cfg(test)]
mod tests {
    use super::super::{HanikaCons, TightSlab};
    use super::*;
    use crate::kernel::Kernel;
    use fixed::FixedI32;

    const SETTINGS: Arithmetic = Arithmetic { c_bits: 12, d_bits: 12, edge_shift: 0, epsilon: 4 };

    fn ray(origin: Triple<i64>, direction: Triple<i64>) -> Option<Ray<TightSlab<1>>> {
        Ray::new(SETTINGS, origin, direction, 0)
    }

    #[test]
    fn directions_have_length_one_whatever_is_given() {
        assert!(ray([0; 3], [0; 3]).is_none());
        for direction in [[1, 0, 0], [-1, 1, 1], [3, -4, 1 << 30], [(1 << 31) - 1; 3], [-(1 << 31) + 1, 5, 0]] {
            let found = ray([0; 3], direction).unwrap().direction;
            let square: i128 = found.iter().map(|&c| i128::from(c) * i128::from(c)).sum();
            assert!((square - (1 << 62)).abs() < 1 << 36, "{direction:?} {found:?}");
            assert!(found.iter().all(|c| (-(1 << 31)..1 << 31).contains(c)));
        }
    }

    #[test]
    fn a_segment_ends_at_its_light() {
        let reach = |to| Ray::<TightSlab<1>>::segment(SETTINGS, [10, 20, 30], to, 0).map(|ray| ray.reach);
        assert_eq!(reach([13, 24, 30]), Some(5));
        assert_eq!(reach([11, 21, 31]), Some(1), "sqrt(3), rounded down");
        assert_eq!(reach([10, 20, 30]), None);
        // The largest difference that there can be.
        let far = (1 << 30) + OUTSIDE;
        assert_eq!(reach([far + 10, far + 20, far + 30]), Some(T_END));
    }

    #[test]
    fn origins_stand_off_by_epsilon_and_stay_near_the_grid() {
        let surface = |point: Triple<i64>, normal: [i32; 3]| Surface::<GridQ31> {
            point: point.map(|c| c << POINT_BITS),
            normal: normal.map(FixedI32::from_bits),
            front: true,
            u: FixedI32::ZERO,
            v: FixedI32::ZERO,
        };
        let up = [0, i32::MAX, 0];
        assert_eq!(stand_off(SETTINGS, &surface([100, 200, 300], up)), [100, 204, 300]);
        assert_eq!(stand_off(SETTINGS, &surface([100, 200, 300], [0, i32::MIN, 0])), [100, 196, 300]);
        let far = stand_off(SETTINGS, &surface([-(1 << 30), (1 << 31) - 1, 300], up));
        assert_eq!(far, [-OUTSIDE, (1 << GRID_BITS) + OUTSIDE, 300]);
        let found =
            HanikaCons::leaving(SETTINGS, &surface([100, 200, 300], up), up.map(FixedI32::from_bits), 7).unwrap();
        assert_eq!((found.origin, found.direction, found.skip), ([100, 204, 300], up.map(i64::from), 7));
    }
}
