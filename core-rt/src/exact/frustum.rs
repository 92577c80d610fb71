//! The rays of a tile, and what bounds them.
//!
//! # Directions
//! All is in 32 bits, whatever the width: directions in units of 2^(`DIRECTION_BITS` - 13), with F fractional bits. In pixel
//! (i, j) of the tile d = first + i right + j down is within `spread` of the direction D that the pixel's ray has: half a
//! unit of D that the camera rounds by, and 8 2^-F, since `first` and 7 steps each way are rounded down and 7 2^-F is added.
//!
//! # Planes
//! Depth is along the axis u. For another axis v, with s at least D_v / |D_u| for all rays, no ray reaches p_v > s |p_u|, and a
//! box that is beyond that in all its corners is missed; likewise below. The quotient of two functions that are linear in the
//! pixel has its ends in the corners of the tile; what the rays are off their d moves it by at most
//! spread (1 + |s|) / |D_u|.
//!
//! # Edges
//! With P, Q and R the corners of a triangle less the origin, det = D . N and N = P x Q + Q x R + R x P, the ray meets the
//! triangle iff D . (P x Q), D . (Q x R) and D . (R x P) have the sign of P . N, or are 0, and det has it; then t = P . N / det.
//! These are the numbers of the triangle test, up to sign. 1 / t is linear in D. `docs/EXACTNESS.md` has the bounds step by
//! step.

use super::boxes::BoxNode;
use super::width::{Distance, Wide, Width};
use super::{Exact, Ray};
use crate::camera::Camera;
use crate::kernel::{Bounds, Vertices};
use crate::num::{Triple, Word, cross, mantissa, narrow_dot, reciprocal, sub};
use crate::render::Tile;
use crate::tile::{Beam, Edge, Edges, Footprint, Linear, SIDE};

/// The bits of a direction's component, without those below the unit.
const UNIT_BITS: u32 = 13;

/// Fractional bits of directions, at most, and what they must be at least.
const FRACTION_BITS: i32 = 8;
const FRACTION_BITS_MIN: i32 = 4;

/// Bits of a vector that directions are multiplied by, where steps are short; fewer where they are long.
const VECTOR_BITS: u32 = 16;

/// Steps from pixel to pixel are below 2^13 in the last bit.
const STEP_BITS: u32 = 13;

/// Fractional bits of slopes, which are below 2.
const SLOPE_BITS: u32 = 14;

/// What rounding the middle direction and the steps from there to a pixel is off by at most, of the last bit.
const STEP_ERROR: i32 = (1 + SIDE as i32 + 1) / 2;

/// By how much a function's values may be low for rounding it and its steps down.
const LINEAR_ERROR: i32 = 2 * SIDE as i32;

/// The least component along the axis of depth, units.
const DEPTH_MIN: i32 = 1 << 9;

/// Bits of a coordinate that boxes are tested with.
const BOX_BITS: u32 = 15;

/// Fractional bits of a nearness: of a direction's component along the axis of depth by a depth in [`BOX_BITS`].
const NEARNESS_BITS: u32 = 18;

/// What a nearness of less is not made a limit of: no depth is as large.
const NEARNESS_MIN: i32 = 1 << 8;

/// A plane that no ray passes, through an axis: the sign of `v 2^14 - slope u - offset`.
#[derive(Clone, Copy, Debug)]
struct Side {
    slope: i32,
    offset: i32,
}

impl Side {
    /// On which side of it a point is; |v - o_v| and |u - o_u| are at most 2^15 and |slope| is below 2^15, so it is below 2^31.
    #[inline(always)]
    fn beyond(self, u: i32, v: i32) -> i32 {
        (v << SLOPE_BITS).wrapping_sub(self.slope.wrapping_mul(u)).wrapping_sub(self.offset)
    }
}

/// The rays of a tile.
#[derive(Clone, Copy, Debug)]
pub struct Frustum<W: Width> {
    origin: Triple<W::Word>,
    /// The direction in the first pixel: units, and what is left of them.
    first: Triple<i32>,
    rest: Triple<i32>,
    right: Triple<i32>,
    down: Triple<i32>,
    fraction_bits: u32,
    /// The bits of a vector that directions are multiplied by.
    vector_bits: u32,
    /// The last pixel.
    last: [i32; 2],
    /// By how much a component may be off, with the fractional bits.
    spread: i32,
    /// What the magnitudes of a direction's components sum to at most, units.
    length: i32,
    /// The axis of depth, and whether it is looked along downwards.
    axis: usize,
    is_down: bool,
    /// The largest component along it.
    largest: i32,
    /// The origin that depths of near planes are counted from.
    depth_origin: i32,
    /// Of the two other axes, what high and low planes are tested with.
    sides: [[Side; 2]; 2],
}

