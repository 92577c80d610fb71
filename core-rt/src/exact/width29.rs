//! 29 bits: the hot path in `i64`, exact decisions in `i128`, the order of two hits in 256 bits.
//!
//! | value | bound | fits |
//! | --- | --- | --- |
//! | vertices, edges, origins - vertices | < 2^29 | `i32` |
//! | directions D | < 2^31, largest >= 2^30 | `i32` |
//! | R = S x D | < 2^61 | `i64` |
//! | N = e1 x e2 | < 2^58 (area of a projection) | `i64` |
//! | U, V, det, tn | < 3 * 2^29 * 2^61 < 2^92 | `i128` |
//! | S . S, r^2 | < 3 * 2^58 | `i64` |
//! | D . D | < 3 * 2^62 | `u64` |
//! | S . D | < 3 * 2^60 | `i64` |
//! | its square, (D . D) (S . S - r^2) | < 9 * 2^120 < 2^124 | `i128` |
//! | t | <= 2^29 / 2^30 = 1/2 | Q31 |
//!
//! Vertices keep a margin from the ends of the grid, so that origins that stand off a surface are no farther from any
//! vertex than the rest.

use core::cmp::Ordering;

use super::boxes::BoxNode29;
use super::slopes::{PerAxis, Slopes, Slopes29};
use super::width::{Reciprocal, Width};
use super::width14::Width14;
use crate::kernel::Surface;
use crate::num::{BitLength, Triple, Word, round_shift};
use crate::space::grid29::{POINT_BITS, normalise};
use crate::space::{Grid29, Space};

/// The widths of `exact29`, in the form that suits the machine.
pub type Width29 = Width29In<{ cfg!(target_pointer_width = "32") }>;

/// The widths of `exact29`, in one of two forms: that for machines of 32 bits reads boxes in 13 bits, which are rounded
/// outwards, and knows a depth in 13 bits. Both find the same hits in the same records.
#[derive(Clone, Copy, Debug, Default)]
pub struct Width29In<const NARROW: bool>;

/// In what the two forms differ.
pub trait Form {
    /// See [`Width::Slopes`].
    type Slopes: Slopes<Word = i64>;
}

impl Form for Width29In<false> {
    type Slopes = PerAxis<Reciprocal29>;
}

impl Form for Width29In<true> {
    type Slopes = Slopes29;
}

/// How far rays start above a surface, in grid units.
///
/// The resolved point is within 2^-8 of the true one along each axis, the unit normal within 2^-28, the rounding to the
/// grid is 1/2: along the normal at most sqrt(3) (1/2 + 2^-8 + 2^-27) < 0.88 < 1 - 2^-28.
const STAND_OFF: i64 = 1;

/// `floor(2^63 / |component|)`, with the component's sign.
#[derive(Clone, Copy, Debug)]
pub struct Reciprocal29(i64);

impl Reciprocal for Reciprocal29 {
    type Word = i64;
    const SLACK: i64 = 4;

    #[inline]
    fn new(component: i64) -> Self {
        // For 0 and 1 the largest word: low by one part in 2^63.
        let quotient = (1u64 << 63) / component.unsigned_abs().max(1);
        let magnitude = quotient.min(i64::MAX as u64) as i64;
        Self(if component < 0 { -magnitude } else { magnitude })
    }

    /// t in Q31: delta 2^31 / |D| = delta 2^32 (2^63 / |D|) / 2^64. One multiplication that keeps its high half, and no
    /// variable shift.
    #[inline(always)]
    fn along(self, delta: i64) -> i64 {
        ((i128::from(delta << 32) * i128::from(self.0)) >> 64) as i64
    }
}

