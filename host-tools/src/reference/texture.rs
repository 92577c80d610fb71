//! Textures: texture coordinates to linear light.

use glam::{DVec2, DVec3};

use crate::model::{Filter, Texture};

/// The colour at `uv`, v up, the texture repeated without end: linear RGB in [0, 1].
pub(super) fn look_up(texture: &Texture, uv: DVec2, filter: Filter) -> DVec3 {
    let [width, height] = texture.size;
    let place = (uv - uv.floor()) * DVec2::new(width.into(), height.into());
    match filter {
        Filter::Nearest => texel(texture, place.floor()),
        Filter::Bilinear => {
            // Texels are at their middles.
            let place = place - 0.5;
            let low = place.floor();
            let share = place - low;
            let row = |y: f64| {
                let at = |x: f64| texel(texture, low + DVec2::new(x, y));
                at(0.0) * (1.0 - share.x) + at(1.0) * share.x
            };
            row(0.0) * (1.0 - share.y) + row(1.0) * share.y
        }
    }
}

/// The texel of whole coordinates, counted from the left of the bottom row, repeated.
fn texel(texture: &Texture, place: DVec2) -> DVec3 {
    let [width, height] = texture.size.map(i64::from);
    let column = (place.x as i64).rem_euclid(width);
    let row = height - 1 - (place.y as i64).rem_euclid(height);
    DVec3::from(texture.texels[(row * width + column) as usize].map(linear))
}

/// The inverse of IEC 61966-2-1's curve.
fn linear(byte: u8) -> f64 {
    let encoded = f64::from(byte) / 255.0;
    if encoded <= 0.040_45 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Red above green on the left, black above white on the right.
    fn four() -> Texture {
        Texture { size: [2, 2], texels: vec![[255, 0, 0], [0, 0, 0], [0, 255, 0], [255, 255, 255]] }
    }

    #[test]
    fn nearest_texels_have_v_up_and_repeat() {
        let at = |u: f64, v: f64| look_up(&four(), DVec2::new(u, v), Filter::Nearest);
        assert_eq!(at(0.0, 0.0), DVec3::Y);
        assert_eq!(at(0.49, 0.51), DVec3::X);
        assert_eq!(at(0.75, 0.25), DVec3::ONE);
        assert_eq!(at(0.75, 0.99), DVec3::ZERO);
        assert_eq!(at(-0.25, -3.75), DVec3::ONE);
        assert_eq!(at(1e300, -1e300), at(0.0, 0.0), "whole numbers all");
    }

    #[test]
    fn between_texels_light_is_mixed_and_the_edges_meet() {
        let at = |u: f64, v: f64| look_up(&four(), DVec2::new(u, v), Filter::Bilinear);
        assert_eq!(at(0.25, 0.25), DVec3::Y);
        assert_eq!(at(0.25, 0.5), DVec3::new(0.5, 0.5, 0.0));
        assert_eq!(at(0.5, 0.25), DVec3::new(0.5, 1.0, 0.5));
        assert_eq!(at(0.0, 0.25), DVec3::new(0.5, 1.0, 0.5), "the last column is beside the first");
        assert_eq!(at(0.5, 0.5), DVec3::new(0.5, 0.5, 0.25));
    }

    #[test]
    fn bytes_are_srgb() {
        assert_eq!((linear(0), linear(255)), (0.0, 1.0));
        assert!((linear(188) - 0.502_886).abs() < 1e-6);
        assert!((linear(10) - 10.0 / 255.0 / 12.92).abs() < 1e-18);
    }
}
