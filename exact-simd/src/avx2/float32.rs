//! `f32` in the same layout, for comparison: the scalar kernel's formulas, operation by operation.

use core::arch::x86_64::*;
use core::cmp::Ordering;

use core_rt::bvh::Bvh;
use core_rt::kernel::{Kernel, NONE, Vertices};
use core_rt::profile::Profile;
use core_rt::stats::Stats;
use float_rt::{Float32, Ray};

use super::collapse::WIDTH;
use super::search::{Found, search};
use super::tree::{Layout, Node, Packet, Row, Wide};
use super::walk::Entered;

/// v0, e1, e2.
pub(super) const ROWS: usize = 9;

impl Layout<ROWS> for f32 {
    const LANES: [usize; WIDTH] = [0, 1, 2, 3, 4, 5, 6, 7];

    fn plane(coordinate: i32) -> Self {
        coordinate as f32
    }

    fn triangle([v0, v1, v2]: &Vertices) -> [f32; ROWS] {
        let edge = |v: &[i32; 3], axis: usize| (v[axis] - v0[axis]) as f32;
        let place = |axis: usize| v0[axis] as f32;
        let [a, b, c] = [place(0), place(1), place(2)];
        [a, b, c, edge(v1, 0), edge(v1, 1), edge(v1, 2), edge(v2, 0), edge(v2, 1), edge(v2, 2)]
    }

    fn lane(_row: usize, lane: usize) -> usize {
        lane
    }
}

type Triple = [__m256; 3];

/// What the lanes need of a ray.
struct Lanes {
    origin: Triple,
    direction: Triple,
    entering: Triple,
    leaving: Triple,
    is_down: [usize; 3],
    reach: __m256,
}

#[target_feature(enable = "avx2")]
#[inline]
fn load(row: &Row<f32>) -> __m256 {
    zerocopy::transmute!(row.0)
}

#[target_feature(enable = "avx2")]
#[inline]
fn splat([x, y, z]: [f32; 3]) -> Triple {
    [_mm256_set1_ps(x), _mm256_set1_ps(y), _mm256_set1_ps(z)]
}

#[target_feature(enable = "avx2")]
#[inline]
fn dot(a: &Triple, b: &Triple) -> __m256 {
    let xy = _mm256_add_ps(_mm256_mul_ps(a[0], b[0]), _mm256_mul_ps(a[1], b[1]));
    _mm256_add_ps(xy, _mm256_mul_ps(a[2], b[2]))
}

#[target_feature(enable = "avx2")]
#[inline]
fn cross(a: &Triple, b: &Triple) -> Triple {
    let part = |i: usize, j: usize| _mm256_sub_ps(_mm256_mul_ps(a[i], b[j]), _mm256_mul_ps(a[j], b[i]));
    [part(1, 2), part(2, 0), part(0, 1)]
}

impl Lanes {
    #[target_feature(enable = "avx2")]
    #[inline]
    fn new(ray: &Ray<f32>) -> Self {
        let [x, y, z] = ray.direction;
        let entering = [1.0 / x, 1.0 / y, 1.0 / z];
        let padding = 1.0 + 4.0 * f32::EPSILON;
        let down = |c: f32| usize::from(c < 0.0);
        Self {
            origin: splat(ray.origin),
            direction: splat(ray.direction),
            entering: splat(entering),
            leaving: splat([entering[0] * padding, entering[1] * padding, entering[2] * padding]),
            is_down: [down(entering[0]), down(entering[1]), down(entering[2])],
            reach: _mm256_set1_ps(ray.reach),
        }
    }

