//! The triangle test: exact signs, a filter in one word, hits in exact order.
//!
//! With S = o - v0, R = S x D and N = e1 x e2, the barycentrics times the determinant are
//!
//! U = e2 . R,  V = -e1 . R,  det = -D . N,  W = det - U - V,  tn = S . N,  t = tn / det.
//!
//! The line through the ray meets the triangle iff U, V and W have one sign (zero belongs to both: edges are inclusive)
//! and det is not 0. It is a hit iff t > 0.
//!
//! **Filter.** Let e be below 2^b for all edges e of the triangle (b is its `shift`), m be b or [`Width::FILTER_SHIFT`], and
//! q = R >> m. Then u = e2 . q is U / 2^m low or high by less than |e2|_1, since each component of R / 2^m - q is in [0, 1). So
//! |u - U / 2^m| < 3 * 2^b, and likewise v. With R below 2^c, `|u| <= 3 * 2^b * 2^(c - m)` fits the word.
//! The record keeps n = N >> k, k = max(0, 2 b - NORMAL_BITS). Then -(D . n) is det / 2^k within |D|_1, and shifted right
//! by m - k it is det / 2^m within (3 * 2^DIRECTION_BITS >> (m - k)) + 2. W is a triple product with the third edge, as U and V
//! are with theirs, so W / 2^m and its error, far below 2^c, fit the word although the terms' sum may not: it is computed by wrapping.
//! Where the filter is undecided, the same sums are formed in [`Width::Wide`], without error. `docs/EXACTNESS.md` has the
//! proof step by step.

use core::cmp::Ordering;

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use super::ray::Ray;
use super::width::{Wide, Width};
use crate::kernel::Vertices;
use crate::num::{Triple, Word, cross, narrow_dot, sub};

/// v0, e1, e2, n = N >> k (three fields each), then shift and material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(transparent)]
pub struct TriangleRecord<T>([T; 13]);

impl<T: Copy> TriangleRecord<T> {
    #[inline(always)]
    fn row<W: Word>(&self, first: usize) -> Triple<W>
    where
        T: Into<W>,
    {
        // `first` is a constant of the callers, so the checks fold away.
        [self.0[first].into(), self.0[first + 1].into(), self.0[first + 2].into()]
    }

    #[inline(always)]
    fn v0<W: Word>(&self) -> Triple<W>
    where
        T: Into<W>,
    {
        self.row(0)
    }

    #[inline(always)]
    pub(super) fn v0_fields(&self) -> Triple<T> {
        [self.0[0], self.0[1], self.0[2]]
    }

    #[inline(always)]
    fn e1<W: Word>(&self) -> Triple<W>
    where
        T: Into<W>,
    {
        self.row(3)
    }

    #[inline(always)]
    fn e2<W: Word>(&self) -> Triple<W>
    where
        T: Into<W>,
    {
        self.row(6)
    }

    #[inline(always)]
    pub(super) fn n<W: Word>(&self) -> Triple<W>
    where
        T: Into<W>,
    {
        self.row(9)
    }

    #[inline(always)]
    pub(super) fn meta(&self) -> T {
        self.0[12]
    }
}

/// The record, or `None` where the triangle has no area, is off the grid, or its material is too high.
pub(super) fn pack<W: Width>(vertices: &Vertices, material: u32) -> Option<TriangleRecord<W::Short>> {
    let grid = W::MARGIN..(1 << W::GRID_BITS) - W::MARGIN;
    if !vertices.as_flattened().iter().all(|c| grid.contains(c)) {
        return None;
    }
    assemble::<W>(vertices.map(|vertex| vertex.map(W::Word::from_i32)), material)
}

