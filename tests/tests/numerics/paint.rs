//! Texture coordinates between corners, and light between texels.

use core_rt::exact::{Exact, Width14};
use core_rt::kernel::Kernel;
use core_rt::space::{Grid14, Grid29, GridQ31, Space};
use core_rt::texture::{LARGEST_SIDE, Texture, UV_BITS, UV_END};
use fixed::FixedI32;
use fixed::types::I2F14;
use fixed::types::extra::{U30, U31};
use tests::random::SplitMix64;

use super::within_tolerance;
use crate::hits::{exactly, hits};

/// Numbers at corners, of any magnitude below the end, close together or far apart.
fn corners(random: &mut SplitMix64) -> [i32; 3] {
    let last = i64::from(UV_END) - 1;
    let base = random.within([0, last]);
    let spread = 1 << random.within([0, 30]);
    [0; 3].map(|_| match random.below(6) {
        0 => last as i32,
        1 => 0,
        _ => (base + random.within([-spread, spread])).clamp(0, last) as i32,
    })
}

/// The largest error of a blend, by what it may be for a span; `fraction_bits` are those of the weights.
fn blend_error(fraction_bits: u32, allowed: impl Fn(f64) -> f64, blend: impl Fn([i32; 3], i64, i64) -> i32) -> f64 {
    let mut random = SplitMix64(3);
    let one = 1i64 << fraction_bits;
    let mut worst = 0f64;
    for _ in 0..1_000_000 {
        let corners = corners(&mut random);
        let u = if random.below(8) == 0 { 0 } else { random.within([0, one - 1]) };
        let v = if random.below(8) == 0 { one - 1 - u } else { random.within([0, one - 1 - u]) };
        let [a, b, c] = corners.map(i128::from);
        // Exact, in the weights' fractions of a unit.
        let exact = a * i128::from(one) + (b - a) * i128::from(u) + (c - a) * i128::from(v);
        let found = i128::from(blend(corners, u, v)) * i128::from(one);
        let span = (b - a).unsigned_abs().max((c - a).unsigned_abs()) as f64;
        worst = worst.max((found - exact) as f64 / one as f64 / allowed(span));
        worst = worst.max((exact - found) as f64 / one as f64 / allowed(span));
    }
    worst
}

#[test]
fn numbers_between_corners() {
    let worst = blend_error(
        14,
        |span| 0.5 + span / 32_768.0,
        |corners, u, v| Grid14::blend(corners, I2F14::from_bits(u as i16), I2F14::from_bits(v as i16)),
    );
    within_tolerance("Grid14 blend, 0.5 and 2^-15 of the span", worst);
    let worst = blend_error(
        30,
        |_| 1.0,
        |corners, u, v| Grid29::blend(corners, FixedI32::<U30>::from_bits(u as i32), FixedI32::from_bits(v as i32)),
    );
    within_tolerance("Grid29 blend, units", worst);
    let worst = blend_error(
        31,
        |_| 1.0,
        |corners, u, v| GridQ31::blend(corners, FixedI32::<U31>::from_bits(u as i32), FixedI32::from_bits(v as i32)),
    );
    within_tolerance("GridQ31 blend, units", worst);
}

/// The largest weights that rounding can make, where overflow would be trapped.
#[test]
fn weights_beyond_the_edges() {
    let (zero, last) = (0, UV_END - 1);
    for corners in [[zero, last, last], [last, zero, zero], [last, zero, last]] {
        for (u, v) in [(1 << 14, 0), (0, 1 << 14), (1 << 13, (1 << 13) + 8), (1 << 14, 1 << 14)] {
            Grid14::blend(corners, I2F14::from_bits(u as i16), I2F14::from_bits(v as i16));
        }
        for (u, v) in [(1 << 30, 0), (1 << 30, 1 << 30), (i32::MAX, i32::MAX), (i32::MIN, i32::MIN)] {
            Grid29::blend(corners, FixedI32::<U30>::from_bits(u), FixedI32::from_bits(v));
            GridQ31::blend(corners, FixedI32::<U31>::from_bits(u), FixedI32::from_bits(v));
        }
    }
}

/// Weights and their blend together, of real hits: a texture of n texels across a triangle is off by so many n 2^-14.
#[test]
fn texture_coordinates_of_hits() {
    let mut worst = 0f64;
    hits::<Width14>(20_000, |ray, corners, triangle| {
        let (origin, direction) = (ray.origin.map(i64::from), ray.direction.map(i64::from));
        let (_, u, v) = exactly([origin, direction], corners);
        let surface = Exact::<Width14>::resolve(ray, triangle);
        let span = 1 << 28;
        for [a, b, c] in [[0, span, 0], [0, 0, span], [span, 0, 0], [0, span, span]] {
            let exact = f64::from(a) + f64::from(b - a) * u + f64::from(c - a) * v;
            let found = f64::from(Grid14::blend([a, b, c], surface.u, surface.v));
            worst = worst.max((found - exact).abs() * 16_384.0 / f64::from(span));
        }
    });
    within_tolerance("exact14 texture coordinate, 2^-14 of the span", worst);
}

/// The inverse of IEC 61966-2-1's curve.
fn light(byte: u8) -> f64 {
    let encoded = f64::from(byte) / 255.0;
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

#[test]
fn bytes_of_textures_are_srgb_rounded_to_nearest() {
    let texels: Vec<u8> = (0..=255).collect();
    let gray = Texture { size: [256, 1], format: Texture::GRAY8, ..Texture::default() };
    for byte in 0..=255u8 {
        let uv = [(i32::from(byte) << (UV_BITS - 8)) + 5, 0];
        let expected = (light(byte) * 65_535.0).round() as u16;
        assert_eq!(gray.look_up(&texels, uv, false), Some([expected; 3]), "{byte}");
    }
}

#[test]
fn light_between_texels() {
    let mut random = SplitMix64(11);
    let mut worst = 0f64;
    for side in [[1, 1], [2, 3], [64, 64], [5, LARGEST_SIDE], [LARGEST_SIDE, 2]] {
        let [width, height] = side.map(usize::from);
        // Extremes beside each other: there the slope is steepest.
        let texels: Vec<u8> = (0..width * height)
            .map(|i| if i % 2 == 0 { 255 } else { [0, random.below(256) as u8][i / 2 % 2] })
            .collect();
        let texture = Texture { size: side, format: Texture::GRAY8, ..Texture::default() };
        for _ in 0..200_000 {
            let uv = [0; 2].map(|_| random.within([-1 << UV_BITS, 1 << 26]) as i32);
            let [found, ..] = texture.look_up(&texels, uv, true).expect("a texel");
            let place = |c: i32, side: usize| {
                let place = f64::from(c) / f64::from(1 << UV_BITS) * side as f64 - 0.5;
                let low = place.floor();
                let at = |step: i64| (low as i64 + step).rem_euclid(side as i64) as usize;
                (at(0), at(1), place - low)
            };
            let ((x0, x1, s), (y0, y1, t)) = (place(uv[0], width), place(uv[1], height));
            let at = |x: usize, y: usize| light(texels[y * width + x]);
            let row = |y: usize| at(x0, y) * (1.0 - s) + at(x1, y) * s;
            let exact = row(y0) * (1.0 - t) + row(y1) * t;
            worst = worst.max((f64::from(found) - exact * 65_535.0).abs());
        }
    }
    within_tolerance("bilinear texture, 2^-16", worst);
}
