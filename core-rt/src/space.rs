//! Spaces: the formats that shading computes in, and the operations that it needs.
//!
//! A space fixes the word of points and directions, the fraction bits of unit vectors and of barycentrics, and
//! how each operation rounds. Shaders are written once against [`Space`]; an integer space of any width and a
//! float space are exchanged without them noticing.

pub(crate) mod grid14;
pub(crate) mod grid29;

pub use grid14::Grid14;
pub use grid29::{Grid29, GridQ31};

use core::fmt::Debug;

use crate::colour::Colour;
use crate::num::Triple;
use crate::record::Record;

/// A cosine, or a share of light: a number in [0, 1].
pub type Scalar<S> = <<S as Space>::Colour as Colour>::Cosine;

/// Schlick's share in Q16 for a cosine in Q16; within 2^-13. The fifth power is that of 15 bits, so that products fit 32.
#[inline]
pub(crate) fn fresnel_q16(cosine_q16: u32, r0_q16: u32) -> u32 {
    let x_q15 = ((1 << 16) - cosine_q16.min(1 << 16)) >> 1;
    let square = (x_q15 * x_q15) >> 15;
    let fifth_q15 = (((square * square) >> 15) * x_q15) >> 15;
    r0_q16 + ((((1 << 16) - r0_q16) * fifth_q15) >> 15)
}

/// Formats and operations for shading. Implemented by zero-sized types.
pub trait Space: Copy + Debug + Default + Send + Sync + 'static {
    /// A point on a surface or a light, with a few bits below the grid.
    type Point: Copy + Debug;
    /// A unit vector.
    type Unit: Copy + Debug + PartialEq;
    /// A number in [0, 1]: a barycentric coordinate.
    type Fraction: Copy + Debug + Default;
    /// Linear light.
    type Colour: Colour;
    /// A unit vector as it stands in the blob.
    type Normal: Record;

    /// The unit vector of a record.
    fn unit(normal: &Self::Normal) -> Self::Unit;
    /// Whether a record's length is 1 within 2^-8.
    fn is_unit(normal: &Self::Normal) -> bool;
    /// The record of a unit vector given with 30 fractional bits; rounds to nearest.
    fn normal(unit_q30: Triple<i32>) -> Self::Normal;
    /// The unit vector of a Q30 triple, as directional lights have it.
    fn unit_from_q30(unit_q30: Triple<i32>) -> Self::Unit;
    /// A point given in whole grid units.
    fn point(grid: Triple<i32>) -> Self::Point;
    /// The direction from one point to another; `None` where they are the same.
    fn towards(from: Self::Point, to: Self::Point) -> Option<Self::Unit>;
    /// `(1 - u - v) n0 + u n1 + v n2`, normalised; `None` where it is zero.
    fn interpolate(normals: [Self::Unit; 3], u: Self::Fraction, v: Self::Fraction) -> Option<Self::Unit>;
    /// The opposite direction.
    fn negate(unit: Self::Unit) -> Self::Unit;
    /// Whether the angle between two directions is at most a right one.
    fn aligned(a: Self::Unit, b: Self::Unit) -> bool;
    /// The cosine of the angle between two directions; `None` where it is not positive.
    fn cosine(a: Self::Unit, b: Self::Unit) -> Option<Scalar<Self>>;
    /// The direction of a ray that came `along` and is mirrored at a surface: d - 2 (d . n) n.
    fn reflect(along: Self::Unit, normal: Self::Unit) -> Self::Unit;
    /// The direction of a ray that came `along` and passes a surface whose normal is towards it, and the cosine behind it
    /// (Snell's law). `eta_q28` is the index before the surface by that behind it; `None` where all is reflected.
    fn refract(along: Self::Unit, normal: Self::Unit, eta_q28: u32) -> Option<(Self::Unit, Scalar<Self>)>;
    /// The direction half way between two; `None` where they are opposite.
    fn halfway(a: Self::Unit, b: Self::Unit) -> Option<Self::Unit>;
    /// The cosine between two directions to a power in Q2, by the chord between them; 0 from a right angle on.
    fn lobe(a: Self::Unit, b: Self::Unit, exponent_q2: u16) -> Scalar<Self>;
    /// The share of light that is reflected under a cosine (Schlick, "An Inexpensive BRDF Model for Physically-based
    /// Rendering", 1994): r0 + (1 - r0) (1 - cos)^5.
    fn fresnel(cosine: Scalar<Self>, r0: u16) -> Scalar<Self>;
}

/// Whether a Q30 triple has length 1 within 2^-8, so that formats that hold less than 2 hold it.
#[must_use]
pub fn is_unit_q30(unit: Triple<i32>) -> bool {
    // Each square is at most 2^62, and 2^60 after the shift.
    let square_q58: u64 = unit.iter().map(|&c| i64::from(c)).map(|c| (c * c) as u64 >> 2).sum();
    square_q58.abs_diff(1 << 58) < 1 << 51
}