/// The record of a triangle on the grid; `None` where it has no area, or its material is too high.
#[inline(always)]
pub(super) fn assemble<W: Width>(
    [v0, v1, v2]: [Triple<W::Word>; 3],
    material: u32,
) -> Option<TriangleRecord<W::Short>> {
    let (e1, e2) = (sub(v1, v0), sub(v2, v0));
    // Twice the area of a projection onto a square of side 2^b: below 2^(2 GRID_BITS), which the word has.
    let normal = cross(e1, e2);
    if normal == [W::Word::ZERO; 3] {
        return None;
    }
    // One count over the magnitudes: the highest set bit is what matters.
    let any = |e: Triple<W::Word>| e[0].magnitude() | e[1].magnitude() | e[2].magnitude();
    let shift = (any(e1) | any(e2) | any(sub(v2, v1))).magnitude_bits();
    let k = (2 * shift).saturating_sub(W::NORMAL_BITS);
    let [v0, e1, e2, n] = [v0, e1, e2, normal.map(|c| c >> k)].map(|row| row.map(W::short));
    let meta = W::join_meta(shift, material)?;
    Some(TriangleRecord([v0[0], v0[1], v0[2], e1[0], e1[1], e1[2], e2[0], e2[1], e2[2], n[0], n[1], n[2], meta]))
}

/// The record of a vertex on the grid.
pub(super) fn vertex<W: Width>(place: Triple<i32>) -> Triple<W::Short> {
    place.map(|c| W::short(W::Word::from_i32(c)))
}

/// The corners.
pub(super) fn vertices<W: Width>(triangle: &TriangleRecord<W::Short>) -> Vertices {
    let v0 = triangle.v0_fields().map(W::coordinate);
    let [e1, e2]: [Triple<W::Word>; 2] = [triangle.e1(), triangle.e2()];
    let add = |e: Triple<W::Word>| [v0[0] + e[0], v0[1] + e[1], v0[2] + e[2]];
    [v0, add(e1), add(e2)].map(|v| v.map(Word::low_i32))
}

/// A hit: t as an exact fraction of positive integers, and about t in `T_BITS`.
#[derive(Clone, Copy, Debug)]
pub struct Depth<W: Width> {
    /// The numerator of t.
    pub numerator: W::Wide,
    /// The denominator of t.
    pub denominator: W::Wide,
    /// t within [`Width::SLACK`], with [`Width::T_BITS`].
    pub t: W::Word,
}

/// The hit, if there is one with 0 < t within the ray's reach.
#[inline(always)]
pub(super) fn intersect<W: Width>(ray: &Ray<W>, triangle: &TriangleRecord<W::Short>) -> Option<Depth<W>> {
    let det = if W::FILTERED { filtered(ray, triangle) } else { W::Word::ONE };
    if det == W::Word::ZERO { None } else { exactly(ray, triangle, det == W::Word::ONE) }
}

/// The hit with a triangle that the line through the ray meets, or may meet.
#[cfg_attr(not(prefer_size), inline(always))]
#[cfg_attr(prefer_size, inline(never))]
pub(super) fn exactly<W: Width>(
    ray: &Ray<W>,
    triangle: &TriangleRecord<W::Short>,
    is_undecided: bool,
) -> Option<Depth<W>> {
    if is_undecided && !decided(ray, triangle) { None } else { depth(ray, triangle) }
}

/// Whether the line through the ray meets the triangle: if so -(D . n), which is then at least 2 in magnitude, 0 if not, and 1
/// where the filter does not decide.
///
/// Not inlined: most triangles are missed, and what a chip with few registers has for itself here is worth more than the call.
/// It calls nothing, so that it has nothing to keep.
#[inline(never)]
pub(super) fn filtered<W: Width>(ray: &Ray<W>, triangle: &TriangleRecord<W::Short>) -> W::Word {
    let [x, y, z] = triangle.v0_fields().map(W::coordinate);
    let s = sub(ray.origin, [x, y, z]);
    let (shift, _) = W::split_meta(triangle.meta());
    let taken = W::FILTER_SHIFT.unwrap_or(shift);
    let q = cross(s, ray.direction).map(|c| c >> taken);
    let edge_error = (W::Word::ONE + W::Word::ONE + W::Word::ONE) << shift;
    let u = narrow_dot(triangle.e2(), q);
    let v = -narrow_dot(triangle.e1(), q);
    // At least its error above 0, or below it: a sign is certain.
    let (least, most) = (u.min(v), u.max(v));
    if most >= edge_error && least <= -edge_error {
        return W::Word::ZERO;
    }

    let down = match W::FILTER_SHIFT {
        // m - k = b - k = min(b, NORMAL_BITS - b), and b <= GRID_BITS <= NORMAL_BITS.
        None => shift.min(W::NORMAL_BITS - shift),
        Some(taken) => taken - (2 * shift).saturating_sub(W::NORMAL_BITS),
    };
    let det = -narrow_dot(ray.direction, triangle.n());
    // Two: the shift may take a fraction off the error, and one off the determinant.
    let det_error =
        (((W::Word::ONE + W::Word::ONE + W::Word::ONE) << W::DIRECTION_BITS) >> down) + W::Word::ONE + W::Word::ONE;
    let w = (det >> down).wrapping_sub(u).wrapping_sub(v);
    let w_error = det_error + edge_error + edge_error;
    if w >= w_error {
        if least <= -edge_error {
            return W::Word::ZERO;
        }
        if least >= edge_error {
            return det;
        }
    } else if w <= -w_error {
        if most >= edge_error {
            return W::Word::ZERO;
        }
        if most <= -edge_error {
            return det;
        }
    }
    W::Word::ONE
}

