//! The ray/sphere test.
//!
//! E. Haines, J. Günther, T. Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray Tracing Gems, 2019:
//! the discriminant comes from the distance between centre and ray, which does not cancel for a small sphere far away,
//! and the nearer root from the product of both.

use glam::DVec3;

use super::bounds::Bounds;
use super::ray::Ray;

/// A sphere, with its index after all triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sphere {
    /// The centre, scene units.
    pub(super) centre: DVec3,
    /// The radius, scene units.
    pub(super) radius: f64,
    /// The number of triangles, and the index in [`Model::spheres`](crate::model::Model::spheres).
    pub(super) prim: u32,
}

impl Sphere {
    /// The depths, in order, at which the line of `ray` crosses the sphere, behind the origin too.
    pub(super) fn crossings(&self, ray: &Ray) -> Option<[f64; 2]> {
        let from_centre = ray.origin - self.centre;
        let a = ray.step.length_squared();
        let b = -from_centre.dot(ray.step);
        let nearest = from_centre + ray.step * (b / a);
        let discriminant = self.radius * self.radius - nearest.length_squared();
        if discriminant < 0.0 || discriminant.is_nan() {
            return None;
        }
        let c = from_centre.length_squared() - self.radius * self.radius;
        let root = libm::sqrt(a * discriminant);
        let q = if b < 0.0 { b - root } else { b + root };
        // Where q is 0 the ray touches at its origin: the other depth is no number, and neither is positive.
        let (one, other) = (q / a, c / q);
        Some(if one < other { [one, other] } else { [other, one] })
    }

    /// The least positive depth at which `ray` meets the sphere, from either side.
    #[inline]
    pub(super) fn intersect(&self, ray: &Ray) -> Option<f64> {
        self.crossings(ray)?.into_iter().find(|&depth| depth > 0.0)
    }

    /// The depth at which `ray`, which starts on the sphere, meets it again.
    pub(super) fn leave(&self, ray: &Ray) -> Option<f64> {
        let depth = -2.0 * (ray.origin - self.centre).dot(ray.step) / ray.step.length_squared();
        (depth > 0.0).then_some(depth)
    }

    /// How far `point` is from the surface, scene units.
    pub(super) fn distance(&self, point: DVec3) -> f64 {
        ((point - self.centre).length() - self.radius).abs()
    }

    /// A box around it, a little larger: a ray that grazes the sphere is off by some roundings of what it is tested with.
    pub(super) fn bounds(&self) -> Bounds {
        let reach = self.radius + libm::ldexp(self.centre.abs().max_element() + self.radius, -40);
        Bounds { low: self.centre - reach, high: self.centre + reach }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Sphere = Sphere { centre: DVec3::new(0.0, 0.0, 5.0), radius: 1.0, prim: 0 };

    fn hit(sphere: Sphere, origin: [f64; 3], direction: [f64; 3]) -> Option<f64> {
        sphere.intersect(&Ray::new(origin.into(), direction.into()))
    }

    #[test]
    fn known_points_from_outside_inside_and_beyond() {
        assert_eq!(hit(UNIT, [0.0; 3], [0.0, 0.0, 1.0]), Some(4.0));
        assert_eq!(hit(UNIT, [0.0, 0.0, 5.0], [0.0, 0.0, 1.0]), Some(1.0), "from the centre");
        assert_eq!(hit(UNIT, [0.0, 0.0, 4.5], [0.0, 0.0, 1.0]), Some(1.5), "from the inside");
        assert_eq!(hit(UNIT, [0.0, 0.0, 7.0], [0.0, 0.0, 1.0]), None, "it is behind");
        assert_eq!(hit(UNIT, [0.0; 3], [0.0, 1.0, 1.0]), None, "beside it");
        assert_eq!(hit(UNIT, [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]), Some(5.0), "a tangent touches");
        assert_eq!(hit(UNIT, [0.0; 3], [0.0; 3]), None);
        assert_eq!(hit(UNIT, [0.0; 3], [0.0, f64::NAN, 1.0]), None);
    }

    #[test]
    fn a_small_sphere_far_away_keeps_its_place() {
        // b^2 - 4ac is off by more than the sphere is large here.
        let far = Sphere { centre: DVec3::new(0.0, 0.0, 1e9), radius: 1e-3, prim: 0 };
        let seen = |x: f64| hit(far, [x, 0.0, 0.0], [0.0, 0.0, 1.0]).is_some();
        assert!(seen(0.999e-3) && !seen(1.001e-3));
    }

    #[test]
    fn a_ray_from_the_surface_leaves_through_the_other_side_or_not_at_all() {
        let start = DVec3::new(0.0, 0.0, 4.0);
        assert_eq!(UNIT.leave(&Ray::new(start, DVec3::Z)), Some(2.0));
        assert_eq!(UNIT.leave(&Ray::new(start, DVec3::new(0.0, 3.0, 3.0))), Some(1.0));
        assert_eq!(UNIT.leave(&Ray::new(start, DVec3::new(0.0, 1.0, -1e-9))), None);
    }
}
