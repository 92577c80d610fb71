//! LDR-FLIP: the error seen when flipping between two pictures.
//!
//! P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild: FLIP: A Difference
//! Evaluator for Alternating Images, Proc. ACM Comput. Graph. Interact. Tech. 3(2), 2020. The colour
//! pipeline (contrast sensitivity, CIELAB with Hunt's adjustment, HyAB) gives an error that the feature
//! pipeline (edges and points) raises where structure appears or goes.

use super::mean_by_bands;
use super::plane::{Kernel, Plane, gaussian, kernel};
use crate::picture::Picture;
use core::f64::consts::PI;
use glam::{DMat3, DVec3};

/// The paper's viewer: 0.7 m from a display of 3840 pixels in 0.7 m.
const PIXELS_PER_DEGREE: f64 = 67.0;

/// The exponent of the colour difference, and the knee of its map to [0, 1].
const COLOUR_EXPONENT: f64 = 0.7;
const KNEE_AT: f64 = 0.4;
const KNEE_TO: f64 = 0.95;

/// Peak to trough of the eye's edge detector, degrees.
const FEATURE_WIDTH: f64 = 0.082;

/// The b of the paper's table 1: spreads of the contrast sensitivity, degrees squared over 2 pi^2.
const ACHROMATIC: f64 = 0.0047;
const RED_GREEN: f64 = 0.0053;
/// Two Gaussians, with their weights a.
const BLUE_YELLOW: [(f64, f64); 2] = [(34.1, 0.04), (13.5, 0.025)];

/// Mean FLIP error of two pictures of one size, in [0, 1].
pub(super) fn mean(a: &Picture, b: &Picture) -> f64 {
    let observer = Observer::new();
    mean_by_bands(a, |first_row, rows| {
        let [a, b] = [a, b].map(|picture| observer.perceive(picture, first_row, rows));
        a.iter().zip(&b).map(|(a, b)| observer.error(a, b)).sum()
    })
}

/// What is seen at a pixel.
struct Percept {
    /// Hunt-adjusted CIELAB after the contrast sensitivity filter.
    colour: DVec3,
    /// Response of the edge detector, 0 to 1.
    edge: f64,
    /// Response of the point detector, 0 to 1.
    point: f64,
}

/// The filters and tables of the viewer.
struct Observer {
    /// Linear light of an encoded byte.
    linear: [f64; 256],
    /// Linear sRGB to XYZ relative to the white point, so that white is (1, 1, 1); and back.
    to_xyz: DMat3,
    to_rgb: DMat3,
    /// Margin of rows that the filters use up.
    margin: u32,
    achromatic: Kernel,
    red_green: Kernel,
    /// With weights that sum to 1.
    blue_yellow: [(f64, Kernel); 2],
    feature_radius: u32,
    blur: Kernel,
    edge: Kernel,
    point: Kernel,
    /// The largest colour difference, between Hunt-adjusted green and blue, to the exponent.
    most: f64,
}

