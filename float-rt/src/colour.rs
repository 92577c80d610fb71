//! Linear light in floats, and its way to bytes.

use core_rt::colour::{Albedo, Colour, Radiance, Rgb888, Transfer};
use core_rt::num::Triple;

use crate::real::Real;
use crate::vector::{add, scale};

/// Linear RGB; 1 is white.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RgbF<F>(pub Triple<F>);

impl<F: Real> Colour for RgbF<F> {
    type Cosine = F;
    type Light = Triple<F>;

    /// The mantissa and the power of two are exact.
    #[inline]
    fn light(radiance: &Radiance) -> Triple<F> {
        let unit = F::ONE.ldexp(i32::from(radiance.exponent) - 16);
        radiance.mantissa.map(|mantissa| F::from_i32(mantissa.into()) * unit)
    }

    fn tinted(light: Triple<F>, tint: &Albedo) -> Triple<F> {
        Self(light).reflected(tint).0
    }

    #[inline]
    fn constant(radiance: &Radiance) -> Self {
        Self(Self::light(radiance))
    }

    #[inline]
    fn lit(light: &Triple<F>, cosine: F) -> Self {
        Self(scale(*light, cosine))
    }

    /// Saturates by itself: sums of lights are far from the end of the exponents.
    #[inline]
    fn plus(self, other: Self) -> Self {
        Self(add(self.0, other.0))
    }

    /// A division and not a product with 1 / 65535: white gives back all.
    #[inline]
    fn reflected(self, albedo: &Albedo) -> Self {
        let channel = |light: F, albedo: u16| light * (F::from_i32(albedo.into()) / F::from_i32(65_535));
        let ([r, g, b], [kr, kg, kb]) = (self.0, *albedo);
        Self([channel(r, kr), channel(g, kg), channel(b, kb)])
    }

    #[inline]
    fn doubled(self, times: u32) -> Self {
        Self(self.0.map(|light| light.ldexp(times.min(15) as i32)))
    }

    #[inline]
    fn share(part: F) -> u16 {
        (part * F::from_i32(65_535) + F::ONE.ldexp(-1)).to_i32().clamp(0, 65_535) as u16
    }

    fn encode(self, transfer: Transfer) -> Rgb888 {
        self.clamped().0.map(|light| byte(light, transfer))
    }

    fn encode_gray(self, transfer: Transfer) -> u8 {
        let weight = |weight: i32| F::from_i32(weight) / F::from_i32(10_000);
        let [r, g, b] = self.clamped().0;
        byte(r * weight(2126) + g * weight(7152) + b * weight(722), transfer)
    }

    #[inline]
    fn clamped(self) -> Self {
        Self(self.0.map(|light| if light < F::ONE { light } else { F::ONE }))
    }

    fn to_q16(self) -> [u32; 3] {
        self.clamped().0.map(|light| (light.ldexp(16) + F::ONE.ldexp(-1)).to_i32().max(0) as u32)
    }

    fn from_q16(light: [u32; 3]) -> Self {
        Self(light.map(|light| F::from_i64(light.into()).ldexp(-16)))
    }

    #[inline]
    fn mean(self, samples: u16) -> Self {
        let samples = F::from_i32(samples.max(1).into());
        Self(self.0.map(|sum| sum / samples))
    }
}

/// Light up to 1 as a byte, rounded to nearest.
fn byte<F: Real>(light: F, transfer: Transfer) -> u8 {
    let encoded = match transfer {
        Transfer::Srgb => srgb(light),
        Transfer::Linear => light,
    };
    // The conversion truncates, and takes what is negative for 0.
    (encoded * F::from_i32(255) + F::ONE.ldexp(-1)).to_u8()
}

/// The curve of IEC 61966-2-1 for light up to 1, by its formula: a table of thresholds would be faster by far on a chip,
/// and would be the integer kernels' way.
fn srgb<F: Real>(light: F) -> F {
    let ratio = |numerator: i32, denominator: i32| F::from_i32(numerator) / F::from_i32(denominator);
    if light <= ratio(31_308, 10_000_000) {
        light * ratio(1292, 100)
    } else {
        light.pow(ratio(10, 24)) * ratio(1055, 1000) - ratio(55, 1000)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn byte<F: Real>(light: F, transfer: Transfer) -> u8 {
        let [r, g, b] = RgbF([light; 3]).encode(transfer);
        assert!(r == g && g == b);
        r
    }

    /// The standard's inverse of a byte and a part.
    fn linear(byte: f64) -> f64 {
        let encoded = byte / 255.0;
        if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
    }

    #[test]
    fn srgb_turns_half_way_between_bytes() {
        for i in 0..=255u8 {
            let exact = f64::from(i);
            assert_eq!((byte(linear(exact) as f32, Transfer::Srgb), byte(linear(exact), Transfer::Srgb)), (i, i));
            if i < 255 {
                for (step, expected) in [(0.4999, i), (0.5001, i + 1)] {
                    let light = linear(exact + step);
                    assert_eq!(byte(light as f32, Transfer::Srgb), expected, "{i} + {step} in f32");
                    assert_eq!(byte(light, Transfer::Srgb), expected, "{i} + {step} in f64");
                }
            }
        }
    }

    #[test]
    fn pixels_clamp_and_round() {
        for transfer in [Transfer::Srgb, Transfer::Linear] {
            assert_eq!((byte(7e4f32, transfer), byte(1.0f32, transfer), byte(0.0f32, transfer)), (255, 255, 0));
        }
        assert_eq!((byte(0.5f64, Transfer::Linear), byte(127.49 / 255.0, Transfer::Linear)), (128, 127));
        assert_eq!((byte(0.5f64, Transfer::Srgb), byte(0.18f64, Transfer::Srgb)), (188, 118));
    }

    #[test]
    fn light_is_exact_at_both_ends_of_its_range() {
        let brightest = Radiance { mantissa: [u16::MAX; 3], exponent: 15 };
        let dimmest = Radiance { mantissa: [1 << 15; 3], exponent: -15 };
        assert_eq!(RgbF::constant(&brightest), RgbF([32_767.5f32; 3]));
        assert_eq!(RgbF::constant(&dimmest), RgbF([1.0f32 / 65_536.0; 3]));
        assert_eq!(RgbF::lit(&RgbF::light(&brightest), 0.5), RgbF([16_383.75f32; 3]));
    }

    #[test]
    fn white_reflects_all_and_black_nothing() {
        let light = RgbF([0.1f32, 3.0, 12_345.678]);
        assert_eq!(light.reflected(&[u16::MAX; 3]), light);
        assert_eq!(light.reflected(&[0; 3]), RgbF([0.0; 3]));
        assert_eq!(RgbF([1.0f64; 3]).reflected(&[13_107; 3]), RgbF([0.2; 3]));
    }
}