/// A vector with its component along an axis first.
#[inline(always)]
fn turned<T>([x, y, z]: Triple<T>, axis: usize) -> Triple<T> {
    match axis {
        0 => [x, y, z],
        1 => [y, z, x],
        _ => [z, x, y],
    }
}

/// The inverse of [`turned`].
#[inline(always)]
fn turned_back<T>([u, v, w]: Triple<T>, axis: usize) -> Triple<T> {
    match axis {
        0 => [u, v, w],
        1 => [w, u, v],
        _ => [v, w, u],
    }
}

impl<W: Width> Frustum<W> {
    /// The bits of a direction below a unit.
    const DROPPED_BITS: u32 = W::DIRECTION_BITS.saturating_sub(UNIT_BITS);
    /// The bits of a coordinate that are not looked at.
    const COARSE_BITS: u32 = W::GRID_BITS.saturating_sub(BOX_BITS);

    /// A coordinate of a box.
    #[inline(always)]
    fn coarse(plane: <W::Node as BoxNode>::Plane) -> i32 {
        let plane: W::Word = plane.into();
        (plane >> Self::COARSE_BITS).low_i32()
    }

    #[inline(always)]
    fn linear(&self, g: Triple<i32>) -> Linear {
        let f = self.fraction_bits;
        let dot = |d: &Triple<i32>| d[0] * g[0] + d[1] * g[1] + d[2] * g[2];
        Linear {
            first: dot(&self.first) + (dot(&self.rest) >> f),
            right: dot(&self.right) >> f,
            down: dot(&self.down) >> f,
        }
    }

    /// The sum of the magnitudes of a vector's components times what directions are off, rounded up.
    #[inline(always)]
    fn off(&self, g: Triple<i32>) -> i32 {
        let sum = g[0].abs() + g[1].abs() + g[2].abs();
        ((sum * self.spread) >> self.fraction_bits) + 1
    }
}

/// `value` rounded to a multiple of 2^shift, and divided by it.
#[inline(always)]
fn rounded<T: Word>(value: T, shift: u32) -> i32 {
    ((value + ((T::ONE << shift) >> 1)) >> shift).low_i32()
}

