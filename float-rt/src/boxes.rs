//! The slab test with reciprocals (Kay & Kajiya 1986; Williams, Barrus, Morley & Shirley, "An Efficient and Robust
//! Ray-Box Intersection Algorithm", 2005), padded so that rounding loses no hit (Ize, "Robust BVH Ray Traversal", JCGT
//! 2013).
//!
//! Let the line of a ray meet what is in a box at t > 0, and let e be the largest relative error of a rounding. Along
//! each axis entry <= t <= exit. An entry is a difference times a reciprocal: three roundings, so it is high by at most
//! (1 + e)^3. An exit is that with a reciprocal made longer by 1 + 8 e, which is a fourth rounding: it is at least
//! (1 - e)^4 (1 + 8 e) of its own, which is more than (1 + e)^3. So no such box is left out.
//!
//! What a limit leaves out is another matter: it comes from the computed t of another hit, and no padding covers a
//! sliver's.

use core_rt::kernel::{ANY_OCTANT, Bounds};
use core_rt::num::Triple;

use crate::format::Format;
use crate::ray::{Path, padding};
use crate::real::Real;
use crate::record::NodeRecord;

/// The node's record. Corners must lie on the grid.
pub(crate) fn pack<F: Format>(boxes: [Bounds; 2], children: [u32; 2]) -> F::Node {
    let planes = boxes.map(|b| [b.low.map(F::from_i32), b.high.map(F::from_i32)]);
    F::Node::new(planes, children)
}

/// The whole grid units in the boxes of a record; 0, and so off the grid, for a plane that is not a number.
pub(crate) fn unpack<F: Format>(node: &F::Node) -> [Bounds; 2] {
    node.planes().map(|[low, high]| Bounds {
        low: low.map(|plane| (-(-plane).floor()).to_i32()),
        high: high.map(|plane| plane.floor().to_i32()),
    })
}

/// A `t` that no entry into a box of a hit at `t` exceeds, but for the error of `t` itself.
#[inline]
pub(crate) fn limit<F: Real>(t: F) -> F {
    t * padding()
}

/// Where a ray enters a child, if it does before the limit.
#[inline(always)]
pub(crate) fn enter<F: Format, const OCTANT: usize>(
    path: &Path<F>,
    node: &F::Node,
    child: usize,
    limit: F,
) -> Option<F> {
    slab::<_, OCTANT>(path, &node.planes()[child], limit)
}

/// Whether floats are routines. Leaving a box as soon as an axis decides is what makes them bearable; an FPU is quicker
/// without the branches. Both find the same.
const SOFT_FLOAT: bool = cfg!(any(target_arch = "arm", target_arch = "riscv32"));

