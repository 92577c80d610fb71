//! One channel over a band of rows, and separable filters on it.

use crate::picture::Picture;

/// Values of `width` columns, row by row.
#[derive(Clone, Debug)]
pub(super) struct Plane {
    width: usize,
    values: Vec<f64>,
}

/// A one-dimensional filter of odd length, its centre in the middle.
pub(super) type Kernel = Vec<f64>;

/// The kernel `weight(x)` for whole x from -radius to radius.
pub(super) fn kernel(radius: u32, weight: impl Fn(f64) -> f64) -> Kernel {
    let radius = f64::from(radius);
    let taps = 2 * radius as usize + 1;
    (0..taps).map(|tap| weight(tap as f64 - radius)).collect()
}

/// A Gaussian of standard deviation `sigma`, pixels; its sum is 1.
pub(super) fn gaussian(radius: u32, sigma: f64) -> Kernel {
    let raw = kernel(radius, |x| libm::exp(-x * x / (2.0 * sigma * sigma)));
    let sum: f64 = raw.iter().sum();
    raw.iter().map(|weight| weight / sum).collect()
}

impl Plane {
    /// The plane of `values`, whose length is a multiple of `width`.
    pub(super) fn new(width: usize, values: Vec<f64>) -> Self {
        Self { width, values }
    }

    /// `value` of the pixels of `rows` rows from `first_row` on, with `margin` more on either side; beyond the
    /// picture its first or last row is repeated. The picture is not empty.
    pub(super) fn of_band(
        picture: &Picture,
        first_row: u32,
        rows: u32,
        margin: u32,
        value: impl Fn([u8; 3]) -> f64,
    ) -> Self {
        let width = picture.width() as usize;
        let mut values = Vec::with_capacity(width * (rows + 2 * margin) as usize);
        for row in 0..rows + 2 * margin {
            let y = (first_row + row).saturating_sub(margin).min(picture.height() - 1) as usize;
            values.extend(picture.pixels()[y * width..][..width].iter().map(|&pixel| value(pixel)));
        }
        Self::new(width, values)
    }

    /// The values, row by row.
    pub(super) fn values(&self) -> &[f64] {
        &self.values
    }

    /// The same without the first and last `margin` rows.
    pub(super) fn without_margin(&self, margin: u32) -> Self {
        let cut = margin as usize * self.width;
        Self::new(self.width, self.values[cut..self.values.len() - cut].to_vec())
    }

    /// The product with another plane of the same size, value by value.
    pub(super) fn times(&self, other: &Self) -> Self {
        Self::new(self.width, self.values.iter().zip(&other.values).map(|(a, b)| a * b).collect())
    }

    /// Correlates each row with `kernel`, with the row's ends repeated beyond it.
    pub(super) fn along_rows(&self, kernel: &[f64]) -> Self {
        let radius = kernel.len() / 2;
        let mut padded = vec![0.0; self.width + 2 * radius];
        let mut values = Vec::with_capacity(self.values.len());
        for row in self.values.chunks_exact(self.width) {
            padded[..radius].fill(row[0]);
            padded[radius..radius + self.width].copy_from_slice(row);
            padded[radius + self.width..].fill(row[self.width - 1]);
            let at = values.len();
            values.resize(at + self.width, 0.0);
            // Tap by tap, so that the inner loop runs along the row and vectorises.
            for (tap, weight) in kernel.iter().enumerate() {
                for (value, sample) in values[at..].iter_mut().zip(&padded[tap..]) {
                    *value += weight * sample;
                }
            }
        }
        Self::new(self.width, values)
    }

    /// Correlates each column with `kernel`. The first and last rows, as many as its radius, are used up.
    pub(super) fn along_columns(&self, kernel: &[f64]) -> Self {
        let used = (kernel.len() - 1) * self.width;
        let mut values = vec![0.0; self.values.len() - used];
        for (row, out) in values.chunks_exact_mut(self.width).enumerate() {
            for (tap, weight) in kernel.iter().enumerate() {
                let samples = &self.values[(row + tap) * self.width..];
                for (value, sample) in out.iter_mut().zip(samples) {
                    *value += weight * sample;
                }
            }
        }
        Self::new(self.width, values)
    }

    /// Correlates with the outer product of `kernel` with itself.
    pub(super) fn filtered(&self, kernel: &[f64]) -> Self {
        self.along_rows(kernel).along_columns(kernel)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filters_agree_with_their_definition() {
        let ramp = [-1.0, 2.0, 5.0];
        let plane = Plane::new(4, (0..20).map(|i| f64::from(i * i % 7)).collect());
        let at = |x: i32, y: i32| plane.values()[(y * 4 + x.clamp(0, 3)) as usize];
        let rows = plane.along_rows(&ramp);
        let columns = plane.along_columns(&ramp);
        assert_eq!((rows.values().len(), columns.values().len()), (20, 12));
        for (x, y) in (0..5).flat_map(|y| (0..4).map(move |x| (x, y))) {
            let expected = -at(x - 1, y) + 2.0 * at(x, y) + 5.0 * at(x + 1, y);
            assert_eq!(rows.values()[(y * 4 + x) as usize], expected);
            if (1..4).contains(&y) {
                let expected = -at(x, y - 1) + 2.0 * at(x, y) + 5.0 * at(x, y + 1);
                assert_eq!(columns.values()[((y - 1) * 4 + x) as usize], expected);
            }
        }
        assert_eq!(plane.without_margin(1).values(), &plane.values()[4..16]);
    }

    #[test]
    fn a_band_repeats_the_rows_at_the_border() {
        let picture = Picture::from_fn(2, 3, |x, y| [(10 * y + x) as u8, 0, 0]);
        let band = Plane::of_band(&picture, 1, 2, 2, |pixel| f64::from(pixel[0]));
        assert_eq!(band.values(), [0., 1., 0., 1., 10., 11., 20., 21., 20., 21., 20., 21.]);
    }

    #[test]
    fn a_gaussian_keeps_a_constant() {
        let weights = gaussian(5, 1.5);
        assert_eq!(weights.len(), 11);
        // The centre weight of the 11-tap window of Wang et al.
        assert!((weights[5] - 0.266_011_7).abs() < 1e-7, "{}", weights[5]);
        let flat = Plane::new(3, vec![7.0; 3 * 11]).filtered(&weights);
        assert_eq!(flat.values().len(), 3);
        assert!(flat.values().iter().all(|value| (value - 7.0).abs() < 1e-12));
    }
}
