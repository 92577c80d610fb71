use super::*;
use crate::meshes;
use crate::rays::{Bounds, Rays};
use num::{BigInt, BigRational, Integer, One, Signed, Zero, rational::Ratio};

/// The widest bounds that the oracle takes.
const WIDEST: Bounds = Bounds { grid_bits: 30, origin: [-MAX_COORDINATE, MAX_COORDINATE], direction: MAX_DIRECTION };

/// t, u and v of u e1 + v e2 - t d = o - v0 by elimination; `None` if it has no single solution.
fn solve<T: Clone + Integer + Signed + From<i64>>(triangle: &Triangle, ray: &Ray) -> Option<[Ratio<T>; 3]> {
    let [v0, v1, v2] = *triangle;
    let mut rows = [0, 1, 2].map(|i| {
        [-ray.direction[i], v1[i] - v0[i], v2[i] - v0[i], ray.origin[i] - v0[i]]
            .map(|c| Ratio::from_integer(T::from(c)))
    });
    for column in 0..3 {
        let found = (column..3).find(|&row| !rows[row][column].is_zero())?;
        rows.swap(column, found);
        let pivot = rows[column].clone();
        for (i, row) in rows.iter_mut().enumerate() {
            if i != column && !row[column].is_zero() {
                let factor = row[column].clone() / pivot[column].clone();
                for (entry, pivot) in row.iter_mut().zip(&pivot) {
                    *entry = entry.clone() - pivot.clone() * factor.clone();
                }
            }
        }
    }
    Some([0, 1, 2].map(|i| rows[i][3].clone() / rows[i][i].clone()))
}

/// t of a hit, by the definition itself.
fn rational_hit<T: Clone + Integer + Signed + From<i64>>(triangle: &Triangle, ray: &Ray) -> Option<Ratio<T>> {
    let [t, u, v] = solve::<T>(triangle, ray)?;
    let inside = !u.is_negative() && !v.is_negative() && u + v <= Ratio::one();
    (inside && t.is_positive()).then_some(t)
}

fn line(origin: [i64; 3], direction: [i64; 3]) -> Ray {
    Ray { origin, direction, limit: None, skip: None }
}

fn cube(values: std::ops::RangeInclusive<i64>) -> Vec<[i64; 3]> {
    let all = || values.clone();
    all().flat_map(|x| all().flat_map(move |y| all().map(move |z| [x, y, z]))).collect()
}

/// What takes itself for an oracle of one triangle: t of a hit.
type Judge = fn(&Triangle, &Ray) -> Option<Ratio<i64>>;

/// The kinds of points in {0, 1, 2}^3; a symmetry of the cube takes each other point to one of
/// these.
const ORIGINS: [[i64; 3]; 4] = [[1, 0, 0], [0, 0, 0], [1, 1, 0], [1, 1, 1]];

/// Tries all triangles on the grid 0..=side against the rays from those points in all directions
/// between two points of that grid. Returns how often the judge was right and wrong.
fn tiny_space(side: i64, judge: Judge) -> [usize; 2] {
    let (points, directions) = (cube(0..=side), cube(-side..=side));
    (0..points.len())
        .into_par_iter()
        .flat_map_iter(|a| {
            let points = &points;
            (0..a).flat_map(move |b| (0..b).map(move |c| [points[a], points[b], points[c]]))
        })
        .map(|triangle| {
            let mut verdicts = [0; 2];
            for origin in ORIGINS {
                for &direction in &directions {
                    let ray = line(origin, direction);
                    let right = judge(&triangle, &ray) == rational_hit::<i64>(&triangle, &ray);
                    verdicts[usize::from(!right)] += 1;
                }
            }
            verdicts
        })
        .reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}

fn t(nearest: Nearest) -> Ratio<i64> {
    Ratio::new(nearest.numerator as i64, nearest.denominator as i64)
}

#[test]
fn a_tiny_space_agrees_completely() {
    let [right, wrong] = tiny_space(2, |&[a, b, c], ray| {
        let forward = Oracle::new(&[[a, b, c]]).nearest(ray).map(t);
        let backward = Oracle::new(&[[c, b, a]]).nearest(ray).map(t);
        assert_eq!(forward, backward);
        forward
    });
    assert_eq!([right, wrong], [2925 * 4 * 125, 0]);
}

#[test]
fn a_tiny_space_finds_faults() {
    // Edges left out, hits behind or at the origin kept, v unchecked.
    let faults: [Judge; 3] = [
        |triangle, ray| {
            let [t, u, v] = solve::<i64>(triangle, ray)?;
            (t.is_positive() && u.is_positive() && v.is_positive() && u + v < Ratio::one()).then_some(t)
        },
        |triangle, ray| {
            let [t, u, v] = solve::<i64>(triangle, ray)?;
            (!u.is_negative() && !v.is_negative() && u + v <= Ratio::one()).then_some(t)
        },
        |triangle, ray| {
            let [t, u, v] = solve::<i64>(triangle, ray)?;
            (t.is_positive() && !u.is_negative() && u + v <= Ratio::one()).then_some(t)
        },
    ];
    for fault in faults {
        assert!(tiny_space(1, fault)[1] > 0);
    }
}

