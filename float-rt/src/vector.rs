//! Vectors of three numbers. Sums go from left to right: their order is part of the result.

use core_rt::num::Triple;

use crate::real::Real;

/// `a + b`.
#[inline(always)]
pub(crate) fn add<F: Real>(a: Triple<F>, b: Triple<F>) -> Triple<F> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// `a - b`.
#[inline(always)]
pub(crate) fn sub<F: Real>(a: Triple<F>, b: Triple<F>) -> Triple<F> {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a * factor`.
#[inline(always)]
pub(crate) fn scale<F: Real>(a: Triple<F>, factor: F) -> Triple<F> {
    a.map(|c| c * factor)
}

/// `a . b`.
#[inline(always)]
pub(crate) fn dot<F: Real>(a: Triple<F>, b: Triple<F>) -> F {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// `a x b`.
#[inline(always)]
pub(crate) fn cross<F: Real>(a: Triple<F>, b: Triple<F>) -> Triple<F> {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// `a` with length 1; `None` for zero, and for what is so short that its square is not a number of full precision. The
/// longest that is asked for, the cross product of two edges in `f32`, is below 2^50, and its square below 2^100.
#[inline]
pub(crate) fn normalise<F: Real>(a: Triple<F>) -> Option<Triple<F>> {
    let square = dot(a, a);
    if square < F::MIN_POSITIVE {
        return None;
    }
    let length = square.sqrt();
    Some(a.map(|c| c / length))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unit_vectors_at_both_ends_of_the_range() {
        for length in [1e-18f32, 1.0, 1e15] {
            let [x, y, z] = normalise([3.0 * length, 0.0, -4.0 * length]).unwrap();
            assert!((x - 0.6).abs() < 1e-7 && y == 0.0 && (z + 0.8).abs() < 1e-7, "{length}: {x} {z}");
        }
        assert_eq!(normalise([0.0f32; 3]), None);
        assert_eq!(normalise([1e-25f32; 3]), None, "its square is 0");
    }

    #[test]
    fn the_cross_product_is_right_handed() {
        assert_eq!(cross([1.0f64, 0.0, 0.0], [0.0, 1.0, 0.0]), [0.0, 0.0, 1.0]);
        assert_eq!(cross([0.0f64, 2.0, 0.0], [0.0, 0.0, 3.0]), [6.0, 0.0, 0.0]);
    }
}
