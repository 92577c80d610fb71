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

use crate::colour::{Colour, Radiance};
use crate::num::{BitLength, Triple};
use crate::record::{Checker, Reach, Record};

/// A cosine, or a share of light: a number in [0, 1].
pub type Scalar<S> = <<S as Space>::Colour as Colour>::Cosine;

/// Light on its way.
pub type Light<S> = <<S as Space>::Colour as Colour>::Light;

/// How many times brighter than at its reach a light gets: nearer than a 16th of it, it is as bright as there.
pub const BRIGHTEST: u32 = 256;

/// `radiance` times `factor / 2^32 * 2^exponent`, at most [`BRIGHTEST`] times. The factor is not 0, and is truncated to 16 bits.
#[inline]
pub(crate) fn faded(radiance: Radiance, factor_q32: u32, exponent: i32) -> Radiance {
    let zeros = u32::BITS - factor_q32.bit_length();
    let (factor_q16, exponent) = (((factor_q32 << zeros) >> 16) as u16, exponent - zeros as i32);
    // From 2^8 on, that is [1/2, 1) times 2^9.
    if exponent > 8 { radiance.times(1 << 15, 9) } else { radiance.times(factor_q16, exponent) }
}

/// By how much a point is raised before it is told in which cube it lies, in Q31 of a cube.
pub(crate) const fn raised_q31(is_across: bool) -> u32 {
    1 << if is_across { 25 } else { 21 }
}

/// Schlick's share in Q16 for a cosine in Q16; within 2^-13. The fifth power is that of 15 bits, so that products fit 32: at
/// most 2^30 + 2^14, and 2^31 + 2^14.
#[inline]
pub(crate) fn fresnel_q16(cosine_q16: u32, r0_q16: u32) -> u32 {
    let product = |a: u32, b: u32| (a * b + (1 << 14)) >> 15;
    let x_q15 = ((1 << 16) + 1 - cosine_q16.min(1 << 16)) >> 1;
    let square_q15 = product(x_q15, x_q15);
    let fifth_q15 = product(product(square_q15, square_q15), x_q15);
    let r0_q16 = r0_q16 + (r0_q16 >> 15);
    r0_q16 + product((1 << 16) - r0_q16, fifth_q15)
}

/// Formats and operations for shading. Implemented by zero-sized types.
pub trait Space: Copy + Debug + Default + Send + Sync + 'static {
    /// A point on a surface or a light, with a few bits below the grid.
    type Point: Copy + Debug + PartialEq;
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
    /// A point of a triangle of these corners, moved onto the planes through them across these normals: by each in its
    /// weight, unless it is above (Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021). It stays between
    /// the two ends of a range, in which the corners are.
    fn lift(
        point: Self::Point,
        corners: [Self::Point; 3],
        normals: [Self::Unit; 3],
        weights: [Self::Fraction; 2],
        range: [Self::Point; 2],
    ) -> Self::Point;
    /// Whether the cosine of the angle between two directions is above 1/4.
    fn near(a: Self::Unit, b: Self::Unit) -> bool;
    /// `(1 - u - v) a + u b + v c` of numbers from 0 to below 2^30, rounded to nearest.
    fn blend(corners: Triple<i32>, u: Self::Fraction, v: Self::Fraction) -> i32;
    /// The opposite direction.
    fn negate(unit: Self::Unit) -> Self::Unit;
    /// Whether the angle between two directions is at most a right one.
    fn aligned(a: Self::Unit, b: Self::Unit) -> bool;
    /// The cosine of the angle between two directions; `None` where it is not positive.
    fn cosine(a: Self::Unit, b: Self::Unit) -> Option<Scalar<Self>>;
    /// The direction of a ray that came `along` and is mirrored at a surface: d - 2 (d . n) n.
    fn reflect(along: Self::Unit, normal: Self::Unit) -> Self::Unit;
    /// The direction of a ray that came `along` and passes a surface whose normal is towards it (Snell's law). `eta_q28` is
    /// the index before the surface by that behind it; `None` where all is reflected.
    fn refract(along: Self::Unit, normal: Self::Unit, eta_q28: u32) -> Option<Self::Unit>;
    /// The direction of two random numbers: uniform on the sphere, since that is uniform along any axis (Archimedes; M.-Z. Shao
    /// & N. Badler, "Spherical Sampling by Archimedes' Theorem", 1996).
    fn anywhere(numbers: [u32; 2]) -> Self::Unit;
    /// A direction and another in its share, 65535 for 1, normalised; `None` where they cancel.
    fn strewn(unit: Self::Unit, by: Self::Unit, share: u16) -> Option<Self::Unit>;
    /// The direction half way between two; `None` where they are opposite.
    fn halfway(a: Self::Unit, b: Self::Unit) -> Option<Self::Unit>;
    /// The cosine between two directions to a power in Q2, by the chord between them; 0 from a right angle on.
    fn lobe(a: Self::Unit, b: Self::Unit, exponent_q2: u16) -> Scalar<Self>;
    /// The share of light that is reflected under a cosine (Schlick, "An Inexpensive BRDF Model for Physically-based
    /// Rendering", 1994): r0 + (1 - r0) (1 - cos)^5.
    fn fresnel(cosine: Scalar<Self>, r0: u16) -> Scalar<Self>;
    /// The light that arrives at one point from another, different one, by the square of the distance: at most
    /// [`BRIGHTEST`] times what it is at `reach`.
    fn faded(light: Light<Self>, from: Self::Point, to: Self::Point, reach: &Reach) -> Light<Self>;
    /// The shares of what is straight down and straight up, for a direction: (1 - y) / 2 and (1 + y) / 2.
    fn altitude(unit: Self::Unit) -> [Scalar<Self>; 2];
    /// The axis along which a direction is longest; of equal ones the first.
    fn longest(unit: Self::Unit) -> usize;
    /// Whether the cube of a point is odd. It is raised by 1/64 of a cube along an axis, by 1/1024 along the others.
    fn is_odd(point: Self::Point, across: usize, checker: &Checker) -> bool;
}

/// Whether a Q30 triple has length 1 within 2^-8, so that formats that hold less than 2 hold it.
#[must_use]
pub fn is_unit_q30(unit: Triple<i32>) -> bool {
    // Each square is at most 2^62, and 2^60 after the shift.
    let square_q58: u64 = unit.iter().map(|&c| i64::from(c)).map(|c| (c * c) as u64 >> 2).sum();
    square_q58.abs_diff(1 << 58) < 1 << 51
}