#[test]
fn the_widest_range_agrees_with_big_rationals() {
    let mut hits = 0;
    for (name, mesh) in meshes::all(30).into_iter().chain([("degenerates", meshes::degenerates(30))]) {
        // Spread over both signs, so that differences reach 2^31.
        let spread = |c: i64| if c > 1 << 29 { c } else { -c };
        let step = mesh.len().div_ceil(10);
        let mesh: Vec<_> = mesh.into_iter().step_by(step).map(|t| t.map(|v| v.map(spread))).collect();
        let oracle = Oracle::new(&mesh);
        for (kind, ray) in Rays::new(&mesh, WIDEST, 3).take(50) {
            let expected = (0..)
                .zip(&mesh)
                .filter(|(prim, _)| ray.skip != Some(*prim))
                .filter_map(|(prim, triangle)| Some((rational_hit::<BigInt>(triangle, &ray)?, prim)))
                .filter(|(t, _)| ray.limit.is_none() || *t < BigRational::one())
                .min();
            let found = oracle.nearest(&ray);
            hits += usize::from(found.is_some());
            let found = found.map(|n| (BigRational::new(n.numerator.into(), n.denominator.into()), n.prim));
            assert_eq!(found, expected, "{name} {kind:?} {ray:?}");
            assert_eq!(oracle.any(&ray), expected.is_some());
        }
    }
    assert!(hits > 100, "{hits}");
}

#[test]
fn the_shortcut_never_drops_a_hit_and_drops_most_misses() {
    let [mut dropped, mut tried] = [0, 0];
    for (name, mesh) in meshes::all(30) {
        for (kind, ray) in Rays::new(&mesh, WIDEST, 4).take(500) {
            for triangle in &mesh {
                let relative = triangle.map(|v| [0, 1, 2].map(|i| v[i] - ray.origin[i]));
                let dropped_here = separated(&relative, ray.direction);
                assert!(!dropped_here || hit(&relative, ray.direction).is_none(), "{name} {kind:?} {ray:?}");
                dropped += usize::from(dropped_here);
                tried += 1;
            }
        }
    }
    assert!(2 * dropped > tried, "{dropped} of {tried}");
}

#[test]
fn the_extreme_corners_do_not_overflow() {
    let ends = [-MAX_COORDINATE, MAX_COORDINATE];
    let corner = |set: usize| [0, 1, 2].map(|axis| ends[set >> axis & 1]);
    for set in 0..8 * 8 * 8 * 8 * 8 {
        let [a, b, c, origin, direction] = [0, 3, 6, 9, 12].map(|shift| corner(set >> shift & 7));
        let ray = line(origin, direction.map(|c| 2 * c));
        let found = Oracle::new(&[[a, b, c]]).nearest(&ray);
        // The same in units of 2^30, where nothing can overflow; d is two units long.
        let unit = |v: [i64; 3]| v.map(|c| c / MAX_COORDINATE);
        let expected = rational_hit::<i64>(&[a, b, c].map(unit), &line(unit(origin), unit(ray.direction)));
        let found = found.map(|n| BigRational::new(n.numerator.into(), n.denominator.into()));
        let expected = expected.map(|t| BigRational::new((*t.numer()).into(), (*t.denom()).into()));
        assert_eq!(found, expected);
    }
}

#[test]
fn fractions_are_ordered_exactly_and_ties_by_index() {
    let nearest = |prim, numerator, denominator| Nearest { prim, numerator, denominator };
    let (n, d) = ((1 << 95) + 12_345, (1 << 97) - 1);
    // 1/d - 1/(d+1) apart and less: a hundred bits beyond f64, and the products beyond 128 bits.
    assert_eq!(nearest(1, n, d).order(&nearest(0, n + 1, d)), Ordering::Less);
    assert_eq!(nearest(0, n, d).order(&nearest(1, n, d + 1)), Ordering::Greater);
    assert_eq!(nearest(1, n, d).order(&nearest(0, n - 1, d - 1)), Ordering::Greater);
    assert_eq!(nearest(5, 3, 7).order(&nearest(2, 3 << 90, 7 << 90)), Ordering::Greater);
    assert_eq!(nearest(1, 3, 7).order(&nearest(2, 3 << 90, 7 << 90)), Ordering::Less);
}

#[test]
fn ties_skips_and_limits_count() {
    let near = [[0, 0, 8], [1, 0, 8], [0, 1, 8]]; // |N| = 1: the fractions are in lowest terms
    let far = near.map(|[x, y, _]| [x, y, 16]);
    let oracle = Oracle::new(&[far, near, near]);
    let prim = |ray: Ray| {
        let nearest = oracle.nearest(&ray).map(|n| n.prim);
        assert_eq!(oracle.any(&ray), nearest.is_some());
        nearest
    };
    let ray = line([0, 0, 0], [0, 0, 1]);
    assert_eq!(prim(ray), Some(1));
    let skip = Some(1);
    assert_eq!(prim(Ray { skip, ..ray }), Some(2));
    let from_the_nearer = line([0, 0, 8], [0, 0, 1]); // t = 0 is no hit
    assert_eq!(prim(from_the_nearer), Some(0));
    // A segment that ends on the surface stops short of it; shifted left, it is the same segment.
    for shift in [0, 5, 20] {
        let segment = |z: i64| Ray { direction: [0, 0, z << shift], limit: Some(shift), ..ray };
        assert_eq!([prim(segment(8)), prim(segment(9))], [None, Some(1)]);
    }
    let limit = Some(127);
    assert_eq!(prim(Ray { limit, ..ray }), None);
}

#[test]
fn batches_give_what_single_rays_give() {
    // More than a block of triangles, with copies on either side of its end; not a whole number of
    // batches.
    let mesh = meshes::duplicates(20, 400, 5);
    let oracle = Oracle::new(&mesh);
    let bounds = Bounds { grid_bits: 20, origin: [0, 1 << 20], direction: 1 << 20 };
    let rays: Vec<_> = Rays::new(&mesh, bounds, 6).take(BATCH * 2 + 7).map(|(_, ray)| ray).collect();
    let single: Vec<_> = rays.iter().map(|ray| oracle.nearest(ray)).collect();
    assert!(single.iter().flatten().count() > 50);
    assert_eq!(oracle.nearest_batch(&rays), single);
}
