//! Nearest hits by brute force in exact arithmetic: what every exact kernel must agree with.
//!
//! A ray meets a triangle where it passes its three edges on one side. With the vertices relative
//! to the origin, p = v - o, the side of an edge is the sign of a volume spanned with the
//! direction:
//!
//! ```text
//! w0 = det(d, p1, p2)    w1 = det(d, p2, p0)    w2 = det(d, p0, p1)
//! t = det(p0, p1, p2) / (w0 + w1 + w2)
//! ```
//!
//! (K. Jones, *Intersecting a ray and a triangle with Plücker coordinates*, Ray Tracing News 13(1),
//! 2000.) The kernels work from e1, e2 and S x d instead, so the two share a definition and no
//! formula. There are no boxes and no hierarchy. The one shortcut, `separated`, is exact too.

use std::cmp::Ordering;

use ethnum::U256;
use rayon::prelude::*;

/// A triangle by its three vertices, grid units.
pub type Triangle = [[i64; 3]; 3];

/// The greatest absolute value of a coordinate of a vertex or an origin.
pub const MAX_COORDINATE: i64 = 1 << 30;
/// The greatest absolute value of a component of a direction.
pub const MAX_DIRECTION: i64 = 1 << 31;

/// Rays that share one pass over a block of triangles, and the triangles of a block: 18 KiB of
/// them, so that a large mesh is read from the first-level cache and not from memory.
const BATCH: usize = 64;
const BLOCK: usize = 512;

/// A ray: the points o + t d with t > 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ray {
    /// o, grid units; each at most [`MAX_COORDINATE`] in size.
    pub origin: [i64; 3],
    /// d, grid units per unit of t; each at most [`MAX_DIRECTION`] in size. Zero hits nothing.
    pub direction: [i64; 3],
    /// `Some(k)`, k < 128: only t < 2^-k counts. A segment is `Some(0)`, or k after d was shifted
    /// left by k.
    pub limit: Option<u32>,
    /// The triangle on which the ray starts; it is not tested.
    pub skip: Option<u32>,
}

/// A hit at t = numerator / denominator, both positive, not reduced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Nearest {
    /// Index of the triangle.
    pub prim: u32,
    /// |S . N| with S = o - v0 and N = e1 x e2; below 2^95.6.
    pub numerator: i128,
    /// |d . N|; below 2^97.2.
    pub denominator: i128,
}

impl Nearest {
    /// The order of hits along one ray: by t exactly, then by index.
    pub fn order(&self, other: &Self) -> Ordering {
        // Below 2^95.6 * 2^97.2 < 2^193.
        let cross =
            |a: &Self, b: &Self| U256::from(a.numerator.unsigned_abs()) * U256::from(b.denominator.unsigned_abs());
        cross(self, other).cmp(&cross(other, self)).then(self.prim.cmp(&other.prim))
    }
}

/// The triangles of a mesh, ready to be tried one by one.
#[derive(Clone, Debug)]
pub struct Oracle {
    /// Coordinates fit 31 bits; half the bytes is half the memory traffic of a pass.
    triangles: Vec<[[i32; 3]; 3]>,
}

impl Oracle {
    /// Takes a mesh; a triangle without area is never hit.
    ///
    /// # Panics
    /// If a coordinate exceeds [`MAX_COORDINATE`].
    pub fn new(triangles: &[Triangle]) -> Self {
        let narrow = |c: i64| {
            assert!(c.abs() <= MAX_COORDINATE, "vertex coordinate {c} is out of the oracle's range");
            c as i32
        };
        Self { triangles: triangles.iter().map(|t| t.map(|v| v.map(narrow))).collect() }
    }

    /// The hit with the smallest t, and of those the one with the lowest index.
    ///
    /// # Panics
    /// If the ray is out of range.
    pub fn nearest(&self, ray: &Ray) -> Option<Nearest> {
        hits(&self.triangles, 0, ray).min_by(Nearest::order)
    }

