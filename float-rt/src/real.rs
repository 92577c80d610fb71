//! The operations that a float tracer needs of its numbers, each with one result on every machine.

use core::cmp::Ordering;
use core::ops::{Add, Div, Mul, Neg, Sub};

use core_rt::record::Record;

/// A number of IEEE 754. What is not correctly rounded by the standard comes from [`libm`], never from the platform.
pub trait Real:
    Record
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// Beyond everything.
    const INFINITY: Self;
    /// The distance from 1 to the next number: twice the largest relative error of one rounding.
    const EPSILON: Self;
    /// The least positive number of full precision.
    const MIN_POSITIVE: Self;
    /// The nearest number.
    fn from_i32(value: i32) -> Self;
    /// The nearest number.
    fn from_i64(value: i64) -> Self;
    /// Towards zero; saturating, and 0 for what is not a number.
    fn to_i32(self) -> i32;
    /// Towards zero; saturating, and 0 for what is not a number.
    fn to_u8(self) -> u8;
    /// The square root, rounded to nearest.
    fn sqrt(self) -> Self;
    /// The greatest whole number that is not above.
    fn floor(self) -> Self;
    /// `self` to the power of `exponent`, within an ulp.
    fn pow(self, exponent: Self) -> Self;
    /// Cosine and sine of so many half turns, within an ulp and what pi is off.
    fn on_circle(self) -> [Self; 2];
    /// `self * 2^exponent`.
    fn ldexp(self, exponent: i32) -> Self;
    /// The total order of IEEE 754.
    fn order(self, other: Self) -> Ordering;
}

macro_rules! real {
    ($real:ident, $sqrt:ident, $floor:ident, $pow:ident, $sincos:ident, $ldexp:ident) => {
        impl Real for $real {
            const ZERO: Self = 0.0;
            const ONE: Self = 1.0;
            const INFINITY: Self = $real::INFINITY;
            const EPSILON: Self = $real::EPSILON;
            const MIN_POSITIVE: Self = $real::MIN_POSITIVE;
            #[inline(always)]
            fn from_i32(value: i32) -> Self {
                value as Self
            }
            #[inline(always)]
            fn from_i64(value: i64) -> Self {
                value as Self
            }
            #[inline(always)]
            fn to_i32(self) -> i32 {
                self as i32
            }
            #[inline(always)]
            fn to_u8(self) -> u8 {
                self as u8
            }
            #[inline]
            fn sqrt(self) -> Self {
                libm::$sqrt(self)
            }
            #[inline]
            fn floor(self) -> Self {
                libm::$floor(self)
            }
            #[inline]
            fn pow(self, exponent: Self) -> Self {
                libm::$pow(self, exponent)
            }
            fn on_circle(self) -> [Self; 2] {
                let (sine, cosine) = libm::$sincos(self * core::$real::consts::PI);
                [cosine, sine]
            }
            #[inline]
            fn ldexp(self, exponent: i32) -> Self {
                libm::$ldexp(self, exponent)
            }
            #[inline(always)]
            fn order(self, other: Self) -> Ordering {
                self.total_cmp(&other)
            }
        }
    };
}
real!(f32, sqrtf, floorf, powf, sincosf, ldexpf);
real!(f64, sqrt, floor, pow, sincos, ldexp);
