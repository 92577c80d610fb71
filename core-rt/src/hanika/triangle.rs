//! The triangle test (2.4): Hanika's integer form of Wald's projection.
//!
//! With N = e1 x e2 and r the axis of its largest component, p and q the next two in turn, the plane is
//! `x_r + n_p x_p + n_q x_q = d` for n = N / N_r, and a point k of it, relative to v0, has the barycentrics
//!
//! u = (e1_p k_q - e1_q k_p) / N_r,  v = (e2_q k_p - e2_p k_q) / N_r,
//!
//! as the report names them: with e1 = v1 - v0 and e2 = v2 - v0 (derived) u is the weight of v2, and v that of v1.
//!
//! **Record.** n is Q31, rounded to nearest; 1 becomes 1 - 2^-31. The constant d is that of the rounded n, in whole grid units
//! (derived). Edges are divided by N_r, times 2^E, clamped to [-1, 1], and scaled to (-1, 1): by 2^31 - 1, so that no edge is
//! 2^31. So they are Q(31 + E), and so are u and v.
//!
//! **Hit.** Products are brought back by `>> 31` before they are added, as in the listing. Its numerator is that of whole grid
//! units, and t is `(numerator << 31) / denominator` (derived; the listing as it is printed has neither d nor the shift).

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use super::boxes::{self, Slab};
use super::ray::Ray;
use super::{GRID_BITS, MARGIN};
use crate::kernel::{ANY_OCTANT, Bounds, Vertices};
use crate::num::{Triple, cross, round_shift, sub};

/// The largest number below 1, in Q31.
const ONE: i64 = (1 << 31) - 1;

/// Denominators below this are refused. They are low by less than 2 (two floors) and wrong by at most 1 for each of n_p and n_q
/// (half a unit, or one where n is 1, times a direction of at most 1): below 4 units the sign is not known. The report gives no
/// value.
const DENOMINATOR_MIN: i64 = 4;

/// The material stands above the axis.
const AXIS_BITS: u32 = 2;
pub(super) const MATERIALS_MAX: u32 = u32::MAX >> AXIS_BITS;

/// A triangle in 68 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct TriangleRecord {
    /// n_p and n_q, Q31.
    normal: [i32; 2],
    /// d, grid units.
    plane: i32,
    /// Along p and q, over N_r, Q(31 + E).
    e1: [i32; 2],
    e2: [i32; 2],
    /// r, and the material above it.
    meta: u32,
    vertices: Vertices,
}

impl TriangleRecord {
    /// The corners, grid units.
    pub(super) fn vertices(&self) -> Vertices {
        self.vertices
    }

    #[inline]
    pub(super) fn material(&self) -> u32 {
        self.meta >> AXIS_BITS
    }

    /// r, p and q.
    #[inline(always)]
    pub(super) fn axes(&self) -> [usize; 3] {
        axes(self.meta as usize & ((1 << AXIS_BITS) - 1))
    }

    /// n_p and n_q, Q31.
    #[inline(always)]
    pub(super) fn slopes(&self) -> [i64; 2] {
        self.normal.map(i64::from)
    }
}

/// An axis and the next two in turn.
#[inline(always)]
fn axes(r: usize) -> [usize; 3] {
    match r {
        0 => [0, 1, 2],
        1 => [1, 2, 0],
        _ => [2, 0, 1],
    }
}

/// A triangle along the axis of its largest normal component, before any rounding.
#[derive(Clone, Copy, Debug)]
pub(super) struct Projection {
    r: usize,
    /// N along r, p and q, below 2^58: twice the area of a projection. The first is not zero, and the largest.
    normal: Triple<i64>,
    e1: [i64; 2],
    e2: [i64; 2],
}

impl Projection {
    /// `None` where the triangle has no area. Of axes that are equal the first is taken.
    pub(super) fn of(vertices: &Vertices) -> Option<Self> {
        let [v0, v1, v2] = vertices.map(|v| v.map(i64::from));
        let (e1, e2) = (sub(v1, v0), sub(v2, v0));
        let normal = cross(e1, e2);
        let [x, y, z] = normal.map(i64::abs);
        let r = if x >= y && x >= z {
            0
        } else if y >= z {
            1
        } else {
            2
        };
        let [r, p, q] = axes(r);
        let normal = [normal[r], normal[p], normal[q]];
        (normal[0] != 0).then_some(Self { r, normal, e1: [e1[p], e1[q]], e2: [e2[p], e2[q]] })
    }

    /// The largest E with all edges times 2^E at most N_r; 0 where there is none.
    pub(super) fn edge_shift(&self) -> u8 {
        let longest = self.e1.iter().chain(&self.e2).map(|c| c.unsigned_abs()).max().unwrap_or(0);
        // N_r is not zero, so neither is the longest. N_r <= 2 longest^2, so E <= 29.
        self.normal[0].unsigned_abs().checked_div(longest).and_then(u64::checked_ilog2).unwrap_or(0) as u8
    }
}

