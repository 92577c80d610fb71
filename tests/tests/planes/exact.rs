//! The text's algorithm in integers without a width, cut to words only where the text keeps a word.

use num::{BigInt, Integer, Signed, Zero};
use planes_rt::scene::{Outline, Settings, Sphere};

type Triple = [BigInt; 3];

/// What is met: the sphere, t in its fraction's unit, the point, and the direction in which the ray goes on.
pub(crate) type Meeting = (usize, BigInt, Triple, Triple);

/// A value in a word of so many bits with its sign.
fn word(value: BigInt, bits: u32) -> BigInt {
    let most = (BigInt::from(1) << (bits - 1)) - 1;
    if value > most {
        most
    } else if value < -most.clone() {
        -most
    } else {
        value
    }
}

fn dot(a: &Triple, b: &Triple) -> BigInt {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn each(f: impl Fn(usize) -> BigInt) -> Triple {
    [f(0), f(1), f(2)]
}

/// The largest integer whose square is no more, by halving.
fn root(value: &BigInt) -> BigInt {
    let (mut low, mut high) = (BigInt::zero(), value + 1);
    while &high - &low > BigInt::from(1) {
        let middle: BigInt = (&low + &high) / 2;
        if &middle * &middle <= *value { low = middle } else { high = middle }
    }
    low
}

/// The way of a ray.
pub(crate) fn way(spheres: &[Sphere], settings: &Settings, origin: [i16; 3], direction: [i16; 3]) -> Vec<Meeting> {
    let widths = settings.widths;
    let component = |value| word(value, widths.coordinate());
    let product = |value| word(value, widths.product());
    let fraction = BigInt::from(1) << widths.t_fraction();
    let half_up = |value: BigInt, unit: &BigInt| Integer::div_floor(&(value * 2 + unit), &(unit * 2));
    let (mut origin, mut direction) = (origin.map(BigInt::from), direction.map(BigInt::from));
    let mut way = Vec::new();
    for _ in 0..settings.generations {
        let a = product(dot(&direction, &direction));
        let mut best: Option<(usize, BigInt)> = None;
        for (number, sphere) in spheres.iter().enumerate() {
            let s = each(|axis| component(&origin[axis] - sphere.centre[axis]));
            let b = product(dot(&direction, &s));
            let c = product(dot(&s, &s) - BigInt::from(sphere.radius) * sphere.radius);
            let determinant: BigInt = &b * &b - &a * &c;
            if determinant.is_negative() || !b.is_negative() {
                continue;
            }
            let most = (BigInt::from(1) << widths.determinant()) - 1;
            let above = -b - root(&determinant.min(most));
            if above.is_negative() {
                continue;
            }
            let t = product(Integer::div_floor(&(above * &fraction), &a));
            if best.as_ref().is_none_or(|(_, least)| t <= *least) {
                best = Some((number, t));
                if settings.outline == Outline::Literal {
                    break;
                }
            }
        }
        let Some((number, t)) = best else { break };
        origin = each(|axis| component(&origin[axis] + half_up(&t * &direction[axis], &fraction)));
        let normal = each(|axis| component(&origin[axis] - spheres[number].centre[axis]));
        let square = product(dot(&normal, &normal)).max(1.into());
        let unit = BigInt::from(1) << (widths.coordinate() - 1);
        // Towards zero, as division of integers is.
        let quotient = product(dot(&direction, &normal)) * 2 * &unit / square;
        direction = each(|axis| component(&direction[axis] - half_up(&quotient * &normal[axis], &unit)));
        way.push((number, t, origin.clone(), direction.clone()));
    }
    way
}
