//! `exact29` in lanes of 32 bits.
use core::arch::x86_64::*;

use core_rt::bvh::Bvh;
use core_rt::exact::{Depth, Ray, Reciprocal, Reciprocal29, Exact29, Width, Width29};
use core_rt::kernel::{Kernel, NONE, Vertices};
use core_rt::num::{cross, sub};
use core_rt::profile::Profile;
use core_rt::stats::Stats;
use std::cmp::Ordering;

use crate::collapse::WIDTH;
use crate::tree::{Layout, Node, Packet, Row, Wide, Word};
use crate::walk::{Entered, walk};

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
        if row < 3 { lane } else { PERMUTED[lane] }
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

fn factor(d: i64) -> i64 {
    let m = ((1u64 << (32 + T_BITS)) / d.unsigned_abs().max(1)) as i64;
    if d < 0 { -m } else { m }
}

fn is_down(d: i64) -> usize {
    usize::from(d < 0)
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
        let factor = ray.direction.map(factor);
        Self {
            origin: splat(ray.origin),
            direction: splat(ray.direction),
            factor: splat(factor),
            is_down: ray.direction.map(is_down),
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
    fn candidates(&self, packet: &Packet<i32, ROWS>) -> u32 {
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
        let minus_det = dot(9, &self.direction, &self.direction);
        let v = _mm256_sub_epi32(_mm256_setzero_si256(), minus_v);
        let w = _mm256_sub_epi32(_mm256_sub_epi32(minus_v, u), minus_det);
        let least = _mm256_min_epi32(_mm256_min_epi32(u, v), w);
        let most = _mm256_max_epi32(_mm256_max_epi32(u, v), w);
        let has_negative = _mm256_cmpgt_epi32(_mm256_set1_epi32(1 - ERROR), least);
        let has_positive = _mm256_cmpgt_epi32(most, _mm256_set1_epi32(ERROR - 1));
        !bits(_mm256_and_si256(has_negative, has_positive)) & ((1 << packet.count) - 1)
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

/// Visits what may be hit.
#[target_feature(enable = "avx2")]
#[inline]
fn hits<P: Profile<Kernel = Exact29>>(
    tree: &Wide<i32, ROWS>,
    bvh: &Bvh<'_, P>,
    ray: &Ray<Width29>,
    stats: &mut impl Stats,
    mut visit: impl FnMut(u32, Depth<Width29>) -> Option<i32>,
) {
    let lanes = Lanes::new(ray);
    let reach = match ray.reach {
        None => 1 << (T_BITS - 1),
        Some(reach) => 1i64.checked_shl((T_BITS as i32 + reach).max(0) as u32).unwrap_or(i64::MAX).min(1 << (T_BITS - 1)) as i32,
    };
    let is_steep = ray.direction.iter().any(|d| d.unsigned_abs() < 1 << STEEP_BITS);
    let reciprocals = if is_steep { ray.direction.map(Reciprocal29::new) } else { [Reciprocal29::new(1); 3] };
    let mut boxes = 0;
    let mut triangles = 0;
    walk(
        reach,
        0,
        |index, limit| {
            let node = tree.nodes.get(index as usize)?;
            boxes += node.count;
            Some(if is_steep { enter_steep(&ray.origin, &reciprocals, node, limit) } else { lanes.enter(node, limit) })
        },
        |leaf, mut limit| {
            match leaf {
                Word::Node(_) => {}
                Word::Packets { first, count } => {
                    for packet in tree.packets.get(first as usize..(first + count) as usize).unwrap_or_default() {
                        triangles += packet.count;
                        let mut mask = lanes.candidates(packet);
                        while mask != 0 {
                            let index = packet.first + mask.trailing_zeros();
                            mask &= mask - 1;
                            if index == ray.skip {
                                continue;
                            }
                            if let Some(depth) = meet(bvh, ray, index) {
                                limit = visit(index, depth)?;
                            }
                        }
                    }
                }
                Word::Spheres(place) => {
                    let [first, count] = tree.spheres.get(place as usize).copied().unwrap_or_default();
                    for index in first..first + count {
                        stats.sphere();
                        let hit = bvh.sphere(index).and_then(|s| Exact29::intersect_sphere(ray, s, index == ray.skip));
                        if let Some(depth) = hit {
                            limit = visit(index, depth)?;
                        }
                    }
                }
            }
            Some(limit)
        },
    );
    stats.boxes(boxes);
    for _ in 0..triangles {
        stats.triangle();
    }
}

#[target_feature(enable = "avx2")]
pub(crate) fn closest<P: Profile<Kernel = Exact29>>(
    tree: &Wide<i32, ROWS>,
    bvh: &Bvh<'_, P>,
    ray: &Ray<Width29>,
    stats: &mut impl Stats,
) -> u32 {
    let mut best: Option<(u32, Depth<Width29>)> = None;
    let mut limit = 1 << (T_BITS - 1);
    if let Some(reach) = ray.reach {
        limit = 1i64.checked_shl((T_BITS as i32 + reach).max(0) as u32).unwrap_or(i64::MAX).min(1 << (T_BITS - 1)) as i32;
    }
    hits(tree, bvh, ray, stats, |index, depth| {
        let nearer = best.as_ref().is_none_or(|(hit, best)| match Exact29::order(&depth, best) {
            Ordering::Less => true,
            Ordering::Equal => bvh.id(index) < bvh.id(*hit),
            Ordering::Greater => false,
        });
        if nearer {
            limit = ((depth.t + Width29::SLACK) >> (Width29::T_BITS - T_BITS)) as i32;
            best = Some((index, depth));
        }
        Some(limit)
    });
    best.map_or(NONE, |(index, _)| index)
}

#[target_feature(enable = "avx2")]
pub(crate) fn any<P: Profile<Kernel = Exact29>>(
    tree: &Wide<i32, ROWS>,
    bvh: &Bvh<'_, P>,
    ray: &Ray<Width29>,
    stats: &mut impl Stats,
    mut blocks: impl FnMut(u32) -> bool,
) -> bool {
    let mut limit = 1 << (T_BITS - 1);
    if let Some(reach) = ray.reach {
        limit = 1i64.checked_shl((T_BITS as i32 + reach).max(0) as u32).unwrap_or(i64::MAX).min(1 << (T_BITS - 1)) as i32;
    }
    let mut blocked = false;
    hits(tree, bvh, ray, stats, |index, _| {
        blocked = blocks(index);
        (!blocked).then_some(limit)
    });
    blocked
}
