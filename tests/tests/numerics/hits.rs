//! What a hit is resolved to: depth, fractions, point, and an origin that stands off.

use core_rt::exact::{Exact, Ray, Width, Width14, Width20, Width29};
use core_rt::kernel::{Kernel, NONE};
use core_rt::num::Word;
use core_rt::space::Space;
use tests::meshes;
use tests::random::SplitMix64;
use tests::rays::{self, Rays};

use crate::within_tolerance;

/// Real hits, through the kernel's own rays: what `depth`, `fraction` and `point` may be given.
pub(crate) fn hits<W>(count: usize, mut visit: impl FnMut(&Ray<W>, [[i64; 3]; 3], &<Exact<W> as Kernel>::Triangle))
where
    W: Width<Word: Into<i64>>,
{
    for (seed, (_, mesh)) in (1..).zip(meshes::all(W::GRID_BITS)) {
        let last = (1i64 << W::GRID_BITS) - 1 - i64::from(W::MARGIN);
        let mesh: Vec<_> = mesh.iter().map(|t| t.map(|v| v.map(|c| c.clamp(W::MARGIN.into(), last)))).collect();
        let bounds = rays::Bounds {
            grid_bits: W::GRID_BITS,
            origin: [0, (1 << W::GRID_BITS) - 1],
            direction: (1 << W::DIRECTION_BITS) - 1,
        };
        let mut random = SplitMix64(seed);
        for (_, ray) in Rays::new(&mesh, bounds, seed).take(count) {
            // Few triangles are hit by a given ray: take one that the ray was aimed near by trying several.
            for _ in 0..4 {
                let corners = mesh[random.below(mesh.len() as u64) as usize];
                let word = |v: [i64; 3]| v.map(|c| W::Word::from_i64(c).expect("in range"));
                let (Some(triangle), Some(ray)) = (
                    Exact::<W>::triangle((), &corners.map(|v| v.map(|c| c as i32)), 0),
                    Ray::<W>::new(word(ray.origin), word(ray.direction), NONE),
                ) else {
                    continue;
                };
                if Exact::<W>::intersect(&ray, &triangle).is_some() {
                    visit(&ray, corners, &triangle);
                }
            }
        }
    }
}

/// What f64 makes of t, u, v; exact enough beside 14 bits, and beside 29 because the sums are exact in i128.
pub(crate) fn exactly(ray: [[i64; 3]; 2], [v0, v1, v2]: [[i64; 3]; 3]) -> (f64, f64, f64) {
    let sub = |a: [i64; 3], b: [i64; 3]| [0, 1, 2].map(|i| i128::from(a[i] - b[i]));
    let cross =
        |a: [i128; 3], b: [i128; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [i128; 3], b: [i128; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (e1, e2, s) = (sub(v1, v0), sub(v2, v0), sub(ray[0], v0));
    let d = ray[1].map(i128::from);
    let (n, r) = (cross(e1, e2), cross(s, d));
    let det = -dot(d, n);
    let over = |a: i128| a as f64 / det as f64;
    (over(dot(s, n)), over(dot(e2, r)), over(-dot(e1, r)))
}

/// The worst errors of depth (in 2^-T_BITS), of fractions (in 2^-bits), of points (in grid units), and whether every origin
/// that stands off is on the side of the surface that the ray came from.
fn resolved<W>(
    fraction: impl Fn(<W::Space as Space>::Fraction) -> f64,
    fraction_bits: i32,
    point: impl Fn(<W::Space as Space>::Point) -> [f64; 3],
) -> [f64; 3]
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    let mut worst = [0f64; 3];
    let mut count = 0;
    hits::<W>(60_000, |ray, corners, triangle| {
        count += 1;
        let (origin, direction) = (ray.origin.map(Into::into), ray.direction.map(Into::into));
        let (t, u, v) = exactly([origin, direction], corners);
        let depth = Exact::<W>::intersect(ray, triangle).expect("a hit");
        let approximate: i64 = W::depth(depth.numerator, depth.denominator).into();
        worst[0] = worst[0].max((approximate as f64 - t * (2f64).powi(W::T_BITS as i32)).abs());

        let surface = Exact::<W>::resolve(ray, triangle);
        for (found, exact) in [(fraction(surface.u), u), (fraction(surface.v), v)] {
            assert!((0.0..=1.0).contains(&found));
            worst[1] = worst[1].max((found - exact).abs() * (2f64).powi(fraction_bits));
        }
        let found = point(surface.point);
        for axis in 0..3 {
            let exact = origin[axis] as f64 + t * direction[axis] as f64;
            worst[2] = worst[2].max((found[axis] - exact).abs());
        }

        // N . (o' - v0) has the sign of N . (o - v0), or of -N . D where the ray starts in the plane.
        let start: [i64; 3] = W::stand_off(&surface).map(Into::into);
        let side = |from: [i64; 3]| -> i128 {
            let sub = |a: [i64; 3], b: [i64; 3]| [0, 1, 2].map(|i| i128::from(a[i]) - i128::from(b[i]));
            let (e1, e2, s) = (sub(corners[1], corners[0]), sub(corners[2], corners[0]), sub(from, corners[0]));
            (e1[1] * e2[2] - e1[2] * e2[1]) * s[0]
                + (e1[2] * e2[0] - e1[0] * e2[2]) * s[1]
                + (e1[0] * e2[1] - e1[1] * e2[0]) * s[2]
        };
        assert!(side(start).signum() == side(origin).signum(), "{start:?} is not in front of {corners:?}");
    });
    assert!(count > 20_000, "only {count} hits were looked at");
    worst
}

#[test]
fn resolved_hits_of_exact14() {
    let q4 = |p: [i32; 3]| p.map(|c| f64::from(c) / 16.0);
    let [depth, fraction, point] = resolved::<Width14>(|f| f.to_num(), 14, q4);
    within_tolerance("exact14 depth, 2^-13", depth);
    within_tolerance("exact14 fraction, 2^-14", fraction);
    within_tolerance("exact14 point, grid units", point);
}

#[test]
fn resolved_hits_of_exact29() {
    let q8 = |p: [i64; 3]| p.map(|c| c as f64 / 256.0);
    let [depth, fraction, point] = resolved::<Width29>(|f| f.to_num(), 30, q8);
    within_tolerance("exact29 depth, 2^-31", depth);
    within_tolerance("exact29 fraction, 2^-30", fraction);
    within_tolerance("exact29 point, grid units", point);
}

#[test]
fn resolved_hits_of_exact20() {
    let q8 = |p: [i64; 3]| p.map(|c| c as f64 / 256.0);
    let [depth, fraction, point] = resolved::<Width20>(|f| f.to_num(), 30, q8);
    within_tolerance("exact20 depth, 2^-41", depth);
    within_tolerance("exact20 fraction, 2^-30", fraction);
    within_tolerance("exact20 point, grid units", point);
}
