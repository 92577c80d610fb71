//! How a cost grows: least squares in the logarithms of both.

/// The exponent k of the power law c x^k that is nearest to (x, y) in the squares of log y. `None` with fewer than two
/// different x, and where something is not positive and finite.
#[must_use]
pub fn exponent(points: &[(f64, f64)]) -> Option<f64> {
    let usable = |value: f64| value > 0.0 && value.is_finite();
    if points.is_empty() || points.iter().any(|&(x, y)| !usable(x) || !usable(y)) {
        return None;
    }
    let logs: Vec<(f64, f64)> = points.iter().map(|&(x, y)| (libm::log(x), libm::log(y))).collect();
    let count = logs.len() as f64;
    let mean_x = logs.iter().map(|log| log.0).sum::<f64>() / count;
    let mean_y = logs.iter().map(|log| log.1).sum::<f64>() / count;
    let spread: f64 = logs.iter().map(|log| (log.0 - mean_x) * (log.0 - mean_x)).sum();
    let common: f64 = logs.iter().map(|log| (log.0 - mean_x) * (log.1 - mean_y)).sum();
    // Equal x leave at most rounding, far below the spread of different whole numbers.
    (points.iter().any(|point| point.0 != points[0].0)).then(|| common / spread)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_power_law_has_its_own_exponent(
            k in -3.0..3.0f64,
            c in 1e-6..1e9f64,
            xs in prop::collection::btree_set(1u32..1_000_000, 2..12),
        ) {
            let points: Vec<_> = xs.iter().map(|&x| (f64::from(x), c * libm::pow(f64::from(x), k))).collect();
            let spread = libm::log(points[points.len() - 1].0 / points[0].0);
            // A rounding of both logarithms, over the span of one.
            prop_assert!((exponent(&points).unwrap() - k).abs() < 1e-12 / spread.min(1.0));
        }
    }

    #[test]
    fn noise_is_averaged_and_what_has_no_exponent_gets_none() {
        // About the law x^1 symmetrically: the slope of (0, 0), (1, 2), (2, 1) log units, and (3, 3), is 0.8.
        let points = [(0.0, 0.0), (1.0, 2.0), (2.0, 1.0), (3.0, 3.0)].map(|(x, y)| (libm::exp(x), libm::exp(y)));
        assert!((exponent(&points).unwrap() - 0.8).abs() < 1e-12);
        for none in [&[][..], &[(5.0, 1.0)], &[(5.0, 1.0), (5.0, 2.0)], &[(1.0, 0.0), (2.0, 1.0)]] {
            assert_eq!(exponent(none), None);
        }
    }
}
