//! How far two pictures are from each other.
//!
//! Three families: errors of the encoded bytes (`max_abs` to `psnr`), perception (`ssim` and `flip`), and
//! the count that the 2009 report on integer ray tracing used, `over_64`, with two finer thresholds.

mod flip;
mod plane;
mod ssim;

use crate::picture::Picture;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;

/// The distance between two pictures. Byte errors are in units of the encoded 8-bit values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Comparison {
    /// The largest difference of a channel, 0 to 255.
    pub max_abs: u8,
    /// The mean absolute difference over all channels of all pixels.
    pub mean_abs: f64,
    /// The root of the mean squared difference over all channels of all pixels.
    pub rmse: f64,
    /// 20 log10(255 / rmse), decibels. Infinite for equal pictures, which JSON cannot say: `None`, or `null`.
    pub psnr: Option<f64>,
    /// Mean structural similarity of the luma, at most 1; 1 for equal pictures.
    ///
    /// Wang et al. 2004 at full size: 11 x 11 Gaussian window of sigma 1.5, K1 = 0.01, K2 = 0.03, L = 255, on
    /// luma 0.299 R + 0.587 G + 0.114 B, the mean over every pixel; beyond the border, the edge is repeated.
    pub ssim: f64,
    /// Mean LDR-FLIP error at 67 pixels a degree, 0 to 1; 0 for equal pictures.
    pub flip: f64,
    /// Pixels whose [`difference`] exceeds 1.
    pub over_1: u64,
    /// Pixels whose [`difference`] exceeds 4.
    pub over_4: u64,
    /// Pixels whose [`difference`] exceeds 64: the 2009 report's count.
    pub over_64: u64,
}

/// Two pictures that cannot be compared: (width, height) of each, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "the pictures differ in size: {} x {} and {} x {} pixels; only equal sizes can be compared",
    .0.0, .0.1, .1.0, .1.1
)]
pub struct SizeMismatch(pub (u32, u32), pub (u32, u32));

/// Compares two pictures of one size. It is symmetric, and the same for any number of threads.
///
/// # Errors
/// [`SizeMismatch`] where the sizes differ.
pub fn compare(a: &Picture, b: &Picture) -> Result<Comparison, SizeMismatch> {
    let gray = difference(a, b)?;
    let over = |threshold| gray.pixels().iter().filter(|pixel| pixel[0] > threshold).count() as u64;

    // Exact: 2^26 pixels of three channels stay below 2^44.
    let (mut max_abs, mut sum, mut squares) = (0, 0u64, 0u64);
    for (&a, &b) in a.pixels().as_flattened().iter().zip(b.pixels().as_flattened()) {
        let error = a.abs_diff(b);
        max_abs = max_abs.max(error);
        sum += u64::from(error);
        squares += u64::from(error) * u64::from(error);
    }
    let channels = a.pixels().as_flattened().len().max(1) as f64;
    let rmse = (squares as f64 / channels).sqrt();
    Ok(Comparison {
        max_abs,
        mean_abs: sum as f64 / channels,
        rmse,
        psnr: (squares > 0).then(|| 20.0 * libm::log10(255.0 / rmse)),
        ssim: ssim::mean(a, b),
        flip: flip::mean(a, b),
        over_1: over(1),
        over_4: over(4),
        over_64: over(64),
    })
}

/// The gray picture of the 2009 report: each channel's absolute difference, summed, clipped to 255.
///
/// Equal to ImageMagick's `convert A B -compose difference -composite -separate -background black -compose
/// plus -flatten DIFF`, given 8-bit pictures.
///
/// # Errors
/// [`SizeMismatch`] where the sizes differ.
pub fn difference(a: &Picture, b: &Picture) -> Result<Picture, SizeMismatch> {
    let size = |picture: &Picture| (picture.width(), picture.height());
    if size(a) != size(b) {
        return Err(SizeMismatch(size(a), size(b)));
    }
    let mut gray = Picture::new(a.width(), a.height());
    for (gray, (a, b)) in gray.pixels_mut().iter_mut().zip(a.pixels().iter().zip(b.pixels())) {
        let sum = (0..3).fold(0u8, |sum, channel| sum.saturating_add(a[channel].abs_diff(b[channel])));
        *gray = [sum; 3];
    }
    Ok(gray)
}

/// The mean over all pixels (0 where there are none) of a measure that `sum(first_row, rows)` sums over a band of rows.
///
/// Bands bound the memory and share the work; they and the order of the sum do not depend on the machine.
fn mean_by_bands(picture: &Picture, sum: impl Fn(u32, u32) -> f64 + Sync) -> f64 {
    const ROWS: u32 = 64;
    if picture.pixels().is_empty() {
        return 0.0;
    }
    let height = picture.height();
    let bands: Vec<f64> = (0..height.div_ceil(ROWS))
        .into_par_iter()
        .map(|band| sum(band * ROWS, ROWS.min(height - band * ROWS)))
        .collect();
    bands.iter().sum::<f64>() / picture.pixels().len() as f64
}

