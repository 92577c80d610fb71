//! `exact29` in lanes of 32 bits.

use core::arch::x86_64::*;

use core_rt::bvh::Bvh;
use core_rt::exact::{Depth, Ray, Reciprocal, Reciprocal29, Exact29, Width, Width29};
use core_rt::kernel::{Kernel, Vertices};
use core_rt::num::{cross, sub};
use core_rt::profile::Profile;
use core_rt::stats::Stats;

use crate::collapse::WIDTH;
use crate::tree::{Layout, Node, Packet, Row, Wide};
use crate::search::{Found, Nearest, search};
use crate::walk::Entered;

const T_BITS: u32 = 21;
const SLACK: i32 = 2;
const STEEP_BITS: u32 = 23;
const EDGE_BITS: u32 = 29;
const ERROR: i32 = 6;

/// v0, e1, e2, n
pub(crate) const ROWS: usize = 12;

const PERMUTED: [usize; WIDTH] = [0, 2, 1, 3, 4, 6, 5, 7];

impl Layout<ROWS> for i32 {
    const LANES: [usize; WIDTH] = PERMUTED;

    fn plane(coordinate: i32) -> Self {
        coordinate
    }

    fn triangle([v0, v1, v2]: &Vertices) -> [i32; ROWS] {
        let wide = |v: &[i32; 3]| v.map(i64::from);
        let (e1, e2) = (sub(wide(v1), wide(v0)), sub(wide(v2), wide(v0)));
        let largest = e1.into_iter().chain(e2).map(i64::unsigned_abs).max().unwrap_or(0);
        let up = EDGE_BITS - (u64::BITS - largest.leading_zeros()).min(EDGE_BITS);
        let normal = cross(e1, e2).map(|c| ((i128::from(c) << up) >> 32) as i32);
        let [e1, e2] = [e1, e2].map(|e| e.map(|c| (c << up) as i32));
        [v0[0], v0[1], v0[2], e1[0], e1[1], e1[2], e2[0], e2[1], e2[2], normal[0], normal[1], normal[2]]
    }

    fn lane(row: usize, lane: usize) -> usize {
        if row < 3 || row >= 9 { lane } else { PERMUTED[lane] }
    }
}

/// What the lanes need of a ray.
struct Lanes {
    origin: [__m256i; 3],
    direction: [__m256i; 3],
    factor: [__m256i; 3],
    is_down: [usize; 3],
}

#[target_feature(enable = "avx2")]
#[inline]
fn load(row: &Row<i32>) -> __m256i {
    zerocopy::transmute!(row.0)
}

/// The upper halves of products of eight numbers with one, in the order of [`PERMUTED`].
#[target_feature(enable = "avx2")]
#[inline]
fn high_product(a: __m256i, b: __m256i) -> __m256i {
    high(_mm256_mul_epi32(a, b), _mm256_mul_epi32(odd(a), b))
}

#[target_feature(enable = "avx2")]
#[inline]
fn odd(a: __m256i) -> __m256i {
    _mm256_srli_epi64::<32>(a)
}

#[target_feature(enable = "avx2")]
#[inline]
fn odd3([x, y, z]: [__m256i; 3]) -> [__m256i; 3] {
    [odd(x), odd(y), odd(z)]
}

/// The upper halves.
#[target_feature(enable = "avx2")]
#[inline]
fn high(even: __m256i, odd: __m256i) -> __m256i {
    _mm256_castps_si256(_mm256_shuffle_ps::<0xdd>(_mm256_castsi256_ps(even), _mm256_castsi256_ps(odd)))
}

#[target_feature(enable = "avx2")]
#[inline]
fn bits(mask: __m256i) -> u32 {
    _mm256_movemask_ps(_mm256_castsi256_ps(mask)) as u32
}

#[inline]
fn factor(d: i64) -> i64 {
    let m = ((1u64 << (32 + T_BITS)) / d.unsigned_abs().max(1)) as i64;
    if d < 0 { -m } else { m }
}

#[inline]
fn is_down(d: i64) -> usize {
    usize::from(d < 0)
}

#[inline]
fn is_steep(ray: &Ray<Width29>) -> bool {
    let [x, y, z] = ray.direction;
    x.unsigned_abs().min(y.unsigned_abs()).min(z.unsigned_abs()) < 1 << STEEP_BITS
}

fn meet<P: Profile<Kernel = Exact29>>(bvh: &Bvh<'_, P>, ray: &Ray<Width29>, index: u32) -> Option<Depth<Width29>> {
    bvh.triangles.of(index, |triangle| Exact29::intersect(ray, triangle)).flatten()
}

