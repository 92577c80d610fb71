//! Mean structural similarity.
//!
//! Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli: Image Quality Assessment: From Error Visibility to
//! Structural Similarity, IEEE Transactions on Image Processing 13(4), 2004, equation 13 and section III.C.

use super::mean_by_bands;
use super::plane::{Plane, gaussian};
use crate::picture::Picture;

const RADIUS: u32 = 5;
const SIGMA: f64 = 1.5;
/// (K1 L)^2 and (K2 L)^2, which steady the two ratios where their denominators are small.
const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);

/// Mean SSIM of the luma of two pictures of one size.
pub(super) fn mean(a: &Picture, b: &Picture) -> f64 {
    let window = gaussian(RADIUS, SIGMA);
    mean_by_bands(a, |first_row, rows| {
        let [a, b] = [a, b].map(|picture| Plane::of_band(picture, first_row, rows, RADIUS, luma));
        let [mean_a, mean_b] = [&a, &b].map(|plane| plane.filtered(&window));
        let squares_a = a.times(&a).filtered(&window);
        let squares_b = b.times(&b).filtered(&window);
        let products = a.times(&b).filtered(&window);
        (0..mean_a.values().len())
            .map(|i| {
                let (mean_a, mean_b) = (mean_a.values()[i], mean_b.values()[i]);
                let variance_a = squares_a.values()[i] - mean_a * mean_a;
                let variance_b = squares_b.values()[i] - mean_b * mean_b;
                let covariance = products.values()[i] - mean_a * mean_b;
                (2.0 * mean_a * mean_b + C1) * (2.0 * covariance + C2)
                    / ((mean_a * mean_a + mean_b * mean_b + C1) * (variance_a + variance_b + C2))
            })
            .sum()
    })
}

/// Luma of Rec. 601, 0 to 255, from encoded RGB.
fn luma([r, g, b]: [u8; 3]) -> f64 {
    0.299 * f64::from(r) + 0.587 * f64::from(g) + 0.114 * f64::from(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_pictures_differ_in_luminance_alone() {
        // With no variance only the first ratio is left.
        let [a, b] = [100u8, 140].map(|level| Picture::from_fn(13, 9, |_, _| [level; 3]));
        let expected = (2.0 * 100.0 * 140.0 + C1) / (100.0 * 100.0 + 140.0 * 140.0 + C1);
        assert!((mean(&a, &b) - expected).abs() < 1e-9);
    }

    #[test]
    fn a_negative_is_anticorrelated() {
        let checks =
            |flip: bool| Picture::from_fn(40, 40, |x, y| if ((x + y) % 2 == 0) ^ flip { [160; 3] } else { [96; 3] });
        assert_eq!(mean(&checks(false), &checks(false)), 1.0);
        assert!(mean(&checks(false), &checks(true)) < -0.8);
    }

    /// The definition, window by window, without separation or bands.
    #[test]
    fn it_is_its_definition() {
        let [a, b] = [(3, 5), (7, 2)].map(|(p, q)| {
            Picture::from_fn(9, 70, |x, y| [(x * x * p + y * q) as u8, (x * 20 + y) as u8, (y * p) as u8])
        });
        let at =
            |picture: &Picture, x: i32, y: i32| luma(picture.pixels()[(y.clamp(0, 69) * 9 + x.clamp(0, 8)) as usize]);
        let offsets = || (-5..=5).flat_map(|dy| (-5..=5).map(move |dx| (dx, dy)));
        let weight = |(dx, dy): (i32, i32)| (-f64::from(dx * dx + dy * dy) / 4.5).exp();
        let total: f64 = offsets().map(weight).sum();
        let mut expected = 0.0;
        for (x, y) in (0..70).flat_map(|y| (0..9).map(move |x| (x, y))) {
            let expectation = |f: &dyn Fn(f64, f64) -> f64| -> f64 {
                let term = |d: (i32, i32)| weight(d) * f(at(&a, x + d.0, y + d.1), at(&b, x + d.0, y + d.1));
                offsets().map(term).sum::<f64>() / total
            };
            let (ma, mb) = (expectation(&|a, _| a), expectation(&|_, b| b));
            let va = expectation(&|a, _| (a - ma) * (a - ma));
            let vb = expectation(&|_, b| (b - mb) * (b - mb));
            let cov = expectation(&|a, b| (a - ma) * (b - mb));
            expected += (2.0 * ma * mb + C1) * (2.0 * cov + C2) / ((ma * ma + mb * mb + C1) * (va + vb + C2));
        }
        assert!((mean(&a, &b) - expected / 630.0).abs() < 1e-9);
    }
}
