//! The triangle test: Möller & Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", JGT 2(1), 1997.
//!
//! With det = e1 . (D x e2), S = o - v0: u = S . (D x e2) / det, v = D . (S x e1) / det, t = e2 . (S x e1) / det. The
//! division waits until the ray is known to meet the triangle, as in the paper's own code for culling: most do not.

use core_rt::kernel::Vertices;
use core_rt::num::{Triple, cross as integer_cross, sub as integer_sub};

use crate::format::Format;
use crate::kernel::MARGIN;
use crate::ray::Ray;
use crate::real::Real;
use crate::record::TriangleRecord;
use crate::vector::{cross, dot, sub};

/// Materials are numbered up to this.
pub(crate) const MATERIALS_MAX: u32 = i32::MAX.unsigned_abs();

/// The record, or `None` where the triangle has no area, is off the grid, or its material is too high. Whether it has area
/// is decided in integers, as for every kernel.
pub(crate) fn pack<F: Format>(vertices: &Vertices, material: u32) -> Option<F::Triangle> {
    let grid = MARGIN..(1 << F::GRID_BITS) - MARGIN;
    if !vertices.as_flattened().iter().all(|c| grid.contains(c)) || material > MATERIALS_MAX {
        return None;
    }
    let [v0, v1, v2] = *vertices;
    let (e1, e2) = (integer_sub(v1, v0), integer_sub(v2, v0));
    if integer_cross(e1.map(i64::from), e2.map(i64::from)) == [0; 3] {
        return None;
    }
    Some(F::Triangle::new([v0, e1, e2].map(|row| row.map(F::from_i32)), material))
}

/// The corners: exact for a record that [`pack`] made.
pub(crate) fn vertices<F: Format>(triangle: &F::Triangle) -> Vertices {
    let [v0, e1, e2] = *triangle.rows();
    let to = |e: Triple<F>| [v0[0] + e[0], v0[1] + e[1], v0[2] + e[2]].map(F::to_i32);
    [v0.map(F::to_i32), to(e1), to(e2)]
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Hit<F> {
    pub(crate) t: F,
    pub(crate) u: F,
    pub(crate) v: F,
}

/// The determinant and the numerators of u, v and t, of a ray that meets the triangle at t > 0; all by one sign, so that
/// the determinant is positive.
#[inline(always)]
fn meet<F: Real>(ray: &Ray<F>, rows: &[Triple<F>; 3]) -> Option<(F, Hit<F>)> {
    let [v0, e1, e2] = *rows;
    let p = cross(ray.direction, e2);
    let det = dot(e1, p);
    let (facing, away) = (det > F::ZERO, det < F::ZERO);
    if !(facing || away) {
        return None;
    }
    let positive = |value: F| if facing { value } else { -value };
    let det = positive(det);
    let s = sub(ray.origin, v0);
    let u = positive(dot(s, p));
    if u < F::ZERO || u > det {
        return None;
    }
    let q = cross(s, e1);
    let v = positive(dot(ray.direction, q));
    if v < F::ZERO || u + v > det {
        return None;
    }
    let t = positive(dot(e2, q));
    (t > F::ZERO).then_some((det, Hit { t, u, v }))
}

/// `t` of the hit, if there is one with 0 < t within the ray's reach. It is finite.
#[inline(always)]
pub(crate) fn intersect<F: Format>(ray: &Ray<F>, triangle: &F::Triangle) -> Option<F> {
    let (det, hit) = meet(ray, triangle.rows())?;
    let t = hit.t / det;
    (t < ray.reach).then_some(t)
}

/// The hit of a ray that has one.
#[inline]
pub(crate) fn hit<F: Format>(ray: &Ray<F>, triangle: &F::Triangle) -> Option<Hit<F>> {
    let (det, hit) = meet(ray, triangle.rows())?;
    Some(Hit { t: hit.t / det, u: hit.u / det, v: hit.v / det })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Triangle32;
    use core_rt::kernel::NONE;

    const FLOOR: Vertices = [[8, 8, 8], [12, 8, 8], [8, 12, 8]];

    fn floor() -> Triangle32 {
        pack::<f32>(&FLOOR, 3).unwrap()
    }

    fn at(origin: Triple<f32>, direction: Triple<f32>, reach: f32) -> Option<Hit<f32>> {
        let ray = Ray::new(origin, direction, reach, NONE).unwrap();
        let found = intersect(&ray, &floor())?;
        let whole = hit(&ray, &floor());
        assert_eq!(whole.map(|hit| hit.t), Some(found));
        whole
    }

    #[test]
    fn a_known_point_from_both_sides() {
        let expected = Some(Hit { t: 8.0, u: 0.25, v: 0.5 });
        assert_eq!(at([9.0, 10.0, 24.0], [0.0, 0.0, -2.0], f32::INFINITY), expected);
        assert_eq!(at([9.0, 10.0, 4.0], [0.0, 0.0, 0.5], f32::INFINITY), expected);
        assert_eq!(at([9.0, 10.0, 4.0], [0.0, 0.0, -0.5], f32::INFINITY), None, "it is behind");
        assert_eq!(at([9.0, 10.0, 24.0], [0.0, 0.0, -2.0], 8.0), None, "the reach is not within");
        assert_eq!(at([9.0, 10.0, 8.0], [0.0, 0.0, -2.0], f32::INFINITY), None, "t = 0 is not a hit");
    }

    #[test]
    fn edges_and_corners_belong_to_it_and_the_plane_does_not() {
        for (x, y) in [(8.0, 8.0), (12.0, 8.0), (8.0, 12.0), (10.0, 10.0), (8.0, 9.0), (9.0, 8.0)] {
            assert!(at([x, y, 0.0], [0.0, 0.0, 1.0], f32::INFINITY).is_some(), "{x} {y}");
        }
        for (x, y) in [(7.5, 8.0), (8.0, 7.5), (10.5, 10.0), (12.5, 8.0)] {
            assert_eq!(at([x, y, 0.0], [0.0, 0.0, 1.0], f32::INFINITY), None, "{x} {y}");
        }
        assert_eq!(at([0.0, 9.0, 8.0], [1.0, 0.0, 0.0], f32::INFINITY), None);
    }

    #[test]
    fn records_keep_corners_and_material_to_the_ends_of_the_grid() {
        fn check<F: Format>() {
            let last = (1 << F::GRID_BITS) - MARGIN - 1;
            let far: Vertices = [[last, MARGIN, last - 1], [MARGIN, last, MARGIN], [last, last, MARGIN]];
            let record = pack::<F>(&far, MATERIALS_MAX).unwrap();
            assert_eq!((vertices::<F>(&record), record.material()), (far, MATERIALS_MAX));
            for bad in [last + 1, MARGIN - 1] {
                assert_eq!(pack::<F>(&[[bad, MARGIN, last], far[1], far[2]], 0), None);
            }
            assert_eq!(pack::<F>(&far, MATERIALS_MAX + 1), None);
            assert_eq!(pack::<F>(&[far[0], far[1], far[0]], 0), None, "no area");
        }
        check::<f32>();
        check::<f64>();
    }
}
