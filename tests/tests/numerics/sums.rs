//! Sums and orders of products, exact at the ends of their ranges.

use core_rt::exact::{Width, Width14, Width20, Width29};
use core_rt::num::{cross, sub};
use ethnum::U256;
use tests::random::SplitMix64;

#[test]
fn exact_sums_at_the_ends() {
    let ends14 = [-(1i64 << 15) + 1, -1, 0, 1, (1 << 15) - 1];
    let normals14 = [-(1i64 << 30), -(1 << 30) + 1, -(1 << 15), -1, 0, 0x7fff, 1 << 15, (1 << 30) - 1, 1 << 30];
    for a in ends14 {
        for b in normals14 {
            for c in normals14 {
                let found = Width14::dot([a, -a, a].map(|c| c as i32), [b, c, b].map(|c| c as i32));
                assert_eq!(i128::from(found), i128::from(a) * i128::from(b - c + b), "{a} {b} {c}");
            }
        }
    }
    // Corners of the cube that the budget allows, and directions to the corners of theirs: the largest U, det and tn.
    let corner = |i: usize| [0, 1, 2].map(|axis| i64::from(Width20::SPAN) * (i >> axis & 1) as i64);
    let largest_direction = (1i64 << Width20::DIRECTION_BITS) - 1;
    let mut most = 0;
    for (i, j, k) in (0..512).map(|n| (n & 7, n >> 3 & 7, n >> 6)) {
        let (edge, s) = (sub(corner(j), corner(i)), sub(corner(k), corner(i)));
        for d in 0..8 {
            let d = [0, 1, 2].map(|axis| if d >> axis & 1 == 0 { largest_direction } else { -largest_direction });
            let wide = |a: [i64; 3], b: [i64; 3]| (0..3).map(|i| i128::from(a[i]) * i128::from(b[i])).sum::<i128>();
            for (a, b) in [(edge, cross(s, d)), (d, cross(edge, s)), (s, cross(edge, corner(d[0] as usize & 7)))] {
                assert_eq!(i128::from(Width20::dot(a, b)), wide(a, b), "{a:?} . {b:?}");
                most = most.max(wide(a, b).abs());
            }
        }
    }
    assert!(most > 1 << 62, "the ends were not reached: {most}");
    let largest = 1i64 << 61;
    assert_eq!(Width29::dot([1 << 29; 3], [largest; 3]), 3 * (1i128 << 90));
    assert_eq!(Width29::dot([-(1 << 29); 3], [largest; 3]), -3 * (1i128 << 90));
}

#[test]
fn fractions_are_ordered_as_256_bits_order_them() {
    let mut random = SplitMix64(11);
    let mut term = |bits: u32| -> i128 {
        let size = random.within([1, bits.into()]) as u32;
        (i128::from(random.bits()) << 64 | i128::from(random.bits())) & ((1i128 << size) - 1) | 1
    };
    for i in 0..1_000_000 {
        let (a, b, c) = (term(92), term(92), term(92));
        // Every third pair is equal, or unequal by one in one term.
        let pair = if i % 3 == 0 { (a + i128::from(i % 2), b) } else { (c, term(92)) };
        let wide = |x: i128| U256::new(x as u128);
        let expected = (wide(a) * wide(pair.1)).cmp(&(wide(pair.0) * wide(b)));
        assert_eq!(Width29::order((a, b), pair), expected, "{a} / {b}, {pair:?}");
    }
}
