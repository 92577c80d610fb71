//! What the box test keeps of a ray: the distance at which it crosses a plane is a difference of coordinates times a factor.
//!
//! [`PerAxis`] is a reciprocal of each component, all in one unit. [`Scaled`] is for words of 32 bits: a product with no shift
//! after it, in a unit that is the ray's own.
//!
//! **The unit of [`Scaled`].** Let d be a component in units of 2^`UNIT_BITS` (so that every direction has a largest component
//! in [2^12, 2^13) or less) and delta below 2^`DELTA_BITS`. Q13 of delta / d takes a factor 2^13 / d of many sizes, and for
//! a factor of 16 bits a shift of its own along each axis. But where no component is less than a 64th of the largest, the
//! factors in Q(13 + S), S = 3 + floor(log2) of the least component, are whole numbers of 11 to 16 bits, and all three
//! products are in Q(13 + S). Other rays have S = 0 and shift: they are few, and one copy of the descent serves them all.

use core::fmt::Debug;

use crate::kernel::{ANY_OCTANT, octant};
use crate::num::{Triple, Word, byte_length, mantissa, reciprocal};

use super::width::Reciprocal;

/// What the box test keeps of a ray. See [`boxes`](super) for what it must hold.
pub trait Slopes: Copy + Debug + Send + Sync {
    /// The word of origins and directions.
    type Word: Word;
    /// The word of distances.
    type Distance: Word;
    /// Whether there are rays that are not tested by their octant.
    const ANY_OCTANT: bool = false;

    /// For a scaled direction.
    fn new(origin: Triple<Self::Word>, direction: Triple<Self::Word>) -> Self;
    /// For a scaled direction, and boxes that are tested in the way that serves all octants.
    #[inline(always)]
    fn of_any(origin: Triple<Self::Word>, direction: Triple<Self::Word>) -> Self {
        Self::new(origin, direction)
    }
    /// The octant that boxes are tested by.
    fn octant(&self) -> usize;
    /// Where a ray of an octant crosses the near and the far one of two planes of an axis, the low one and the high one. A
    /// constant octant may have the slack in the far one.
    fn crossed<const OCTANT: usize>(
        &self,
        axis: usize,
        low: Self::Word,
        high: Self::Word,
    ) -> (Self::Distance, Self::Distance);
    /// By how much an exit may be low, where [`Slopes::crossed`] has not added it.
    fn slack<const OCTANT: usize>(&self) -> Self::Distance;
    /// A limit that nothing exceeds that is entered at or before a depth, in the width's `T_BITS`.
    fn limit(&self, depth: Self::Word) -> Self::Distance;
}

/// Distances to two planes of an axis, in the order in which a ray of an octant crosses them.
#[inline(always)]
pub(crate) fn in_order<const OCTANT: usize, T: Word>(axis: usize, low: T, high: T) -> (T, T) {
    match OCTANT {
        ANY_OCTANT => (low.min(high), low.max(high)),
        _ if OCTANT >> axis & 1 == 0 => (low, high),
        _ => (high, low),
    }
}

/// A reciprocal of each component.
#[derive(Clone, Copy, Debug)]
pub struct PerAxis<R: Reciprocal> {
    origin: Triple<R::Word>,
    reciprocal: [R; 3],
    octant: usize,
}

impl<R: Reciprocal> Slopes for PerAxis<R> {
    type Word = R::Word;
    type Distance = R::Word;

    #[inline]
    fn new(origin: Triple<R::Word>, direction: Triple<R::Word>) -> Self {
        Self { origin, reciprocal: direction.map(R::new), octant: octant(direction) }
    }

    #[inline(always)]
    fn octant(&self) -> usize {
        self.octant
    }

    #[inline(always)]
    fn crossed<const OCTANT: usize>(&self, axis: usize, low: R::Word, high: R::Word) -> (R::Word, R::Word) {
        let along = |plane: R::Word| self.reciprocal[axis].along(plane - self.origin[axis]);
        in_order::<OCTANT, _>(axis, along(low), along(high))
    }