/// An aligned table of names and figures, a line each, with no line end after the last.
impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "max_abs   {:>10}", self.max_abs)?;
        writeln!(f, "mean_abs  {:>15.4}", self.mean_abs)?;
        writeln!(f, "rmse      {:>15.4}", self.rmse)?;
        match self.psnr {
            Some(psnr) => writeln!(f, "psnr      {psnr:>13.2} dB")?,
            None => writeln!(f, "psnr      {:>10}    dB", "inf")?,
        }
        writeln!(f, "ssim      {:>17.6}", self.ssim)?;
        writeln!(f, "flip      {:>17.6}", self.flip)?;
        writeln!(f, "over_1    {:>10} pixels", self.over_1)?;
        writeln!(f, "over_4    {:>10} pixels", self.over_4)?;
        write!(f, "over_64   {:>10} pixels", self.over_64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noise(seed: u32, width: u32, height: u32) -> Picture {
        let mut state = seed;
        let mut byte = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 24) as u8
        };
        Picture::from_fn(width, height, |_, _| [byte(), byte(), byte()])
    }

    #[test]
    fn equal_pictures_are_at_no_distance() {
        let picture = noise(1, 70, 67);
        let same = compare(&picture, &picture.clone()).unwrap();
        assert_eq!((same.max_abs, same.mean_abs, same.rmse, same.psnr), (0, 0.0, 0.0, None));
        assert_eq!((same.ssim, same.flip), (1.0, 0.0));
        assert_eq!((same.over_1, same.over_4, same.over_64), (0, 0, 0));
    }

    #[test]
    fn byte_errors_are_those_of_a_small_case_by_hand() {
        let black = Picture::new(2, 1);
        let mut other = black.clone();
        other.pixels_mut()[1] = [3, 0, 4];
        let c = compare(&black, &other).unwrap();
        assert_eq!((c.max_abs, c.mean_abs, c.rmse), (4, 7.0 / 6.0, (25.0f64 / 6.0).sqrt()));
        assert!((c.psnr.unwrap() - 41.9329).abs() < 1e-4, "{:?}", c.psnr);
        assert_eq!((c.over_1, c.over_4, c.over_64), (1, 1, 0));
    }

    #[test]
    fn thresholds_are_strict_and_on_the_clipped_sum() {
        let black = Picture::new(6, 1);
        let mut other = black.clone();
        other.pixels_mut().copy_from_slice(&[[1, 0, 0], [1, 0, 1], [4, 0, 0], [3, 2, 0], [32; 3], [255; 3]]);
        let gray = difference(&other, &black).unwrap();
        assert_eq!(gray.pixels(), [[1; 3], [2; 3], [4; 3], [5; 3], [96; 3], [255; 3]]);
        let c = compare(&black, &other).unwrap();
        assert_eq!((c.over_1, c.over_4, c.over_64), (5, 3, 2));
        other.pixels_mut()[4] = [22, 21, 21];
        assert_eq!(compare(&black, &other).unwrap().over_64, 1, "64 is not over 64");
    }

    #[test]
    fn comparison_is_symmetric_and_independent_of_threads() {
        let (a, b) = (noise(1, 70, 150), noise(2, 70, 150));
        let c = compare(&a, &b).unwrap();
        assert_eq!(compare(&b, &a).unwrap(), c);
        for threads in [1, 3] {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            assert_eq!(pool.install(|| compare(&a, &b)).unwrap(), c);
        }
    }

    #[test]
    fn sizes_must_agree() {
        let mismatch = compare(&Picture::new(4, 2), &Picture::new(2, 4)).unwrap_err();
        assert!(mismatch.to_string().contains("4 x 2 and 2 x 4"));
        assert!(difference(&Picture::new(1, 1), &Picture::new(1, 2)).is_err());
        let empty = Picture::new(0, 3);
        assert_eq!(compare(&empty, &empty).unwrap().max_abs, 0);
    }

    #[test]
    fn json_and_table_bear_every_name() {
        let names = ["max_abs", "mean_abs", "rmse", "psnr", "ssim", "flip", "over_1", "over_4", "over_64"];
        let equal = compare(&Picture::new(3, 3), &Picture::new(3, 3)).unwrap();
        let json = serde_json::to_value(equal).unwrap();
        assert!(json["psnr"].is_null());
        assert_eq!(json.as_object().unwrap().len(), names.len());
        let table = equal.to_string();
        assert_eq!(table.lines().count(), names.len());
        for (name, line) in names.iter().zip(table.lines()) {
            assert!(json.get(name).is_some(), "{name}");
            assert_eq!(line.split_whitespace().next(), Some(*name));
        }
    }
}
