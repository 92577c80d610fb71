//! No box that is hit is missed, by reciprocals that are never high.

use core_rt::exact::{Exact, Reciprocal, Reciprocal20, Reciprocal29, Width, Width14, Width20, Width29, Width29In};
use core_rt::kernel::{Bounds, Kernel};
use core_rt::num::Word;
use tests::octants::enter;
use tests::random::SplitMix64;

use crate::hits::hits;

/// A hit's box is always entered, even with the hit itself as the limit.
fn no_false_miss<W>()
where
    W: Width<Word: Into<i64>>,
{
    let mut count = 0u64;
    hits::<W>(60_000, |ray, corners, triangle| {
        let bounds = Bounds::of(&corners.map(|v| v.map(|c| c as i32)));
        let node = Exact::<W>::node([bounds; 2], [0; 2]);
        let depth = Exact::<W>::intersect(ray, triangle).expect("a hit");
        let met = Exact::<W>::meet(ray, triangle).expect("a hit");
        let path = Exact::<W>::path(ray);
        for limit in [&Exact::<W>::span(&depth), &met]
            .map(|span| Exact::<W>::limit(&path, span))
            .into_iter()
            .chain([Exact::<W>::reach(ray, &path)])
        {
            let [first, second] = enter::<Exact<W>>(&path, &node, limit);
            assert!(first.is_some() && first == second, "{ray:?} misses {bounds:?}");
            assert!(Exact::<W>::within(first.expect("entered"), limit));
        }
        count += 1;
    });
    println!("{}: {count} boxes that were hit were entered", W::NAME);
}

#[test]
fn no_box_that_is_hit_is_missed() {
    no_false_miss::<Width14>();
    no_false_miss::<Width20>();
    no_false_miss::<Width29In<false>>();
    no_false_miss::<Width29In<true>>();
}

/// `along` is never high, negative where the difference is, and low by at most the slack.
fn reciprocal_bounds<W, R>(deltas: &[i64])
where
    W: Width<Word: Into<i64>>,
    R: Reciprocal<Word = W::Word>,
{
    let mut random = SplitMix64(3);
    let top = 1i64 << W::DIRECTION_BITS;
    let ends = [1, 2, 3, 5, top / 2 - 1, top / 2, top / 2 + 1, top - 2, top - 1];
    let magnitudes = ends.into_iter().chain((0..200_000).map(|_| {
        let bits = random.within([1, W::DIRECTION_BITS.into()]);
        random.within([1, (1i64 << bits) - 1])
    }));
    let t_max: i64 = W::T_MAX.into();
    for magnitude in magnitudes {
        let word = |value: i64| W::Word::from_i64(value).expect("in range");
        let (reciprocal, opposite) = (R::new(word(magnitude)), R::new(word(-magnitude)));
        for &delta in deltas {
            let found: i64 = reciprocal.along(word(delta)).into();
            assert_eq!(found, opposite.along(word(-delta)).into(), "{delta} / {magnitude}: the sign matters");
            let exact = (i128::from(delta) << W::T_BITS).div_euclid(magnitude.into());
            if delta < 0 {
                assert!(found < 0, "{delta} / {magnitude}: {found}");
            } else {
                assert!(i128::from(found) <= exact, "{delta} / {magnitude}: {found} is over {exact}");
                let needed = exact.min(t_max.into());
                assert!(i128::from(found + R::SLACK.into()) >= needed, "{delta} / {magnitude}: {found}, {exact}");
            }
        }
    }
    // No movement along the axis: everything on the far side is out of reach, and the plane itself is not.
    let still = R::new(W::Word::ZERO);
    assert!(Into::<i64>::into(still.along(W::Word::ONE)) + Into::<i64>::into(R::SLACK) >= t_max);
    assert_eq!(still.along(W::Word::ZERO), W::Word::ZERO);
}

#[test]
fn reciprocals_are_low_by_less_than_the_slack() {
    reciprocal_bounds::<Width20, Reciprocal20>(&[
        -(1 << 20),
        -1,
        0,
        1,
        2,
        (1 << 19) - 1,
        1 << 19,
        (1 << 20) - 1,
        1 << 20,
    ]);
    reciprocal_bounds::<Width29, Reciprocal29>(&[
        -(1 << 29),
        -1,
        0,
        1,
        2,
        (1 << 28) - 1,
        1 << 28,
        (1 << 29) - 1,
        1 << 29,
    ]);
}