    #[inline(always)]
    fn slack<const OCTANT: usize>(&self) -> R::Word {
        R::SLACK
    }

    #[inline(always)]
    fn limit(&self, depth: R::Word) -> R::Word {
        depth + R::SLACK
    }
}

/// Factors in a unit of the ray's own. Both coordinates of an axis are taken times a factor, the origin's beforehand.
#[derive(Clone, Copy, Debug)]
struct Scaled<const DIRECTION_BITS: u32, const UNIT_BITS: u32, const DELTA_BITS: u32> {
    /// Of the component's sign.
    factor: Triple<i32>,
    /// The origin's products: what a near plane's is less, and a far one's; the slack is in the latter. Where products are
    /// shifted, those for low planes and high ones, without.
    near: Triple<i32>,
    far: Triple<i32>,
    slack: i32,
    /// A byte each, the lowest first: what products are shifted by along each axis, all 0 where the ray has an octant; then S.
    shifts: u32,
}

/// Where no component has more bits less than this than a direction may have, products are not shifted.
const SPREAD_BITS: u32 = 7;

/// S is at most this: T, below 2^16 in Q13, is then below 2^30.
const SCALE_MAX: u32 = 14;

impl<const DIRECTION_BITS: u32, const UNIT_BITS: u32, const DELTA_BITS: u32>
    Scaled<DIRECTION_BITS, UNIT_BITS, DELTA_BITS>
{
    /// `of_any` says that no octant is wanted.
    /// For a direction, with its largest component in [2^(`DIRECTION_BITS` - 1), 2^`DIRECTION_BITS`), and the origin's
    /// coordinates that low planes and high ones are counted from.
    ///
    /// 2^(16 + log2 d) / d is not below [`reciprocal`]'s mantissa less 2, since that cuts d to 16 bits, and exceeds it by at
    /// most 6.
    #[inline(always)]
    fn new(direction: Triple<i32>, low: Triple<i32>, high: Triple<i32>, of_any: bool) -> Self {
        let magnitudes = direction.map(i32::unsigned_abs);
        let [x, y, z] = magnitudes;
        let has_octant = !of_any && x.min(y).min(z) >> (DIRECTION_BITS - SPREAD_BITS) != 0;
        let [x, y, z] = if has_octant { Self::same_unit(magnitudes) } else { magnitudes.map(Self::own_unit) };
        let slack = if has_octant { (1 << DELTA_BITS) + (8 << x.1) } else { 16 };
        let axis = |axis: usize, factor: u32| {
            let is_down = direction[axis] < 0;
            let factor = if is_down { -(factor as i32) } else { factor as i32 };
            let [first, last] = if is_down && has_octant { [high, low] } else { [low, high] };
            let own_slack = if has_octant { slack } else { 0 };
            let far = last[axis].wrapping_mul(factor).wrapping_sub(own_slack);
            (factor, first[axis].wrapping_mul(factor), far)
        };
        let shifts = if has_octant { x.1 << 24 } else { z.1 << 16 | y.1 << 8 | x.1 };
        let [x, y, z] = [axis(0, x.0), axis(1, y.0), axis(2, z.0)];
        Self { factor: [x.0, y.0, z.0], near: [x.1, y.1, z.1], far: [x.2, y.2, z.2], slack, shifts }
    }

    /// Factors in Q(13 + S), each with S, for components of which none is small.
    #[inline(always)]
    fn same_unit(magnitudes: Triple<u32>) -> [(u32, u32); 3] {
        // The components' lengths, less one: 8 bits tell, of which the first two are not both 0.
        let log2 = magnitudes.map(|d| byte_length(d >> (DIRECTION_BITS - 8)) + (DIRECTION_BITS - 9));
        let scale = (log2[0].min(log2[1]).min(log2[2]) + 3 - UNIT_BITS).min(SCALE_MAX);
        let factor = |axis: usize| {
            let (d, log2) = (magnitudes[axis], log2[axis]);
            let normal = if DIRECTION_BITS > 16 { d >> (log2 - 15) } else { d << (15 - log2) };
            ((mantissa(normal) - 2) >> (log2 + 3 - UNIT_BITS - scale), scale)
        };
        [factor(0), factor(1), factor(2)]
    }

    /// A factor of 16 bits, and by what products with it are shifted to be in Q13.
    #[inline(never)]
    #[cold]
    fn own_unit(magnitude: u32) -> (u32, u32) {
        let r = reciprocal(magnitude);
        if magnitude != 0 && r.log2_d + 3 >= UNIT_BITS {
            (r.mantissa - 2, r.log2_d + 3 - UNIT_BITS)
        } else {
            // A difference of 1 is then 2^16 - 1 or more, which no t in Q13 exceeds by more than the slack.
            (0xffff, 0)
        }
    }

    /// S, or 0 where the ray has no octant.
    #[inline(always)]
    fn scale(&self) -> u32 {
        self.shifts >> 24
    }

    /// What products are shifted by along an axis.
    #[inline(always)]
    fn shift(&self, axis: usize) -> u32 {
        self.shifts >> (8 * axis) & 31
    }

    #[inline(always)]
    fn octant(&self) -> usize {
        if self.scale() == 0 { ANY_OCTANT } else { octant(self.factor) }
    }

    /// |delta| is at most 2^15 and |factor| below 2^16, so their product is below 2^31: the difference of products that may
    /// wrap.
    #[inline(always)]
    fn crossed<const OCTANT: usize>(&self, axis: usize, low: i32, high: i32) -> (i32, i32) {
        let along = |plane: i32, origin: i32| plane.wrapping_mul(self.factor[axis]).wrapping_sub(origin);
        let (near, far) = (self.near[axis], self.far[axis]);
        match OCTANT {
            ANY_OCTANT => {
                let shift = self.shift(axis);
                in_order::<OCTANT, _>(axis, along(low, near) >> shift, along(high, far) >> shift)
            }
            _ if OCTANT >> axis & 1 == 0 => (along(low, near), along(high, far)),
            _ => (along(high, near), along(low, far)),
        }
    }

    #[inline(always)]
    fn slack<const OCTANT: usize>(&self) -> i32 {
        if OCTANT == ANY_OCTANT { self.slack } else { 0 }
    }

    /// From a depth in Q13.
    #[inline(always)]
    fn limit(&self, depth_q13: i32) -> i32 {
        (depth_q13 << self.scale()) + self.slack
    }
}