impl Lanes {
    #[target_feature(enable = "avx2")]
    #[inline]
    fn new(ray: &Ray<Width29>) -> Self {
        let splat = |[x, y, z]: [i64; 3]| {
            [_mm256_set1_epi32(x as i32), _mm256_set1_epi32(y as i32), _mm256_set1_epi32(z as i32)]
        };
        Self {
            origin: splat(ray.origin),
            direction: splat(ray.direction),
            factor: splat([factor(ray.direction[0]), factor(ray.direction[1]), factor(ray.direction[2])]),
            is_down: [is_down(ray.direction[0]), is_down(ray.direction[1]), is_down(ray.direction[2])],
        }
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    fn enter<'n>(&self, node: &'n Node<i32>, limit: i32) -> Entered<'n, i32> {
        let crossed = |axis: usize, side: usize| {
            let delta = _mm256_sub_epi32(load(&node.planes[axis][side & 1]), self.origin[axis]);
            high_product(delta, self.factor[axis])
        };
        let near = |axis: usize| crossed(axis, self.is_down[axis]);
        let far = |axis: usize| crossed(axis, self.is_down[axis] ^ 1);
        let entry = _mm256_max_epi32(_mm256_max_epi32(near(0), near(1)), _mm256_max_epi32(near(2), _mm256_setzero_si256()));
        let exit = _mm256_min_epi32(_mm256_min_epi32(far(0), far(1)), far(2));
        let exit = _mm256_min_epi32(_mm256_add_epi32(exit, _mm256_set1_epi32(SLACK)), _mm256_set1_epi32(limit));
        let missed = bits(_mm256_cmpgt_epi32(entry, exit));
        Entered { mask: !missed & ((1 << node.count) - 1), at: zerocopy::transmute!(entry), children: &node.children }
    }

    /// The lanes of triangles that may be met by the line.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn candidates(&self, packet: &Packet<i32, ROWS>, limit: i32) -> u32 {
        let row = |row: usize| load(&packet.rows[row]);
        let [x, y, z] = self.direction;
        let from = |axis: usize| _mm256_sub_epi32(self.origin[axis], row(axis));
        let s = [from(0), from(1), from(2)];
        let t = odd3(s);
        let cross = |a: __m256i, b: __m256i, c: __m256i, d: __m256i| {
            _mm256_sub_epi64(_mm256_mul_epi32(a, b), _mm256_mul_epi32(c, d))
        };
        let r = [
            high(cross(s[1], z, s[2], y), cross(t[1], z, t[2], y)),
            high(cross(s[2], x, s[0], z), cross(t[2], x, t[0], z)),
            high(cross(s[0], y, s[1], x), cross(t[0], y, t[1], x)),
        ];
        let r_odd = odd3(r);
        let dot = |first: usize, even: &[__m256i; 3], other: &[__m256i; 3]| {
            let v = [row(first), row(first + 1), row(first + 2)];
            let sum = |a: [__m256i; 3], b: &[__m256i; 3]| {
                let xy = _mm256_add_epi64(_mm256_mul_epi32(a[0], b[0]), _mm256_mul_epi32(a[1], b[1]));
                _mm256_add_epi64(xy, _mm256_mul_epi32(a[2], b[2]))
            };
            high(sum(v, even), sum(odd3(v), other))
        };
        let minus_v = dot(3, &r, &r_odd);
        let u = dot(6, &r, &r_odd);
        let minus_det = _mm256_shuffle_epi32::<0xd8>(dot(9, &self.direction, &self.direction));
        let v = _mm256_sub_epi32(_mm256_setzero_si256(), minus_v);
        let w = _mm256_sub_epi32(_mm256_sub_epi32(minus_v, u), minus_det);
        let least = _mm256_min_epi32(_mm256_min_epi32(u, v), w);
        let most = _mm256_max_epi32(_mm256_max_epi32(u, v), w);
        let has_negative = _mm256_cmpgt_epi32(_mm256_set1_epi32(1 - ERROR), least);
        let has_positive = _mm256_cmpgt_epi32(most, _mm256_set1_epi32(ERROR - 1));
        let mask = !bits(_mm256_and_si256(has_negative, has_positive)) & ((1 << packet.count) - 1);
        if mask == 0 {
            return 0;
        }
        // Of those that remain, t: S . n by the sign of the determinant.
        let minus_tn = _mm256_shuffle_epi32::<0xd8>(dot(9, &s, &t));
        let _ = limit;
        let det = _mm256_abs_epi32(minus_det);
        let tn = _mm256_sign_epi32(minus_tn, minus_det);
        let tn = _mm256_sub_epi32(_mm256_setzero_si256(), tn);
        let certain = _mm256_cmpgt_epi32(det, _mm256_set1_epi32(2));
        let behind = _mm256_cmpgt_epi32(_mm256_set1_epi32(-1), tn);
        let most = _mm256_shuffle_epi32::<0xd8>(high_product(_mm256_add_epi32(det, _mm256_set1_epi32(3)), _mm256_set1_epi32((limit + 1) << (31 - T_BITS))));
        let beyond = _mm256_cmpgt_epi32(tn, _mm256_add_epi32(_mm256_add_epi32(most, most), _mm256_set1_epi32(3)));
        mask & !bits(_mm256_and_si256(certain, _mm256_or_si256(behind, beyond)))
    }
}

