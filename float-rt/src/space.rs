//! Shading in floats: points, unit vectors and barycentrics are plain numbers.

use core::marker::PhantomData;

use core_rt::num::Triple;
use core_rt::record::{Checker, Reach};
use core_rt::space::{BRIGHTEST, Space};

use crate::colour::RgbF;
use crate::real::Real;
use crate::vector::{add, dot, normalise, scale, sub};

/// The space of float kernels.
#[derive(Clone, Copy, Debug, Default)]
pub struct FloatSpace<F>(PhantomData<F>);

impl<F: Real> Space for FloatSpace<F> {
    type Point = Triple<F>;
    type Unit = Triple<F>;
    type Fraction = F;
    type Colour = RgbF<F>;
    type Normal = Triple<F>;

    #[inline]
    fn unit(normal: &Triple<F>) -> Triple<F> {
        *normal
    }

    fn is_unit(normal: &Triple<F>) -> bool {
        // Within 2^-7 of 1 is the square of a length within 2^-8. What is not a number is not within anything.
        let error = dot(*normal, *normal) - F::ONE;
        let bound = F::ONE.ldexp(-7);
        -bound < error && error < bound
    }

    fn normal(unit_q30: Triple<i32>) -> Triple<F> {
        Self::unit_from_q30(unit_q30)
    }

    #[inline]
    fn unit_from_q30(unit_q30: Triple<i32>) -> Triple<F> {
        scale(unit_q30.map(F::from_i32), F::ONE / F::from_i32(1 << 30))
    }

    #[inline]
    fn point(grid: Triple<i32>) -> Triple<F> {
        grid.map(F::from_i32)
    }

    #[inline]
    fn towards(from: Triple<F>, to: Triple<F>) -> Option<Triple<F>> {
        normalise(sub(to, from))
    }

    #[inline]
    fn interpolate(normals: [Triple<F>; 3], u: F, v: F) -> Option<Triple<F>> {
        let [n0, n1, n2] = normals;
        normalise(add(add(scale(n0, F::ONE - u - v), scale(n1, u)), scale(n2, v)))
    }

    fn lift(
        point: Triple<F>,
        corners: [Triple<F>; 3],
        normals: [Triple<F>; 3],
        [u, v]: [F; 2],
        _range: [Triple<F>; 2],
    ) -> Triple<F> {
        let mut lifted = point;
        for ((corner, normal), weight) in corners.into_iter().zip(normals).zip([F::ONE - u - v, u, v]) {
            let height = dot(sub(point, corner), normal);
            if height < F::ZERO {
                lifted = sub(lifted, scale(normal, height * weight));
            }
        }
        lifted
    }

    #[inline]
    fn near(a: Triple<F>, b: Triple<F>) -> bool {
        dot(a, b) > F::ONE.ldexp(-2)
    }

    /// Differences are exact before they become floats.
    #[inline]
    fn blend([a, b, c]: Triple<i32>, u: F, v: F) -> i32 {
        let moved = F::from_i32(b - a) * u + F::from_i32(c - a) * v;
        (F::from_i32(a) + moved + F::ONE.ldexp(-1)).floor().to_i32()
    }

    #[inline]
    fn negate(unit: Triple<F>) -> Triple<F> {
        unit.map(|c| -c)
    }

    #[inline]
    fn aligned(a: Triple<F>, b: Triple<F>) -> bool {
        dot(a, b) >= F::ZERO
    }

    #[inline]
    fn cosine(a: Triple<F>, b: Triple<F>) -> Option<F> {
        let cosine = dot(a, b);
        // Unit vectors are units but for rounding.
        (cosine > F::ZERO).then_some(if cosine < F::ONE { cosine } else { F::ONE })
    }

    #[inline]
    fn reflect(along: Triple<F>, normal: Triple<F>) -> Triple<F> {
        let twice = dot(along, normal).ldexp(1);
        sub(along, scale(normal, twice))
    }

    #[inline]
    fn refract(along: Triple<F>, normal: Triple<F>, eta_q28: u32) -> Option<Triple<F>> {
        let eta = F::from_i64(eta_q28.into()).ldexp(-28);
        let cosine = -dot(along, normal);
        let square = F::ONE - eta * eta * (F::ONE - cosine * cosine);
        if square < F::ZERO {
            return None;
        }
        let behind = square.sqrt();
        Some(add(scale(along, eta), scale(normal, eta * cosine - behind)))
    }

