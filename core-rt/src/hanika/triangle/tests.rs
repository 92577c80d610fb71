use super::super::boxes::TightSlab;
use super::super::ray::T_END;
use super::super::testing::Random;
use super::*;
use crate::arithmetic::Arithmetic;

type Ray = super::Ray<TightSlab<1>>;

const SETTINGS: Arithmetic = Arithmetic { c_bits: 12, d_bits: 12, edge_shift: 0, epsilon: 4 };

fn ray(edge_shift: u8, origin: Triple<i64>, direction: Triple<i64>) -> Ray {
    Ray::new(Arithmetic { edge_shift, ..SETTINGS }, origin, direction, 0).unwrap()
}

fn wide(v: Triple<i32>) -> Triple<i128> {
    v.map(i128::from)
}

/// Twice the signed area of the projection along an axis, from the vertices and not from edges.
fn area(vertices: &Vertices, axis: usize) -> i128 {
    let [p, q] = [(axis + 1) % 3, (axis + 2) % 3];
    let [a, b, c] = vertices.map(wide);
    a[p] * b[q] - b[p] * a[q] + b[p] * c[q] - c[p] * b[q] + c[p] * a[q] - a[p] * c[q]
}

/// Every field, against the fraction that it is the nearest to.
#[test]
fn records_hold_the_nearest_numbers() {
    let mut random = Random(1);
    let (mut saturated, mut clamped) = (0, 0);
    for _ in 0..200_000 {
        let vertices = random.triangle();
        let edge_shift = random.within(0, 29) as u8;
        let areas = [0, 1, 2].map(|axis| area(&vertices, axis));
        let Some(record) = pack(edge_shift, &vertices, 5) else {
            assert_eq!(areas, [0; 3], "{vertices:?}");
            continue;
        };
        assert_eq!((record.vertices(), record.material()), (vertices, 5));
        let [r, p, q] = record.axes();
        assert_eq!([p, q], [(r + 1) % 3, (r + 2) % 3]);
        assert!(areas.iter().all(|area| area.abs() <= areas[r].abs()), "{vertices:?}");
        let nearest = |found: i64, numerator: i128| {
            let denominator = areas[r].abs();
            let numerator = numerator * areas[r].signum();
            if found.abs() == i64::from(i32::MAX) {
                // Or beyond it.
                return numerator * i128::from(found.signum()) * 2 >= denominator * (2 * i128::from(i32::MAX) - 1);
            }
            (i128::from(found) * denominator - numerator).abs() * 2 <= denominator
        };
        let [n_p, n_q] = record.normal.map(i64::from);
        assert!(nearest(n_p, areas[p] << 31) && nearest(n_q, areas[q] << 31), "{vertices:?} {record:?}");
        saturated += u32::from(n_p.abs() == ONE || n_q.abs() == ONE);
        let [a, b, c] = vertices.map(wide);
        for (edge, end) in [(record.e1, b), (record.e2, c)] {
            for (found, axis) in edge.into_iter().zip([p, q]) {
                let scaled = ((end[axis] - a[axis]) * i128::from(i32::MAX)) << edge_shift;
                assert!(nearest(found.into(), scaled), "{vertices:?} {record:?}");
                clamped += u32::from(i64::from(found).abs() == ONE);
            }
        }
        let plane = (a[r] << 31) + i128::from(n_p) * a[p] + i128::from(n_q) * a[q];
        assert!(((i128::from(record.plane) << 31) - plane).abs() <= 1 << 30, "{vertices:?} {record:?}");
    }
    assert!(saturated > 100 && clamped > 100, "{saturated} {clamped}: the ends were not tried");
}

#[test]
fn what_is_no_triangle_is_refused() {
    let good = [[16, 16, 16], [100, 16, 16], [16, 100, 16]];
    assert!(pack(0, &good, MATERIALS_MAX).is_some() && pack(0, &good, MATERIALS_MAX + 1).is_none());
    assert!(pack(0, &[[16, 16, 16], [100, 16, 16], [184, 16, 16]], 0).is_none(), "no area");
    let last = (1 << 29) - 17;
    assert!(pack(0, &[[16, 16, last], [100, 16, 16], [16, 100, 16]], 0).is_some());
    for off in [15, last + 1, -1, i32::MIN] {
        assert!(pack(0, &[[16, 16, off], [100, 16, 16], [16, 100, 16]], 0).is_none(), "{off}");
    }
}

/// A right angle whose legs are a power of two, so that nothing but the scaling below 1 rounds.
#[test]
fn a_plain_triangle_is_hit_where_it_is() {
    let record = pack(10, &[[100, 100, 100], [1124, 100, 100], [100, 1124, 100]], 0).unwrap();
    assert_eq!((record.e1, record.e2), ([i32::MAX, 0], [0, i32::MAX]));
    let found = |x, y| hit(&ray(10, [x, y, 1000], [0, 0, -1]), &record);
    let inside = found(100 + 256, 100 + 512).unwrap();
    assert_eq!((inside.t, inside.away), (900, false));
    // u is the weight of v2, v that of v1: a quarter of v1 and half of v2, in Q(31 + 10) and less by 2^-31.
    assert_eq!([inside.v, inside.u], [256, 512].map(|k| k * ONE));
    // Edges belong to it, and the next row does not.
    for (x, y, is_hit) in [
        (100, 100, true),
        (1124, 100, true),
        (612, 612, true),
        (613, 612, false),
        (99, 100, false),
        (100, 99, false),
        (1125, 100, false),
    ] {
        assert_eq!(found(x, y).is_some(), is_hit, "{x} {y}");
    }
    // From behind, from too near, and away from it.
    assert!(hit(&ray(10, [200, 200, 0], [0, 0, 1]), &record).unwrap().away);
    assert_eq!(hit(&ray(10, [200, 200, 100], [0, 0, -1]), &record), None);
    assert_eq!(hit(&ray(10, [200, 200, 1000], [0, 0, 1]), &record), None);
    assert_eq!(hit(&ray(10, [200, 200, 1000], [1, 0, 0]), &record), None, "along the plane");
}

