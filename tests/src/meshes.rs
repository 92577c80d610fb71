//! Small meshes that look for trouble: closed ones that must not leak, slivers, needles, ties.
//!
//! Vertices lie on the grid 0..2^bits; `bits` is 8 to 30. Except in [`degenerates`] every triangle
//! has an area.

use crate::oracle::Triangle;
use crate::random::SplitMix64;

/// A mesh of each sort for a grid, with its name. [`degenerates`] is not among them.
pub fn all(bits: u32) -> Vec<(&'static str, Vec<Triangle>)> {
    let last = last(bits);
    vec![
        ("sphere", sphere(bits, 12)),
        ("cuboid", cuboid([0; 3], [last; 3])),
        ("plate", cuboid([last / 3, last / 2, 0], [last / 2, last / 2 + 1, last])),
        ("soup", soup(bits, 200, 1)),
        ("slivers", slivers(bits, 200, 2)),
        ("needle fan", needle_fan(bits, 100)),
        ("coplanar", coplanar(bits, 100, 3)),
        ("duplicates", duplicates(bits, 50, 4)),
        ("staircase", staircase(bits, 100)),
        ("scales", scales(bits)),
        ("heightfield", heightfield(bits, 10, 5)),
    ]
}

/// A closed sphere over the grid: an octahedron, each face cut into n x n, rounded to the grid.
/// 8 n^2 triangles; they keep their areas for n up to 2^bits / 16.
pub fn sphere(bits: u32, n: i64) -> Vec<Triangle> {
    let radius = last(bits) / 2;
    let point = |v: [i64; 3]| {
        let length = (v.iter().map(|c| c * c).sum::<i64>() as f64).sqrt();
        v.map(|c| radius + 1 + (c as f64 * radius as f64 / length).round() as i64)
    };
    let mut triangles = Vec::new();
    for octant in 0..8 {
        let sign = [0, 1, 2].map(|axis| 1 - (octant >> axis & 1) * 2);
        let mut face = |corners: [[i64; 2]; 3]| {
            let [a, b, c] = corners.map(|[i, j]| point([sign[0] * i, sign[1] * j, sign[2] * (n - i - j)]));
            let mirrored = sign[0] * sign[1] * sign[2] < 0;
            triangles.push(if mirrored { [a, c, b] } else { [a, b, c] });
        };
        for i in 0..n {
            for j in 0..n - i {
                face([[i, j], [i + 1, j], [i, j + 1]]);
                if i + j + 2 <= n {
                    face([[i + 1, j], [i + 1, j + 1], [i, j + 1]]);
                }
            }
        }
    }
    triangles
}

/// A closed axis-parallel box of twelve triangles, seen from outside; `low` is below `high` on each
/// axis.
pub fn cuboid(low: [i64; 3], high: [i64; 3]) -> Vec<Triangle> {
    let corner = |set: usize| [0, 1, 2].map(|axis| if set >> axis & 1 == 1 { high[axis] } else { low[axis] });
    (0..3)
        .flat_map(|axis| {
            let [i, j, k] = [1, 2, 0].map(|step| 1 << ((axis + step) % 3));
            [[0, j, i], [i, j, i | j], [k, k | i, k | j], [k | j, k | i, k | i | j]]
        })
        .map(|triangle| triangle.map(corner))
        .collect()
}

/// Triangles between random grid points.
pub fn soup(bits: u32, count: usize, seed: u64) -> Vec<Triangle> {
    let mut random = SplitMix64(seed);
    with_area(count, || [[0; 3]; 3].map(|v| v.map(|_: i64| random.within([0, last(bits)]))))
}

/// Triangles whose third vertex is within two units of the line through the others; lengths of a
/// few units to the whole grid.
pub fn slivers(bits: u32, count: usize, seed: u64) -> Vec<Triangle> {
    let mut random = SplitMix64(seed);
    let last = last(bits);
    with_area(count, || {
        let reach = 2 << random.below(u64::from(bits));
        let a = [0; 3].map(|_: i64| random.within([0, last]));
        let b = a.map(|c| (c + random.within([-reach, reach])).clamp(0, last));
        let weight = random.within([0, 256]);
        let c = [0, 1, 2].map(|i| {
            let on_line = a[i] + (b[i] - a[i]) * weight / 256;
            (on_line + random.within([-1, 1])).clamp(0, last)
        });
        [a, b, c]
    })
}