    /// The middles of 2^32 heights, and of as many turns less an eighth. Above and below are kept apart: next to a pole the
    /// difference from 1 is all that there is.
    fn anywhere([height, turn]: [u32; 2]) -> Triple<F> {
        let number = |number: i64| F::from_i64(number).ldexp(-32);
        let odd = 2 * i64::from(height) + 1;
        let (below, above) = (number(odd), number((1 << 33) - odd));
        let across = (below * above).sqrt();
        let [cosine, sine] = number(2 * i64::from(turn) + 1 - (1 << 30)).on_circle();
        [across * cosine, across * sine, number(odd - (1 << 32))]
    }

    fn strewn(unit: Triple<F>, by: Triple<F>, share: u16) -> Option<Triple<F>> {
        normalise(add(unit, scale(by, F::from_i32(share.into()) / F::from_i32(65_535))))
    }

    #[inline]
    fn halfway(a: Triple<F>, b: Triple<F>) -> Option<Triple<F>> {
        normalise(add(a, b))
    }

    fn lobe(a: Triple<F>, b: Triple<F>, exponent_q2: u16) -> F {
        Self::cosine(a, b).map_or(F::ZERO, |cosine| cosine.pow(F::from_i32(exponent_q2.into()).ldexp(-2)))
    }

    #[inline]
    fn fresnel(cosine: F, r0: u16) -> F {
        let (x, r0) = (F::ONE - cosine, F::from_i32(r0.into()) / F::from_i32(65_535));
        let square = x * x;
        r0 + (F::ONE - r0) * (square * square * x)
    }

    fn faded(light: Triple<F>, from: Triple<F>, to: Triple<F>, reach: &Reach) -> Triple<F> {
        if reach.mantissa == 0 {
            return light;
        }
        let v = sub(to, from);
        let brighter = F::from_i32(reach.mantissa.into()).ldexp(reach.exponent.into()) / dot(v, v);
        let brightest = F::from_i32(BRIGHTEST as i32);
        scale(light, if brighter < brightest { brighter } else { brightest })
    }

    #[inline]
    fn altitude(unit: Triple<F>) -> [F; 2] {
        [F::ONE - unit[1], F::ONE + unit[1]].map(|share| share.ldexp(-1))
    }

    #[inline]
    fn longest(unit: Triple<F>) -> usize {
        let [x, y, z] = unit.map(|c| if c < F::ZERO { -c } else { c });
        if x >= y && x >= z { 0 } else { usize::from(y < z) + 1 }
    }

    fn is_odd(point: Triple<F>, across: usize, checker: &Checker) -> bool {
        let cubes = |q63: u64| F::from_i64((q63 >> 1) as i64).ldexp(-62);
        let step = cubes(checker.step_q63).ldexp(8);
        let parity = |axis: usize| {
            let raised = F::ONE.ldexp(if axis == across { -6 } else { -10 });
            let half = ((point[axis] * step + cubes(checker.start_q63[axis])) + raised).floor().ldexp(-1);
            half != half.floor()
        };
        parity(0) ^ parity(1) ^ parity(2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Space32 = FloatSpace<f32>;

    #[test]
    fn units_are_told_from_what_is_none() {
        assert!(Space32::is_unit(&[0.6, 0.0, -0.8]));
        assert!(Space32::is_unit(&[1.003, 0.0, 0.0]));
        for bad in [[1.005, 0.0, 0.0], [0.99, 0.0, 0.0], [0.0; 3], [f32::NAN, 0.0, 1.0], [f32::INFINITY, 0.0, 0.0]] {
            assert!(!Space32::is_unit(&bad), "{bad:?}");
        }
        let q30 = [644_245_094, 0, -858_993_459]; // 0.6, 0, -0.8
        assert_eq!(Space32::normal(q30), [0.6, 0.0, -0.8]);
    }

    #[test]
    fn cosines_are_positive_and_at_most_1() {
        assert_eq!(Space32::cosine([1.001, 0.0, 0.0], [1.0, 0.0, 0.0]), Some(1.0));
        assert_eq!(Space32::cosine([0.6, 0.8, 0.0], [1.0, 0.0, 0.0]), Some(0.6));
        assert_eq!(Space32::cosine([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]), None);
        assert!(Space32::aligned([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]));
    }

    #[test]
    fn normals_between_corners_and_none_where_they_cancel() {
        let normals = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]];
        assert_eq!(Space32::interpolate(normals, 1.0, 0.0), Some([0.0, 1.0, 0.0]));
        assert_eq!(Space32::interpolate(normals, 0.0, 0.5), None);
    }
}