/// For grids of 15 bits, directions of 13 bits and t in Q13.
#[derive(Clone, Copy, Debug)]
pub struct Slopes14(Scaled<13, 0, 15>);

/// For grids of 29 bits, directions of 31 bits and t in Q31, on machines of 32 bits: boxes are rounded outwards to 2^16 grid
/// units as they are read.
///
/// Then differences are below 2^14 and, with components in units of 2^20, t is in Q17.
#[derive(Clone, Copy, Debug)]
pub struct Slopes29(Scaled<31, 20, 14>);

/// The bits of a plane that [`Slopes29`] does not read.
const COARSE_BITS: u32 = 16;

macro_rules! slopes {
    ($name:ident, $word:ty, $plane:expr, $depth:expr, $new:expr) => {
        impl Slopes for $name {
            type Word = $word;
            type Distance = i32;
            const ANY_OCTANT: bool = true;

            #[inline(always)]
            fn new(origin: Triple<$word>, direction: Triple<$word>) -> Self {
                Self($new(origin, direction, false))
            }

            #[inline(always)]
            fn of_any(origin: Triple<$word>, direction: Triple<$word>) -> Self {
                Self($new(origin, direction, true))
            }

            #[inline(always)]
            fn octant(&self) -> usize {
                self.0.octant()
            }

            #[inline(always)]
            fn crossed<const OCTANT: usize>(&self, axis: usize, low: $word, high: $word) -> (i32, i32) {
                self.0.crossed::<OCTANT>(axis, $plane(low), $plane(high))
            }

            #[inline(always)]
            fn slack<const OCTANT: usize>(&self) -> i32 {
                self.0.slack::<OCTANT>()
            }

            #[inline(always)]
            fn limit(&self, depth: $word) -> i32 {
                self.0.limit($depth(depth))
            }
        }
    };
}
slopes!(Slopes14, i32, |plane| plane, |depth| depth, |origin, direction, of_any| Scaled::new(
    direction, origin, origin, of_any
));
slopes!(
    Slopes29,
    i64,
    |plane: i64| (plane as u32 >> COARSE_BITS) as i32,
    |depth: i64| (depth as u32 >> 14) as i32, // from Q31 to Q17
    |origin: Triple<i64>, direction: Triple<i64>, of_any| {
        let up = origin.map(|c| -((-c as i32) >> COARSE_BITS));
        let down = origin.map(|c| (c as i32 >> COARSE_BITS) - 1);
        Scaled::new(direction.map(|c| c as i32), up, down, of_any)
    }
);