impl<W: Width> Beam<Exact<W>> for Frustum<W> {
    #[inline(never)]
    fn new(camera: &Camera<W::Word>, tile: Tile) -> Option<Self> {
        let [x, y] = [tile.width / 2, tile.height / 2];
        let (fraction_bits, [middle, right, down]) = camera.linear(tile.x + x, tile.y + y);
        let given = (fraction_bits + Self::DROPPED_BITS) as i32;
        let step_bits = W::Word::common_bits(right.into_iter().chain(down));
        let taken = FRACTION_BITS.min(given + STEP_BITS as i32 - step_bits as i32);
        if taken < FRACTION_BITS_MIN {
            return None;
        }
        let fraction_bits = taken.unsigned_abs();
        let [middle, right, down] = [middle, right, down].map(|v| {
            v.map(|c| match given - taken {
                cut @ 0.. => rounded(c, cut.unsigned_abs()),
                cut => (c << cut.unsigned_abs()).low_i32(),
            })
        });
        let [x, y] = [x, y].map(i32::from);
        let first = [0, 1, 2].map(|axis| middle[axis] - x * right[axis] - y * down[axis]);
        let last = [i32::from(tile.width) - 1, i32::from(tile.height) - 1];
        let spread = ((1 << fraction_bits) >> (Self::DROPPED_BITS + 1)) + 1 + STEP_ERROR;

        // The corners, in quarters of a unit.
        let quarters = fraction_bits - 2;
        let corner =
            |x: i32, y: i32| [0, 1, 2].map(|axis| (first[axis] + x * right[axis] + y * down[axis]) >> quarters);
        let corners = [corner(0, 0), corner(last[0], 0), corner(0, last[1]), corner(last[0], last[1])];
        let middle = middle.map(i32::abs);
        let axis =
            if middle[0] >= middle[1] && middle[0] >= middle[2] { 0 } else { 1 + usize::from(middle[2] > middle[1]) };
        let turned = |v| turned(v, axis);
        let is_down = turned(corners[0])[0] < 0;
        let (mut low, mut high, mut largest, mut smallest) = ([i32::MAX; 2], [i32::MIN; 2], 0, i32::MAX);
        for corner in corners {
            let [along, across @ ..] = turned(corner);
            let depth = if is_down { -along } else { along };
            if depth < 4 * DEPTH_MIN {
                return None;
            }
            (largest, smallest) = (depth.max(largest), depth.min(smallest));
            let r = reciprocal(depth as u32);
            for which in [0, 1] {
                let v = across[which];
                if v.abs() >= 2 * depth {
                    return None;
                }
                // |v| is below 2^16 and the mantissa, halved, below 2^15.
                let slope = (v * (r.mantissa >> 1) as i32) >> (r.log2_d + 1);
                (low[which], high[which]) = (slope.min(low[which]), slope.max(high[which]));
            }
        }
        let r = reciprocal((smallest - 8) as u32);
        let off = 3 * ((spread >> quarters) + 2);
        let margin = ((off * r.mantissa as i32) >> (r.log2_d + 2)) + 8;
        if low.iter().any(|&low| low - margin <= -(2 << SLOPE_BITS))
            || high.iter().any(|&high| high + margin >= 2 << SLOPE_BITS)
        {
            return None;
        }
        // What low planes are counted from, and high ones.
        let origin = camera.eye();
        let up = turned(origin.map(|c| -((-c) >> Self::COARSE_BITS).low_i32()));
        let below = turned(origin.map(|c| (c >> Self::COARSE_BITS).low_i32() - i32::from(Self::COARSE_BITS > 0)));
        let side = |which: usize, slope: i32, is_low: bool| {
            let slope = if is_down { -slope } else { slope };
            let v = if is_low { up[1 + which] } else { below[1 + which] };
            let u = if (slope < 0) == is_low { up[0] } else { below[0] };
            Side { slope, offset: (v << SLOPE_BITS).wrapping_sub(slope.wrapping_mul(u)) }
        };
        let sides =
            [0, 1].map(|which| [side(which, high[which] + margin, true), side(which, low[which] - margin, false)]);
        let sum = |v: &Triple<i32>| v[0].abs() + v[1].abs() + v[2].abs();
        let length = ((sum(&first) + last[0] * sum(&right) + last[1] * sum(&down)) >> fraction_bits) + 4;
        let mask = (1 << fraction_bits) - 1;
        Some(Self {
            origin,
            first: first.map(|c| c >> fraction_bits),
            rest: first.map(|c| c & mask),
            right,
            down,
            fraction_bits,
            vector_bits: VECTOR_BITS - (FRACTION_BITS - taken).unsigned_abs() / 2,
            last,
            spread,
            length,
            axis,
            is_down,
            largest: (largest >> 2) + 2 + (spread >> fraction_bits),
            depth_origin: if is_down { below[0] } else { up[0] },
            sides,
        })
    }

    #[inline(always)]
    fn axis(&self) -> usize {
        self.axis
    }

    #[inline(always)]
    fn reach(&self) -> Distance<W> {
        <Distance<W> as Word>::from_i32(i32::MAX)
    }

    #[inline]
    fn limit(&self, nearness: i32) -> Distance<W> {
        if nearness < NEARNESS_MIN {
            return self.reach();
        }
        let r = reciprocal(nearness as u32);
        // The component is at most 2^13 + 11, the mantissa with its error at most 2^16 + 4.
        let limit = (self.largest as u32 * (r.mantissa + 5)) >> (r.log2_d - (NEARNESS_BITS - 16));
        <Distance<W> as Word>::from_i32(limit as i32 + 1)
    }

    #[inline(always)]
    fn enter<const AXIS: usize>(&self, node: &W::Node, child: usize, limit: Distance<W>) -> Option<Distance<W>> {
        let [low, high] = &node.planes()[child];
        let (u_low, u_high) = (Self::coarse(low[AXIS]), Self::coarse(high[AXIS]));
        let near = if self.is_down { self.depth_origin - u_high } else { u_low - self.depth_origin };
        let near = <Distance<W> as Word>::from_i32(near);
        // Behind the eye there is nothing between the planes.
        if near > limit {
            return None;
        }
        for which in [0, 1] {
            let axis = (AXIS + 1 + which) % 3;
            let [above, below] = self.sides[which];
            let v = Self::coarse(low[axis]);
            let u = if above.slope < 0 { u_low } else { u_high };
            if above.beyond(u, v) > 0 {
                return None;
            }
            let v = Self::coarse(high[axis]);
            let u = if below.slope < 0 { u_high } else { u_low };
            if below.beyond(u, v) < 0 {
                return None;
            }
        }
        Some(near)
    }