/// Boxes one by one, by the kernel's own reciprocals.
fn enter_steep<'n>(
    origin: &[i64; 3],
    reciprocals: &[Reciprocal29; 3],
    node: &'n Node<i32>,
    limit: i32,
) -> Entered<'n, i32> {
    let mut entered = Entered { mask: 0, at: [0; WIDTH], children: &node.children };
    for slot in 0..node.count as usize % (WIDTH + 1) {
        let lane = PERMUTED[slot % WIDTH];
        let (mut entry, mut exit) = (0, i64::MAX - Reciprocal29::SLACK);
        for axis in [0, 1, 2] {
            let [low, high] = [0, 1].map(|side| {
                let plane = i64::from(node.planes[axis][side].0[lane]) + side as i64;
                reciprocals[axis].along(plane - origin[axis])
            });
            (entry, exit) = (low.min(high).max(entry), low.max(high).min(exit));
        }
        let at = (entry >> (Width29::T_BITS - T_BITS)) as i32;
        if entry <= exit + Reciprocal29::SLACK && at <= limit {
            entered.mask |= 1 << slot;
            entered.at[slot % WIDTH] = at;
        }
    }
    entered
}

/// The limit that a ray begins with: no hit is beyond it.
fn reach(ray: &Ray<Width29>) -> i32 {
    // t is at most 1/2; that of a segment is below 2^reach, and where that is below the unit, it is 0 as the lanes count.
    let bits = ray.reach.map_or(T_BITS as i32 - 1, |reach| (T_BITS as i32 + reach).clamp(0, T_BITS as i32 - 1));
    1 << bits
}

#[target_feature(enable = "avx2")]
#[inline]
fn hits<P: Profile<Kernel = Exact29>>(
    of: (&Wide<i32, ROWS>, &Bvh<'_, P>),
    ray: &Ray<Width29>,
    stats: &mut impl Stats,
    mut visit: impl FnMut(u32, Depth<Width29>) -> Option<i32>,
) {
    let lanes = Lanes::new(ray);
    let test = |found: Found<'_, i32, ROWS, Depth<Width29>>| match found {
        Found::Sphere(index, depth) => visit(index, depth),
        Found::Packet(packet, mut limit) => {
            let mut mask = lanes.candidates(packet, limit);
            while mask != 0 {
                let index = packet.first + mask.trailing_zeros();
                mask &= mask - 1;
                if index != ray.skip
                    && let Some(depth) = meet(of.1, ray, index)
                {
                    limit = visit(index, depth)?;
                }
            }
            Some(limit)
        }
    };
    if is_steep(ray) {
        let reciprocals = ray.direction.map(Reciprocal29::new);
        search(of, ray, reach(ray), stats, |node, limit| enter_steep(&ray.origin, &reciprocals, node, limit), test);
    } else {
        search(of, ray, reach(ray), stats, |node, limit| lanes.enter(node, limit), test);
    }
}

#[target_feature(enable = "avx2")]
pub(crate) fn closest<P: Profile<Kernel = Exact29>>(
    of: (&Wide<i32, ROWS>, &Bvh<'_, P>),
    ray: &Ray<Width29>,
    stats: &mut impl Stats,
) -> u32 {
    let (mut nearest, mut limit) = (Nearest::NONE, reach(ray));
    hits(of, ray, stats, |index, depth| {
        if nearest.take(of.1, index, depth) {
            limit = ((depth.t + Width29::SLACK) >> (Width29::T_BITS - T_BITS)) as i32;
        }
        Some(limit)
    });
    nearest.hit()
}

#[target_feature(enable = "avx2")]
pub(crate) fn any<P: Profile<Kernel = Exact29>>(
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
