//! Upper halves of products, in lanes of 32 bits.
//!
//! AVX2 multiplies four pairs of words of 32 bits at a time. What lanes keep of a product is its upper half, rounded down: two
//! multiplications and a shuffle give eight. That brings the lanes of each half of a register into the order 0, 2, 1, 3
//! ([`SHUFFLED`]), so one side is stored in that order beforehand; twice shuffled, lanes are back.

use core::arch::x86_64::*;

use super::collapse::WIDTH;
use super::tree::Row;

/// From which lane an upper half comes.
pub(super) const SHUFFLED: [usize; WIDTH] = [0, 2, 1, 3, 4, 6, 5, 7];

/// A vector in lanes.
pub(super) type Triple = [__m256i; 3];

/// The numbers of a row.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn load(row: &Row<i32>) -> __m256i {
    zerocopy::transmute!(row.0)
}

/// A vector in every lane. Coordinates, components and factors fit.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn splat([x, y, z]: [i64; 3]) -> Triple {
    [_mm256_set1_epi32(x as i32), _mm256_set1_epi32(y as i32), _mm256_set1_epi32(z as i32)]
}

/// A bit for each lane that is set.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn bits(mask: __m256i) -> u32 {
    _mm256_movemask_ps(_mm256_castsi256_ps(mask)).cast_unsigned()
}

/// The odd lanes, where the even ones were: these are multiplied.
#[target_feature(enable = "avx2")]
#[inline]
fn odd(a: __m256i) -> __m256i {
    _mm256_srli_epi64::<32>(a)
}

/// The upper halves of numbers of 64 bits, of even lanes and of odd ones; shuffled.
#[target_feature(enable = "avx2")]
#[inline]
fn upper(even: __m256i, odd: __m256i) -> __m256i {
    _mm256_castps_si256(_mm256_shuffle_ps::<0b11_01_11_01>(_mm256_castsi256_ps(even), _mm256_castsi256_ps(odd)))
}

/// Shuffles, and so brings back what is shuffled.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn shuffle(a: __m256i) -> __m256i {
    _mm256_shuffle_epi32::<0b11_01_10_00>(a)
}

/// The upper halves of products, shuffled; `b` has one number in all lanes.
#[target_feature(enable = "avx2")]
#[inline]
pub(super) fn product(a: __m256i, b: __m256i) -> __m256i {
    upper(_mm256_mul_epi32(a, b), _mm256_mul_epi32(odd(a), b))
}

/// A vector in lanes, and its odd lanes.
#[derive(Clone, Copy)]
pub(super) struct Both {
    pub(super) even: Triple,
    pub(super) odd: Triple,
}

impl Both {
    #[target_feature(enable = "avx2")]
    #[inline]
    pub(super) fn new(even: Triple) -> Self {
        Self { even, odd: [odd(even[0]), odd(even[1]), odd(even[2])] }
    }

    /// The upper halves of dot products, shuffled.
    #[target_feature(enable = "avx2")]
    #[inline]
    pub(super) fn dot(&self, other: &Self) -> __m256i {
        let sum = |a: &Triple, b: &Triple| {
            let two = _mm256_add_epi64(_mm256_mul_epi32(a[0], b[0]), _mm256_mul_epi32(a[1], b[1]));
            _mm256_add_epi64(two, _mm256_mul_epi32(a[2], b[2]))
        };
        upper(sum(&self.even, &other.even), sum(&self.odd, &other.odd))
    }

    /// The upper halves of cross products, shuffled.
    #[target_feature(enable = "avx2")]
    #[inline]
    pub(super) fn cross(&self, other: &Self) -> Triple {
        let one = |a: &Triple, b: &Triple, i: usize, j: usize| {
            _mm256_sub_epi64(_mm256_mul_epi32(a[i], b[j]), _mm256_mul_epi32(a[j], b[i]))
        };
        let part = |i, j| upper(one(&self.even, &other.even, i, j), one(&self.odd, &other.odd, i, j));
        [part(1, 2), part(2, 0), part(0, 1)]
    }
}
