//! Shading's operations over the whole range of what they may be given, in every space, against f64 on the same inputs.

use std::fmt::Debug;

use core_rt::colour::{Colour, Radiance};
use core_rt::num::power;
use core_rt::record::{Checker, Reach};
use core_rt::space::{BRIGHTEST, Grid14, Grid29, GridQ31, Scalar, Space};
use fixed::types::U16F16;
use float_rt::FloatSpace;
use glam::DVec3;
use tests::random::SplitMix64;

use crate::within_tolerance;

type Float = FloatSpace<f32>;

/// How a space's numbers read.
trait Read: Space {
    const NAME: &'static str;
    /// Bits of a random number that count.
    const NUMBER_BITS: u32;
    /// Fractional bits of a point.
    const POINT_BITS: i32;
    /// Points are below 2 to this, in grid units.
    const GRID_BITS: u32;
    fn vector(unit: Self::Unit) -> DVec3;
    fn number(scalar: Scalar<Self>) -> f64;
    fn scalar(number: f64) -> Scalar<Self>;
    fn fraction(number: f64) -> Self::Fraction;
    fn weight(fraction: Self::Fraction) -> f64;
    fn place(point: Self::Point) -> DVec3;
    fn light(light: core_rt::space::Light<Self>) -> f64;
}

macro_rules! fixed_space {
    ($space:ty, $name:literal, $number_bits:literal, $point_bits:literal, $grid_bits:literal) => {
        impl Read for $space {
            const NAME: &'static str = $name;
            const NUMBER_BITS: u32 = $number_bits;
            const POINT_BITS: i32 = $point_bits;
            const GRID_BITS: u32 = $grid_bits;
            fn vector(unit: Self::Unit) -> DVec3 {
                DVec3::from_array(unit.map(|c| c.to_num()))
            }
            fn number(scalar: U16F16) -> f64 {
                scalar.to_num()
            }
            fn scalar(number: f64) -> U16F16 {
                U16F16::from_num(number)
            }
            fn fraction(number: f64) -> Self::Fraction {
                <Self as Space>::Fraction::from_num(number.min(0.999_99))
            }
            fn weight(fraction: Self::Fraction) -> f64 {
                fraction.to_num()
            }
            fn place(point: Self::Point) -> DVec3 {
                DVec3::from_array(point.map(|c| c as f64)) * libm::ldexp(1.0, -$point_bits)
            }
            fn light(light: Radiance) -> f64 {
                f64::from(light.mantissa[0]) * libm::ldexp(1.0, i32::from(light.exponent) - 16)
            }
        }
    };
}
fixed_space!(Grid14, "14", 16, 4, 15);
fixed_space!(Grid29, "29", 32, 8, 29);
fixed_space!(GridQ31, "Q31", 32, 8, 29);

impl Read for Float {
    const NAME: &'static str = "f32";
    const NUMBER_BITS: u32 = 32;
    const POINT_BITS: i32 = 0;
    const GRID_BITS: u32 = 24;
    fn vector(unit: [f32; 3]) -> DVec3 {
        DVec3::from_array(unit.map(f64::from))
    }
    fn number(scalar: f32) -> f64 {
        scalar.into()
    }
    fn scalar(number: f64) -> f32 {
        number as f32
    }
    fn fraction(number: f64) -> f32 {
        number as f32
    }
    fn weight(fraction: f32) -> f64 {
        fraction.into()
    }
    fn place(point: [f32; 3]) -> DVec3 {
        Self::vector(point)
    }
    fn light(light: [f32; 3]) -> f64 {
        light[0].into()
    }
}

/// A direction of any kind: along an axis, near one, in a plane of two, or any.
fn direction(random: &mut SplitMix64) -> DVec3 {
    let mut component = |kind: u64| match random.below(kind) {
        0 => 0.0,
        1 => random.within([-4, 4]) as f64 * 1e-4,
        _ => random.within([-1_000_000, 1_000_000]) as f64 / 1e6,
    };
    let kind = 4 + component(9).abs() as u64;
    let found = DVec3::new(component(kind), component(kind), component(kind));
    found.try_normalize().unwrap_or(DVec3::Y)
}

fn unit<S: Read>(v: DVec3) -> S::Unit {
    S::unit_from_q30(v.to_array().map(|c| (c * libm::ldexp(1.0, 30)).round() as i32))
}