/// `numerator / denominator`, to nearest, halves away from zero, at most [`ONE`] in magnitude.
fn quotient(numerator: i128, denominator: i64) -> i32 {
    let (n, d) = (numerator.unsigned_abs(), u128::from(denominator.unsigned_abs()));
    let magnitude = ((2 * n + d) / (2 * d)).min(ONE as u128) as i32;
    if (numerator < 0) == (denominator < 0) { magnitude } else { -magnitude }
}

/// The record, or `None` where the triangle has no area, is off the grid, or its material is too high.
pub(super) fn pack(edge_shift: u8, vertices: &Vertices, material: u32) -> Option<TriangleRecord> {
    let grid = MARGIN..(1 << GRID_BITS) - MARGIN;
    if material > MATERIALS_MAX || !vertices.as_flattened().iter().all(|c| grid.contains(c)) {
        return None;
    }
    let Projection { r, normal: [n_r, n_p, n_q], e1, e2 } = Projection::of(vertices)?;
    // Below 2^58 * 2^31.
    let slope = |component: i64| quotient(i128::from(component) << 31, n_r);
    let normal = [n_p, n_q].map(slope);
    // Below 2^29 * 2^31 * 2^29.
    let edge = |component: i64| quotient((i128::from(component) * i128::from(ONE)) << edge_shift, n_r);
    let [v_r, v_p, v_q] = axes(r).map(|axis| i64::from(vertices[0][axis]));
    // Below 3 * 2^29 * 2^31, and 3 * 2^29 < 2^31 after the shift.
    let plane = round_shift((v_r << 31) + v_p * i64::from(normal[0]) + v_q * i64::from(normal[1]), 31);
    Some(TriangleRecord {
        normal,
        plane: plane as i32,
        e1: e1.map(edge),
        e2: e2.map(edge),
        meta: material << AXIS_BITS | r as u32,
        vertices: *vertices,
    })
}

/// A hit, as the listing leaves it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Hit {
    /// Grid units.
    pub(super) t: i32,
    /// The weights of v2 and v1, Q(31 + E).
    pub(super) u: i64,
    pub(super) v: i64,
    /// Whether n points away from where the ray came from.
    pub(super) away: bool,
}

/// The report's listing, line by line.
#[inline(always)]
pub(super) fn hit<S: Slab>(ray: &Ray<S>, triangle: &TriangleRecord) -> Option<Hit> {
    let [r, p, q] = triangle.axes();
    let (origin, direction) = (&ray.origin, &ray.direction);
    let [n_p, n_q] = triangle.slopes();

    // 2^31 * 2^31 each; at most 3 * 2^31 in all.
    let denominator = direction[r] + ((direction[p] * n_p) >> 31) + ((direction[q] * n_q) >> 31);
    if denominator.abs() < DENOMINATOR_MIN {
        return None;
    }
    // An origin is below 2^30. What is left of the sum are differences to v0: at most 3 (2^29 + 2^7) + 3.
    let numerator = i64::from(triangle.plane) - origin[r] - ((origin[p] * n_p) >> 31) - ((origin[q] * n_q) >> 31);
    let t = (numerator << 31) / denominator;
    if t < 1 || t >= i64::from(ray.reach) {
        return None;
    }

    // Derived: the hit relative to v0. Below 2^30 * 2^31, and 2^30 + 2^29 + 2^7 + 1 after the shift.
    let v0 = &triangle.vertices[0];
    let k = |axis: usize| origin[axis] + ((t * direction[axis]) >> 31) - i64::from(v0[axis]);
    let (k_p, k_q) = (k(p), k(q));

    // Each product is below (2^31 - 1) (3 * 2^29 + 2^7 + 1), and twice that below 2^63.
    let [e1_p, e1_q] = triangle.e1.map(i64::from);
    let u = e1_p * k_q - e1_q * k_p;
    if u < 0 {
        return None;
    }
    let [e2_p, e2_q] = triangle.e2.map(i64::from);
    let v = e2_q * k_p - e2_p * k_q;
    if v < 0 {
        return None;
    }
    // The sum of two that are not negative fits unsigned, where the listing's might not fit signed.
    if (u as u64 + v as u64) >> ray.edge_shift > 1 << 31 {
        return None;
    }
    Some(Hit { t: t as i32, u, v, away: denominator > 0 })
}

/// The t of a hit, if there is one within the ray's reach.
#[inline(always)]
pub(super) fn intersect<S: Slab>(ray: &Ray<S>, triangle: &TriangleRecord) -> Option<i32> {
    let t = hit(ray, triangle)?.t;
    if S::CONFIRMS {
        let own = boxes::planes::<S>(Bounds::of(&triangle.vertices));
        ray.slab.enter::<ANY_OCTANT>(ray.origin, &own, t)?;
    }
    Some(t)
}

#[cfg(test)]
mod tests;
