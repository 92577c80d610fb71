//! The watertight ray/triangle test.
//!
//! S. Woop, C. Benthin, I. Wald, "Watertight Ray/Triangle Intersection", JCGT 2(1), 2013. The ray is
//! sheared onto its major axis, which takes each vertex to a point of the plane; the triangle is hit
//! where its three edge functions do not differ in sign there. Two triangles that share an edge see
//! the same two points and so the same edge function, of opposite sign: at least one is hit.
//!
//! Preferred to T. Möller and B. Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT
//! 2(1), 1997, whose three functions are rounded differently in each triangle, so that a ray may slip
//! between two. Away from edges the two agree to rounding; the tests hold this one against that.
//!
//! Valid while the cubes of distances are finite and normal: scenes between 1e-90 and 1e90 units.

use glam::DVec3;

use super::ray::Ray;

/// A triangle by its corners, with its index in file order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Triangle {
    /// v0, v1, v2.
    pub(super) corners: [DVec3; 3],
    /// Index in [`Model::triangles`](crate::model::Model::triangles).
    pub(super) prim: u32,
}

/// Where a ray meets a triangle, or another surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    /// Depth of the point, positive.
    pub(super) depth: f64,
    /// Weight of v1.
    pub(super) u: f64,
    /// Weight of v2.
    pub(super) v: f64,
}

impl Crossing {
    /// A crossing of what has no corners.
    pub(super) const fn without_weights(depth: f64) -> Self {
        Self { depth, u: 0.0, v: 0.0 }
    }
}

impl Triangle {
    /// e1 x e2: twice the area long, on the side from which the corners run counter-clockwise.
    pub(super) fn cross(&self) -> DVec3 {
        let [v0, v1, v2] = self.corners;
        (v1 - v0).cross(v2 - v0)
    }

    /// Whether the plane contains `point`, to within a distance of `contact`.
    pub(super) fn in_plane(&self, point: DVec3, contact: f64) -> bool {
        let normal = self.cross();
        normal.dot(point - self.corners[0]).abs() <= contact * normal.length()
    }

    /// Whether f64 can tell the triangle's plane. One of no area cannot be shaded, and is no surface.
    pub(super) fn has_area(&self) -> bool {
        self.cross().try_normalize().is_some()
    }

    /// Where `ray` meets the triangle, from either side; edges and corners belong to it. A ray in
    /// its plane misses.
    #[inline]
    pub(super) fn intersect(&self, ray: &Ray) -> Option<Crossing> {
        let [x, y, z] = ray.axes;
        let shear = |corner: DVec3| {
            let relative = corner - ray.origin;
            let depth = relative[z] * ray.step[z];
            let across = relative[x] - ray.step[x] * depth;
            let along = relative[y] - ray.step[y] * depth;
            (across, along, depth)
        };
        let (ax, ay, az) = shear(self.corners[0]);
        let (bx, by, bz) = shear(self.corners[1]);
        let (cx, cy, cz) = shear(self.corners[2]);

        let a = determinant(cx, cy, bx, by);
        let b = determinant(ax, ay, cx, cy);
        let c = determinant(bx, by, ax, ay);
        let inside = (a >= 0.0 && b >= 0.0 && c >= 0.0) || (a <= 0.0 && b <= 0.0 && c <= 0.0);
        let area = a + b + c;
        if !inside || area == 0.0 {
            return None;
        }
        // A convex combination of the corners' depths: its error never leaves the triangle, however
        // thin that is.
        let depth = (a * az + b * bz + c * cz) / area;
        (depth > 0.0).then_some(Crossing { depth, u: b / area, v: c / area })
    }
}

