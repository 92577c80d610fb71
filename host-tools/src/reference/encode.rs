//! From linear light to bytes.

use glam::DVec3;

use crate::model::Transfer;

/// The bytes of a linear colour: clamped to [0, 1], put through `transfer`, rounded to nearest.
pub fn encode(colour: DVec3, transfer: Transfer) -> [u8; 3] {
    let curve = match transfer {
        Transfer::Srgb => srgb,
        Transfer::Linear => |linear| linear,
    };
    colour.to_array().map(|linear| (255.0 * curve(linear.clamp(0.0, 1.0))).round() as u8)
}

/// The curve of IEC 61966-2-1 over [0, 1].
fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The standard's inverse.
    fn linear(byte: u8) -> f64 {
        let encoded = f64::from(byte) / 255.0;
        if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
    }

    #[test]
    fn known_bytes() {
        let colour = DVec3::new(0.5, 0.18, 0.001);
        assert_eq!(encode(colour, Transfer::Srgb), [188, 118, 3]);
        assert_eq!(encode(colour, Transfer::Linear), [128, 46, 0]);
        for transfer in [Transfer::Srgb, Transfer::Linear] {
            assert_eq!(encode(DVec3::new(0.0, 1.0, -0.5), transfer), [0, 255, 0]);
            assert_eq!(encode(DVec3::new(9.0, f64::INFINITY, 1.0), transfer), [255; 3]);
        }
    }

    #[test]
    fn every_byte_comes_back_and_turns_half_way_to_the_next() {
        for byte in 0..=255 {
            assert_eq!(encode(DVec3::splat(linear(byte)), Transfer::Srgb), [byte; 3]);
        }
        for byte in 0..255 {
            let half = (f64::from(byte) + 0.5) / 255.0;
            let below = encode(DVec3::splat(half * (1.0 - 1e-9)), Transfer::Linear);
            let above = encode(DVec3::splat(half * (1.0 + 1e-9)), Transfer::Linear);
            assert_eq!((below, above), ([byte; 3], [byte + 1; 3]));
        }
    }
}
