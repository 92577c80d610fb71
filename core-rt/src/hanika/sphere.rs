//! The sphere test. The 2009 report has triangles alone; this is what its formats make of the test of
//! [`exact`](crate::exact), to the letter: integers to 2^31 and products of two in 64 bits, squares of these in 128.
//!
//! Directions have length 1 in Q31 but for rounding, and origins are up to 2^7 off the grid, so offsets are below 2^29 + 2^7,
//! |D| below 2^31 (1 + 2^-27) and |S . D| below 2^61, though its terms are not smaller than `Exact29`'s. Inside and outside, hit
//! and miss are decided without error. t is in whole grid units, as that of a triangle is, rounded up: a hit is not lost for being
//! near, else rays would leak out of spheres. The point is that of the unrounded t.
//!
//! No hit is lost by [`HanikaCons`](super::HanikaCons)' boxes: they hold the true hit, at less than 1 before t, and what a limit
//! leaves out is beyond it by `SLACK`, 4.

use fixed::FixedI32;

use super::UNIT_BITS;
use super::boxes::Slab;
use super::ray::Ray;
use crate::exact::{Crossing, Width, Width29, crossing};
use crate::kernel::Surface;
use crate::num::sub;
use crate::space::grid29::normalise;
use crate::space::{GridQ31, Space};
use crate::sphere::SphereRecord;

/// The least radius, grid units: twice the farthest that rays may stand off.
pub(super) const RADIUS_MIN: i32 = 128;

/// The t of a hit, if there is one within the ray's reach.
#[inline]
pub(super) fn intersect<S: Slab>(ray: &Ray<S>, sphere: &SphereRecord<i32>, leaves: bool) -> Option<i32> {
    let s = sub(ray.origin, sphere.centre());
    let Crossing { numerator, denominator, .. } = crossing::<Width29>(s, ray.direction, sphere.radius(), leaves)?;
    // |D|^2 t in units of directions, below 2^63, times their length in Q31. `max` says that a denominator is not 0.
    let t = ((numerator << UNIT_BITS) + denominator - 1) / denominator.max(1);
    (t < i128::from(ray.reach)).then_some(t as i32)
}

/// See [`Kernel::resolve_sphere`](crate::kernel::Kernel::resolve_sphere).
pub(super) fn resolve<S: Slab>(ray: &Ray<S>, sphere: &SphereRecord<i32>) -> Surface<GridQ31> {
    let centre = sphere.centre();
    let s = sub(ray.origin, centre);
    // The traversal found the hit by the same function, so it is there. A ray that leaves the sphere is inside.
    let Crossing { numerator, denominator, outside } = crossing::<Width29>(s, ray.direction, sphere.radius(), false)
        .unwrap_or(Crossing { numerator: 1, denominator: 1, outside: true });
    let (point, outward) = Width29::on_sphere(centre, s, ray.direction, numerator, denominator);
    let normal = if outside { outward } else { outward.map(|c| -c) };
    Surface {
        point,
        // It has the length of the radius.
        normal: normalise(normal).unwrap_or_else(|| GridQ31::unit_from_q30([0, 0, 1 << 30])),
        front: outside,
        u: FixedI32::default(),
        v: FixedI32::default(),
    }
}