impl<const NARROW: bool> Width for Width29In<NARROW>
where
    Self: Form,
{
    const ID: u16 = 29;
    const NAME: &'static str = "exact29";
    const GRID_BITS: u32 = 29;
    const MARGIN: i32 = 8;
    const SPAN: i32 = (1 << 29) - 8;
    const DIRECTION_BITS: u32 = 31;
    const NORMAL_BITS: u32 = 30;
    const FILTER_SHIFT: Option<u32> = Some(32);
    const MATERIALS_MAX: u32 = (1 << 26) - 1;
    const T_BITS: u32 = 31;
    /// An exit T <= 2^31 is computed low by less than T 2^-32 (the reciprocal is at least 2^32, and its floor takes off less
    /// than one) + 1 (the shift). A depth is within 3 of true: its denominator and numerator are truncated to 32 bits. The
    /// narrow one is [`Width14`](super::Width14)'s, in units of Q17: within 7 of them.
    const SLACK: i64 = if NARROW { 8 << 14 } else { Reciprocal29::SLACK };
    const T_MAX: i64 = 1 << 30;

    type Space = Grid29;
    type Word = i64;
    type Wide = i128;
    type Short = i32;
    type Node = BoxNode29;
    type Slopes = <Self as Form>::Slopes;

    #[inline(always)]
    fn short(word: i64) -> i32 {
        debug_assert!(i64::from(word as i32) == word);
        word as i32
    }

    /// The narrow form is by limbs of b, as [`Width14`](super::Width14)'s: of 30 bits, for |a| < 2^31 and |b| < 2^61. A limb's
    /// product is below 2^62, and the third is added in 128 bits.
    #[inline]
    fn dot(a: Triple<i64>, b: Triple<i64>) -> i128 {
        if NARROW {
            let sum = |limb: fn(i64) -> i64| {
                let two = a[0].product(limb(b[0])) + a[1].product(limb(b[1]));
                i128::from(two) + i128::from(a[2].product(limb(b[2])))
            };
            return (sum(|b| b >> 30) << 30) + sum(|b| b & 0x3fff_ffff);
        }
        let product = |a: i64, b: i64| i128::from(a) * i128::from(b);
        product(a[0], b[0]) + product(a[1], b[1]) + product(a[2], b[2])
    }

    /// Below 3 * 2^62.
    #[inline(always)]
    fn square(a: Triple<i64>) -> i128 {
        a.iter().map(|&c| (c * c) as u64).sum::<u64>().into()
    }

    #[inline]
    fn discriminant_root(a: i128, b: i128, c: i128) -> Option<(i128, bool)> {
        let discriminant = b * b - a * c;
        if discriminant < 0 {
            return None;
        }
        let root = discriminant.cast_unsigned().isqrt().cast_signed();
        Some((root, root * root == discriminant))
    }

    #[inline]
    fn order(a: (i128, i128), b: (i128, i128)) -> Ordering {
        wide_product(a.0, b.1).cmp(&wide_product(b.0, a.1))
    }

    /// With the denominator scaled to 32 bits, the numerator is at most 2^31 (t <= 1/2), and 2^62 in Q31. `max` says here
    /// and below that a denominator is not 0: the compiler cannot know, and would link a panic.
    #[inline]
    fn depth(numerator: i128, denominator: i128) -> i64 {
        if NARROW {
            // The 64 bits from the denominator's highest on: t in Q13 with a unit of 2^-4, which is Q17.
            let above = denominator.cast_unsigned().bit_length().saturating_sub(i64::BITS - 5);
            return i64::from(Width14::depth((numerator << 4 >> above) as i64, (denominator >> above) as i64)) << 14;
        }
        let bits = denominator.cast_unsigned().bit_length();
        let scaled = |value: i128| if bits > 32 { value >> (bits - 32) } else { value << (32 - bits) } as u64;
        ((scaled(numerator) << Self::T_BITS) / scaled(denominator).max(1)) as i64
    }

    /// As [`Width::depth`], in Q30: the numerator is at most the denominator, so below 2^62 in Q30. Both are
    /// truncated, so it is within 2^-30 of true; the floor and the clamp keep it at most 1.
    #[inline]
    fn fraction(numerator: i128, denominator: i128) -> <Grid29 as Space>::Fraction {
        let bits = denominator.cast_unsigned().bit_length();
        let scaled = |value: i128| if bits > 32 { value >> (bits - 32) } else { value << (32 - bits) } as u64;
        let fraction = ((scaled(numerator) << 30) / scaled(denominator).max(1)).min(1 << 30);
        <Grid29 as Space>::Fraction::from_bits(fraction as i32)
    }

    /// t in Q62 from 64 leading bits of the denominator, so within 2^-61; D t is within 2^-30 before its rounding to Q8.
    #[inline]
    fn point(origin: Triple<i64>, direction: Triple<i64>, numerator: i128, denominator: i128) -> Triple<i64> {
        let t_q62 = quotient_q62(numerator, denominator);
        let moved = |origin: i64, direction: i64| {
            let offset_q62 = i128::from(direction) * t_q62; // at most 2^31 * 2^61
            (origin << POINT_BITS) + round_shift_wide(offset_q62, 62 - POINT_BITS)
        };
        [moved(origin[0], direction[0]), moved(origin[1], direction[1]), moved(origin[2], direction[2])]
    }

    /// D t is within 2^-30, as for a point, and its rounding within 2^-33. A t that was rounded up to a multiple of 1 / |D|^2
    /// adds at most 2^-30. The offset is a radius at most, below 2^60 in Q32.
    #[inline]
    fn on_sphere(
        centre: Triple<i64>,
        s: Triple<i64>,
        direction: Triple<i64>,
        numerator: i128,
        denominator: i128,
    ) -> (Triple<i64>, Triple<i64>) {
        const OFFSET_BITS: u32 = 32;
        let t_q62 = quotient_q62(numerator, denominator);
        let offset = [0, 1, 2].map(|axis| {
            let moved_q62 = i128::from(direction[axis]) * t_q62; // at most 2^31 * 2^61
            (s[axis] << OFFSET_BITS) + round_shift_wide(moved_q62, 62 - OFFSET_BITS)
        });
        let point =
            [0, 1, 2].map(|axis| (centre[axis] << POINT_BITS) + round_shift(offset[axis], OFFSET_BITS - POINT_BITS));
        (point, offset)
    }

    #[inline]
    fn normalise(vector: Triple<i64>) -> Option<<Grid29 as Space>::Unit> {
        normalise(vector)
    }

    #[inline]
    fn stand_off(surface: &Surface<Grid29>) -> Triple<i64> {
        let placed = |point_q8: i64, unit_q30: i64| {
            // One rounding: the sum in Q30, the point being below 2^30 grid units.
            round_shift((point_q8 << (30 - POINT_BITS)) + STAND_OFF * unit_q30, 30)
        };
        let n = surface.normal.map(|c| i64::from(c.to_bits()));
        [placed(surface.point[0], n[0]), placed(surface.point[1], n[1]), placed(surface.point[2], n[2])]
    }

    #[inline]
    fn direction(unit: <Grid29 as Space>::Unit) -> Triple<i64> {
        unit.map(|c| i64::from(c.to_bits()))
    }

    /// The shift in the low 5 bits, the material above.
    fn join_meta(shift: u32, material: u32) -> Option<i32> {
        (shift <= Self::GRID_BITS && material <= Self::MATERIALS_MAX).then_some((material << 5 | shift) as i32)
    }

    #[inline(always)]
    fn split_meta(meta: i32) -> (u32, u32) {
        // 30 and 31 are no shifts; `min` keeps NORMAL_BITS - shift from wrapping.
        ((meta as u32 & 31).min(Self::NORMAL_BITS), meta as u32 >> 5)
    }
}