/// The largest of `count` errors.
fn worst(count: usize, seed: u64, mut error: impl FnMut(&mut SplitMix64) -> Option<f64>) -> f64 {
    let mut random = SplitMix64(seed);
    (0..count).filter_map(|_| error(&mut random)).fold(0.0, f64::max)
}

fn reflections<S: Read>() -> f64 {
    worst(300_000, 1, |random| {
        let (d, n) = (unit::<S>(direction(random)), unit::<S>(direction(random)));
        let (v, w) = (S::vector(d), S::vector(n));
        let exact = v - w * (2.0 * v.dot(w));
        Some((S::vector(S::reflect(d, n)) - exact).abs().max_element())
    })
}

/// Errors are those of a square root, which is steep where it is small: so they are times the cosine behind.
fn refractions<S: Read>() -> f64 {
    worst(300_000, 2, |random| {
        let (d, n) = (unit::<S>(direction(random)), unit::<S>(direction(random)));
        let (v, w) = (S::vector(d).normalize(), S::vector(n).normalize());
        let n = if v.dot(w) > 0.0 { S::negate(n) } else { n };
        let w = if v.dot(w) > 0.0 { -w } else { w };
        let ior = libm::exp2(random.within([-3_320_000, 3_320_000]) as f64 / 1e6); // 1/10 to 10
        let eta_q28 = (ior * libm::ldexp(1.0, 28)) as u32;
        let eta = f64::from(eta_q28) * libm::ldexp(1.0, -28);
        let cosine = -v.dot(w);
        let square = 1.0 - eta * eta * (1.0 - cosine * cosine);
        // What is so near to the critical angle may go either way.
        let behind = libm::sqrt(square.max(1e-3));
        match S::refract(d, n, eta_q28) {
            None => (square > 1e-3).then_some(f64::INFINITY).filter(|_| square > 0.05),
            Some(_) if square < -0.05 => Some(f64::INFINITY),
            Some(_) if square < 1e-3 => None,
            Some(found) => {
                let exact = v * eta + w * (eta * cosine - behind);
                Some((S::vector(found) - exact).abs().max_element() * behind / eta.max(1.0).powi(2))
            }
        }
    })
}

/// Where two directions are nearly opposite, what is half way is little: errors are times the length of their mean.
fn halfways<S: Read>() -> f64 {
    worst(300_000, 3, |random| {
        let (a, b) = (unit::<S>(direction(random)), unit::<S>(direction(random)));
        let sum = S::vector(a) + S::vector(b);
        let found = S::halfway(a, b);
        if sum.length() < 1e-3 {
            return None;
        }
        Some((S::vector(found?) - sum.normalize()).abs().max_element() * sum.length() / 2.0)
    })
}

/// The point of the sphere that two random numbers mean: heights and turns in the middles of their steps.
fn anywhere(numbers: [u32; 2], bits: u32) -> DVec3 {
    let [height, turn] = numbers.map(|n| (f64::from(n >> (32 - bits)) + 0.5) * libm::ldexp(1.0, -(bits as i32)));
    let (sine, cosine) = libm::sincos(2.0 * std::f64::consts::PI * (turn - 0.125));
    let across = 2.0 * (height * (1.0 - height)).sqrt();
    DVec3::new(across * cosine, across * sine, 2.0 * height - 1.0)
}

/// Random numbers, often at an end: of all, or of a quarter of a turn.
fn numbers(random: &mut SplitMix64) -> [u32; 2] {
    [0; 2].map(|_| match random.below(4) {
        0 => (random.below(9) as u32).wrapping_sub(4),
        1 => (random.below(4) << 30) as u32 | (random.below(9) as u32).wrapping_sub(4) >> 2,
        _ => random.below(1 << 32) as u32,
    })
}

fn anywheres<S: Read>() -> f64 {
    worst(300_000, 10, |random| {
        let numbers = numbers(random);
        Some((S::vector(S::anywhere(numbers)) - anywhere(numbers, S::NUMBER_BITS)).abs().max_element())
    })
}

/// Where two directions nearly cancel, what is left is little: errors are times its length.
fn strewings<S: Read>() -> f64 {
    worst(300_000, 11, |random| {
        let (a, b) = (unit::<S>(direction(random)), S::anywhere(numbers(random)));
        let share = [0, 1, 0x7fff, 0x8000, u16::MAX, random.below(1 << 16) as u16][random.below(6) as usize];
        let sum = S::vector(a) + S::vector(b) * (f64::from(share) / 65_535.0);
        let found = S::strewn(a, b, share);
        if sum.length() < 1e-3 {
            return None;
        }
        Some((S::vector(found?) - sum.normalize()).abs().max_element() * sum.length())
    })
}