impl Observer {
    fn new() -> Self {
        // The primaries of sRGB and D65 at (0.3127, 0.3290), exact up to a scale for each row, which the
        // division by the white point takes away.
        let rows = DMat3::from_cols(
            DVec3::new(10_135_552.0, 8_788_810.0, 4_435_075.0),
            DVec3::new(2_613_072.0, 8_788_810.0, 887_015.0),
            DVec3::new(1_425_312.0, 8_788_810.0, 70_074_185.0),
        )
        .transpose();
        let to_xyz = DMat3::from_diagonal((rows * DVec3::ONE).recip()) * rows;

        // exp(-pi^2 x^2 / b) is a Gaussian; all three have the radius of the widest.
        let sigma = |b: f64| PIXELS_PER_DEGREE * (b / (2.0 * PI * PI)).sqrt();
        let margin = (3.0 * sigma(BLUE_YELLOW[0].1)).ceil() as u32;
        let sensitivity = |b: f64| gaussian(margin, sigma(b));
        let volume = |(a, b): (f64, f64)| {
            let side: f64 = kernel(margin, |x| libm::exp(-x * x / (2.0 * sigma(b) * sigma(b)))).iter().sum();
            a * (PI / b).sqrt() * side * side
        };
        let both: f64 = BLUE_YELLOW.map(volume).iter().sum();

        let sd = 0.5 * FEATURE_WIDTH * PIXELS_PER_DEGREE;
        let feature_radius = (3.0 * sd).ceil() as u32;
        let bell = |x: f64| libm::exp(-x * x / (2.0 * sd * sd));

        let colour = |rgb| hunt_adjusted_lab(to_xyz * rgb);
        Self {
            linear: core::array::from_fn(|byte| match byte as f64 / 255.0 {
                dark if dark <= 0.04045 => dark / 12.92,
                encoded => libm::pow((encoded + 0.055) / 1.055, 2.4),
            }),
            to_xyz,
            to_rgb: to_xyz.inverse(),
            margin,
            achromatic: sensitivity(ACHROMATIC),
            red_green: sensitivity(RED_GREEN),
            blue_yellow: BLUE_YELLOW.map(|(a, b)| (volume((a, b)) / both, sensitivity(b))),
            feature_radius,
            blur: gaussian(feature_radius, sd),
            edge: balanced(&kernel(feature_radius, |x| -x * bell(x))),
            point: balanced(&kernel(feature_radius, |x| (x * x / (sd * sd) - 1.0) * bell(x))),
            most: libm::pow(hyab(colour(DVec3::Y), colour(DVec3::Z)), COLOUR_EXPONENT),
        }
    }

    /// What is seen of a band of rows.
    fn perceive(&self, picture: &Picture, first_row: u32, rows: u32) -> Vec<Percept> {
        // The opponent space YCxCz but for its scales and offset: the filters sum to 1, so those cancel.
        let plane = |value: fn(DVec3) -> f64| {
            Plane::of_band(picture, first_row, rows, self.margin, |pixel| {
                value(self.to_xyz * DVec3::from_array(pixel.map(|byte| self.linear[usize::from(byte)])))
            })
        };
        let luminance = plane(|xyz| xyz.y);
        let y = luminance.filtered(&self.achromatic);
        let x_y = plane(|xyz| xyz.x - xyz.y).filtered(&self.red_green);
        let opponent = plane(|xyz| xyz.y - xyz.z);
        let y_z = self.blue_yellow.each_ref().map(|(weight, kernel)| (weight, opponent.filtered(kernel)));

        let luminance = luminance.without_margin(self.margin - self.feature_radius);
        let blurred = luminance.along_rows(&self.blur);
        let responses =
            |kernel: &Kernel| (luminance.along_rows(kernel).along_columns(&self.blur), blurred.along_columns(kernel));
        let (edges, points) = (responses(&self.edge), responses(&self.point));
        let norm = |(x, y): &(Plane, Plane), i: usize| {
            let (x, y) = (x.values()[i], y.values()[i]);
            (x * x + y * y).sqrt()
        };

        (0..y.values().len())
            .map(|i| {
                let y = y.values()[i];
                let y_z: f64 = y_z.iter().map(|(weight, plane)| *weight * plane.values()[i]).sum();
                let rgb = self.to_rgb * DVec3::new(y + x_y.values()[i], y, y - y_z);
                Percept {
                    colour: hunt_adjusted_lab(self.to_xyz * rgb.clamp(DVec3::ZERO, DVec3::ONE)),
                    edge: norm(&edges, i),
                    point: norm(&points, i),
                }
            })
            .collect()
    }

    /// The error between what is seen at a pixel of one picture and of the other.
    fn error(&self, a: &Percept, b: &Percept) -> f64 {
        let difference = libm::pow(hyab(a.colour, b.colour), COLOUR_EXPONENT) / self.most;
        let colour = if difference < KNEE_AT {
            difference * KNEE_TO / KNEE_AT
        } else {
            KNEE_TO + (difference - KNEE_AT) / (1.0 - KNEE_AT) * (1.0 - KNEE_TO)
        };
        let change = (a.edge - b.edge).abs().max((a.point - b.point).abs());
        let feature = (change / 2f64.sqrt()).sqrt();
        libm::pow(colour, 1.0 - feature)
    }
}

