//! From (ray, id) to the hit point, the normal and the barycentrics: one function for every traversal.

use super::ray::Ray;
use super::triangle::{TriangleRecord, parts};
use super::width::Width;
use crate::kernel::Surface;
use crate::num::{Triple, cross, sub};
use crate::space::Space;

/// See [`Kernel::resolve`](crate::kernel::Kernel::resolve).
pub(super) fn resolve<W: Width>(ray: &Ray<W>, triangle: &TriangleRecord<W::Short>) -> Surface<W::Space> {
    let [v0, e1, e2] = parts::<W>(triangle);
    let s = sub(ray.origin, v0);
    let r = cross(s, ray.direction);
    let normal = cross(e1, e2);
    let det = -W::dot(ray.direction, normal);
    let facing = det > W::Wide::default();
    // tn, U and V carry the sign of det.
    let positive = |value: W::Wide| if facing { value } else { -value };
    let (numerator, denominator) = (positive(W::dot(s, normal)), positive(det));
    let (u, v) = (positive(W::dot(e2, r)), positive(-W::dot(e1, r)));
    let normal: Triple<W::Word> = if facing { normal } else { normal.map(|c| -c) };
    Surface {
        point: W::point(ray.origin, ray.direction, numerator, denominator),
        // A record's triangle has area, so its normal is not zero; the default is for a record that lies.
        normal: W::normalise(normal).unwrap_or_else(|| W::Space::unit_from_q30([0, 0, 1 << 30])),
        front: facing,
        u: W::fraction(u, denominator),
        v: W::fraction(v, denominator),
    }
}
