//! Between which t a hit is said to be, there it is: by exact fractions, with and without an end near it.

use core_rt::exact::{Exact, Ray, Span, Width, Width14, Width20, Width29In};
use core_rt::kernel::Kernel;
use num::BigInt;

use crate::hits::hits;

/// Whether numerator / denominator is between two t, or at one of them.
fn holds<W: Width>(ends: [i64; 2], [numerator, denominator]: &[BigInt; 2]) -> bool {
    let t = numerator << W::T_BITS;
    let [least, most] = ends.map(|t| BigInt::from(t) * denominator);
    least <= t && t <= most
}

/// How many spans were looked at, how many hold their t, how many do when narrowed to their middles, and of how many the exact t
/// was not asked for.
#[derive(Debug, Default)]
struct Tally {
    all: u32,
    held: u32,
    held_by_middle: u32,
    for_less: u32,
}

fn tally<W>() -> Tally
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    let mut tally = Tally::default();
    hits::<W>(60_000, |ray, _, triangle| {
        let depth = Exact::<W>::intersect(ray, triangle).expect("a hit");
        let t = [depth.numerator, depth.denominator].map(|n| BigInt::from(n.into()));
        // Ends below the hit, about it and beyond: powers of two.
        let scale = t[0].bits() as i32 - t[1].bits() as i32;
        for reach in [None].into_iter().chain((scale - 2..=scale + 2).map(Some)) {
            if reach.is_some_and(|reach| W::T_BITS as i32 + reach < 0 || reach > 1) {
                continue;
            }
            let ray = Ray { reach, ..*ray };
            let span = Exact::<W>::meet(&ray, triangle);
            assert_eq!(span.is_some(), Exact::<W>::intersect(&ray, triangle).is_some(), "{ray:?}");
            let Some(span) = span else { continue };
            let ends: [i64; 2] = span.ends().map(Into::into);
            let [least, most] = ends;
            tally.all += 1;
            tally.held += u32::from(holds::<W>(ends, &t));
            tally.held_by_middle += u32::from(holds::<W>([(least + most) / 2; 2], &t));
            tally.for_less += u32::from(most - least != 2 * W::SLACK.into());
        }
    });
    println!("{}: {tally:?}", W::NAME);
    tally
}

fn check<W>()
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    let tally = tally::<W>();
    assert!(tally.all > 50_000 && tally.held == tally.all, "{tally:?}");
    assert!(
        tally.held_by_middle < tally.all / 2,
        "spans are wider than they need to be, or the check passes all: {tally:?}"
    );
    if Span::<W>::IS_EXACT {
        assert_eq!(tally.for_less, 0);
    } else {
        // Rays are aimed at edges and along planes, where determinants are small.
        assert!(tally.for_less > tally.all / 3, "the exact t was asked for too often: {tally:?}");
    }
}

#[test]
fn hits_are_where_they_are_said_to_be() {
    check::<Width14>();
    check::<Width20>();
    check::<Width29In<false>>();
    check::<Width29In<true>>();
}
