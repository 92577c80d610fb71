//! Integers and the few operations on them that the tracer is built from.
//!
//! Formats are named: `_q13` is a value with 13 fractional bits. Ranges stand where they are relied on,
//! and every plain operator is expected not to overflow: builds with overflow checks trap where an
//! argument is wrong. Where wrapping is meant, the operation says so.

mod circle;
mod length;
mod power;
mod recip;
mod rsqrt;

pub use circle::{on_circle_q15, on_circle_q30};
pub use length::{BitLength, byte_length};
pub use power::power;
pub use recip::{RECIPROCAL_ERROR_BITS, Reciprocal16, mantissa, reciprocal};
pub use rsqrt::{inverse_sqrt_u32, inverse_sqrt_u64, isqrt_u64, sqrt_u32, sqrt_u64};

use core::fmt::Debug;
use core::ops::{Add, BitOr, Mul, Neg, Shl, Shr, Sub};

/// A machine word that holds a product of two coordinates: `i32` for 14-bit grids, `i64` for 29-bit ones.
pub trait Word:
    Copy
    + Ord
    + Debug
    + Default
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + Shl<u32, Output = Self>
    + Shr<u32, Output = Self>
    + BitOr<Output = Self>
    + 'static
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// A grid coordinate or a direction as it stands in a header; both fit every word.
    fn from_i32(value: i32) -> Self;
    /// A coefficient, or `None` where it does not fit.
    fn from_i64(value: i64) -> Option<Self>;
    /// The value, which the caller knows to fit 32 bits.
    fn low_i32(self) -> i32;
    /// `self * other`, for factors that fit 32 bits: on a machine of 32 bits a wide product of two words, and not of four.
    fn product(self, other: Self) -> Self;
    /// `self - other` modulo the word, for a difference that is known to fit although its parts do not.
    fn wrapping_sub(self, other: Self) -> Self;
    /// The number of bits that `|self|` takes: 0 for 0, n for 2^(n-1) <= |self| < 2^n.
    fn magnitude_bits(self) -> u32;
    /// The least n for which all values are at least -2^n and below 2^n.
    fn common_bits(values: impl IntoIterator<Item = Self>) -> u32;
    /// `|self|`; never called on the most negative word.
    fn magnitude(self) -> Self {
        if self < Self::ZERO { -self } else { self }
    }
}

macro_rules! word {
    ($word:ty) => {
        impl Word for $word {
            const ZERO: Self = 0;
            const ONE: Self = 1;
            #[inline(always)]
            fn from_i32(value: i32) -> Self {
                value.into()
            }
            #[inline(always)]
            fn from_i64(value: i64) -> Option<Self> {
                value.try_into().ok()
            }
            #[inline(always)]
            fn low_i32(self) -> i32 {
                self as i32
            }
            #[inline(always)]
            fn product(self, other: Self) -> Self {
                debug_assert!([self, other].map(|c| Self::from(c as i32)) == [self, other]);
                if cfg!(target_pointer_width = "32") {
                    Self::from(self as i32) * Self::from(other as i32)
                } else {
                    self * other
                }
            }
            #[inline(always)]
            fn wrapping_sub(self, other: Self) -> Self {
                self.wrapping_sub(other)
            }
            #[inline(always)]
            fn magnitude_bits(self) -> u32 {
                self.unsigned_abs().bit_length()
            }
            #[inline(always)]
            fn common_bits(values: impl IntoIterator<Item = Self>) -> u32 {
                // One length for all: the highest bit that differs from its value's sign.
                let differing = values.into_iter().fold(0, |all, value| all | (value ^ (value >> (Self::BITS - 1))));
                differing.cast_unsigned().bit_length()
            }
        }
    };
}
word!(i32);
word!(i64);

/// A triple of one type: a point, a direction, a row of a record.
pub type Triple<T> = [T; 3];

/// `a - b`.
#[inline(always)]
pub fn sub<T: Word>(a: Triple<T>, b: Triple<T>) -> Triple<T> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a x b`, for components that fit 32 bits. Each component is at most twice the product of the largest ones.
#[cfg_attr(not(prefer_size), inline(always))]
#[cfg_attr(prefer_size, inline(never))]
pub fn cross<T: Word>(a: Triple<T>, b: Triple<T>) -> Triple<T> {
    let term = |i: usize, j: usize| a[i].product(b[j]) - a[j].product(b[i]);
    [term(1, 2), term(2, 0), term(0, 1)]
}

/// `a . b` for components that fit 32 bits, in the word itself, so at most three times the product of the largest ones.
#[inline(always)]
pub fn narrow_dot<T: Word>(a: Triple<T>, b: Triple<T>) -> T {
    a[0].product(b[0]) + a[1].product(b[1]) + a[2].product(b[2])
}

/// `a . b` in the word itself, so at most three times the product of the largest components.
#[inline(always)]
pub fn dot<T: Word>(a: Triple<T>, b: Triple<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The largest number of bits that a component's magnitude takes.
#[inline(always)]
pub fn bits<T: Word>(a: Triple<T>) -> u32 {
    // One count over the three magnitudes: the highest set bit is what matters.
    let [x, y, z] = a.map(Word::magnitude);
    x.max(y).max(z).magnitude_bits()
}

/// `value / 2^shift` rounded to nearest, halves up. `shift` is below the width of `T`, and the sum fits.
#[inline(always)]
pub fn round_shift<T: Word>(value: T, shift: u32) -> T {
    match shift {
        0 => value,
        _ => (value + (T::ONE << (shift - 1))) >> shift,
    }
}