/// Whether the line through the ray meets the triangle, without error.
#[inline(always)]
fn decided<W: Width>(ray: &Ray<W>, triangle: &TriangleRecord<W::Short>) -> bool {
    let [v0, e1, e2] = parts::<W>(triangle);
    let r = cross(sub(ray.origin, v0), ray.direction);
    let zero = W::Wide::default();
    let u = W::dot(e2, r);
    let v = -W::dot(e1, r);
    if (u < zero && v > zero) || (u > zero && v < zero) {
        return false;
    }
    let det = -W::dot(ray.direction, cross(e1, e2));
    let w = det.wrapping_sub(u).wrapping_sub(v);
    (u >= zero && v >= zero && w >= zero && det > zero) || (u <= zero && v <= zero && w <= zero && det < zero)
}

/// t, for a line that meets the triangle.
#[cfg_attr(not(prefer_size), inline(always))]
pub(super) fn depth<W: Width>(ray: &Ray<W>, triangle: &TriangleRecord<W::Short>) -> Option<Depth<W>> {
    let [v0, e1, e2] = parts::<W>(triangle);
    let s = sub(ray.origin, v0);
    let (numerator, denominator) = fraction::<W>(ray, s, e1, e2);
    if numerator <= W::Wide::default() {
        return None;
    }
    within_reach(ray, numerator, denominator)
}

/// The hit at a t of positive parts, if that is within the ray's reach.
#[inline(always)]
pub(super) fn within_reach<W: Width>(ray: &Ray<W>, numerator: W::Wide, denominator: W::Wide) -> Option<Depth<W>> {
    // n < d 2^r iff floor(n / 2^r) < d, and n 2^r < d iff n < ceil(d / 2^r): no shift that could overflow.
    let within_reach = match ray.reach {
        None => true,
        Some(reach @ 0..) => numerator >> reach.unsigned_abs() < denominator,
        Some(reach) => numerator < -(-denominator >> reach.unsigned_abs()),
    };
    within_reach.then(|| Depth { numerator, denominator, t: W::depth(numerator, denominator) })
}

/// tn and det, with det made positive.
#[inline]
pub(super) fn fraction<W: Width>(
    ray: &Ray<W>,
    s: Triple<W::Word>,
    e1: Triple<W::Word>,
    e2: Triple<W::Word>,
) -> (W::Wide, W::Wide) {
    let normal = cross(e1, e2);
    let det = -W::dot(ray.direction, normal);
    let numerator = W::dot(s, normal);
    if det < W::Wide::default() { (-numerator, -det) } else { (numerator, det) }
}

/// The exact order of t, by the approximate one where that is certain.
#[inline]
pub(super) fn order<W: Width>(a: &Depth<W>, b: &Depth<W>) -> Ordering {
    let apart = W::SLACK + W::SLACK;
    if a.t + apart < b.t {
        Ordering::Less
    } else if b.t + apart < a.t {
        Ordering::Greater
    } else {
        W::order((a.numerator, a.denominator), (b.numerator, b.denominator))
    }
}

/// The pieces that resolving a hit needs.
#[inline(always)]
pub(super) fn parts<W: Width>(triangle: &TriangleRecord<W::Short>) -> [Triple<W::Word>; 3] {
    [triangle.v0(), triangle.e1(), triangle.e2()]
}
