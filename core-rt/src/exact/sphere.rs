//! The sphere test: exact signs, an integer square root, hits in the order of those of triangles.
//!
//! With S = o - centre, the ray is at distance r from the centre where a t^2 + 2 b t + c = 0, for
//!
//! a = D . D,  b = S . D,  c = S . S - r^2,  so t = (-b -+ sqrt(b^2 - a c)) / a.
//!
//! The ray starts outside iff c > 0. Then it hits iff b < 0 and b^2 - a c >= 0, first at the lesser t: a tangent touches.
//! Otherwise it starts inside, or on the sphere, and hits at the greater t, if that is not 0. These are decided without error.
//!
//! **t is rounded up to a multiple of 1 / a**: a fraction as a triangle's t is, and ordered with those exactly. So it is at least 1 / a, and at most 1 / |D| grid units beyond the sphere. At the rounded t,
//! D . (S + t D) = b + a t is a whole number of the sign of the true one: the outward normal there is towards the viewer
//! exactly where the ray started outside.
//!
//! **A ray that starts on a sphere** starts off it on one side, by [`Width::stand_off`], and which side that is c tells. Outside
//! it never meets the sphere again, which is convex. Inside it meets it at the greater t. That the side is the right one for
//! radii from [`RADIUS_MIN`] is shown in `docs/EXACTNESS.md`.

use super::ray::Ray;
use super::triangle::{Depth, within_reach};
use super::width::Width;
use crate::kernel::Surface;
use crate::num::{Triple, Word, dot, sub};
use crate::space::Space;
use crate::sphere::SphereRecord;

/// The least radius, grid units.
pub(super) const RADIUS_MIN: i32 = 2;

/// Where a ray meets a sphere.
pub(crate) struct Crossing<T> {
    /// The numerator of t, positive.
    pub(crate) numerator: T,
    /// The denominator of t, |D|^2.
    pub(crate) denominator: T,
    /// Whether the ray comes from outside.
    pub(crate) outside: bool,
}

/// Where a ray from `s`, relative to the centre, meets a sphere; `leaves` says that it starts on it, off it on one side.
///
/// b is at most 3 2^s 2^DIRECTION_BITS for offsets below 2^s, which fits the word: see [`Width`].
#[inline]
pub(crate) fn crossing<W: Width>(
    s: Triple<W::Word>,
    direction: Triple<W::Word>,
    radius: W::Word,
    leaves: bool,
) -> Option<Crossing<W::Wide>> {
    let zero = W::Wide::default();
    let b: W::Wide = dot(s, direction).into();
    let c = W::square(s) - W::square([radius, W::Word::default(), W::Word::default()]);
    let outside = c > zero;
    if (outside && (leaves || b >= zero)) || (leaves && c == zero) {
        return None;
    }
    let denominator = W::square(direction);
    let (root, is_whole) = W::discriminant_root(denominator, b, c)?;
    // Rounded up: the lesser t by the root rounded down, the greater one by the root rounded up.
    let numerator = if outside || is_whole { root } else { root + W::Wide::from(W::Word::ONE) };
    let numerator = if outside { -b - numerator } else { numerator - b };
    (numerator > zero).then_some(Crossing { numerator, denominator, outside })
}

/// The hit, if there is one with 0 < t within the ray's reach.
#[inline]
pub(super) fn intersect<W: Width>(ray: &Ray<W>, sphere: &SphereRecord<W::Short>, leaves: bool) -> Option<Depth<W>> {
    let s = sub(ray.origin, sphere.centre());
    let Crossing { numerator, denominator, .. } = crossing::<W>(s, ray.direction, sphere.radius(), leaves)?;
    within_reach(ray, numerator, denominator)
}

/// See [`Kernel::resolve_sphere`](crate::kernel::Kernel::resolve_sphere).
pub(super) fn resolve<W: Width>(ray: &Ray<W>, sphere: &SphereRecord<W::Short>) -> Surface<W::Space> {
    let centre = sphere.centre();
    let s = sub(ray.origin, centre);
    // The traversal found the hit by the same function, so it is there. A ray that leaves the sphere is inside.
    let Crossing { numerator, denominator, outside } = crossing::<W>(s, ray.direction, sphere.radius(), false)
        .unwrap_or(Crossing { numerator: W::Word::ONE.into(), denominator: W::Word::ONE.into(), outside: true });
    let (point, outward) = W::on_sphere(centre, s, ray.direction, numerator, denominator);
    let normal = if outside { outward } else { outward.map(|c| -c) };
    Surface {
        point,
        // It has the length of the radius.
        normal: W::normalise(normal).unwrap_or_else(|| W::Space::unit_from_q30([0, 0, 1 << 30])),
        front: outside,
        u: Default::default(),
        v: Default::default(),
    }
}
