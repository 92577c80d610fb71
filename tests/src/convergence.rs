//! How fast a mean of random samples comes nearer to the truth: by the square root of their number, where they are independent.

use std::ops::RangeInclusive;

use glam::DVec3;
use host_tools::report::page::fit;

/// The exponents of the error over the number of samples that count as -1/2.
pub const ALLOWED: RangeInclusive<f64> = -0.55..=-0.45;

/// Samples a pixel at which it is measured.
pub const COUNTS: [u32; 5] = [1, 4, 16, 64, 256];

/// The root of the mean square of the difference, over all channels: linear light, of which white is 1.
///
/// # Panics
/// If the pictures are not of one size, or empty.
#[must_use]
pub fn rmse(found: &[DVec3], truth: &[DVec3]) -> f64 {
    assert!(found.len() == truth.len() && !found.is_empty(), "pictures of different sizes");
    let sum: f64 = found.iter().zip(truth).map(|(a, b)| (*a - *b).length_squared()).sum();
    libm::sqrt(sum / (3 * found.len()) as f64)
}

/// The exponent of the power of the number of samples that is nearest to the error at [`COUNTS`].
///
/// # Panics
/// If there is no error at all.
#[must_use]
pub fn exponent(truth: &[DVec3], mut picture: impl FnMut(u32) -> Vec<DVec3>) -> f64 {
    let errors = COUNTS.map(|samples| (f64::from(samples), rmse(&picture(samples), truth)));
    fit::exponent(&errors).expect("an error that is not zero")
}
