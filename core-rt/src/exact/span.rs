//! Between which t a hit is, in one word: enough to tell most hits apart and to leave boxes out.
//!
//! The exact t of [`depth`](super::triangle) takes sums of twice the word. It is wanted where two hits are too near each other
//! to be told apart without, and nowhere else while a ray is traced.
//!
//! With n = N >> k as the record has it and the determinant d = -(D . n) of the filter, t is about 2 h / d, where
//! h = ((s_0 n_0 + s_1 n_1) >> 1) + (s_2 n_2 >> 1), which the word has where the whole sum may not.
//!
//! **Bound.** Each component of N / 2^k - n is in [0, 1), so that 2 h is S . N / 2^k within x = 3 * 2^GRID_BITS + 2, and d is
//! det / 2^k within y = 3 * 2^DIRECTION_BITS. Then t = (2 h + a) / (d + b) with |a| <= x and |b| <= y, and it is off 2 h / d by
//! (x + y 2 h / d) / (d - y) at most. Where d has [`SPARE_BITS`] more bits than D, d - y is at least 61/64 of d, so with
//! 51/16 < 13/4 this is below 13 * 2^DIRECTION_BITS (2^(GRID_BITS - DIRECTION_BITS) + 2 / 3 / 2^DIRECTION_BITS + 2 h / d) / 4 d.
//!
//! The quotient is taken with 16 bits below the largest t, a unit of 2^-q: as in `Width14::depth`, it is high by less than 2 and
//! low by less than 7. What exceeds 16 bits on the way is beyond every t, and is cut to these.

use core::cmp::Ordering;

use super::ray::Ray;
use super::triangle::{self, Depth, TriangleRecord};
use super::width::Width;
use crate::num::{Word, mantissa, sub};

/// Two t, in [`Width::T_BITS`], between which that of a hit is, or at one of which.
#[derive(Clone, Copy, Debug)]
pub struct Span<W: Width> {
    least: W::Word,
    most: W::Word,
}

impl<W: Width> Span<W> {
    /// Whether every one is of an exact t.
    pub const IS_EXACT: bool = !W::FILTERED;

    /// The lesser one and the greater one.
    #[must_use]
    pub fn ends(&self) -> [W::Word; 2] {
        [self.least, self.most]
    }
}

/// That of a hit whose t is known.
#[inline(always)]
pub(super) fn of<W: Width>(depth: &Depth<W>) -> Span<W> {
    Span { least: depth.t - W::SLACK, most: depth.t + W::SLACK }
}

/// The order of two hits of a ray, where these tell.
#[inline(always)]
pub(super) fn order<W: Width>(a: &Span<W>, b: &Span<W>) -> Option<Ordering> {
    if a.most < b.least {
        Some(Ordering::Less)
    } else if b.most < a.least {
        Some(Ordering::Greater)
    } else {
        None
    }
}

/// A depth that is low by the slack at most.
#[inline(always)]
pub(super) fn depth<W: Width>(span: &Span<W>) -> W::Word {
    span.most - W::SLACK
}

/// The hit with a triangle.
#[inline(always)]
pub(super) fn meet<W: Width>(ray: &Ray<W>, triangle: &TriangleRecord<W::Short>) -> Option<Span<W>> {
    if !W::FILTERED {
        return triangle::intersect(ray, triangle).map(|depth| of(&depth));
    }
    let det = triangle::filtered(ray, triangle);
    if det == W::Word::ZERO { None } else { within(ray, triangle, det) }
}

/// By how many bits a determinant is longer than a direction's component, at least, where it is good for a quotient.
const SPARE_BITS: u32 = 7;

/// The hit with a triangle that the line through the ray meets by this determinant, or of which the filter does not tell, if it
/// has a t above 0 within the ray's reach.
// Out of line: few of the triangles that are tried are met.
#[inline(never)]
fn within<W: Width>(ray: &Ray<W>, triangle: &TriangleRecord<W::Short>, det: W::Word) -> Option<Span<W>> {
    let bits = det.magnitude_bits();
    // 2^16 such units are the largest t, a power of two; of a grid too small for them nothing is told apart by them.
    let unit_bits = (W::T_MAX.magnitude_bits() - 1).checked_sub(16);
    if let Some(unit_bits) = unit_bits.filter(|_| bits >= W::DIRECTION_BITS + SPARE_BITS) {
        let q = W::T_BITS - unit_bits;
        let s = sub(ray.origin, triangle.v0_fields().map(W::coordinate));
        let n = triangle.n::<W::Word>();
        // Each product is at most SPAN 2^NORMAL_BITS, and two of them fit the word.
        let half = ((s[0].product(n[0]) + s[1].product(n[1])) >> 1) + (s[2].product(n[2]) >> 1);
        let half = if det < W::Word::ZERO { -half } else { half };
        // (3 * 2^GRID_BITS + 2) / 2, rounded up.
        let doubt = ((W::Word::ONE + W::Word::ONE + W::Word::ONE) << (W::GRID_BITS - 1)) + W::Word::ONE;
        if half < -doubt {
            return None;
        }
        if half > doubt {
            let divisor = (det.magnitude() >> (bits - 16)).low_i32().unsigned_abs();
            let largest = (W::Word::ONE << 16) - W::Word::ONE;
            let numerator = (half >> (bits - 1 - q)).min(largest).low_i32().unsigned_abs();
            let t = (numerator * mantissa(divisor)) >> 15; // below 2^17
            // 13 (2^15 + 2^17 + 8) < 2^22; one for the shift, and 8 for the quotient.
            let reach = (1 << (W::GRID_BITS + q - W::DIRECTION_BITS)) + 8;
            // The determinant is below 3 * 2^(NORMAL_BITS + DIRECTION_BITS).
            let down = bits + 1 - W::DIRECTION_BITS;
            let down = if W::NORMAL_BITS + 3 < u32::BITS { down } else { down.min(u32::BITS - 1) };
            let error = ((13 * (reach + t)) >> down) + 9;
            let place = |t: u32| W::Word::from_i32(t.cast_signed()) << unit_bits;
            let span = Span { least: place(t) - place(error), most: place(t + error) };
            let limit = ray.reach_limit();
            if ray.reach.is_none() || span.most < limit {
                return Some(span);
            }
            if span.least >= limit {
                return None;
            }
        }
    }
    exactly(ray, triangle, det == W::Word::ONE)
}

/// By the exact t: rare.
#[cold]
#[inline(never)]
fn exactly<W: Width>(ray: &Ray<W>, triangle: &TriangleRecord<W::Short>, is_undecided: bool) -> Option<Span<W>> {
    triangle::exactly(ray, triangle, is_undecided).map(|depth| of(&depth))
}
