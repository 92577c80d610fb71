//! `exact29` in lanes of 32 bits: what is certainly missed is left out, the kernel decides about the rest.
//!
//! # Boxes
//! T is t in Q21, and m = floor(2^53 / |D|), with the sign of D, is at most 2^30: `STEEP_BITS` keeps it so. Along an axis
//! floor(delta m / 2^32) is not above T where that is not negative, and negative where it is: m is not high. T counts up to 2^20
//! (t <= 1/2), and there it is low by less than 2^20 / m + 1 <= 2, since m >= 2^22: the [`SLACK`] of exits. Distances keep the order of planes. So
//! the argument for boxes of [`core_rt::exact`] holds. A ray that hardly moves along some axis has its boxes
//! tested one by one, by the kernel's reciprocals.
//!
//! # Triangles
//! As the kernel's filter, U = e2 . R, V = -(e1 . R) and W = det - U - V, of which all three have one sign or are 0 where the line
//! meets the triangle. Edges are stored times 2^k, so that the longest component is in [2^28, 2^29), and n = floor(N 2^k / 2^32). With
//! S below 2^30 and D below 2^31, R is below 2^62, and R / 2^32, rounded down, at most 2^30: it fits a lane, and all that
//! follows is in units of 2^64 / 2^k.
//!
//! | value | is off by less than | for |
//! | --- | --- | --- |
//! | U, V | 1.375 | 3 * 2^29 / 2^32, and 1 for the floor |
//! | det = -(D . n) | 2.5 | 3 * 2^31 / 2^32, and 1 |
//! | W | 5.25 | all of them |
//! | tn = S . n | 1.75 | 3 * 2^30 / 2^32, and 1 |
//!
//! Sums of three products are below 3 * 2^59. U and V are at most 2^29, W below 2^31. A value of [`ERROR`] or more has a certain sign.

use core::arch::x86_64::*;

use core_rt::bvh::Bvh;
use core_rt::exact::{Exact29, Ray, Reciprocal, Reciprocal29, Width, Width29};
use core_rt::kernel::{Kernel, NONE, Vertices};
use core_rt::num::{cross, sub};
use core_rt::profile::Profile;
use core_rt::stats::Stats;

use super::collapse::WIDTH;
use super::product::{Both, SHUFFLED, Triple, bits, load, product, shuffle, splat};
use super::search::{Found, search};
use super::sphere29;
use super::tree::{Layout, Node, Packet, Wide};
use super::walk::Entered;

/// Fractional bits of t.
const T_BITS: u32 = 21;

/// By how much an exit may be low.
const SLACK: i32 = 2;

/// A direction with a smaller component is tested box by box.
const STEEP_BITS: u32 = 23;

/// The bits of a triangle's longest edge, as it is stored.
const EDGE_BITS: u32 = 29;

/// From here on the sign of U, V and W is certain.
const ERROR: i32 = 6;

/// What det and tn are off by at most.
const DET_ERROR: i32 = 3;
const TN_ERROR: i32 = 2;

/// A smaller det does not tell well where a hit is.
const DET_LEAST: i64 = 1 << 14;

/// v0, e1, e2 and n, three rows each.
pub(super) const ROWS: usize = 12;
const V0: usize = 0;
const E1: usize = 3;
const E2: usize = 6;
const N: usize = 9;

impl Layout<ROWS> for i32 {
    const LANES: [usize; WIDTH] = SHUFFLED;

    fn plane(coordinate: i32) -> Self {
        coordinate
    }

    fn triangle(vertices: &Vertices) -> [i32; ROWS] {
        let [v0, v1, v2] = vertices.map(|v| v.map(i64::from));
        let (e1, e2) = (sub(v1, v0), sub(v2, v0));
        let largest = e1.into_iter().chain(e2).map(i64::unsigned_abs).max().unwrap_or(0);
        let up = EDGE_BITS.saturating_sub(u64::BITS - largest.leading_zeros());
        // N is below 2 * 2^(2 (29 - k)), so n is below 2^28.
        let n = cross(e1, e2).map(|c| (i128::from(c) << up) >> 32);
        let [e1, e2] = [e1, e2].map(|e| e.map(|c| c << up));
        let mut rows = [0; ROWS];
        for axis in [0, 1, 2] {
            // All fit: see the bounds above.
            rows[V0 + axis] = v0[axis] as i32;
            rows[E1 + axis] = e1[axis] as i32;
            rows[E2 + axis] = e2[axis] as i32;
            rows[N + axis] = n[axis] as i32;
        }
        rows
    }