/// t in Q62 from 64 leading bits of the denominator, so within 2^-61.
#[inline(always)]
fn quotient_q62(numerator: i128, denominator: i128) -> i128 {
    let bits = denominator.cast_unsigned().bit_length();
    let scaled = |value: i128| if bits > 64 { value >> (bits - 64) } else { value } as u128;
    // t <= 1/2: the numerator is at most 2^63 here, and 2^125 shifted.
    ((scaled(numerator) << 62) / scaled(denominator).max(1)) as i128
}

/// `value / 2^shift` rounded to nearest, which fits 64 bits.
#[inline(always)]
fn round_shift_wide(value: i128, shift: u32) -> i64 {
    ((value + (1 << (shift - 1))) >> shift) as i64
}

/// The product of two numbers in [0, 2^127), as high and low halves: schoolbook, by 64-bit digits.
fn wide_product(a: i128, b: i128) -> (u128, u128) {
    const LOW: u128 = u64::MAX as u128;
    let (a, b) = (a.unsigned_abs(), b.unsigned_abs());
    let (a1, a0, b1, b0) = (a >> 64, a & LOW, b >> 64, b & LOW);
    let low = a0 * b0;
    // a1, b1 < 2^63: the sum of two cross products and a carry is below 2^128.
    let middle = a1 * b0 + a0 * b1 + (low >> 64);
    (a1 * b1 + (middle >> 64), (middle << 64) | (low & LOW))
}