    /// Whether anything is hit.
    ///
    /// # Panics
    /// If the ray is out of range.
    pub fn any(&self, ray: &Ray) -> bool {
        hits(&self.triangles, 0, ray).next().is_some()
    }

    /// [`Oracle::nearest`] of each ray, on all cores: the way to try many rays on a large mesh.
    ///
    /// # Panics
    /// If a ray is out of range.
    pub fn nearest_batch(&self, rays: &[Ray]) -> Vec<Option<Nearest>> {
        rays.par_chunks(BATCH)
            .flat_map_iter(|rays| {
                let mut nearest = vec![None; rays.len()];
                for (block, triangles) in self.triangles.chunks(BLOCK).enumerate() {
                    for (ray, nearest) in rays.iter().zip(&mut nearest) {
                        *nearest = hits(triangles, block * BLOCK, ray).chain(*nearest).min_by(Nearest::order);
                    }
                }
                nearest
            })
            .collect()
    }
}

/// All hits of the ray with triangles of which the first has index `first`.
fn hits<'a>(triangles: &'a [[[i32; 3]; 3]], first: usize, ray: &'a Ray) -> impl Iterator<Item = Nearest> + 'a {
    assert!(
        ray.origin.iter().all(|c| c.abs() <= MAX_COORDINATE) && ray.direction.iter().all(|c| c.abs() <= MAX_DIRECTION),
        "{ray:?} is out of the oracle's range"
    );
    triangles.iter().enumerate().filter_map(move |(i, triangle)| {
        // At most 2^30 + 2^30 = 2^31 in size.
        let relative = triangle.map(|v| [0, 1, 2].map(|axis| i64::from(v[axis]) - ray.origin[axis]));
        let prim = (first + i) as u32;
        if separated(&relative, ray.direction) || ray.skip == Some(prim) {
            return None;
        }
        let (numerator, denominator) = hit(&relative, ray.direction)?;
        // n < d / 2^k in integers, without a shift that could overflow.
        let in_reach = ray.limit.is_none_or(|k| numerator <= (denominator - 1) >> k);
        in_reach.then_some(Nearest { prim, numerator, denominator })
    })
}

/// Whether all vertices (relative to the origin) lie strictly on one side of the plane through the
/// ray and one of the axes. That plane holds the whole line and no point of the triangle: certainly
/// a miss.
#[inline]
fn separated(p: &Triangle, d: [i64; 3]) -> bool {
    [(0, 1), (1, 2), (2, 0)].iter().any(|&(i, j)| {
        // Compared, not subtracted: a product is at most 2^31 * 2^31 = 2^62, a difference 2^63.
        p.iter().all(|p| p[i] * d[j] > p[j] * d[i]) || p.iter().all(|p| p[i] * d[j] < p[j] * d[i])
    })
}

/// t as a fraction of positive parts, if the ray meets the triangle (relative to the origin).
fn hit(p: &Triangle, d: [i64; 3]) -> Option<(i128, i128)> {
    let [p0, p1, p2] = *p;
    let volumes = [determinant(d, p1, p2), determinant(d, p2, p0), determinant(d, p0, p1)];
    let denominator: i128 = volumes.iter().sum(); // below 3 * 2^95.6 < 2^97.2
    let side = denominator.signum();
    let numerator = determinant(p0, p1, p2) * side;
    let inside = volumes.iter().all(|w| w * side >= 0);
    (side != 0 && inside && numerator > 0).then_some((numerator, denominator.abs()))
}

/// a . (b x c): six products of at most 2^31 * 2^31 * 2^31, so below 2^95.6.
fn determinant(a: [i64; 3], b: [i64; 3], c: [i64; 3]) -> i128 {
    let [a, b, c] = [a, b, c].map(|v| v.map(i128::from));
    a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])
}

#[cfg(test)]
mod tests;