    /// Edges are multiplied by what is shuffled already.
    fn lane(row: usize, lane: usize) -> usize {
        if (E1..N).contains(&row) { SHUFFLED[lane] } else { lane }
    }
}

/// Whether lanes hold a ray: its origin is less than 2^30 from all that is on the grid, along each axis.
#[inline]
pub(super) fn holds(ray: &Ray<Width29>) -> bool {
    let [x, y, z] = ray.origin;
    let least = -(1 << 29);
    x.min(y).min(z) > least && x.max(y).max(z) < 1 << 30
}

/// Whether a ray hardly moves along some axis.
#[inline]
fn is_steep(ray: &Ray<Width29>) -> bool {
    let [x, y, z] = ray.direction.map(i64::unsigned_abs);
    x.min(y).min(z) < 1 << STEEP_BITS
}

/// `m` of a component.
#[inline]
fn factor(component: i64) -> i64 {
    let quotient = ((1u64 << (32 + T_BITS)) / component.unsigned_abs().max(1)) as i64;
    if component < 0 { -quotient } else { quotient }
}

/// The T that a ray begins with: no hit is beyond it. t is at most 1/2; that of a segment is below 2^reach, which may be less
/// than a unit of T.
#[inline]
fn reach(ray: &Ray<Width29>) -> i32 {
    let bits = ray.reach.map_or(i32::MAX, |reach| T_BITS as i32 + reach);
    1 << bits.clamp(0, T_BITS as i32 - 1)
}

/// A ray, in all lanes.
struct Lanes {
    origin: Triple,
    direction: Triple,
    factor: Triple,
    is_down: [usize; 3],
}

/// What is left of a packet.
struct Left {
    /// A lane each of triangles that may be hit.
    mask: u32,
    /// And of those whose line meets them, certainly.
    is_met: u32,
    /// |det| and tn of its sign, in the order of the lanes.
    det: __m256i,
    tn: __m256i,
}

impl Left {
    /// The lanes of what is certainly beyond a limit: tn > det T for the largest |det|, the largest T and the least tn. Where the
    /// sign of det is not what it seems, t is below 0. T is at most 2^20; times (T + 1) 2^10, half of det T is an upper half.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn beyond(&self, limit: i32) -> u32 {
        let most = _mm256_add_epi32(self.det, _mm256_set1_epi32(DET_ERROR));
        let half = shuffle(product(most, _mm256_set1_epi32((limit + 1) << (31 - T_BITS))));
        // Twice what the floor left of it is low by less than 2.
        let product = _mm256_add_epi32(_mm256_add_epi32(half, half), _mm256_set1_epi32(2 + TN_ERROR));
        bits(_mm256_cmpgt_epi32(self.tn, product))
    }

    /// Where a line that meets the triangle of a lane hits it, if that is certainly ahead and before `end`, a t as those are.
    /// Both products are below 2^60.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn within(&self, lane: u32, end: i64) -> Option<Between> {
        let at = |row: __m256i| -> i64 {
            let row: [i32; WIDTH] = zerocopy::transmute!(row);
            row[lane as usize % WIDTH].into()
        };
        let (det, tn) = (at(self.det), at(self.tn));
        if det < DET_LEAST || tn < i64::from(TN_ERROR) {
            return None;
        }
        let [error, det_error] = [TN_ERROR, DET_ERROR].map(i64::from);
        let least = ((tn - error) << Width29::T_BITS) / (det + det_error);
        let most = ((tn + error) << Width29::T_BITS) / (det - det_error) + 1;
        (most < end).then_some([least, most])
    }
}

impl Lanes {
    #[target_feature(enable = "avx2")]
    #[inline]
    fn new(ray: &Ray<Width29>) -> Self {
        let [x, y, z] = ray.direction;
        Self {
            origin: splat(ray.origin),
            direction: splat(ray.direction),
            factor: splat([factor(x), factor(y), factor(z)]),
            is_down: [usize::from(x < 0), usize::from(y < 0), usize::from(z < 0)],
        }
    }

