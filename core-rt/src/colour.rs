//! Linear light in Q16.16 (the 2009 report's Table 1), saturating, and its way to bytes.
//!
//! Sums saturate at 65535.99998 instead of wrapping. Products of two unsigned 16-bit factors stay in 32 bits,
//! so that no 64-bit product is needed on a Cortex-M0.

use fixed::types::U16F16;
use serde::{Deserialize, Serialize};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::num::Triple;
use crate::srgb;

/// A pixel: red, green, blue, 8 bits each.
pub type Rgb888 = [u8; 3];

/// How linear light in [0, 1] becomes a byte.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Transfer {
    /// IEC 61966-2-1.
    Srgb,
    /// In proportion.
    Linear,
}

/// Light of any strength from 2^-31 to nearly 2^15: `mantissa * 2^exponent / 2^16`, linear RGB.
///
/// One exponent for three mantissas: a product with a cosine is one 32-bit multiplication.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, FromBytes, IntoBytes, Immutable, KnownLayout,
)]
#[repr(C)]
pub struct Radiance {
    /// Mantissas; the host makes the largest of them at least 2^15 where the exponent allows it.
    pub mantissa: [u16; 3],
    /// In `EXPONENTS`.
    pub exponent: i16,
}

impl Radiance {
    /// The exponents that are allowed; a product then shifts right by 1 to 31 bits.
    pub const EXPONENTS: core::ops::RangeInclusive<i16> = -15..=15;

    /// Whether this adds nothing.
    #[must_use]
    pub fn is_black(&self) -> bool {
        self.mantissa == [0; 3]
    }

    /// What a surface lets through of it; within half a unit of the mantissa.
    #[inline]
    #[must_use]
    pub fn tinted(self, tint: &Albedo) -> Self {
        let [r, g, b] = self.mantissa;
        Self { mantissa: [rounded(r, tint[0]), rounded(g, tint[1]), rounded(b, tint[2])], ..self }
    }

    /// Times `factor_q16 * 2^exponent`, the factor in [1/2, 1). Each channel is within a unit of the mantissa, or of 2^-31
    /// where the exponent cannot follow; it saturates.
    #[inline]
    #[must_use]
    pub fn times(self, factor_q16: u16, exponent: i32) -> Self {
        let (least, most) = (i32::from(*Self::EXPONENTS.start()), i32::from(*Self::EXPONENTS.end()));
        let wanted = i32::from(self.exponent).saturating_add(exponent);
        let exponent = wanted.clamp(least, most);
        let mantissa = self.mantissa.map(|mantissa| {
            // At most 2^32 - 2^17 + 1 before the rounding.
            let product = (u32::from(mantissa) * u32::from(factor_q16) + (1 << 15)) >> 16;
            // One of the two shifts is by nothing.
            let dimmer = exponent.saturating_sub(wanted).clamp(0, 17) as u32;
            let brighter = wanted.saturating_sub(exponent).clamp(0, 16) as u32;
            (((product + (1 << dimmer >> 1)) >> dimmer) << brighter).min(u16::MAX.into()) as u16
        });
        Self { mantissa, exponent: exponent as i16 }
    }
}

/// `a b / 65535`, as [`product`], to nearest: 65535 2^16 + 2^15 fits.
#[inline(always)]
fn rounded(a: u16, b: u16) -> u16 {
    ((u32::from(a) * (u32::from(b) + u32::from(b >> 15)) + (1 << 15)) >> 16) as u16
}

/// Diffuse reflectance, linear RGB: `value / 65535`, up to 1.
pub type Albedo = [u16; 3];

/// All of the light.
pub const WHITE: Albedo = [u16::MAX; 3];

/// The reflectance of two surfaces, one after the other; within a unit, low, and white changes nothing.
#[inline]
#[must_use]
pub fn product(a: &Albedo, b: &Albedo) -> Albedo {
    let channel = |a: u16, b: u16| ((u32::from(a) * (u32::from(b) + u32::from(b >> 15))) >> 16) as u16;
    [channel(a[0], b[0]), channel(a[1], b[1]), channel(a[2], b[2])]
}

/// A reflectance on the way to white: `albedo + (1 - albedo) share`.
#[inline]
#[must_use]
pub fn towards_white(albedo: &Albedo, share: u16) -> Albedo {
    albedo.map(|channel| channel + rounded(u16::MAX - channel, share))
}

