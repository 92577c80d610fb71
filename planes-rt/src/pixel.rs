//! One pixel: what is not needed is skipped.

use crate::colour::{Cosine, LIGHT_MAX, Light, SHARE_ONE, mean, share_of};
use crate::jitter::strewn;
use crate::path::{Onward, onward};
use crate::scene::{Outline, Sample, Scene, Sphere};
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
    /// Whether anything is seen of that.
    pub is_seen: bool,
}

/// The light of a pixel.
#[inline(always)]
#[must_use]
pub fn trace(scene: &Scene<'_>, pixel: [u16; 2]) -> Light {
    let mut sum = [0; 3];
    for sample in scene.samples() {
        let light = trace_telling(scene, pixel, sample, |_| ());
        if scene.settings.samples == 1 {
            return light;
        }
        for channel in 0..3 {
            sum[channel] += u32::from(light[channel]);
        }
    }
    mean(sum, scene.settings.samples)
}

/// The light of one of its samples, telling of each sphere that is met. The last direction is told although no ray may take
/// it; where a path ends, it is that in which it came.
#[inline(always)]
pub fn trace_telling(scene: &Scene<'_>, pixel: [u16; 2], sample: Sample, tell: impl FnMut(Met)) -> Light {
    // What follows no paths has nothing of them in its loop.
    if scene.settings.paths {
        follow::<true>(scene, pixel, sample, tell)
    } else {
        follow::<false>(scene, pixel, sample, tell)
    }
}

#[inline(always)]
fn follow<const PATHS: bool>(scene: &Scene<'_>, pixel: [u16; 2], sample: Sample, mut tell: impl FnMut(Met)) -> Light {
    let widths = scene.settings.widths;
    let (mut origin, mut direction) = scene.ray_of(pixel, sample);
    let mut share = [i32::from(SHARE_ONE); 3];
    // At most white in each of less than 2^16 generations. A path's share may be 2^7, so that it is cut each time: at most 2^20.
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
        }
        if PATHS {
            light = light.map(|channel| channel.min(LIGHT_MAX.into()));
            let chance = (sample.of(pixel), u32::from(generation) + 1);
            let next = onward(&sphere.surface, [direction, normal], share, chance, widths);
            Onward { direction, share } = next.unwrap_or(Onward { direction, share: [0; 3] });
        } else {
            for (share, mirror) in share.iter_mut().zip(sphere.surface.mirror) {
                *share = share_of(*share, mirror.into());
            }
            direction = reflection(direction, normal, widths);
            if sphere.surface.roughness > 0 {
                let [height, turn, ..] = sample.of(pixel).numbers(generation.into());
                direction = strewn(direction, normal, sphere.surface.roughness, [height, turn], widths);
            }
        }
        let is_seen = share != [0; 3];
        tell(Met { sphere: number, t, point: origin, direction, is_seen });
        if !is_seen {
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
