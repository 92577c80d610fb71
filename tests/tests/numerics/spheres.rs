//! Points and normals of spheres, and where rays start that leave them.

use core_rt::exact::{Exact, Ray, Width, Width14, Width20, Width29};
use core_rt::kernel::{Kernel, NONE, Surface};
use core_rt::num::Word;
use core_rt::space::Space;
use core_rt::sphere;
use ethnum::I256;
use tests::ball_rays::{balls, rays};
use tests::balls::Ball;
use tests::random::SplitMix64;

use crate::within_tolerance;

/// The true hit relative to the centre, grid units, from the kernel's t, n / a: with q(n) = n^2 + 2 b n + a c, the root is
/// q / 2 (n + b) below n, but for the square of that, and less than 1 in any case. All but the last steps are in whole numbers.
fn true_offset(ball: &Ball, origin: [i64; 3], direction: [i64; 3], n: i128, a: i128) -> [f64; 3] {
    let (n, a) = (I256::from(n), I256::from(a));
    let s = [0, 1, 2].map(|i| I256::from(origin[i] - ball.centre[i]));
    let d = direction.map(I256::from);
    let (mut b, mut c) = (I256::ZERO, -I256::from(ball.radius) * I256::from(ball.radius));
    for i in 0..3 {
        b += s[i] * d[i];
        c += s[i] * s[i];
    }
    let (q, slope) = (n * n + b * n * 2 + a * c, (n + b) * 2);
    let below = if slope == I256::ZERO { 0.0 } else { (q.as_f64() / slope.as_f64()).clamp(0.0, 1.0) };
    [0, 1, 2].map(|i| ((s[i] * a + d[i] * n).as_f64() - d[i].as_f64() * below) / a.as_f64())
}

/// The worst errors of points (grid units) and of normals' components (in units of the last place), of spheres of all sizes.
/// Every origin that stands off is on the side that it is to be on, without an exception.
fn resolved<W>(
    point: impl Fn(<W::Space as Space>::Point) -> [f64; 3],
    unit: impl Fn(<W::Space as Space>::Unit) -> [f64; 3],
    ulp: f64,
) -> [f64; 2]
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    let mut random = SplitMix64(17);
    let (mut worst, mut count) = ([0f64; 2], 0);
    for ball in balls::<Exact<W>>(&mut random, 2000) {
        let record = sphere::Ball { centre: ball.centre.map(|c| c as i32), radius: ball.radius as i32 };
        let record = Exact::<W>::sphere(&record, 0).expect("it fits");
        for (origin, direction) in rays::<Exact<W>>(&mut random, &[ball], 100) {
            let word = |v: [i64; 3]| v.map(|c| W::Word::from_i64(c).expect("rays fit the kernel"));
            let Some(ray) = Ray::<W>::new(word(origin), word(direction), NONE) else { continue };
            let Some(depth) = Exact::<W>::intersect_sphere(&ray, &record, false) else { continue };
            count += 1;
            let (origin, direction) = (ray.origin.map(Into::into), ray.direction.map(Into::into));
            let surface = Exact::<W>::resolve_sphere(&ray, &record);
            let offset = true_offset(&ball, origin, direction, depth.numerator.into(), depth.denominator.into());
            let side = if surface.front { 1.0 } else { -1.0 };
            let (found, normal) = (point(surface.point), unit(surface.normal));
            for axis in 0..3 {
                let exact = ball.centre[axis] as f64 + offset[axis];
                worst[0] = worst[0].max((found[axis] - exact).abs());
                worst[1] = worst[1].max((normal[axis] - side * offset[axis] / ball.radius as f64).abs() / ulp);
            }

            let square = |v: [i64; 3]| -> i128 { v.iter().map(|&c| i128::from(c) * i128::from(c)).sum() };
            let outside = |from: [i64; 3]| {
                square([0, 1, 2].map(|i| from[i] - ball.centre[i])).cmp(&(i128::from(ball.radius).pow(2))) as i32
            };
            let viewer = W::stand_off(&surface).map(Into::into);
            let behind = Surface { normal: <W::Space as Space>::negate(surface.normal), ..surface };
            let behind = W::stand_off(&behind).map(Into::into);
            assert_eq!([outside(viewer), outside(behind)], [side as i32, -side as i32], "{ball:?} {ray:?}");
        }
    }
    assert!(count > 60_000, "only {count} hits were looked at");
    worst
}

#[test]
fn exact14() {
    let q4 = |p: [i32; 3]| p.map(|c| f64::from(c) / 16.0);
    let [point, normal] = resolved::<Width14>(q4, |unit| unit.map(|c| c.to_num()), (2f64).powi(-14));
    within_tolerance("exact14 sphere point, grid units", point);
    within_tolerance("exact14 sphere normal, 2^-14", normal);
}

#[test]
fn exact20() {
    let q8 = |p: [i64; 3]| p.map(|c| c as f64 / 256.0);
    let [point, normal] = resolved::<Width20>(q8, |unit| unit.map(|c| c.to_num()), (2f64).powi(-30));
    within_tolerance("exact20 sphere point, grid units", point);
    within_tolerance("exact20 sphere normal, 2^-30", normal);
}

#[test]
fn exact29() {
    let q8 = |p: [i64; 3]| p.map(|c| c as f64 / 256.0);
    let [point, normal] = resolved::<Width29>(q8, |unit| unit.map(|c| c.to_num()), (2f64).powi(-30));
    within_tolerance("exact29 sphere point, grid units", point);
    within_tolerance("exact29 sphere normal, 2^-30", normal);
}