/// `px qy - py qx`, of exactly the right sign, and exactly negated when p and q are exchanged.
///
/// Rounding is monotonic, so two products that differ after it differed the same way before it. Where
/// they do not, their rounding errors, which `fma` gives exactly, decide.
#[inline]
fn determinant(px: f64, py: f64, qx: f64, qy: f64) -> f64 {
    let left = px * qy;
    let right = py * qx;
    if left == right { libm::fma(px, qy, -left) - libm::fma(py, qx, -right) } else { left - right }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn triangle(corners: [[f64; 3]; 3]) -> Triangle {
        Triangle { corners: corners.map(DVec3::from), prim: 0 }
    }

    fn hit(triangle: &Triangle, origin: [f64; 3], direction: [f64; 3]) -> Option<[f64; 3]> {
        triangle.intersect(&Ray::new(origin.into(), direction.into())).map(|c| [c.depth, c.u, c.v])
    }

    const FLOOR: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    #[test]
    fn a_known_point_from_both_sides() {
        let floor = triangle(FLOOR);
        assert_eq!(hit(&floor, [1.0, 2.0, 8.0], [0.0, 0.0, -2.0]), Some([8.0, 0.25, 0.5]));
        assert_eq!(hit(&floor, [1.0, 2.0, -8.0], [0.0, 0.0, 0.5]), Some([8.0, 0.25, 0.5]));
        assert_eq!(hit(&floor, [1.0, 2.0, 8.0], [0.0, 0.0, 1.0]), None);
        assert_eq!(hit(&floor, [3.0, 2.0, 8.0], [0.0, 0.0, -1.0]), None);
    }

    #[test]
    fn edges_and_corners_are_hit_and_the_plane_is_not() {
        let floor = triangle(FLOOR);
        let turned = triangle([FLOOR[0], FLOOR[2], FLOOR[1]]);
        for [x, y] in [[2.0, 2.0], [0.0, 3.0], [1.0, 0.0], [4.0, 0.0], [0.0, 0.0]] {
            let down = |triangle| hit(triangle, [x, y, 1.0], [0.0, 0.0, -1.0]);
            assert_eq!(down(&floor), Some([1.0, x / 4.0, y / 4.0]));
            assert_eq!(down(&turned), Some([1.0, y / 4.0, x / 4.0]));
        }
        assert_eq!(hit(&floor, [-1.0, 1.0, 0.0], [1.0, 0.0, 0.0]), None);
        let at_the_origin = hit(&floor, [1.0, 1.0, 0.0], [0.0, 0.0, -1.0]);
        assert_eq!(at_the_origin, None, "t = 0 is not a hit");
    }

    #[test]
    fn bad_rays_and_bad_triangles_miss() {
        let floor = triangle(FLOOR);
        assert!(floor.has_area());
        assert_eq!(hit(&floor, [1.0, 1.0, 1.0], [0.0, 0.0, 0.0]), None);
        assert_eq!(hit(&floor, [1.0, 1.0, 1.0], [0.0, f64::NAN, -1.0]), None);
        let point = triangle([[1.0, 1.0, 0.0]; 3]);
        assert!(!point.has_area());
        assert_eq!(hit(&point, [1.0, 1.0, 1.0], [0.0, 0.0, -1.0]), None);
        let line = triangle([[0.0, 0.0, 0.0], [1.0, 1.0, 0.0], [2.0, 2.0, 0.0]]);
        assert!(!line.has_area());
        assert_eq!(hit(&line, [1.0, 1.0, 1.0], [0.0, 0.0, -1.0]), None);
    }

    #[test]
    fn a_determinant_below_rounding_keeps_its_sign() {
        // (1 + 2^-30)(1 - 2^-30) = 1 - 2^-60 rounds to 1.
        let e = libm::ldexp(1.0, -30);
        assert_eq!((1.0 + e) * (1.0 - e) - 1.0, 0.0);
        assert_eq!(determinant(1.0 + e, 1.0, 1.0, 1.0 - e), -e * e);
        assert_eq!(determinant(1.0, 1.0 - e, 1.0 + e, 1.0), e * e);
        assert_eq!(determinant(3.0, 2.0, 6.0, 4.0), 0.0);
    }
}
