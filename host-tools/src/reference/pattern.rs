//! Where in a pixel its samples are: Hammersley's points, in integers, so that every machine has the same.
//!
//! J. M. Hammersley, "Monte Carlo Methods for Solving Multivariable Problems", Annals of the New York Academy of Sciences
//! 86, 1960. Each of n columns has one sample; so has each row, where n is a power of two, and each cell of a square grid
//! where n is a power of four.

/// One pixel in the units that the points are made in.
const PIXEL: u64 = 1 << 16;

/// The points of `samples` samples, at least one: right and down from the pixel's corner, in pixels. One sample is in the
/// middle.
pub(super) fn points(samples: u32) -> impl Iterator<Item = [f64; 2]> {
    let rows = u64::from(samples).next_power_of_two();
    let middle = |place: u64, of: u64| (2 * place + 1) * (PIXEL / 2) / of;
    (0..u64::from(samples)).map(move |i| {
        let row = if rows > 1 { i.reverse_bits() >> (64 - rows.trailing_zeros()) } else { 0 };
        [middle(i, samples.into()), middle(row, rows)].map(|units| units as f64 / PIXEL as f64)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_sample_is_in_the_middle_and_four_are_one_a_quarter() {
        assert_eq!(points(1).collect::<Vec<_>>(), [[0.5, 0.5]]);
        let four = [[0.125, 0.125], [0.375, 0.625], [0.625, 0.375], [0.875, 0.875]];
        assert_eq!(points(4).collect::<Vec<_>>(), four);
    }

    #[test]
    fn every_column_has_one_and_every_cell_of_a_square() {
        for samples in [2, 3, 7, 16, 64, 100, 256] {
            let cells = |places: &dyn Fn([f64; 2]) -> u64| {
                let mut seen: Vec<u64> = points(samples).map(places).collect();
                seen.sort_unstable();
                seen.dedup();
                seen.len() as u32
            };
            let n = f64::from(samples);
            assert_eq!(cells(&|[x, _]| (x * n) as u64), samples);
            let side = n.sqrt();
            if samples.is_power_of_two() && side.fract() == 0.0 {
                assert_eq!(cells(&|[x, y]| (x * side) as u64 + 1000 * (y * side) as u64), samples);
            }
            assert!(points(samples).flatten().all(|place| place > 0.0 && place < 1.0));
        }
    }
}
