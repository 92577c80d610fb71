//! The Pareto front: what nothing else beats in cost and in error at once.

/// For each (cost, badness) whether no other is at most as much in both and less in one. Equals do not dominate each other.
pub(super) fn front(points: &[(f64, f64)]) -> Vec<bool> {
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        let ((cost_a, bad_a), (cost_b, bad_b)) = (points[a], points[b]);
        cost_a.total_cmp(&cost_b).then(bad_a.total_cmp(&bad_b))
    });
    let mut stays = vec![false; points.len()];
    // The last that stayed; what follows costs as much or more, so only a lesser badness, or equality, keeps it.
    let mut last: Option<(f64, f64)> = None;
    for index in order {
        let point = points[index];
        if last.is_none_or(|last| point.1 < last.1 || point == last) {
            stays[index] = true;
            last = Some(point);
        }
    }
    stays
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_front_is_what_brute_force_finds(points in prop::collection::vec((0u8..12, 0u8..12), 0..40)) {
            let points: Vec<(f64, f64)> = points.iter().map(|&(a, b)| (f64::from(a), f64::from(b))).collect();
            let beaten = |a: (f64, f64)| points.iter().any(|&b| b.0 <= a.0 && b.1 <= a.1 && b != a);
            let expected: Vec<bool> = points.iter().map(|&point| !beaten(point)).collect();
            prop_assert_eq!(front(&points), expected);
        }
    }

    #[test]
    fn equal_pictures_are_better_than_any_other() {
        let points = [(1.0, f64::NEG_INFINITY), (2.0, f64::NEG_INFINITY), (0.5, -40.0), (0.6, -30.0)];
        assert_eq!(front(&points), [true, false, true, false]);
    }
}