/// What shading needs of a colour. The integer spaces share [`Rgb16`]; a float space brings its own.
pub trait Colour: Copy + Default + core::fmt::Debug {
    /// The cosine of an angle of incidence, in [0, 1].
    type Cosine: Copy + Default + core::fmt::Debug;
    /// Light on its way from a lamp.
    type Light: Copy + core::fmt::Debug;
    /// Light as it leaves a lamp.
    fn light(radiance: &Radiance) -> Self::Light;
    /// What glass leaves of it.
    fn tinted(light: Self::Light, tint: &Albedo) -> Self::Light;
    /// Light as it stands in the blob.
    fn constant(radiance: &Radiance) -> Self;
    /// Light that arrives under an angle.
    fn lit(light: &Self::Light, cosine: Self::Cosine) -> Self;
    /// The sum, saturating.
    fn plus(self, other: Self) -> Self;
    /// What a surface of this reflectance gives back.
    fn reflected(self, albedo: &Albedo) -> Self;
    /// Twice the light so many times over, saturating. At most 15 times.
    fn doubled(self, times: u32) -> Self;
    /// A share of light as an [`Albedo`]'s channel.
    fn share(part: Self::Cosine) -> u16;
    /// The pixel: clamped to 1, rounded to nearest.
    fn encode(self, transfer: Transfer) -> Rgb888;
    /// The pixel's luminance, after ITU-R BT.709, of the clamped channels in linear light: encoded, rounded to nearest.
    fn encode_gray(self, transfer: Transfer) -> u8;
    /// The light that a picture shows: at most 1.
    fn clamped(self) -> Self;
    /// Of the sum of so many samples, each [clamped](Colour::clamped), the mean. At least one.
    fn mean(self, samples: u16) -> Self;
    /// What a picture shows of it, in Q16, rounded to nearest: whole numbers, whose sums do not depend on their order.
    fn to_q16(self) -> [u32; 3];
    /// From Q16, any.
    fn from_q16(light: [u32; 3]) -> Self;
}

/// Linear RGB in Q16.16.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Rgb16(pub Triple<U16F16>);

impl Colour for Rgb16 {
    type Cosine = U16F16;
    type Light = Radiance;

    #[inline]
    fn light(radiance: &Radiance) -> Radiance {
        *radiance
    }

    #[inline]
    fn tinted(light: Radiance, tint: &Albedo) -> Radiance {
        light.tinted(tint)
    }

    #[inline]
    fn constant(radiance: &Radiance) -> Self {
        Self::lit(radiance, U16F16::ONE)
    }

    /// `mantissa cosine` is at most 65535 * 65536 < 2^32 in Q32 of the scaled light; the shift, in 1..=31 by
    /// [`Radiance::EXPONENTS`], brings it to Q16. Rounded to nearest: a truncated sum would darken.
    #[cfg_attr(not(prefer_size), inline)]
    #[cfg_attr(prefer_size, inline(never))]
    fn lit(radiance: &Radiance, cosine: U16F16) -> Self {
        // Negative exponents down to -15 and positive ones up to 15, so no shift is out of range.
        let shift = (16 - i32::from(radiance.exponent)).clamp(1, 31) as u32;
        let cosine_q16 = cosine.to_bits().min(1 << 16);
        Self(radiance.mantissa.map(|mantissa| {
            let light_q32 = u32::from(mantissa) * cosine_q16;
            U16F16::from_bits((light_q32 >> shift) + ((light_q32 >> (shift - 1)) & 1))
        }))
    }

    #[inline]
    fn plus(self, other: Self) -> Self {
        let ([a, b, c], [d, e, f]) = (self.0, other.0);
        Self([a.saturating_add(d), b.saturating_add(e), c.saturating_add(f)])
    }

    /// `light * albedo / 65535`, by two 16-bit halves. The albedo is widened to [0, 2^16] first (65535 becomes 1),
    /// so that white gives back all. Within one unit of 2^-16, low.
    #[inline]
    fn reflected(self, albedo: &Albedo) -> Self {
        let channel = |light: U16F16, albedo: u16| {
            let light = light.to_bits();
            let albedo_q16 = u32::from(albedo) + u32::from(albedo >> 15);
            // High half: below 2^16 * 2^16 / 2^16 after the shift that the format asks for; it cannot carry out,
            // since albedo <= 1.
            let low = ((light & 0xffff) * (albedo_q16 >> 1)) >> 15;
            U16F16::from_bits((light >> 16) * albedo_q16 + low)
        };
        let ([r, g, b], [kr, kg, kb]) = (self.0, *albedo);
        Self([channel(r, kr), channel(g, kg), channel(b, kb)])
    }

    #[inline]
    fn doubled(self, times: u32) -> Self {
        let times = times.min(15);
        Self(self.0.map(|light| U16F16::from_bits(light.to_bits().min(u32::MAX >> times) << times)))
    }

    #[inline]
    fn share(part: U16F16) -> u16 {
        part.to_bits().min(0xffff) as u16
    }

    fn encode(self, transfer: Transfer) -> Rgb888 {
        self.clamped().0.map(|light| byte(light.to_bits(), transfer))
    }

    /// Weights in Q15, which sum to 1: the sum is at most 2^31, and what was gray stays as it is.
    fn encode_gray(self, transfer: Transfer) -> u8 {
        let [r, g, b] = self.clamped().0.map(U16F16::to_bits);
        byte((r * 6966 + g * 23_436 + b * 2366 + (1 << 14)) >> 15, transfer)
    }

    #[inline]
    fn clamped(self) -> Self {
        Self(self.0.map(|light| light.min(U16F16::ONE)))
    }

