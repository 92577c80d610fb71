//! What an exact kernel is parametrised by: the widths, and the operations whose best form depends on them.

use core::cmp::Ordering;
use core::fmt::Debug;
use core::ops::{Add, Neg, Shr, Sub};

use super::boxes::BoxNode;
use super::slopes::Slopes;
use crate::kernel::Surface;
use crate::num::{BitLength, Triple, Word};
use crate::record::Record;
use crate::space::Space;

/// An integer that holds an exact triple product: `i64` on 14-bit grids, `i128` on 29-bit ones.
pub trait Wide:
    Copy
    + Ord
    + Debug
    + Default
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Neg<Output = Self>
    + Shr<u32, Output = Self>
    + 'static
{
    /// `self - other` modulo the word, for a difference that is known to fit although its parts do not.
    fn wrapping_sub(self, other: Self) -> Self;
    /// Of a positive value the 16 leading bits, and how many bits there are.
    fn leading(self) -> (u32, u32);
}

macro_rules! wide {
    ($wide:ty) => {
        impl Wide for $wide {
            #[inline(always)]
            fn leading(self) -> (u32, u32) {
                let bits = self.cast_unsigned().bit_length();
                let leading = if bits > 16 { self >> (bits - 16) } else { self << (16 - bits) };
                (leading as u32, bits)
            }
            #[inline(always)]
            fn wrapping_sub(self, other: Self) -> Self {
                self.wrapping_sub(other)
            }
        }
    };
}
wide!(i64);
wide!(i128);

/// The reciprocal of a direction's component, of its sign, and never above the true one in magnitude.
pub trait Reciprocal: Copy + Debug + Send + Sync {
    /// The word of grid differences.
    type Word: Word;
    /// By how much a product may be low; see [`Width::SLACK`].
    const SLACK: Self::Word;
    /// From a component; 0 stands for "does not move along this axis".
    fn new(component: Self::Word) -> Self;
    /// `delta / component` in the unit of [`Width::SLACK`], rounded down; not above the true value where that is not
    /// negative, negative where that is. It does not fall as `delta` rises where the component is not negative, and does
    /// not rise where it is. Where the component is 0 and `delta` at least 1, at least every limit that a hit can have, less
    /// [`Width::SLACK`].
    fn along(self, delta: Self::Word) -> Self::Word;
}

/// The word of distances to boxes.
pub type Distance<W> = <<W as Width>::Slopes as Slopes>::Distance;

