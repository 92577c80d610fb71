//! What a processor does with one ray and one sphere, without a branch.
//!
//! Of a ray o + t d and a sphere of centre c and radius r, with s = o - c, the nearer root of
//! |d|^2 t^2 + 2 (d . s) t + |s|^2 - r^2 = 0 is t = (-b - sqrt(b^2 - a c)) / a, where a = |d|^2, b = d . s and
//! c = |s|^2 - r^2. There is a hit where b is negative, the determinant is not, and t is not.
//!
//! b^2 - a c = |d|^2 r^2 - |d x s|^2: it is at most (|d| r)^2 however far the sphere is, so 36 bits hold the determinant of
//! every ray up to |d| r = 2^18. The two products are wider, and only their difference is kept. Where it saturates,
//! the root is too small and the hit too deep in the sphere.
//!
//! Words are at most as wide as [`Widths`] allows: components below 2^14, products below 2^30.

use core::array::from_fn;

use crate::widths::Widths;

/// `a . b` without saturation: 3 2^28 at most.
#[inline(always)]
fn dot(a: [i16; 3], b: [i16; 3]) -> i32 {
    let term = |axis: usize| i32::from(a[axis]) * i32::from(b[axis]);
    term(0) + term(1) + term(2)
}

/// `a . b` as a product.
#[inline(always)]
pub(crate) fn product(a: [i16; 3], b: [i16; 3], widths: Widths) -> i32 {
    widths.saturate_product(dot(a, b))
}

/// `a - b` as components; the difference of two is below 2^15.
#[inline(always)]
pub(crate) fn difference(a: [i16; 3], b: [i16; 3], widths: Widths) -> [i16; 3] {
    let most = widths.coordinate_max() as i16;
    from_fn(|axis| (a[axis] - b[axis]).max(-most).min(most))
}

/// b and c of a ray and a sphere, its radius squared.
#[inline(always)]
pub(crate) fn coefficients(
    origin: [i16; 3],
    direction: [i16; 3],
    centre: [i16; 3],
    radius_squared: i32,
    widths: Widths,
) -> (i32, i32) {
    let s = difference(origin, centre, widths);
    // Between -2^28 and 3 2^28.
    let c = dot(s, s) - radius_squared;
    (product(direction, s, widths), widths.saturate_product(c))
}

/// `b^2 - a c`: magnitudes below 2^61. Negative where the ray misses; else to be [held](held).
#[inline(always)]
pub(crate) fn determinant(a: i32, b: i32, c: i32) -> i64 {
    i64::from(b) * i64::from(b) - i64::from(a) * i64::from(c)
}

/// Whether the determinant may not be negative, in 32 bits: true wherever it is not, and for few others.
///
/// Products are cut to 15 bits and a sign, |b| upwards and a and c downwards: where a c exceeds b^2 then, it does so by all bits
/// too. The squares are at most 2^30.
#[inline(always)]
pub(crate) fn may_be_real(a: i32, b: i32, c: i32, widths: Widths) -> bool {
    let shift = widths.product().max(16) - 16;
    let upwards = (b.abs() >> shift) + 1;
    (a >> shift) * (c >> shift) <= upwards * upwards
}

/// A determinant as its word holds it.
#[inline(always)]
pub(crate) fn held(determinant: i64, widths: Widths) -> i64 {
    determinant.min(widths.determinant_max())
}

/// `-b - root`: negative where the nearer crossing is behind the origin. The root is below 2^29 and -b below 2^30.
#[inline(always)]
pub(crate) fn numerator(b: i32, root: i32) -> i32 {
    -b - root
}

/// t with its fractional bits, rounded down, for a numerator that is not negative: `numerator 2^f / a`, the dividend below
/// 2^41. The t of a ray without a direction is not used.
#[inline(always)]
pub(crate) fn parameter(numerator: i32, a: i32, widths: Widths) -> i32 {
    let dividend = u64::from(numerator.unsigned_abs()) << widths.t_fraction();
    let quotient = dividend / u64::from(a.max(1).unsigned_abs());
    quotient.min(widths.product_max().unsigned_abs().into()) as i32
}

/// o + t d, rounded to nearest.
///
/// `t |d_i|` fits 32 bits: t is at most |b| 2^f / a. Where a was saturated, both are at most the same word, so t is at most
/// 2^f and the product 2^24. Else a = |d|^2 and |b| <= |s| |d|, so that t |d_i| <= 2^f |s| <= 2^10 sqrt(3) 2^14 < 2^25.
#[inline(always)]
pub(crate) fn point(origin: [i16; 3], direction: [i16; 3], t: i32, widths: Widths) -> [i16; 3] {
    let bits = widths.t_fraction();
    let half = (1 << bits) >> 1;
    from_fn(|axis| {
        let along = (t * i32::from(direction[axis]) + half) >> bits;
        widths.saturate_coordinate(i32::from(origin[axis]) + along)
    })
}

/// d - 2 (d . n) n / |n|^2, rounded to nearest, for a normal of any length.
///
/// The quotient has as many fractional bits as n has bits, so that its own rounding costs half a unit. Its dividend is below
/// 2^46; its product with n_i is at most 2 |d| 2^14 in these bits, below 2^30, by Cauchy and Schwarz, where nothing was
/// saturated. Where |n|^2 was, the quotient is at most 2^15 and the product 2^29; where d . n was, the quotient is less than
/// it would be.
#[inline(always)]
pub(crate) fn reflection(direction: [i16; 3], normal: [i16; 3], widths: Widths) -> [i16; 3] {
    let bits = widths.coordinate() - 1;
    let along = product(direction, normal, widths);
    // Without signs: most processors divide small numbers quicker.
    let dividend = u64::from(along.unsigned_abs()) << (1 + bits);
    let quotient = (dividend / u64::from(product(normal, normal, widths).max(1).unsigned_abs())) as i32;
    let quotient = if along < 0 { -quotient } else { quotient };
    let half = (1 << bits) >> 1;
    from_fn(|axis| {
        let turn = (quotient * i32::from(normal[axis]) + half) >> bits;
        widths.saturate_coordinate(i32::from(direction[axis]) - turn)
    })
}

#[cfg(test)]
mod tests;