/// CIELAB of a colour relative to the white point, its chroma scaled by lightness (Hunt's effect).
fn hunt_adjusted_lab(xyz: DVec3) -> DVec3 {
    const DELTA: f64 = 6.0 / 29.0;
    let compressed =
        xyz.map(|t| if t > DELTA * DELTA * DELTA { libm::cbrt(t) } else { t / (3.0 * DELTA * DELTA) + 4.0 / 29.0 });
    let lightness = 116.0 * compressed.y - 16.0;
    let chroma = 0.01 * lightness;
    DVec3::new(
        lightness,
        chroma * 500.0 * (compressed.x - compressed.y),
        chroma * 200.0 * (compressed.y - compressed.z),
    )
}

/// The distance for large colour differences: city-block in lightness, Euclidean in chroma.
fn hyab(a: DVec3, b: DVec3) -> f64 {
    let d = a - b;
    d.x.abs() + (d.y * d.y + d.z * d.z).sqrt()
}

/// The kernel with its positive weights scaled to a sum of 1 and its negative ones to -1.
fn balanced(kernel: &[f64]) -> Kernel {
    let positive: f64 = kernel.iter().filter(|weight| **weight > 0.0).sum();
    let negative: f64 = kernel.iter().filter(|weight| **weight < 0.0).sum();
    kernel.iter().map(|&weight| if weight > 0.0 { weight / positive } else { weight / -negative }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gradient() -> Picture {
        Picture::from_fn(64, 100, |x, y| [(x * 255 / 63) as u8, (y * 255 / 99) as u8, ((x + y) * 255 / 162) as u8])
    }

    fn noise(seed: u32, amplitude: u32) -> Picture {
        let mut state = seed;
        let mut byte = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((state >> 24) * amplitude / 255) as u8
        };
        Picture::from_fn(64, 100, |_, _| [byte(), byte(), byte()])
    }

    /// Figures of NVIDIA's own C++, nv-flip 0.1.2 at 67 pixels a degree, for the same pictures.
    #[test]
    fn it_agrees_with_the_authors_program() {
        let mut noisy = gradient();
        for (pixel, noise) in noisy.pixels_mut().iter_mut().zip(noise(7, 40).pixels()) {
            *pixel = core::array::from_fn(|channel| pixel[channel].saturating_add(noise[channel]));
        }
        let mut dotted = gradient();
        dotted.pixels_mut().iter_mut().step_by(97).for_each(|pixel| *pixel = [255; 3]);
        let checks = Picture::from_fn(64, 100, |x, y| match (x / 5 + y / 7) % 2 {
            0 => [200, 180, 40],
            _ => [30, 60, 90],
        });
        for (name, a, b, expected) in [
            ("noise on a gradient", gradient(), noisy, 0.32322180),
            ("another structure", gradient(), checks, 0.86414639),
            ("dots", gradient(), dotted, 0.05031013),
            ("two noises", noise(1, 255), noise(2, 255), 0.43572091),
        ] {
            let flip = mean(&a, &b);
            assert!((flip - expected).abs() < 1e-6, "{name}: {flip} for {expected}");
        }
    }

    #[test]
    fn flat_colours_are_where_the_formulas_put_them() {
        let flat = |rgb| Picture::from_fn(9, 5, move |_, _| rgb);
        // Where nothing but the colour differs, the authors' program in f32 is right to 2e-5.
        for (a, b, expected) in [
            ([0; 3], [255; 3], 0.96739185),
            ([255, 0, 0], [0, 255, 0], 0.98666579),
            ([0, 255, 0], [0, 0, 255], 1.0),
            ([100; 3], [101; 3], 0.03078891),
        ] {
            let flip = mean(&flat(a), &flat(b));
            assert!((flip - expected).abs() < 2e-5, "{a:?} {b:?}: {flip} for {expected}");
        }
    }
}