    /// Which of eight boxes are entered before a limit.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn enter<'n>(&self, node: &'n Node<i32>, limit: i32) -> Entered<'n, i32> {
        let crossed = |axis: usize, side: usize| {
            product(_mm256_sub_epi32(load(&node.planes[axis][side & 1]), self.origin[axis]), self.factor[axis])
        };
        let near = |axis: usize| crossed(axis, self.is_down[axis]);
        let far = |axis: usize| crossed(axis, self.is_down[axis] ^ 1);
        let entry = _mm256_max_epi32(_mm256_max_epi32(near(0), near(1)), near(2));
        // With 0, an exit behind the origin is before the entry.
        let entry = _mm256_max_epi32(entry, _mm256_setzero_si256());
        let exit = _mm256_min_epi32(_mm256_min_epi32(far(0), far(1)), far(2));
        let exit = _mm256_min_epi32(_mm256_add_epi32(exit, _mm256_set1_epi32(SLACK)), _mm256_set1_epi32(limit));
        let missed = bits(_mm256_cmpgt_epi32(entry, exit));
        Entered { mask: !missed & node.used(), at: zerocopy::transmute!(entry), children: &node.children }
    }

    /// Which of eight triangles may be hit within a limit.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn left(&self, packet: &Packet<i32, ROWS>, limit: i32) -> Left {
        let rows =
            |first: usize| [load(&packet.rows[first]), load(&packet.rows[first + 1]), load(&packet.rows[first + 2])];
        let v0 = rows(V0);
        let from = |axis: usize| _mm256_sub_epi32(self.origin[axis], v0[axis]);
        let s = Both::new([from(0), from(1), from(2)]);
        let d = Both { even: self.direction, odd: self.direction };
        let r = Both::new(s.cross(&d));
        let n = Both::new(rows(N));
        let zero = _mm256_setzero_si256();
        let u = Both::new(rows(E2)).dot(&r);
        let minus_v = Both::new(rows(E1)).dot(&r);
        let minus_det = shuffle(n.dot(&d));
        let v = _mm256_sub_epi32(zero, minus_v);
        let w = _mm256_sub_epi32(_mm256_sub_epi32(minus_v, u), minus_det);
        let least = _mm256_min_epi32(_mm256_min_epi32(u, v), w);
        let most = _mm256_max_epi32(_mm256_max_epi32(u, v), w);
        let (low, high) = (_mm256_set1_epi32(1 - ERROR), _mm256_set1_epi32(ERROR - 1));
        let missed = _mm256_and_si256(_mm256_cmpgt_epi32(low, least), _mm256_cmpgt_epi32(most, high));
        let mask = !bits(missed) & packet.used();
        if mask == 0 {
            return Left { mask, is_met: 0, det: zero, tn: zero };
        }
        let is_met = bits(_mm256_or_si256(_mm256_cmpgt_epi32(least, high), _mm256_cmpgt_epi32(low, most)));
        // t = tn / det, both with the sign of det.
        let det = _mm256_abs_epi32(minus_det);
        let tn = _mm256_sub_epi32(zero, _mm256_sign_epi32(shuffle(n.dot(&s)), minus_det));
        let behind = _mm256_cmpgt_epi32(_mm256_set1_epi32(1 - TN_ERROR), tn);
        let has_sign = _mm256_cmpgt_epi32(det, _mm256_set1_epi32(DET_ERROR - 1));
        let left = Left { mask, is_met, det, tn };
        let out = bits(_mm256_and_si256(behind, has_sign)) | left.beyond(limit);
        Left { mask: mask & !out, ..left }
    }
}

/// Which of eight boxes a ray enters that hardly moves along some axis: one by one, as the kernel tests them.
#[inline(never)]
fn enter_one_by_one<'n>(
    origin: &[i64; 3],
    reciprocals: &[Reciprocal29; 3],
    node: &'n Node<i32>,
    limit: i32,
) -> Entered<'n, i32> {
    let mut entered = Entered { mask: 0, at: [0; WIDTH], children: &node.children };
    for (child, (at, lane)) in entered.at.iter_mut().zip(SHUFFLED).enumerate().take(node.count as usize) {
        let (mut entry, mut exit) = (0, Width29::T_MAX);
        for axis in [0, 1, 2] {
            // The high plane plus one, as the kernel has it.
            let [low, high] = [0, 1].map(|side| i64::from(node.planes[axis][side].0[lane]) + side as i64);
            let [low, high] = [low, high].map(|plane| reciprocals[axis].along(plane - origin[axis]));
            (entry, exit) = (low.min(high).max(entry), low.max(high).min(exit));
        }
        *at = (entry >> (Width29::T_BITS - T_BITS)) as i32;
        if entry <= exit + Reciprocal29::SLACK && *at <= limit {
            entered.mask |= 1 << child;
        }
    }
    entered
}