    /// Rounded to nearest, halves up. The sum of 2^16 - 1 samples is at most 2^32 - 2^16, and has not saturated; nor does the
    /// half carry.
    #[inline]
    fn mean(self, samples: u16) -> Self {
        let samples = u32::from(samples.max(1));
        Self(self.0.map(|sum| U16F16::from_bits((sum.to_bits() + samples / 2) / samples)))
    }

    #[inline]
    fn to_q16(self) -> [u32; 3] {
        self.clamped().0.map(U16F16::to_bits)
    }

    #[inline]
    fn from_q16(light: [u32; 3]) -> Self {
        Self(light.map(U16F16::from_bits))
    }
}

/// Light up to 1, in Q16, as a byte.
fn byte(light_q16: u32, transfer: Transfer) -> u8 {
    match transfer {
        Transfer::Srgb => srgb::encode(light_q16),
        // 2^16 * 255 + 2^15 < 2^24.
        Transfer::Linear => ((light_q16 * 255 + (1 << 15)) >> 16) as u8,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray(bits: u32) -> Rgb16 {
        Rgb16([U16F16::from_bits(bits); 3])
    }

    #[test]
    fn light_at_both_ends_of_its_range() {
        let brightest = Radiance { mantissa: [u16::MAX; 3], exponent: 15 };
        let dimmest = Radiance { mantissa: [1 << 15; 3], exponent: -15 };
        assert_eq!(Rgb16::constant(&brightest), gray(0x7fff_8000));
        assert_eq!(Rgb16::constant(&dimmest), gray(1)); // 2^-16
        assert_eq!(Rgb16::lit(&brightest, U16F16::ZERO), gray(0));
        assert_eq!(gray(u32::MAX).plus(gray(1)), gray(u32::MAX));
    }

    #[test]
    fn reflection_is_low_by_less_than_a_unit_and_white_gives_back_all() {
        for light in [0, 1, 0xffff, 0x1_0000, 0x1_2345, 0xffff_ffff] {
            assert_eq!(gray(light).reflected(&[u16::MAX; 3]), gray(light));
            for albedo in [0u16, 1, 0x7fff, 0x8000, 0xfffe] {
                let albedo_q16 = u64::from(albedo) + u64::from(albedo >> 15);
                let exact = (u64::from(light) * albedo_q16) >> 16;
                let got = u64::from(gray(light).reflected(&[albedo; 3]).0[0].to_bits());
                assert!(got <= exact && exact - got <= 1, "{light:#x} {albedo:#x}: {got} {exact}");
            }
        }
    }

    #[test]
    fn doubling_saturates_and_products_keep_white() {
        assert_eq!(gray(3).doubled(0), gray(3));
        assert_eq!(gray(3).doubled(15), gray(3 << 15));
        assert_eq!(gray(1 << 17).doubled(14), gray(1 << 31));
        assert_eq!(gray(1 << 18).doubled(14), gray((u32::MAX >> 14) << 14));
        for albedo in [0, 1, 0x8000, 0xffff] {
            assert_eq!(product(&[albedo; 3], &[0xffff; 3]), [albedo; 3]);
            assert_eq!(product(&[albedo; 3], &[0; 3]), [0; 3]);
        }
        assert_eq!((Rgb16::share(U16F16::ONE), Rgb16::share(U16F16::ZERO)), (0xffff, 0));
    }

    #[test]
    fn light_fades_and_grows_and_saturates() {
        let light = |mantissa: u16, exponent| Radiance { mantissa: [mantissa; 3], exponent };
        assert_eq!(light(0x8000, 0).times(0x8000, 1), light(0x4000, 1));
        assert_eq!(light(0xffff, 15).times(0xffff, 0), light(0xfffe, 15));
        assert_eq!(light(0xffff, 15).times(0x8000, 1), light(0xffff, 15), "saturates: half of it, twice over and more");
        assert_eq!(light(0x4000, 15).times(0x8000, 2), light(0x8000, 15));
        assert_eq!(light(0xffff, -15).times(0x8000, 0), light(0x8000, -15));
        assert_eq!(light(0xffff, -15).times(0xffff, -14), light(4, -15));
        assert_eq!(light(0xffff, 0).times(0xffff, i32::MIN), light(0, -15), "less than there is");
        assert_eq!(light(1, 0).times(0xffff, i32::MAX), light(0xffff, 15));
        assert_eq!(light(0xffff, 3).tinted(&[0xffff, 0x8000, 0]).mantissa, [0xffff, 0x8000, 0]);
        assert_eq!(towards_white(&[0, 0x8000, 0xffff], 0xffff), [0xffff; 3]);
        assert_eq!(towards_white(&[0, 0x8000, 0xffff], 0), [0, 0x8000, 0xffff]);
    }

    #[test]
    fn encoding_clamps_and_rounds() {
        assert_eq!(gray(u32::MAX).encode(Transfer::Linear), [255; 3]);
        assert_eq!(gray(1 << 15).encode(Transfer::Linear), [128; 3]);
        assert_eq!(gray(u32::MAX).encode(Transfer::Srgb), [255; 3]);
        assert_eq!(gray(1 << 15).encode(Transfer::Srgb), [188; 3]);
    }
}
