//! Axis-aligned boxes and a box test that never loses a hit.
//!
//! Slabs after Kay and Kajiya; the widened exit after T. Ize, "Robust BVH Ray Traversal", JCGT 2(2),
//! 2013.

use glam::DVec3;

use super::ray::Ray;

/// What a depth is multiplied by before something farther than it is given up.
///
/// With u = 2^-53, each of the two slab distances is within 3u of the truth, which is Ize's factor of
/// 1 + 6u. The [triangle test](super::triangle) works with vertices that were rounded too, by another
/// 3u at most each way; 16u covers both, so that the tree returns what a loop over all triangles does.
pub(super) const SLACK: f64 = 1.0 + 16.0 * (f64::EPSILON / 2.0);

/// A closed box; inside out while empty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    /// The corner of least coordinates.
    pub(super) low: DVec3,
    /// The corner of greatest coordinates.
    pub(super) high: DVec3,
}

impl Bounds {
    /// The box of nothing: neutral in [`Bounds::union`].
    pub(super) const EMPTY: Self = Self { low: DVec3::INFINITY, high: DVec3::NEG_INFINITY };

    /// The smallest box around `points`.
    pub(super) fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, |bounds, p| Self { low: bounds.low.min(p), high: bounds.high.max(p) })
    }

    /// The smallest box around both.
    pub(super) fn union(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half the surface; 0 when empty.
    pub(super) fn half_area(self) -> f64 {
        let size = (self.high - self.low).max(DVec3::ZERO);
        size.x * (size.y + size.z) + size.y * size.z
    }

    /// The depth at which `ray` enters, or `None` if it certainly misses or enters beyond `limit`.
    ///
    /// A ray that runs in the plane of a face multiplies zero by infinity there. Each comparison is
    /// written so that this NaN leaves the interval as it was: the plane counts as inside.
    #[inline]
    pub(super) fn entry(&self, ray: &Ray, limit: f64) -> Option<f64> {
        let mut entry = 0.0;
        let mut exit = limit;
        for axis in 0..3 {
            let inverse = ray.inverse[axis];
            let (near, far) = if inverse.is_sign_negative() {
                (self.high[axis], self.low[axis])
            } else {
                (self.low[axis], self.high[axis])
            };
            let near = (near - ray.origin[axis]) * inverse;
            let far = (far - ray.origin[axis]) * inverse;
            entry = if near > entry { near } else { entry };
            exit = if far < exit { far } else { exit };
        }
        (entry <= exit * SLACK).then_some(entry)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit() -> Bounds {
        Bounds::around([DVec3::ZERO, DVec3::ONE])
    }

    fn entry(bounds: Bounds, origin: [f64; 3], direction: [f64; 3], limit: f64) -> Option<f64> {
        bounds.entry(&Ray::new(origin.into(), direction.into()), limit)
    }

    #[test]
    fn enters_misses_and_stops_at_the_limit() {
        let inf = f64::INFINITY;
        assert_eq!(entry(unit(), [-2.0, 0.5, 0.5], [3.0, 0.0, 0.0], inf), Some(2.0));
        assert_eq!(entry(unit(), [-2.0, 0.5, 0.5], [3.0, 0.0, 0.0], 2.0), Some(2.0));
        assert_eq!(entry(unit(), [-2.0, 0.5, 0.5], [3.0, 0.0, 0.0], 1.9), None);
        assert_eq!(entry(unit(), [-2.0, 0.5, 0.5], [-1.0, 0.0, 0.0], inf), None);
        assert_eq!(entry(unit(), [0.5, 0.5, 0.5], [1.0, 1.0, 1.0], inf), Some(0.0));
        assert_eq!(entry(unit(), [-2.0, 1.5, 0.5], [1.0, 0.0, 0.0], inf), None);
        assert_eq!(entry(Bounds::EMPTY, [0.5, 0.5, 0.5], [1.0, 1.0, 1.0], inf), None);
    }

    #[test]
    fn the_planes_of_the_faces_belong_to_the_box() {
        let flat = Bounds::around([DVec3::ZERO, DVec3::new(1.0, 0.0, 1.0)]);
        for zero in [0.0, -0.0] {
            for y in [0.0, 1.0] {
                let grazing = entry(unit(), [-1.0, y, 0.5], [1.0, zero, 0.0], f64::INFINITY);
                assert_eq!(grazing, Some(1.0));
            }
            let inside = entry(flat, [-1.0, 0.0, 0.5], [1.0, zero, 0.0], f64::INFINITY);
            assert_eq!(inside, Some(1.0));
            let above = entry(flat, [-1.0, 1e-300, 0.5], [1.0, zero, 0.0], f64::INFINITY);
            assert_eq!(above, None);
        }
    }
}