    #[target_feature(enable = "avx2")]
    #[inline]
    fn enter<'n>(&self, node: &'n Node<f32>, limit: f32) -> Entered<'n, f32> {
        let delta = |axis: usize, side: usize| _mm256_sub_ps(load(&node.planes[axis][side & 1]), self.origin[axis]);
        let near = |axis: usize| _mm256_mul_ps(delta(axis, self.is_down[axis]), self.entering[axis]);
        let far = |axis: usize| _mm256_mul_ps(delta(axis, self.is_down[axis] ^ 1), self.leaving[axis]);
        let entry = _mm256_max_ps(near(2), _mm256_max_ps(near(1), _mm256_max_ps(near(0), _mm256_setzero_ps())));
        let exit = _mm256_min_ps(far(2), _mm256_min_ps(far(1), _mm256_min_ps(far(0), _mm256_set1_ps(limit))));
        let missed = _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(entry, exit)) as u32;
        Entered { mask: !missed & node.used(), at: zerocopy::transmute!(entry), children: &node.children }
    }

    /// The lanes of triangles that are hit, and where.
    #[target_feature(enable = "avx2")]
    #[inline]
    fn hits(&self, packet: &Packet<f32, ROWS>) -> (u32, __m256) {
        let row = |row: usize| load(&packet.rows[row]);
        let (e1, e2) = ([row(3), row(4), row(5)], [row(6), row(7), row(8)]);
        let p = cross(&self.direction, &e2);
        let det = dot(&e1, &p);
        let zero = _mm256_setzero_ps();
        let sign = _mm256_and_ps(det, _mm256_set1_ps(-0.0));
        let positive = |value: __m256| _mm256_xor_ps(value, sign);
        let size = positive(det);
        let from = |axis: usize| _mm256_sub_ps(self.origin[axis], row(axis));
        let s = [from(0), from(1), from(2)];
        let u = positive(dot(&s, &p));
        let q = cross(&s, &e1);
        let v = positive(dot(&self.direction, &q));
        let t = positive(dot(&e2, &q));
        let outside = _mm256_or_ps(
            _mm256_or_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(u, zero), _mm256_cmp_ps::<_CMP_LT_OQ>(v, zero)),
            _mm256_cmp_ps::<_CMP_GT_OQ>(_mm256_add_ps(u, v), size),
        );
        let ahead = _mm256_and_ps(_mm256_cmp_ps::<_CMP_GT_OQ>(t, zero), _mm256_cmp_ps::<_CMP_GT_OQ>(size, zero));
        let mask = _mm256_movemask_ps(_mm256_andnot_ps(outside, ahead)) as u32 & packet.used();
        if mask == 0 {
            return (0, zero);
        }
        let t = _mm256_div_ps(t, size);
        (mask & _mm256_movemask_ps(_mm256_cmp_ps::<_CMP_LT_OQ>(t, self.reach)) as u32, t)
    }
}

#[target_feature(enable = "avx2")]
pub(super) fn closest<P: Profile<Kernel = Float32>>(
    of: (&Wide<f32, ROWS>, &Bvh<'_, P>),
    ray: &Ray<f32>,
    stats: &mut impl Stats,
) -> u32 {
    let (mut nearest, mut limit) = (Nearest::NONE, ray.reach);
    let lanes = Lanes::new(ray);
    let mut take = |index: u32, depth: f32| {
        if nearest.take(of.1, index, depth) {
            limit = depth * (1.0 + 4.0 * f32::EPSILON);
        }
        limit
    };
    let test = |found: Found<'_, f32, ROWS>| match found {
        Found::Sphere(index, limit) => Some(sphere(of.1, ray, index).map_or(limit, |depth| take(index, depth))),
        Found::Packet(packet, mut limit) => {
            let (mut mask, t) = lanes.hits(packet);
            let t: [f32; WIDTH] = zerocopy::transmute!(t);
            while mask != 0 {
                let lane = mask.trailing_zeros();
                mask &= mask - 1;
                let index = packet.first + lane;
                if index != ray.skip {
                    limit = take(index, t[lane as usize % WIDTH]);
                }
            }
            Some(limit)
        }
    };
    search(of.0, ray.reach, stats, |node, limit| lanes.enter(node, limit), test);
    nearest.hit
}

/// The hit with a sphere, by the kernel's own test.
#[inline(never)]
fn sphere<P: Profile<Kernel = Float32>>(bvh: &Bvh<'_, P>, ray: &Ray<f32>, index: u32) -> Option<f32> {
    Float32::intersect_sphere(ray, bvh.sphere(index)?, index == ray.skip)
}

/// The nearest of some hits: the smallest (t, id).
struct Nearest {
    hit: u32,
    depth: Option<f32>,
}

impl Nearest {
    const NONE: Self = Self { hit: NONE, depth: None };

    /// Takes a hit where it is nearer; whether it is.
    #[inline]
    fn take<P: Profile<Kernel = Float32>>(&mut self, bvh: &Bvh<'_, P>, index: u32, depth: f32) -> bool {
        let is_nearer = self.depth.is_none_or(|nearest| match Float32::order(&depth, &nearest) {
            Ordering::Less => true,
            Ordering::Equal => bvh.id(index) < bvh.id(self.hit),
            Ordering::Greater => false,
        });
        if is_nearer {
            *self = Self { hit: index, depth: Some(depth) };
        }
        is_nearer
    }
}