    #[inline(always)]
    fn footprint(&self, vertices: &Vertices, edges: &mut Edges) -> Footprint {
        let [p, q, r] = vertices.map(|vertex| vertex.map(W::Word::from_i32));
        let from_origin = sub(p, self.origin);
        // By edges: a record has these.
        let moved = |to: Triple<W::Word>| {
            let e = sub(to, p);
            [from_origin[0] + e[0], from_origin[1] + e[1], from_origin[2] + e[2]]
        };
        let [p, q, r] = [from_origin, moved(q), moved(r)];
        let [a, b, c] = [cross(p, q), cross(q, r), cross(r, p)];
        let sum = |axis: usize| a[axis].wrapping_sub(-b[axis]).wrapping_sub(-c[axis]);
        let normal = [sum(0), sum(1), sum(2)];
        let volume = W::dot(p, normal);
        let zero = W::Wide::default();
        if volume == zero {
            return Footprint::Nothing;
        }
        let is_back = volume < zero;
        let shift = W::Word::common_bits(a.into_iter().chain(b).chain(c)).saturating_sub(self.vector_bits);
        for (edge, vector) in edges.edges.iter_mut().zip([a, b, c]) {
            let g = if is_back { vector.map(|c| -rounded(c, shift)) } else { vector.map(|c| rounded(c, shift)) };
            let linear = self.linear(g);
            let band = self.off(g) + (self.length >> 1) + LINEAR_ERROR;
            let line = Linear { first: linear.first + band, ..linear };
            if line.most(self.last) < 0 {
                return Footprint::Nothing;
            }
            *edge = Edge { line, uncertain: 2 * band, vector: g };
        }
        let (leading, length) = (if is_back { -volume } else { volume }).leading();
        let m = mantissa(leading) as i32;
        let factor = if is_back { -m } else { m };
        let normal_shift = W::Word::common_bits(normal).saturating_sub(15);
        let towards = normal.map(|c| (rounded(c, normal_shift) * factor) >> (31 - self.vector_bits));
        let nearness_shift =
            (length + self.vector_bits) as i32 - (16 + normal_shift + Self::COARSE_BITS + NEARNESS_BITS) as i32;
        if !(1..32).contains(&nearness_shift) {
            return Footprint::Unknown;
        }
        edges.nearness = self.linear(towards);
        edges.shift = nearness_shift as u32;
        edges.band = self.off(towards) + 6 * self.length + LINEAR_ERROR;
        Footprint::Edges
    }

    /// With u the axis of depth and v another, all of the box is at p_v <= (b / a) |p_u|, b being its highest v and a the nearest u,
    /// or for b < 0 the farthest: then b |D_u| - a D_v is not negative where a ray meets it. Likewise below.
    fn around(&self, bounds: &Bounds) -> Option<[Linear; 4]> {
        let low = sub(bounds.low.map(W::Word::from_i32), self.origin).map(|c| (c >> Self::COARSE_BITS).low_i32());
        let high = sub(self.origin, bounds.high.map(W::Word::from_i32)).map(|c| -(c >> Self::COARSE_BITS).low_i32());
        let ([u_low, v_low, w_low], [u_high, v_high, w_high]) = (turned(low, self.axis), turned(high, self.axis));
        let (near, far) = if self.is_down { (-u_high, -u_low) } else { (u_low, u_high) };
        if near <= 0 {
            return None;
        }
        let line = |slope: i32, [v, w]: [i32; 2]| {
            let g = turned_back([if self.is_down { -slope } else { slope }, v, w], self.axis);
            let g = g.map(|c| rounded(c, BOX_BITS.saturating_sub(self.vector_bits)));
            let line = self.linear(g);
            Linear { first: line.first + self.off(g) + (self.length >> 1) + LINEAR_ERROR, ..line }
        };
        let above = |high: i32| -if high < 0 { far } else { near };
        let below = |low: i32| if low > 0 { far } else { near };
        Some([
            line(v_high, [above(v_high), 0]),
            line(-v_low, [below(v_low), 0]),
            line(w_high, [0, above(w_high)]),
            line(-w_low, [0, below(w_low)]),
        ])
    }

    /// A vector is within 1/2 along each axis, or without error: its product with a direction is off by at most half the sum of
    /// the direction's components.
    #[inline]
    fn meets(ray: &Ray<W>, edges: &Edges) -> Option<bool> {
        let error = (W::Word::ONE + W::Word::ONE + W::Word::ONE) << (W::DIRECTION_BITS - 1);
        let values = edges.edges.map(|edge| narrow_dot(ray.direction, edge.vector.map(W::Word::from_i32)));
        if values.iter().any(|&value| value < -error) {
            Some(false)
        } else {
            values.iter().all(|&value| value > error).then_some(true)
        }
    }
}