/// Between directions that are as far apart as the highlight is wide.
fn lobes<S: Read>(exponent: u16) -> f64 {
    worst(100_000, 4, |random| {
        let a = direction(random);
        let width = (3.0 / f64::from(exponent).sqrt()).min(2.0);
        let b = (a + direction(random) * (width * random.within([0, 1000]) as f64 / 1000.0)).try_normalize()?;
        let (a, b) = (unit::<S>(a), unit::<S>(b));
        let cosine = S::vector(a).normalize().dot(S::vector(b).normalize());
        let exact = libm::pow(cosine.max(0.0), exponent.into());
        Some((S::number(S::lobe(a, b, exponent * 4)) - exact).abs())
    })
}

fn reflectances<S: Read>() -> f64 {
    worst(300_000, 5, |random| {
        let cosine = S::scalar(random.within([0, 1 << 16]) as f64 / 65_536.0);
        let r0 = random.below(1 << 16) as u16;
        let (c, base) = (S::number(cosine), f64::from(r0) / 65_535.0);
        let exact = base + (1.0 - base) * libm::pow(1.0 - c, 5.0);
        Some((S::number(S::fresnel(cosine, r0)) - exact).abs())
    })
}

/// A grid point, as near to another as one likes.
fn grid_point<S: Read>(random: &mut SplitMix64) -> [i32; 3] {
    [0; 3].map(|_| random.within([0, (1 << S::GRID_BITS) - 1]) as i32)
}

/// Relative to what arrives.
fn fadings<S: Read>() -> f64 {
    worst(300_000, 6, |random| {
        let from = grid_point::<S>(random);
        let near = 1 << random.below(S::GRID_BITS.into());
        let to = from.map(|c| c + random.within([-near, near]) as i32);
        let reach =
            Reach { mantissa: (1 << 15 | random.below(1 << 15)) as u16, exponent: random.within([-10, 44]) as i16 };
        let radiance = Radiance { mantissa: [u16::MAX; 3], exponent: 0 };
        let light = S::Colour::light(&radiance);
        let distance = (S::place(S::point(to)) - S::place(S::point(from))).length_squared();
        let square = f64::from(reach.mantissa) * libm::ldexp(1.0, reach.exponent.into());
        let exact = (square / distance).min(BRIGHTEST.into()) * S::light(light);
        // What is so dim has not all its bits.
        let found = S::light(S::faded(light, S::point(from), S::point(to), &reach));
        (distance > 0.0 && exact > libm::ldexp(1.0, -14)).then(|| (found / exact - 1.0).abs())
    })
}

fn altitudes<S: Read>() -> f64 {
    worst(100_000, 7, |random| {
        let d = unit::<S>(direction(random));
        let y = S::vector(d).y;
        let [down, up] = S::altitude(d);
        Some((S::number(up) - (1.0 + y) / 2.0).abs().max((S::number(down) - (1.0 - y) / 2.0).abs()))
    })
}

/// How far from the side of a cube, in cubes, a point is told to be in the wrong one.
fn cubes<S: Read>() -> f64 {
    worst(300_000, 8, |random| {
        // Up to 2^11 of them along the grid.
        let bits = i64::from(S::GRID_BITS);
        let size = libm::exp2(random.within([(bits - 11) * 1000, bits * 1000]) as f64 / 1000.0);
        let step = libm::ldexp(1.0, 63) / (size * 256.0);
        let start = [0; 3].map(|_| random.below(1 << 20) << 44);
        let checker = Checker { step_q63: step as u64, start_q63: start, other: [0; 3], reserved: 0 };
        let (point, across) = (S::point(grid_point::<S>(random)), random.below(3) as usize);
        let place = S::place(point).to_array();
        let (mut odd, mut margin) = (false, 1.0_f64);
        for axis in 0..3 {
            let raised = if axis == across { 1.0 / 64.0 } else { 1.0 / 1024.0 };
            let cube = place[axis] / size + start[axis] as f64 / libm::ldexp(1.0, 63) + raised;
            odd ^= cube.floor() % 2.0 == 1.0;
            margin = margin.min((cube - cube.round()).abs());
        }
        (S::is_odd(point, across, &checker) != odd).then_some(margin)
    })
}