/// Needles one unit wide from one corner of the grid to the opposite face; `count` is below 2^bits.
pub fn needle_fan(bits: u32, count: i64) -> Vec<Triangle> {
    let rim = |i| [last(bits), i, i & 1];
    (0..count).map(|i| [[0; 3], rim(i), rim(i + 1)]).collect()
}

/// Overlapping triangles in the plane x + y + z = 2^bits - 1: every hit is a tie of several.
pub fn coplanar(bits: u32, count: usize, seed: u64) -> Vec<Triangle> {
    let mut random = SplitMix64(seed);
    let last = last(bits);
    with_area(count, || {
        [[0; 3]; 3].map(|_: [i64; 3]| {
            let [x, y] = [0; 2].map(|_: i64| random.within([0, last / 2]));
            [x, y, last - x - y]
        })
    })
}

/// A soup, then the same with the vertices rotated, then the same reversed: ties go to the first
/// copy.
pub fn duplicates(bits: u32, count: usize, seed: u64) -> Vec<Triangle> {
    let soup = soup(bits, count, seed);
    let rotated = soup.iter().map(|&[a, b, c]| [b, c, a]);
    let reversed = soup.iter().map(|&[a, b, c]| [c, b, a]);
    soup.iter().copied().chain(rotated).chain(reversed).collect()
}

/// Triangles over half a face of the grid, nearly coplanar, stacked a unit or less apart and
/// crossing.
pub fn staircase(bits: u32, count: i64) -> Vec<Triangle> {
    let last = last(bits);
    let base = last / 2;
    let step = |i: i64| {
        let z = |vertex: i64| base + (i >> 3) + (i >> vertex & 1);
        [[0, 0, z(0)], [last, 0, z(1)], [0, last, z(2)]]
    };
    (0..count).map(step).collect()
}

/// A zigzag strip whose edges double from one unit to the whole grid.
pub fn scales(bits: u32) -> Vec<Triangle> {
    let rung = |k: u32| {
        let length = (1 << k).min(last(bits));
        let height = if k % 2 == 1 { length } else { 0 };
        ([length, 0, height], [0, length, height])
    };
    let (p, q) = rung(0);
    let strip = (0..bits).flat_map(|k| {
        let ((a, b), (c, d)) = (rung(k), rung(k + 1));
        [[a, c, b], [b, c, d]]
    });
    [[[0; 3], p, q]].into_iter().chain(strip).collect()
}

/// n x n cells of two triangles over the xy face, random heights, vertices shared; n is below
/// 2^bits.
pub fn heightfield(bits: u32, n: i64, seed: u64) -> Vec<Triangle> {
    let mut random = SplitMix64(seed);
    let last = last(bits);
    let row = n as usize + 1;
    let heights: Vec<i64> = (0..row * row).map(|_| random.within([0, last])).collect();
    let vertex = |i: i64, j: i64| [last * i / n, last * j / n, heights[j as usize * row + i as usize]];
    let cell = |i, j| {
        let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i, j + 1), vertex(i + 1, j + 1)];
        [[a, b, c], [c, b, d]]
    };
    (0..n).flat_map(|j| (0..n).flat_map(move |i| cell(i, j))).collect()
}

/// Triangles without area: points, doubled edges and collinear vertices. No ray hits one.
pub fn degenerates(bits: u32) -> Vec<Triangle> {
    let last = last(bits);
    let (a, b, c) = ([0; 3], [last / 2; 3], [last / 2 * 2; 3]);
    vec![[a, a, a], [c, c, c], [a, a, b], [a, b, a], [b, a, a], [a, b, c], [c, a, b], [b, c, a]]
}

/// The greatest coordinate.
fn last(bits: u32) -> i64 {
    (1 << bits) - 1
}

/// As many as asked for of those drawn that have an area.
fn with_area(count: usize, draw: impl FnMut() -> Triangle) -> Vec<Triangle> {
    std::iter::repeat_with(draw).filter(|t| normal(t) != [0; 3]).take(count).collect()
}