#[cfg(test)]
mod tests {
    use super::*;

    /// Components at the ends of every length, and whole directions of them.
    fn directions(bits: u32) -> impl Iterator<Item = Triple<i32>> {
        let ends = move || (0..bits).flat_map(|b| [1i32 << b, (1 << b) + (1 << b) / 3, ((1i64 << (b + 1)) - 1) as i32]);
        let largest = [1i32 << (bits - 1), ((1i64 << bits) - 1) as i32];
        largest.into_iter().flat_map(move |x| ends().flat_map(move |y| ends().chain([0]).map(move |z| [x, -y, z])))
    }

    fn factors<const DIRECTION_BITS: u32, const UNIT_BITS: u32, const DELTA_BITS: u32>(delta_most: i128) -> [u32; 2] {
        let mut counts = [0; 2];
        for direction in directions(DIRECTION_BITS) {
            let slopes = Scaled::<DIRECTION_BITS, UNIT_BITS, DELTA_BITS>::new(direction, [0; 3], [0; 3], false);
            let has_octant = slopes.octant() != ANY_OCTANT;
            counts[usize::from(has_octant)] += 1;
            for axis in [0, 1, 2] {
                let (d, f) = (i128::from(direction[axis]).abs(), i128::from(slopes.factor[axis]).abs());
                assert!(f > 0 && f < 1 << 16 && (slopes.factor[axis] < 0) == (direction[axis] < 0), "{direction:?}");
                if d == 0 {
                    assert_eq!((f, slopes.shift(axis)), (0xffff, 0));
                    continue;
                }
                let shift = if has_octant { slopes.scale() } else { slopes.shift(axis) };
                // T = delta / d with so many bits; it counts up to 2^16 in Q13.
                let one = 1i128 << (13 + shift + UNIT_BITS);
                assert!(f * d <= one, "{direction:?}: {axis} is high");
                let most = delta_most.min(((d << (3 + shift)) >> UNIT_BITS) + 1);
                let (exit, found) = (most * one / d, most * f);
                let (exit, found) = if has_octant { (exit, found) } else { (exit >> shift, found >> shift) };
                let counts_up_to = 1 << if has_octant { 16 + shift } else { 16 };
                assert!(found + i128::from(slopes.slack) >= exit.min(counts_up_to), "{direction:?}: {axis} is low");
            }
        }
        counts
    }

    #[test]
    fn factors_are_never_high_and_exits_low_by_less_than_the_slack() {
        let [shifted, by_octant] = factors::<13, 0, 15>(1 << 15);
        assert!(shifted > 500 && by_octant > 500, "{shifted} {by_octant}");
        let [shifted, by_octant] = factors::<31, 20, 14>((1 << 13) + 1);
        assert!(shifted > 500 && by_octant > 500, "{shifted} {by_octant}");
    }
}
