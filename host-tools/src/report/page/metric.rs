//! The errors that a reader may choose between.

use crate::report::row::{Measured, Point};

use super::number::significant;

/// A measure of how far a picture is from the reference's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Metric {
    /// Pixels whose gray difference exceeds 64, per cent: the 2009 report's measure.
    Over64,
    /// Pixels whose gray difference exceeds 4, per cent.
    Over4,
    /// The root of the mean squared difference, steps of 255.
    Rmse,
    /// Peak signal to noise, decibels: more is better, and equal pictures have no number.
    Psnr,
    /// LDR-FLIP, 0 to 1.
    Flip,
    /// 1 less the structural similarity.
    Dissimilarity,
}

impl Metric {
    /// In the order of the choice.
    pub(super) const ALL: [Self; 6] =
        [Self::Over64, Self::Over4, Self::Rmse, Self::Psnr, Self::Flip, Self::Dissimilarity];

    /// What the choice calls it.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Over64 => "over 64",
            Self::Over4 => "over 4",
            Self::Rmse => "RMSE",
            Self::Psnr => "PSNR",
            Self::Flip => "FLIP",
            Self::Dissimilarity => "1 − SSIM",
        }
    }

    /// What stands along its axis.
    pub(super) fn axis(self) -> &'static str {
        match self {
            Self::Over64 => "pixels over 64, %",
            Self::Over4 => "pixels over 4, %",
            Self::Rmse => "RMSE, steps of 255",
            Self::Psnr => "PSNR, dB (better downwards)",
            Self::Flip => "FLIP, 0 to 1",
            Self::Dissimilarity => "1 − SSIM",
        }
    }

    /// What it is, for those who do not know it.
    pub(super) fn explanation(self) -> &'static str {
        match self {
            Self::Over64 => {
                "Pixels whose gray difference (the channels' absolute differences, summed) exceeds 64 of 255: the measure \
                 of the 2009 report. A different surface, a hole or a shadow does that; rounding of colours does not."
            }
            Self::Over4 => "Pixels whose gray difference (summed over the channels) exceeds 4 of 255.",
            Self::Rmse => "The root of the mean squared difference of a channel, in steps of the 8-bit output.",
            Self::Psnr => {
                "Peak signal to noise, 20 log10(255 / RMSE). More is better, so its axis runs downwards: \
                 better is below, as in the other plots."
            }
            Self::Flip => {
                "What a viewer would see who flips between the pictures: LDR-FLIP, the mean; 0 is no difference."
            }
            Self::Dissimilarity => "How far the mean structural similarity of the luma is from 1.",
        }
    }

    /// Whether more is better.
    pub(super) fn more_is_better(self) -> bool {
        self == Self::Psnr
    }

    /// Its value; infinite for the PSNR of equal pictures.
    pub(super) fn of(self, point: &Point, measured: &Measured) -> f64 {
        let error = &measured.error;
        match self {
            Self::Over64 => percent(error.over_64, point),
            Self::Over4 => percent(error.over_4, point),
            Self::Rmse => error.rmse,
            Self::Psnr => error.psnr.unwrap_or(f64::INFINITY),
            Self::Flip => error.flip,
            // Equal pictures are alike to the last bit or nearly so.
            Self::Dissimilarity => (1.0 - error.ssim).max(0.0),
        }
    }
}

/// How many pixels of a point's picture, per cent.
pub(super) fn percent(pixels: u64, point: &Point) -> f64 {
    100.0 * pixels as f64 / pixel_count(point) as f64
}

/// A count of pixels as text, per cent: exact zero is told from little.
pub(super) fn percent_text(pixels: u64, point: &Point) -> String {
    format!("{} %", significant(percent(pixels, point)))
}

/// Pixels of a point's picture, at least 1.
pub(super) fn pixel_count(point: &Point) -> u64 {
    (u64::from(point.size[0]) * u64::from(point.size[1])).max(1)
}
