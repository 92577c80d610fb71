//! The ends of every range, in wider words.

use super::*;

fn all_ends(widths: Widths) -> [i16; 7] {
    let most = widths.coordinate_max() as i16;
    [-most, 1 - most, -1, 0, 1, most / 2, most]
}

/// Widths at both ends of every range, and the text's.
fn corners() -> impl Iterator<Item = Widths> {
    let ends = |range: core::ops::RangeInclusive<u32>| [*range.start(), *range.end()];
    let corners = (0..16).map(move |bits: usize| {
        let end = |place: u32, range| ends(range)[bits >> place & 1];
        let coordinate = end(0, Widths::COORDINATE);
        let (product, determinant) = (end(1, Widths::PRODUCT), end(2, Widths::DETERMINANT));
        Widths::new(coordinate, product, determinant, end(3, Widths::T_FRACTION)).unwrap()
    });
    corners.chain([Widths::PIXEL_PLANES])
}

fn wide(a: [i16; 3], b: [i16; 3]) -> i128 {
    (0..3).map(|axis| i128::from(a[axis]) * i128::from(b[axis])).sum()
}

/// A handful of triples with components at the ends.
fn triples(widths: Widths) -> impl Iterator<Item = [i16; 3]> {
    let ends = all_ends(widths);
    (0..ends.len().pow(3)).step_by(5).map(move |n| [ends[n % 7], ends[n / 7 % 7], ends[n / 49]])
}

#[test]
fn words_that_are_wide_enough_give_the_exact_determinant_and_others_saturate() {
    for widths in corners() {
        let most = i128::from(widths.product_max());
        for origin in triples(widths) {
            for direction in triples(widths) {
                for (centre, radius) in [([0; 3], 1), ([-widths.coordinate_max() as i16; 3], widths.coordinate_max())] {
                    let (b, c) = coefficients(origin, direction, centre, radius * radius, widths);
                    let edge = widths.coordinate_max() as i16;
                    let s = from_fn(|axis| (origin[axis] - centre[axis]).clamp(-edge, edge));
                    assert_eq!(i128::from(b), wide(direction, s).clamp(-most, most));
                    assert_eq!(i128::from(c), (wide(s, s) - i128::from(radius * radius)).clamp(-most, most));
                    let a = product(direction, direction, widths);
                    let (a_wide, b_wide, c_wide) = (i128::from(a), i128::from(b), i128::from(c));
                    assert_eq!(i128::from(determinant(a, b, c)), b_wide * b_wide - a_wide * c_wide);
                }
            }
        }
    }
}

#[test]
fn points_and_reflections_stay_in_their_words_at_the_ends() {
    for widths in corners() {
        let most = widths.product_max();
        for direction in triples(widths) {
            let a = product(direction, direction, widths);
            for s in triples(widths) {
                let b = product(direction, s, widths);
                if b < 0 {
                    // The largest t that there is for them; overflow checks watch.
                    let t = parameter(numerator(b, 0), a, widths);
                    assert!(t >= 0 && t <= most);
                    let _ = point(s, direction, t, widths);
                }
                let _ = reflection(direction, s, widths);
            }
        }
    }
    assert_eq!(held(i64::MAX, Widths::PIXEL_PLANES), 0xf_ffff_ffff);
    assert_eq!(numerator(-5, 3), 2);
    assert_eq!(numerator((1 << 30) - 1, (1 << 29) - 1), 2 - (3 << 29));
}

#[test]
fn a_sphere_ahead_is_met_where_arithmetic_by_hand_says() {
    let widths = Widths::PIXEL_PLANES;
    let (origin, direction) = ([-400, 3, 0], [200, 0, 0]);
    let (b, c) = coefficients(origin, direction, [0; 3], 100 * 100, widths);
    assert_eq!((b, c), (-80_000, 150_009));
    let determinant = determinant(40_000, b, c);
    // 200^2 (100^2 - 3^2).
    assert_eq!(determinant, 399_640_000);
    let above = numerator(b, held(determinant, widths).isqrt() as i32);
    assert_eq!(above, 80_000 - 19_990);
    // 1.50025, rounded down in sixty-fourths.
    assert_eq!(parameter(above, 40_000, widths), 96);
    assert_eq!(point(origin, direction, 96, widths), [-100, 3, 0]);
    let whole = Widths::new(12, 24, 36, 0).unwrap();
    assert_eq!(parameter(above, 40_000, whole), 1);
    assert_eq!(point(origin, direction, 1, whole), [-200, 3, 0]);
}

#[test]
fn the_determinant_of_the_text_holds_to_a_direction_times_a_radius_of_2_to_the_18() {
    let widths = Widths::PIXEL_PLANES;
    // Straight at the centre: (|d| r)^2, whatever the distance.
    for (d, r, distance) in [(512i16, 511i16, 600), (511, 512, 2047), (1024, 255, 700)] {
        let radius_squared = i32::from(r) * i32::from(r);
        let (b, c) = coefficients([-distance, 0, 0], [d, 0, 0], [0; 3], radius_squared, widths);
        let (d, r) = (i32::from(d), i32::from(r));
        let exact = i64::from(d * r) * i64::from(d * r);
        assert_eq!(determinant(d * d, b, c), exact);
        assert_eq!(held(exact, widths), exact);
    }
    assert_eq!(held(1 << 36, widths), (1 << 36) - 1);
}

#[test]
fn reflections_are_within_a_unit_and_a_half_where_the_words_hold_them() {
    let widths = Widths::PIXEL_PLANES;
    for normal in [[200, 0, 0], [-117, 117, 117], [3, -199, 40], [1, 0, 0], [0, 2, 1]] {
        for direction in [[-500, 20, 300], [0, 511, 0], [9, 9, -9], [-1000, 1000, -1000]] {
            let (dn, nn) = (wide(direction, normal), wide(normal, normal));
            let out = reflection(direction, normal, widths);
            for axis in 0..3 {
                // 2 |n|^2 times the difference to d - 2 (d.n) n / |n|^2.
                let exact = i128::from(direction[axis]) * nn - 2 * dn * i128::from(normal[axis]);
                let error = 2 * (i128::from(out[axis]) * nn - exact);
                assert!(error.abs() <= 3 * nn, "{direction:?} {normal:?} {out:?}");
            }
        }
    }
    assert_eq!(reflection([7, -8, 9], [0; 3], widths), [7, -8, 9]);
}
