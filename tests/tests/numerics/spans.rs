//! Between which t a hit is said to be, there it is: by exact fractions, with and without an end near it.

use core_rt::exact::{Exact, Ray, Span, Width, Width14, Width20, Width29In};
use core_rt::kernel::Kernel;
use num::BigInt;

use crate::hits::hits;

/// Whether numerator / denominator is within a span.
fn holds<W: Width<Word: Into<i64>>>(span: &Span<W>, [numerator, denominator]: &[BigInt; 2]) -> bool {
    let t = numerator << W::T_BITS;
    let [least, most] = [span.least, span.most].map(|t| BigInt::from(t.into()) * denominator);
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
            let [least, most]: [i64; 2] = [span.least, span.most].map(Into::into);
            let middle = core_rt::num::Word::from_i64((least + most) / 2).expect("a word");
            tally.all += 1;
            tally.held += u32::from(holds::<W>(&span, &t));
            tally.held_by_middle += u32::from(holds::<W>(&Span { least: middle, most: middle }, &t));
            tally.for_less += u32::from(most - least != 2 * W::SLACK.into());
        }
    });
    println!("{}: {tally:?}", W::NAME);
    tally
}

#[test]
fn hits_are_where_they_are_said_to_be() {
    for tally in [tally::<Width14>(), tally::<Width29In<false>>(), tally::<Width29In<true>>()] {
        assert!(tally.all > 50_000 && tally.held == tally.all, "{tally:?}");
        // Rays are aimed at edges and along planes, where determinants are small.
        assert!(tally.for_less > tally.all / 3, "the exact t was asked for too often: {tally:?}");
        assert!(
            tally.held_by_middle < tally.all / 2,
            "spans are wider than they need to be, or the check passes all: {tally:?}"
        );
    }
    let tally = tally::<Width20>();
    assert!(tally.all > 50_000 && tally.held == tally.all && tally.for_less == 0, "{tally:?}");
}