/// Two t between which that of a hit is, or at one of which, in `T_BITS` of the kernel.
pub(super) type Between = [i64; 2];

/// The hit with a triangle, by the kernel.
#[inline(never)]
fn hit<P: Profile<Kernel = Exact29>>(bvh: &Bvh<'_, P>, ray: &Ray<Width29>, index: u32) -> Option<Between> {
    bvh.triangles.of(index, |triangle| Exact29::meet(ray, triangle)).flatten().map(|span| span.ends())
}

/// Whether a hit is nearer than another: by bounds where these tell, else by the kernel.
#[inline]
fn is_nearer<P: Profile<Kernel = Exact29>>(
    bvh: &Bvh<'_, P>,
    ray: &Ray<Width29>,
    (index, [least, most]): (u32, Between),
    (other, [other_least, other_most]): (u32, Between),
) -> bool {
    if most < other_least || other_most < least {
        return most < other_least;
    }
    bvh.replaces(ray, index, other)
}

/// Tells of all hits before the limit that `visit` returns, until it returns none.
#[target_feature(enable = "avx2")]
#[inline]
fn hits<P: Profile<Kernel = Exact29>>(
    of: (&Wide<i32, ROWS>, &Bvh<'_, P>),
    ray: &Ray<Width29>,
    stats: &mut impl Stats,
    mut visit: impl FnMut(u32, Between) -> Option<i32>,
) {
    let lanes = Lanes::new(ray);
    let end = ray.reach.map_or(i64::MAX, |reach| 1 << (Width29::T_BITS as i32 + reach).clamp(0, 62));
    let test = |found: Found<'_, i32, ROWS>| match found {
        Found::Sphere(index, limit) => {
            let sphere = of.1.sphere(index).and_then(|sphere| sphere29::hit(ray, sphere, index == ray.skip, end));
            match sphere {
                Some(between) => visit(index, between),
                None => Some(limit),
            }
        }
        Found::Packet(packet, mut limit) => {
            let left = lanes.left(packet, limit);
            let mut mask = left.mask;
            while mask != 0 {
                let lane = mask.trailing_zeros();
                mask &= mask - 1;
                let index = packet.first + lane;
                if index == ray.skip {
                    continue;
                }
                let is_met = left.is_met >> lane & 1 != 0;
                let within = if is_met { left.within(lane, end) } else { None };
                if let Some(between) = within.or_else(|| hit(of.1, ray, index)) {
                    limit = visit(index, between)?;
                    if mask != 0 {
                        mask &= !left.beyond(limit);
                    }
                }
            }
            Some(limit)
        }
    };
    if is_steep(ray) {
        let reciprocals = ray.direction.map(Reciprocal29::new);
        search(of.0, reach(ray), stats, |node, limit| enter_one_by_one(&ray.origin, &reciprocals, node, limit), test);
    } else {
        search(of.0, reach(ray), stats, |node, limit| lanes.enter(node, limit), test);
    }
}

/// The nearest hit, the smallest (t, id).
#[target_feature(enable = "avx2")]
pub(super) fn closest<P: Profile<Kernel = Exact29>>(
    of: (&Wide<i32, ROWS>, &Bvh<'_, P>),
    ray: &Ray<Width29>,
    stats: &mut impl Stats,
) -> u32 {
    let (mut nearest, mut limit): (Option<(u32, Between)>, _) = (None, reach(ray));
    hits(of, ray, stats, |index, between| {
        if nearest.is_none_or(|nearest| is_nearer(of.1, ray, (index, between), nearest)) {
            // Not below T: what is as far is still to be found.
            limit = (between[1].min(Width29::T_MAX) >> (Width29::T_BITS - T_BITS)) as i32;
            nearest = Some((index, between));
        }
        Some(limit)
    });
    nearest.map_or(NONE, |(index, _)| index)
}

/// Whether anything that is hit blocks.
#[target_feature(enable = "avx2")]
pub(super) fn any<P: Profile<Kernel = Exact29>>(
    of: (&Wide<i32, ROWS>, &Bvh<'_, P>),
    ray: &Ray<Width29>,
    stats: &mut impl Stats,
    mut blocks: impl FnMut(u32) -> bool,
) -> bool {
    let (mut is_blocked, limit) = (false, reach(ray));
    hits(of, ray, stats, |index, _| {
        is_blocked = blocks(index);
        (!is_blocked).then_some(limit)
    });
    is_blocked
}
