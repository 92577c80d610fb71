//! What is true of rays and triangles on the grid of two bits, from a table of all its determinants, in big integers.
//!
//! With the vertices relative to the origin a ray passes the edges of a triangle on the sides that det(d, p1, p2),
//! det(d, p2, p0) and det(d, p0, p1) say, and t is det(p0, p1, p2) over their sum (K. Jones, *Intersecting a ray and a triangle
//! with Plücker coordinates*, Ray Tracing News 13(1), 2000). The kernel has other formulas.

use num::{BigInt, ToPrimitive};
use rayon::prelude::*;

/// A point of the grid, a difference of two, or a direction.
pub(crate) type Vector = [i32; 3];

/// The largest component of a difference, and of a direction.
const MOST: i32 = 3;

/// Values of a component.
const VALUES: usize = 2 * MOST as usize + 1;

/// How many vectors there are.
pub(crate) const VECTORS: usize = VALUES.pow(3);

/// The number of a vector.
pub(crate) fn index(vector: Vector) -> usize {
    vector.iter().fold(0, |sum, c| sum * VALUES + (c + MOST) as usize)
}

/// The vector of a number.
pub(crate) fn vector(index: usize) -> Vector {
    [index / (VALUES * VALUES), index / VALUES % VALUES, index % VALUES].map(|c| c as i32 - MOST)
}

/// `a - b`.
pub(crate) fn difference(a: Vector, b: Vector) -> Vector {
    [0, 1, 2].map(|axis| a[axis] - b[axis])
}

/// det(a, b, c) for all differences b and c that there are at once, and all a.
pub(crate) struct Determinants(Vec<Vec<i16>>);

impl Determinants {
    pub(crate) fn new() -> Self {
        let big = |v: Vector| v.map(BigInt::from);
        let all: Vec<[BigInt; 3]> = (0..VECTORS).map(|a| big(vector(a))).collect();
        let row = |pair: usize| {
            let (b, c) = (vector(pair / VECTORS), vector(pair % VECTORS));
            if difference(b, c).iter().any(|c| c.abs() > MOST) {
                return Vec::new();
            }
            let ([bx, by, bz], [cx, cy, cz]) = (big(b), big(c));
            let normal = [&by * &cz - &bz * &cy, &bz * &cx - &bx * &cz, &bx * &cy - &by * &cx];
            let determinant = |a: &[BigInt; 3]| &a[0] * &normal[0] + &a[1] * &normal[1] + &a[2] * &normal[2];
            all.iter().map(|a| determinant(a).to_i16().expect("below 2^10")).collect()
        };
        Self((0..VECTORS * VECTORS).into_par_iter().map(row).collect())
    }

    /// det(a, b, c) by the number of a.
    pub(crate) fn of(&self, b: Vector, c: Vector) -> &[i16] {
        &self.0[index(b) * VECTORS + index(c)]
    }
}

/// Where a line from the origin meets a triangle, by the determinants of its edges and of its corners: t as a fraction of
/// positive parts.
pub(crate) fn meets(edges: [i16; 3], corners: i16) -> Option<(i64, i64)> {
    let denominator: i16 = edges.iter().sum();
    let side = denominator.signum();
    let numerator = corners * side;
    let inside = edges.iter().all(|edge| edge * side >= 0);
    (side != 0 && inside && numerator > 0).then_some((numerator.into(), denominator.abs().into()))
}
