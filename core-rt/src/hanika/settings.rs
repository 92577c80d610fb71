//! The numbers that a kernel of the report leaves to the scene or to a study, and their ranges.

use super::triangle::Projection;
use super::variant::Variant;
use crate::arithmetic::{Arithmetic, Knobs};
use crate::kernel::Vertices;

/// E is at most this: no edge of a triangle, over N_r, is below 2^-30.
pub(super) const EDGE_SHIFT_MAX: u8 = 29;

/// How far from a surface rays may leave it, grid units.
const EPSILON_MAX: u8 = 64;

/// How far they do unless a study says otherwise: twice what Hanika finds, and less than the report's 6, whose shading
/// loses bits that this one keeps.
const EPSILON: u8 = 4;

/// The settings, where they are in range.
pub(super) fn checked<V: Variant>(arithmetic: Arithmetic) -> Option<Arithmetic> {
    let Arithmetic { c_bits, d_bits, edge_shift, epsilon } = arithmetic;
    let holds = V::holds(c_bits, d_bits) && edge_shift <= EDGE_SHIFT_MAX && (1..=EPSILON_MAX).contains(&epsilon);
    holds.then_some(arithmetic)
}

/// What is asked for, and the report's for the rest: E is the scene's.
pub(super) fn settle<V: Variant>(knobs: &Knobs, triangles: impl Iterator<Item = Vertices>) -> Option<Arithmetic> {
    let [c_bits, d_bits] = V::shifts(knobs)?;
    let edge_shift = knobs.edge_shift.unwrap_or_else(|| scene_edge_shift(triangles));
    checked::<V>(Arithmetic { c_bits, d_bits, edge_shift, epsilon: knobs.epsilon.unwrap_or(EPSILON) })
}

/// The report's refinement: the largest E for which no edge's component over N_r, times 2^E, exceeds 1. Derived: the
/// listing is lost. Where a triangle is so thin that even E = 0 is too much, its edges are clamped.
fn scene_edge_shift(triangles: impl Iterator<Item = Vertices>) -> u8 {
    let shifts = triangles.filter_map(|vertices| Projection::of(&vertices)).map(|projection| projection.edge_shift());
    shifts.min().unwrap_or(0).min(EDGE_SHIFT_MAX)
}

#[cfg(test)]
mod tests {
    use super::super::{Conservative, PlainC, RefinedCd};
    use super::*;

    const FLAT: Vertices = [[16, 16, 100], [16 + 1024, 16, 100], [16, 16 + 1024, 100]];

    fn settled<V: Variant>(knobs: Knobs, triangles: &[Vertices]) -> Option<Arithmetic> {
        settle::<V>(&knobs, triangles.iter().copied())
    }

    #[test]
    fn without_knobs_it_is_the_report() {
        let expected = |c_bits, d_bits| Arithmetic { c_bits, d_bits, edge_shift: 10, epsilon: 4 };
        let none = Knobs::default();
        assert_eq!(settled::<PlainC>(none, &[FLAT]), Some(expected(12, 12)));
        assert_eq!(settled::<RefinedCd>(none, &[FLAT]), Some(expected(15, 9)));
        assert_eq!(settled::<Conservative>(none, &[FLAT]), Some(expected(0, 0)));
    }

    /// Legs of 2^k give exactly 2^-k, which still fits; one unit more does not change that, one less does.
    #[test]
    fn the_thinnest_triangle_decides_the_edge_shift() {
        let shift = |triangles: &[Vertices]| settled::<PlainC>(Knobs::default(), triangles).unwrap().edge_shift;
        let legs = |a: i32, b: i32| [[16, 16, 16], [16 + a, 16, 16], [16, 16 + b, 16]];
        assert_eq!(shift(&[legs(1024, 1024)]), 10);
        assert_eq!(shift(&[legs(1025, 1024)]), 10);
        assert_eq!(shift(&[legs(1024, 1023)]), 9);
        assert_eq!(shift(&[legs(1 << 28, 1 << 28), legs(1 << 20, 8)]), 3);
        // The widest: a leg less than 2^29.
        assert_eq!(shift(&[legs((1 << 29) - 33, (1 << 29) - 33)]), 28);
        // The thinnest: N_r = 1 beside edges of 2^28.
        let long = 1 << 28;
        assert_eq!(shift(&[[[16, 16, 16], [16 + long, 16 + long - 1, 16], [16 + long - 1, 16 + long - 2, 16]]]), 0);
    }

    #[test]
    fn the_ends_of_the_ranges_are_held_and_no_more() {
        let c = |c_bits| Knobs { c_bits: Some(c_bits), ..Knobs::default() };
        let cd = |c_bits, d_bits| Knobs { c_bits: Some(c_bits), d_bits: Some(d_bits), ..Knobs::default() };
        assert!(settled::<PlainC>(c(0), &[]).is_some() && settled::<PlainC>(c(28), &[]).is_some());
        assert!(settled::<PlainC>(c(29), &[]).is_none());
        assert!(settled::<PlainC>(cd(12, 12), &[]).is_some() && settled::<PlainC>(cd(12, 11), &[]).is_none());
        assert!(settled::<RefinedCd>(cd(28, 22), &[]).is_some() && settled::<RefinedCd>(cd(28, 21), &[]).is_none());
        assert!(settled::<RefinedCd>(cd(9, 9), &[]).is_some() && settled::<RefinedCd>(cd(9, 10), &[]).is_none());
        assert!(settled::<RefinedCd>(c(3), &[]).is_some() && settled::<RefinedCd>(c(29), &[]).is_none());
        assert!(settled::<Conservative>(c(0), &[]).is_none());
        let edge = |edge_shift| Knobs { edge_shift: Some(edge_shift), ..Knobs::default() };
        assert!(settled::<Conservative>(edge(29), &[]).is_some() && settled::<Conservative>(edge(30), &[]).is_none());
        let epsilon = |epsilon| Knobs { epsilon: Some(epsilon), ..Knobs::default() };
        for (value, held) in [(0, false), (1, true), (64, true), (65, false)] {
            assert_eq!(settled::<Conservative>(epsilon(value), &[]).is_some(), held, "{value}");
        }
    }
}