/// The widths of an exact kernel.
///
/// Let vertices be below `2^GRID_BITS`, differences of origins and vertices below `2^s`, directions below
/// `2^DIRECTION_BITS`, and c = 1 + s + DIRECTION_BITS. Then R = S x D is below `2^c`, and `3 * 2^c` must fit the word.
pub trait Width: Copy + Debug + Default + Send + Sync + 'static {
    /// See [`Kernel::ID`](crate::kernel::Kernel::ID).
    const ID: u16;
    /// See [`Kernel::NAME`](crate::kernel::Kernel::NAME).
    const NAME: &'static str;
    /// See [`Kernel::GRID_BITS`](crate::kernel::Kernel::GRID_BITS).
    const GRID_BITS: u32;
    /// See [`Kernel::MARGIN`](crate::kernel::Kernel::MARGIN).
    const MARGIN: i32;
    /// See [`Kernel::SPAN`](crate::kernel::Kernel::SPAN).
    const SPAN: i32;
    /// Directions are below 2 to this, and at least 2 to one less in their largest component.
    const DIRECTION_BITS: u32;
    /// Stored normals are at most 2 to this: `2^(NORMAL_BITS + DIRECTION_BITS) * 3` fits the word.
    const NORMAL_BITS: u32;
    /// Whether edge functions are decided in the word where their signs are certain, and exactly only elsewhere. Not where
    /// [`Width::Wide`] is as good as the word.
    const FILTERED: bool = true;
    /// By how many bits the filter lessens R; by those of the triangle's longest edge where it is not the same for all. Then
    /// what is left of R fits 32 bits, and it is at least 2 `GRID_BITS` - `NORMAL_BITS`.
    const FILTER_SHIFT: Option<u32> = None;
    /// See [`Kernel::MATERIALS_MAX`](crate::kernel::Kernel::MATERIALS_MAX).
    const MATERIALS_MAX: u32;
    /// Fractional bits of the `t` that boxes and depths are compared in.
    const T_BITS: u32;
    /// By how much, in `t`, an exit of a box may be low and a depth wrong. Each width proves its own.
    const SLACK: Self::Word;
    /// No hit has a larger `t`.
    const T_MAX: Self::Word;

    /// What it shades in.
    type Space: Space;
    /// The word of the hot path.
    type Word: Word;
    /// The word of exact decisions.
    type Wide: Wide + From<Self::Word>;
    /// A signed coordinate in a triangle's record.
    type Short: Record + Into<Self::Word> + TryFrom<i64>;
    /// The record of a node.
    type Node: BoxNode<Plane: Into<Self::Word>>;
    /// What the box test keeps of a ray.
    type Slopes: Slopes<Word = Self::Word>;

    /// A coordinate on the grid, which is not negative.
    #[inline(always)]
    fn coordinate(short: Self::Short) -> Self::Word {
        short.into()
    }
    /// A coordinate, a component of an edge or of a stored normal, which fit.
    fn short(word: Self::Word) -> Self::Short;
    /// The exact `a . b`, for `a` an edge, an origin's offset or a direction and `b` a cross product of two of these.
    fn dot(a: Triple<Self::Word>, b: Triple<Self::Word>) -> Self::Wide;
    /// The exact `a . a`, for `a` an edge, an origin's offset or a direction.
    fn square(a: Triple<Self::Word>) -> Self::Wide;
    /// `sqrt(b^2 - a c)` rounded down, and whether it is whole; `None` where it is not real. For the [sphere test's] a, b, c.
    ///
    /// [sphere test's]: crate::exact
    fn discriminant_root(a: Self::Wide, b: Self::Wide, c: Self::Wide) -> Option<(Self::Wide, bool)>;
    /// The order of `a.0 / a.1` and `b.0 / b.1`, exactly; all positive.
    fn order(a: (Self::Wide, Self::Wide), b: (Self::Wide, Self::Wide)) -> Ordering;
    /// `numerator / denominator` with [`Width::T_BITS`], within [`Width::SLACK`] of true; both positive, and the
    /// quotient the `t` of a hit.
    fn depth(numerator: Self::Wide, denominator: Self::Wide) -> Self::Word;
    /// `numerator / denominator` in [0, 1], never high.
    fn fraction(numerator: Self::Wide, denominator: Self::Wide) -> <Self::Space as Space>::Fraction;
    /// `origin + direction * numerator / denominator`.
    fn point(
        origin: Triple<Self::Word>,
        direction: Triple<Self::Word>,
        numerator: Self::Wide,
        denominator: Self::Wide,
    ) -> <Self::Space as Space>::Point;
    /// The point on a sphere `s + direction * numerator / denominator` from its `centre`, and that vector to the point, of any
    /// length, within 2^-11 grid units along each axis: a normal needs more bits than a point has.
    fn on_sphere(
        centre: Triple<Self::Word>,
        s: Triple<Self::Word>,
        direction: Triple<Self::Word>,
        numerator: Self::Wide,
        denominator: Self::Wide,
    ) -> (<Self::Space as Space>::Point, Triple<Self::Word>);
    /// `vector` with length 1; `None` for zero.
    fn normalise(vector: Triple<Self::Word>) -> Option<<Self::Space as Space>::Unit>;
    /// The grid point from which rays leave a surface, off it on its normal's side. Each width proves that no ray
    /// that leaves to that side meets the surface's plane again.
    fn stand_off(surface: &Surface<Self::Space>) -> Triple<Self::Word>;
    /// A unit vector as a direction.
    fn direction(unit: <Self::Space as Space>::Unit) -> Triple<Self::Word>;
    /// Packs a triangle's shift and material into its last field.
    fn join_meta(shift: u32, material: u32) -> Option<Self::Short>;
    /// The shift and the material.
    fn split_meta(meta: Self::Short) -> (u32, u32);
}