/// In units of the larger of the last place of the triangle's size and of a point.
fn lifts<S: Read>(bits: i32) -> f64 {
    worst(100_000, 9, |random| {
        let size = 1 << (3 + random.below(u64::from(S::GRID_BITS) - 5));
        let middle = grid_point::<S>(random).map(|c| c / 2 + (1 << (S::GRID_BITS - 2)));
        let corners = [0; 3].map(|_| middle.map(|c| c + random.within([-size, size]) as i32));
        let normals = [0; 3].map(|_| unit::<S>(direction(random)));
        let u = S::fraction(random.within([0, 1000]) as f64 / 1000.0);
        let v = S::fraction((1.0 - S::weight(u)).max(0.0) * random.within([0, 999]) as f64 / 1000.0);
        let weights = [1.0 - S::weight(u) - S::weight(v), S::weight(u), S::weight(v)];
        let point = S::point([0, 1, 2].map(|axis| {
            corners.iter().zip(weights).map(|(corner, w)| f64::from(corner[axis]) * w).sum::<f64>().round() as i32
        }));
        let mut exact = S::place(point);
        for ((corner, normal), weight) in corners.into_iter().zip(normals).zip(weights) {
            let normal = S::vector(normal);
            exact -= normal * (weight * (S::place(point) - S::place(S::point(corner))).dot(normal).min(0.0));
        }
        let range = [0, (1 << S::GRID_BITS) - 1].map(|c| S::point([c; 3]));
        let found = S::place(S::lift(point, corners.map(S::point), normals, [u, v], range));
        let exact = exact.clamp(DVec3::ZERO, S::place(range[1]));
        let unit = libm::ldexp(size as f64, -bits).max(libm::ldexp(1.0, -S::POINT_BITS));
        Some((found - exact).abs().max_element() / unit)
    })
}

fn all<S: Read>(bits: i32)
where
    S::Unit: Debug,
{
    let name = S::NAME;
    let in_units = |what: &str, bits: i32, measured: f64| {
        within_tolerance(&format!("{name} {what}, 2^-{bits}"), measured * libm::ldexp(1.0, bits));
    };
    in_units("reflect", bits, reflections::<S>());
    in_units("refract", bits, refractions::<S>());
    in_units("halfway", bits, halfways::<S>());
    in_units("anywhere", bits, anywheres::<S>());
    in_units("strewn", bits, strewings::<S>());
    for exponent in [1, 10, 100, 1000, 10_000] {
        in_units(&format!("lobe to {exponent}"), 16, lobes::<S>(exponent));
    }
    in_units("fresnel", 16, reflectances::<S>());
    in_units("faded", 16, fadings::<S>());
    in_units("altitude", 16, altitudes::<S>());
    in_units("cubes", 16, cubes::<S>());
    within_tolerance(&format!("{name} lift, units"), lifts::<S>(bits));
}

#[test]
fn of_14_bits() {
    all::<Grid14>(14);
}

#[test]
fn of_29_bits() {
    all::<Grid29>(30);
}

#[test]
fn of_the_2009_report() {
    all::<GridQ31>(30);
}

#[test]
fn of_f32() {
    all::<Float>(24);
}

/// The table's own error, where the lobes above have that of their directions too: relative, with 2^-16 that is always free.
#[test]
fn powers() {
    let mut worst = 0f64;
    for exponent in [0.25_f64, 0.5, 1.0, 2.0, 5.0, 10.0, 50.0, 96.25, 125.0, 1000.0, 4000.0, 10_000.0, 16_383.75] {
        let one = libm::ldexp(1.0, 30);
        // Dense where the highlight is, and over the whole range.
        let width = (8.0 / exponent).min(1.0) * one;
        let near = (0..2000).map(|i| (width * f64::from(i) / 2000.0) as u32);
        for versine in near.chain((0..2000).map(|i| i * ((1 << 30) / 2000))).filter(|&x| x < 1 << 30) {
            let found = f64::from(power(versine, (exponent * 4.0) as u16)) / 65_536.0;
            let exact = libm::pow(1.0 - f64::from(versine) / one, exponent);
            worst = worst.max(((found - exact).abs() - libm::ldexp(1.0, -16)) / exact.max(1e-300));
        }
    }
    within_tolerance("power, 2^-16", worst * libm::ldexp(1.0, 16));
}
