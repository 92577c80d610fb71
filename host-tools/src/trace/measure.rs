//! What a kernel knows of a hit, as f64.

use core_rt::exact::{Exact, Width};
use core_rt::hanika::{Hanika, Variant};
use core_rt::kernel::Kernel;
use core_rt::num::{Triple, cross, sub};
use float_rt::{Float, Format};
use glam::DVec3;

/// A hit: its point is `origin + t direction` for the kernel's own ray, and `(1 - u - v) v0 + u v1 + v v2`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measured {
    /// In directions.
    pub t: f64,
    /// The direction as the kernel has it, grid units.
    pub direction: DVec3,
    /// The weight of the second vertex.
    pub u: f64,
    /// The weight of the third vertex.
    pub v: f64,
}

/// A kernel whose hits can be told in f64.
pub trait Measure: Kernel {
    /// The hit of a ray with a triangle; `None` where there is none.
    fn measure(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<Measured>;
    /// The hit of a ray with a sphere that it does not start on; `None` where there is none.
    fn measure_sphere(ray: &Self::Ray, sphere: &Self::Sphere) -> Option<Measured>;
}

/// Exact fractions, each within 3 roundings of f64.
impl<W: Width<Word: Into<i64>, Wide: Into<i128>>> Measure for Exact<W> {
    fn measure(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<Measured> {
        let depth = Self::intersect(ray, triangle)?;
        let [v0, v1, v2] = Self::vertices(triangle).map(|v| v.map(i64::from));
        let (e1, e2) = (sub(v1, v0), sub(v2, v0));
        let direction = ray.direction.map(Into::into);
        let r = cross(sub(ray.origin.map(Into::into), v0), direction);
        // U and V have the sign of the determinant, so the ratios are not negative.
        let ratio = |numerator: i128| numerator.abs() as f64 / depth.denominator.into() as f64;
        Some(Measured {
            t: ratio(depth.numerator.into()),
            direction: DVec3::from_array(direction.map(|c| c as f64)),
            u: ratio(dot(e2, r)),
            v: ratio(dot(e1, r)),
        })
    }

    fn measure_sphere(ray: &Self::Ray, sphere: &Self::Sphere) -> Option<Measured> {
        let depth = Self::intersect_sphere(ray, sphere, false)?;
        let direction = DVec3::from_array(ray.direction.map(|c| c.into() as f64));
        let (numerator, denominator): (i128, i128) = (depth.numerator.into(), depth.denominator.into());
        Some(Measured { t: numerator as f64 / denominator as f64, direction, u: 0.0, v: 0.0 })
    }
}

/// The sum of three products below 2^90.
fn dot(a: Triple<i64>, b: Triple<i64>) -> i128 {
    let product = |i: usize| i128::from(a[i]) * i128::from(b[i]);
    product(0) + product(1) + product(2)
}

/// What the kernel rounds to: `t` in whole grid units, the rest in Q31.
impl<V: Variant> Measure for Hanika<V> {
    fn measure(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<Measured> {
        let q31 = |value: i64| libm::ldexp(value as f64, -31);
        let t = Self::intersect(ray, triangle)?;
        let surface = Self::resolve(ray, triangle);
        Some(Measured {
            t: t.into(),
            direction: DVec3::from_array(ray.direction.map(q31)),
            u: q31(surface.u.to_bits().into()),
            v: q31(surface.v.to_bits().into()),
        })
    }

    fn measure_sphere(ray: &Self::Ray, sphere: &Self::Sphere) -> Option<Measured> {
        let t = Self::intersect_sphere(ray, sphere, false)?;
        let direction = DVec3::from_array(ray.direction.map(|c| libm::ldexp(c as f64, -31)));
        Some(Measured { t: t.into(), direction, u: 0.0, v: 0.0 })
    }
}

/// The kernel's own numbers.
impl<F: Format + Into<f64>> Measure for Float<F> {
    fn measure(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<Measured> {
        let t = Self::intersect(ray, triangle)?;
        let surface = Self::resolve(ray, triangle);
        Some(Measured {
            t: t.into(),
            direction: DVec3::from_array(ray.direction.map(Into::into)),
            u: surface.u.into(),
            v: surface.v.into(),
        })
    }

    fn measure_sphere(ray: &Self::Ray, sphere: &Self::Sphere) -> Option<Measured> {
        let t = Self::intersect_sphere(ray, sphere, false)?;
        Some(Measured { t: t.into(), direction: DVec3::from_array(ray.direction.map(Into::into)), u: 0.0, v: 0.0 })
    }
}