/// A segment's hits are before its end.
#[test]
fn reach_is_exclusive() {
    let record = pack(10, &[[100, 100, 100], [1124, 100, 100], [100, 1124, 100]], 0).unwrap();
    let to = |reach| hit(&Ray { reach, ..ray(10, [200, 200, 1000], [0, 0, -1]) }, &record).is_some();
    assert!(to(901) && !to(900));
}

/// With an E that is too large, an edge is clamped, and the triangle is wider than it should be: what the report sees at a
/// fixed E = 10.
#[test]
fn a_large_edge_shift_widens_small_triangles() {
    let vertices = [[100, 100, 100], [164, 100, 100], [100, 164, 100]];
    let is_hit = |edge_shift, x| {
        let record = pack(edge_shift, &vertices, 0).unwrap();
        hit(&ray(edge_shift, [x, 100, 1000], [0, 0, -1]), &record).is_some()
    };
    assert!(is_hit(6, 164) && !is_hit(6, 165));
    assert!(is_hit(7, 165) && is_hit(7, 228));
}

/// The bound from which boxes are stored larger: how far a hit is off the plane, along r; and that hits at the ends of all
/// ranges overflow nothing.
#[test]
fn hits_are_less_than_seven_units_off_the_plane() {
    let mut random = Random(2);
    let (mut hits, mut worst) = (0, 0);
    for _ in 0..2_000_000 {
        let vertices = random.triangle();
        let Some(projection) = Projection::of(&vertices) else { continue };
        let edge_shift = projection.edge_shift();
        let record = pack(edge_shift, &vertices, 0).unwrap();
        // Towards a point of the triangle, from anywhere that an origin may be.
        let weights = [random.within(0, 16), random.within(0, 16), 1];
        let total: i64 = weights.iter().sum();
        let target =
            [0, 1, 2].map(|axis| (0..3).map(|i| weights[i] * i64::from(vertices[i][axis])).sum::<i64>() / total);
        let origin = random.vertex().map(|c| (i64::from(c) - (1 << 28)) * 2 + (1 << 28));
        let origin = [0, 1, 2].map(|axis| {
            let (low, high) = vertices
                .iter()
                .fold((i64::MAX, i64::MIN), |(low, high), v| (low.min(v[axis].into()), high.max(v[axis].into())));
            let span = (1 << 29) + (1 << 7);
            origin[axis].clamp(high - span, low + span)
        });
        let Some(ray) = Ray::new(Arithmetic { edge_shift, ..SETTINGS }, origin, sub(target, origin), 0) else {
            continue;
        };
        let Some(Hit { t, .. }) = hit(&ray, &record) else { continue };
        hits += 1;
        // N . (X - v0) / N_r, in Q31.
        let areas = [0, 1, 2].map(|axis| area(&vertices, axis));
        let off = (0..3).map(|axis| {
            let x_q31 = (i128::from(origin[axis] - i64::from(vertices[0][axis])) << 31)
                + i128::from(t) * i128::from(ray.direction[axis]);
            areas[axis] * x_q31
        });
        worst = worst.max((off.sum::<i128>() / areas[record.axes()[0]]).unsigned_abs());
    }
    assert!(hits > 500_000, "{hits}");
    assert!(worst < 7 << 31, "{} / 2^31", worst);
    assert!(worst > 3 << 31, "{} / 2^31: the bound is stale", worst);
}

/// The largest products: far corners of the grid, unclamped directions, clamped edges. Overflow is trapped.
#[test]
fn the_ends_of_the_ranges_overflow_nothing() {
    let mut random = Random(3);
    let ends = [-(1 << 29), -(1 << 7), 0, (1 << 29) + (1 << 7), 1 << 30];
    let (first, last) = (MARGIN, (1 << GRID_BITS) - 1 - MARGIN);
    let mut tried = 0;
    for _ in 0..1_000_000 {
        let vertices: Vertices = [0; 3].map(|_| [0; 3].map(|_| if random.within(0, 1) == 0 { first } else { last }));
        // Some are thin.
        let mut thin = vertices;
        thin[2] = thin[1].map(|c| (c + random.within(-3, 3) as i32).clamp(first, last));
        let vertices = if random.within(0, 1) == 0 { vertices } else { thin };
        let edge_shift = random.within(0, 29) as u8;
        let Some(record) = pack(edge_shift, &vertices, 0) else { continue };
        let origin = [0, 1, 2].map(|axis: usize| {
            let at = ends[random.within(0, 4) as usize];
            let span = (1 << 29) + (1 << 7);
            let (a, b, c) = (vertices[0][axis], vertices[1][axis], vertices[2][axis]);
            at.clamp(i64::from(a.max(b).max(c)) - span, i64::from(a.min(b).min(c)) + span)
        });
        let direction = [0; 3].map(|_| random.sized(31));
        let Some(ray) = Ray::new(Arithmetic { edge_shift, ..SETTINGS }, origin, direction, 0) else { continue };
        if let Some(hit) = hit(&ray, &record) {
            assert!((1..T_END).contains(&hit.t));
        }
        tried += 1;
    }
    assert!(tried > 100_000, "{tried}");
}