/// (v1 - v0) x (v2 - v0), exact for vertices on a grid of up to 30 bits: below 2^61.
fn normal([v0, v1, v2]: &Triangle) -> [i64; 3] {
    let [a, b] = [v1, v2].map(|v| [0, 1, 2].map(|i| v[i] - v0[i]));
    [0, 1, 2].map(|i| {
        let (j, k) = ((i + 1) % 3, (i + 2) % 3);
        a[j] * b[k] - a[k] * b[j]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashMap;

    /// Whether each edge is met by one triangle in each direction.
    fn is_closed(mesh: &[Triangle]) -> bool {
        let mut edges = HashMap::new();
        for &[a, b, c] in mesh {
            for edge in [[a, b], [b, c], [c, a]] {
                *edges.entry(edge).or_insert(0) += 1;
            }
        }
        edges.iter().all(|(&[a, b], &n)| n == 1 && edges.contains_key(&[b, a]))
    }

    /// Six times the volume inside a closed mesh seen counter-clockwise from outside.
    fn volume(mesh: &[Triangle]) -> i128 {
        let corner = |t: &Triangle| (0..3).map(|i| i128::from(normal(t)[i]) * i128::from(t[0][i])).sum::<i128>();
        mesh.iter().map(corner).sum()
    }

    #[test]
    fn meshes_lie_on_the_grid_and_have_areas() {
        for bits in [8, 14, 20, 29, 30] {
            for (name, mesh) in all(bits) {
                assert!(!mesh.is_empty());
                assert!(mesh.iter().flatten().flatten().all(|c| (0..1 << bits).contains(c)), "{name} {bits}");
                assert!(mesh.iter().all(|t| normal(t) != [0; 3]), "{name} {bits}");
            }
            assert!(degenerates(bits).iter().all(|t| normal(t) == [0; 3]));
        }
    }

    #[test]
    fn closed_meshes_are_closed_and_face_outwards() {
        for (bits, n) in [(8, 1), (8, 16), (14, 30), (30, 5)] {
            let mut sphere = sphere(bits, n);
            assert_eq!(sphere.len() as i64, 8 * n * n);
            assert!(is_closed(&sphere) && volume(&sphere) > 0);
            assert!(sphere.iter().all(|t| normal(t) != [0; 3]));
            sphere[0].swap(0, 1);
            assert!(!is_closed(&sphere), "a turned triangle must be noticed");
        }
        let mut cuboid = cuboid([1, 2, 3], [11, 22, 43]);
        assert!(is_closed(&cuboid));
        assert_eq!(volume(&cuboid), 6 * 10 * 20 * 40);
        cuboid.pop();
        assert!(!is_closed(&cuboid), "a hole must be noticed");
    }

    #[test]
    fn slivers_are_thin_and_scales_range_from_one_unit_to_the_grid() {
        let square = |[a, b]: [[i64; 3]; 2]| (0..3).map(|i| i128::from(a[i] - b[i]).pow(2)).sum::<i128>();
        for t in slivers(29, 1000, 6) {
            let longest = [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]].map(square).into_iter().max();
            let doubled_area = normal(&t).map(|c| i128::from(c).pow(2)).into_iter().sum::<i128>();
            // Height^2 = (2 area)^2 / longest^2: within two units of the line, and rounding.
            assert!(longest.is_some_and(|longest| doubled_area <= 9 * longest), "{t:?}");
        }
        let mesh = scales(20);
        let edges = || mesh.iter().flat_map(|t| [[t[0], t[1]], [t[1], t[2]]]).map(square);
        assert_eq!(edges().min(), Some(1));
        assert!(edges().max() >= Some(1 << 40));
        assert!((1..20).all(|k| edges().any(|e| (1 << (2 * k)..4 << (2 * k)).contains(&e))));
    }

    #[test]
    fn coplanar_triangles_share_one_plane() {
        let on_plane = |t: &Triangle| t.iter().all(|v| v.iter().sum::<i64>() == (1 << 20) - 1);
        assert!(coplanar(20, 50, 1).iter().all(on_plane));
        assert!(!soup(20, 50, 1).iter().any(on_plane));
    }
}
