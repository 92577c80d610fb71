//! One pixel: what is not needed is skipped.

use crate::colour::{Cosine, LIGHT_MAX, Light, SHARE_ONE, averaged, share_of};
use crate::jitter::strewn;
use crate::scene::{Outline, Scene, Sphere};
use crate::step::{coefficients, determinant, difference, held, numerator, parameter, point, product, reflection};

/// Where a ray met a sphere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Met {
    /// The sphere's place in the list.
    pub sphere: usize,
    /// t, with its fractional bits.
    pub t: i32,
    /// The point, in components.
    pub point: [i16; 3],
    /// The direction in which the ray goes on, as long as it came.
    pub direction: [i16; 3],
}

/// The light of a pixel.
#[inline(always)]
#[must_use]
pub fn trace(scene: &Scene<'_>, pixel: [u16; 2]) -> Light {
    averaged(scene.settings.samples, |sample| trace_telling(scene, pixel, sample, |_| ()))
}

/// The light of one of its samples, telling of each sphere that is met. The last direction is told although no ray may take
/// it.
#[inline(always)]
pub fn trace_telling(scene: &Scene<'_>, pixel: [u16; 2], sample: u16, mut tell: impl FnMut(Met)) -> Light {
    let widths = scene.settings.widths;
    let (mut origin, mut direction) = scene.ray(pixel);
    let mut share = [i32::from(SHARE_ONE); 3];
    // At most white in each of less than 2^16 generations.
    let mut light = [0; 3];
    for generation in 0..scene.settings.generations {
        let Some((number, sphere, t)) = meet(scene, origin, direction) else {
            for channel in 0..3 {
                light[channel] += share_of(scene.background[channel].into(), share[channel]);
            }
            break;
        };
        origin = point(origin, direction, t, widths);
        let normal = difference(origin, sphere.centre, widths);
        let cosine = Cosine::new(sphere.radius.into(), widths).of(product(normal, scene.light, widths));
        for channel in 0..3 {
            light[channel] += share_of(sphere.surface.sent(channel, cosine), share[channel]);
            share[channel] = share_of(share[channel], sphere.surface.mirror[channel].into());
        }
        direction = reflection(direction, normal, widths);
        if sphere.surface.roughness > 0 {
            let [x, y] = pixel;
            direction = strewn(direction, normal, sphere.surface.roughness, [x, y, sample, generation], widths);
        }
        tell(Met { sphere: number, t, point: origin, direction });
        if share == [0; 3] {
            break;
        }
    }
    light.map(|channel| channel.min(LIGHT_MAX.into()) as u16)
}

/// The sphere at which a ray ends: its place in the list, the sphere, and t with its fractional bits. Components of the origin and of
/// the direction are held by their words.
#[inline(always)]
pub fn meet<'a>(scene: &Scene<'a>, origin: [i16; 3], direction: [i16; 3]) -> Option<(usize, &'a Sphere, i32)> {
    let widths = scene.settings.widths;
    let a = product(direction, direction, widths);
    let mut nearest = None;
    let mut least = widths.product_max();
    for (number, sphere) in scene.spheres.iter().enumerate() {
        let radius = i32::from(sphere.radius);
        let (b, c) = coefficients(origin, direction, sphere.centre, radius * radius, widths);
        if b >= 0 {
            continue;
        }
        let determinant = determinant(a, b, c);
        if determinant < 0 {
            continue;
        }
        // The standard library's root is quicker for one number than a bit at a time, and the same.
        let above = numerator(b, held(determinant, widths).isqrt() as i32);
        if above < 0 {
            continue;
        }
        let t = parameter(above, a, widths);
        if t <= least {
            (nearest, least) = (Some((number, sphere, t)), t);
            if scene.settings.outline == Outline::Literal {
                break;
            }
        }
    }
    nearest
}
