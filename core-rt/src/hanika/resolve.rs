//! From (ray, index) to the hit point, the normal and the barycentrics.

use fixed::FixedI32;

use super::UNIT_BITS;
use super::boxes::Slab;
use super::ray::Ray;
use super::triangle::{Hit, TriangleRecord, hit};
use crate::kernel::Surface;
use crate::num::{Triple, round_shift};
use crate::space::grid29::{POINT_BITS, normalise};
use crate::space::{GridQ31, Space};

/// See [`Kernel::resolve`](crate::kernel::Kernel::resolve).
pub(super) fn resolve<S: Slab>(ray: &Ray<S>, triangle: &TriangleRecord) -> Surface<GridQ31> {
    // The traversal found the hit by the same function, so it is there.
    let Hit { t, u, v, away } = hit(ray, triangle).unwrap_or(Hit { t: 0, u: 0, v: 0, away: false });
    let moved = |origin: i64, direction: i64| {
        // Below 2^30 * 2^31.
        (origin << POINT_BITS) + round_shift(i64::from(t) * direction, UNIT_BITS - POINT_BITS)
    };
    // Q(31 + E) to Q31.
    let weight = |value: i64| FixedI32::from_bits((value >> ray.edge_shift).min(i32::MAX.into()) as i32);
    let ([o, d], [r, p, q]) = ([ray.origin, ray.direction], triangle.axes());
    // Derived: n itself, which has 1 along r, on the side that the ray came from.
    let [n_p, n_q] = triangle.slopes();
    let mut normal: Triple<i64> = [0; 3];
    (normal[r], normal[p], normal[q]) = (1 << UNIT_BITS, n_p, n_q);
    let normal = if away { normal.map(|c| -c) } else { normal };
    // Along r, N = e1 x e2 is positive where the vertices run counter-clockwise seen from there; below 2^59.
    let [v0, v1, v2] = triangle.vertices().map(|v| v.map(i64::from));
    let area = (v1[p] - v0[p]) * (v2[q] - v0[q]) - (v1[q] - v0[q]) * (v2[p] - v0[p]);
    Surface {
        point: [moved(o[0], d[0]), moved(o[1], d[1]), moved(o[2], d[2])],
        // It is not zero along r.
        normal: normalise(normal).unwrap_or_else(|| GridQ31::unit_from_q30([0, 0, 1 << 30])),
        front: away != (area > 0),
        u: weight(v),
        v: weight(u),
    }
}