/// A ray that does not move along an axis has an infinite reciprocal, and in a plane of the box the product is not a
/// number; every comparison with it is false, which leaves the plane out of account.
#[inline(always)]
fn slab<F: Real, const OCTANT: usize>(path: &Path<F>, planes: &[Triple<F>; 2], limit: F) -> Option<F> {
    let (mut entry, mut exit) = (F::ZERO, limit);
    for axis in [0, 1, 2] {
        let negative = if OCTANT == ANY_OCTANT { path.negative[axis] } else { OCTANT >> axis & 1 != 0 };
        let near = (planes[usize::from(negative)][axis] - path.origin[axis]) * path.entering[axis];
        let far = (planes[usize::from(!negative)][axis] - path.origin[axis]) * path.leaving[axis];
        entry = if near > entry { near } else { entry };
        exit = if far < exit { far } else { exit };
        if SOFT_FLOAT && entry > exit {
            return None;
        }
    }
    if entry > exit { None } else { Some(entry) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Node32;
    use crate::ray::Ray;
    use core_rt::kernel::NONE;

    const UNIT: Bounds = Bounds { low: [8; 3], high: [16; 3] };

    fn hit(origin: Triple<f32>, direction: Triple<f32>, limit: f32) -> Option<f32> {
        let ray = Ray::new(origin, direction, f32::INFINITY, NONE).unwrap();
        let node = pack::<f32>([UNIT; 2], [0; 2]);
        let [first, second] = [0, 1].map(|child| enter::<_, ANY_OCTANT>(&ray.path(), &node, child, limit));
        assert_eq!(first, second);
        first
    }

    #[test]
    fn entries_from_each_side_and_from_within() {
        let far = f32::INFINITY;
        assert_eq!(hit([0.0, 10.0, 10.0], [2.0, 0.0, 0.0], far), Some(4.0));
        assert_eq!(hit([10.0, 20.0, 10.0], [0.0, -1.0, 0.0], far), Some(4.0));
        assert_eq!(hit([10.0, 10.0, 10.0], [1.0, 2.0, -3.0], far), Some(0.0));
        assert_eq!(hit([0.0, 10.0, 10.0], [-1.0, 0.0, 0.0], far), None, "it is behind");
        assert_eq!(hit([0.0, 10.0, 10.0], [2.0, 0.0, 0.0], 3.9), None, "it is too far");
        assert_eq!(hit([0.0, 17.0, 10.0], [1.0, 0.0, 0.0], far), None, "it is beside");
    }

    #[test]
    fn rays_in_the_planes_of_a_box_touch_it_whatever_the_sign_of_zero() {
        for y in [8.0, 16.0] {
            for zero in [0.0, -0.0] {
                assert_eq!(hit([0.0, y, 8.0], [1.0, zero, zero], f32::INFINITY), Some(8.0), "{y} {zero}");
            }
        }
        for zero in [0.0, -0.0] {
            assert_eq!(hit([0.0, 17.0, 10.0], [1.0, zero, zero], f32::INFINITY), None);
            assert_eq!(hit([0.0, 7.0, 10.0], [1.0, zero, zero], f32::INFINITY), None);
        }
    }

    /// Points of a box that is flat along an axis, as a wall's is, aimed at from afar: the exact line goes through the
    /// point but for the rounding of the direction, which integers of 24 bits do not have.
    #[test]
    fn no_box_is_lost_by_rounding() {
        let mut state = 1u32;
        let mut random = |bits: u32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> (32 - bits)) as i32
        };
        let (mut unpadded, count) = (0, 100_000);
        for _ in 0..count {
            let point = [random(22), random(22), random(22)].map(|c| c + 8);
            let direction = [random(12) - 2048, random(12) - 2048, random(12) - 2047];
            let steps = random(10) + 1;
            let origin = [0, 1, 2].map(|axis: usize| (point[axis] - steps * direction[axis]) as f32);
            let Some(ray) = Ray::new(origin, direction.map(|c| c as f32), f32::INFINITY, NONE) else { continue };
            let node = pack::<f32>([Bounds { low: point, high: point }; 2], [0; 2]);
            let path = ray.path();
            assert!(
                enter::<_, ANY_OCTANT>(&path, &node, 0, f32::INFINITY).is_some(),
                "{point:?} {direction:?} {steps}"
            );
            let bare = Path { leaving: path.entering, ..path };
            unpadded += u32::from(enter::<_, ANY_OCTANT>(&bare, &node, 0, f32::INFINITY).is_none());
        }
        assert!(unpadded > 1000, "without padding only {unpadded} were lost: the test has no teeth");
    }

    #[test]
    fn boxes_come_back_and_planes_between_units_shrink() {
        assert_eq!(unpack::<f64>(&pack::<f64>([UNIT; 2], [0; 2])), [UNIT; 2]);
        let between = [[8.5, f32::NAN, f32::INFINITY], [16.5, -1.5, 1e30]];
        let [found, _] = unpack::<f32>(&Node32::new([between; 2], [0; 2]));
        assert_eq!(found, Bounds { low: [9, 0, i32::MAX], high: [16, -2, i32::MAX] });
    }
}
