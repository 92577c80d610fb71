//! The sphere test: E. Haines, J. Günther & T. Akenine-Möller, "Precision Improvements for Ray/Sphere Intersection", Ray
//! Tracing Gems, 2019. The discriminant comes from the distance between centre and ray, which does not cancel for a small
//! sphere far away, and each root from a sum without cancellation or from the product of both.
//!
//! Points are put on the sphere along their normal, so they are off it by the roundings of a product and a sum alone, as far as the
//! bound of [`Format::STAND_OFF`] allows: rays that leave it start on the right side.

use core_rt::kernel::Surface;
use core_rt::num::Triple;
use core_rt::sphere::Ball;

use crate::format::Format;
use crate::ray::Ray;
use crate::real::Real;
use crate::record::SphereRecord;
use crate::space::FloatSpace;
use crate::triangle::MATERIALS_MAX;
use crate::vector::{add, dot, normalise, scale, sub};

/// The record, or `None` where the material is too high. The sphere must fit.
pub(crate) fn pack<F: Format>(ball: &Ball, material: u32) -> Option<F::Sphere> {
    let numbers = ball.centre.map(F::from_i32);
    (material <= MATERIALS_MAX).then(|| F::Sphere::new(numbers, F::from_i32(ball.radius), material))
}

/// The sphere: exact for a record that [`pack`] made.
pub(crate) fn ball<F: Format>(sphere: &F::Sphere) -> Ball {
    Ball { centre: sphere.centre().map(F::to_i32), radius: sphere.radius().to_i32() }
}

/// Where a ray meets a sphere, and whether it comes from outside.
#[inline(always)]
fn meet<F: Real>(ray: &Ray<F>, centre: Triple<F>, radius: F, leaves: bool) -> Option<(F, bool)> {
    let from_centre = sub(ray.origin, centre);
    let a = dot(ray.direction, ray.direction);
    let b = -dot(from_centre, ray.direction);
    let c = dot(from_centre, from_centre) - radius * radius;
    let outside = c > F::ZERO;
    if outside && (leaves || b <= F::ZERO) {
        return None;
    }
    let nearest = add(from_centre, scale(ray.direction, b / a));
    let discriminant = radius * radius - dot(nearest, nearest);
    if discriminant < F::ZERO && outside {
        return None;
    }
    // From inside there are always two roots: less than 0 is rounding.
    let root = if discriminant > F::ZERO { (a * discriminant).sqrt() } else { F::ZERO };
    // The root that is larger in magnitude; the product of both is c / a.
    let large = if b < F::ZERO { b - root } else { b + root };
    let t = if outside || b < F::ZERO { c / large } else { large / a };
    (t > F::ZERO).then_some((t, outside))
}

/// `t` of the hit, if there is one with 0 < t within the ray's reach. It is finite.
#[inline]
pub(crate) fn intersect<F: Format>(ray: &Ray<F>, sphere: &F::Sphere, leaves: bool) -> Option<F> {
    let (t, _) = meet(ray, *sphere.centre(), sphere.radius(), leaves)?;
    (t < ray.reach).then_some(t)
}

/// The point and the normal of a hit.
pub(crate) fn resolve<F: Format>(ray: &Ray<F>, sphere: &F::Sphere) -> Surface<FloatSpace<F>> {
    let (centre, radius) = (*sphere.centre(), sphere.radius());
    // The traversal found the hit by the same operations, so it is there.
    let (t, outside) = meet(ray, centre, radius, false).unwrap_or((F::ZERO, true));
    let to_hit = add(sub(ray.origin, centre), scale(ray.direction, t));
    let outward = normalise(to_hit).unwrap_or([F::ZERO, F::ZERO, F::ONE]);
    Surface {
        point: add(centre, scale(outward, radius)),
        normal: if outside { outward } else { outward.map(|c| -c) },
        front: outside,
        u: F::ZERO,
        v: F::ZERO,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use core_rt::kernel::NONE;

    fn hit(origin: Triple<f32>, direction: Triple<f32>, leaves: bool) -> Option<(f32, Triple<f32>, bool)> {
        let sphere = pack::<f32>(&Ball { centre: [1000, 2000, 3000], radius: 100 }, 3).unwrap();
        let ray = Ray::new(origin, direction, f32::INFINITY, NONE).unwrap();
        let t = intersect(&ray, &sphere, leaves)?;
        let surface = resolve(&ray, &sphere);
        Some((t, surface.normal, surface.front))
    }

    #[test]
    fn known_points_from_outside_inside_and_on_it() {
        let outside = [1000.0, 2000.0, 2000.0];
        assert_eq!(hit(outside, [0.0, 0.0, 2.0], false), Some((450.0, [0.0, 0.0, -1.0], true)));
        assert_eq!(hit(outside, [0.0, 0.0, -2.0], false), None, "it is behind");
        assert_eq!(hit(outside, [0.0, 0.0, 2.0], true), None, "it starts on it and outside");
        let inside = [1000.0, 2000.0, 2950.0];
        for leaves in [false, true] {
            assert_eq!(hit(inside, [0.0, 0.0, 1.0], leaves), Some((150.0, [0.0, 0.0, -1.0], false)));
            assert_eq!(hit(inside, [0.0, 0.0, -1.0], leaves), Some((50.0, [0.0, 0.0, 1.0], false)));
        }
        assert_eq!(hit([1100.0, 2000.0, 0.0], [0.0, 0.0, 1.0], false).map(|(t, ..)| t), Some(3000.0), "a tangent");
        assert_eq!(hit([1100.1, 2000.0, 0.0], [0.0, 0.0, 1.0], false), None);
        // On the sphere, as nobody leaves it.
        assert_eq!(hit([1000.0, 2000.0, 2900.0], [0.0, 0.0, 1.0], false).map(|(t, ..)| t), Some(200.0));
        assert_eq!(hit([1000.0, 2000.0, 2900.0], [0.0, 0.0, -1.0], false), None);
    }

    #[test]
    fn records_keep_what_they_are_made_of() {
        fn check<F: Format>() {
            let last = (1 << F::GRID_BITS) - 1;
            let all = Ball { centre: [last, 0, last / 2], radius: last / 2 };
            let record = pack::<F>(&all, MATERIALS_MAX).unwrap();
            assert_eq!((ball::<F>(&record), record.material()), (all, MATERIALS_MAX));
            assert_eq!(pack::<F>(&all, MATERIALS_MAX + 1), None);
        }
        check::<f32>();
        check::<f64>();
    }
}
