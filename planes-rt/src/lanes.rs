//! A tile of pixels in lockstep: every lane takes the same steps, and a mask says whose results count.
//!
//! The text's outline: for each generation, for each sphere, enable, intersect, disable where the root is imaginary, behind or
//! farther; shade; reflect; disable the pixel for what is left of the generation. Taken by the word, that ends a pixel at the first
//! sphere of the list. [`Outline::Nearest`] shades after the last sphere instead, under a mask for each that is the nearest
//! of some lane.
//!
//! State stands in arrays by field, of N lanes; a mask is -1 where a lane is enabled and 0 where it is not. Loops over the lanes
//! have no branch, so that a compiler makes vectors of them; where no lane is enabled, a step is left out.

#![expect(clippy::needless_range_loop, reason = "a lane is a place in many arrays at once")]

use crate::colour::{Cosine, LIGHT_MAX, Light, SHARE_ONE, mean, share_of};
use crate::jitter::strewn;
use crate::root::{digit, pair, split};
use crate::scene::{Outline, Scene, Sphere};
use crate::step::{
    coefficients, determinant, difference, held, may_be_real, numerator, parameter, point, product, reflection,
};
use crate::widths::Widths;

/// A field of all lanes.
type Row<const N: usize> = [i32; N];

/// A component of all lanes.
type Components<const N: usize> = [i16; N];

/// -1 for true, 0 for false.
#[inline(always)]
fn mask(condition: bool) -> i32 {
    -i32::from(condition)
}

/// `new` where the mask is set, `old` elsewhere.
#[inline(always)]
fn select(mask: i32, new: i32, old: i32) -> i32 {
    (new & mask) | (old & !mask)
}

/// Whether any lane is enabled.
#[inline(always)]
fn any<const N: usize>(enabled: &Row<N>) -> bool {
    enabled.iter().fold(0, |any, lane| any | lane) != 0
}

/// The light of a tile's pixels, for a scene [without rough mirrors](Scene::is_rough), which has nothing of them in its code: one
/// function with both would be slower by a third on a Cortex-M0. Places beyond the picture are those of its edge.
#[inline(always)]
#[must_use]
pub fn trace<const N: usize>(scene: &Scene<'_>, pixels: &[[u16; 2]; N]) -> [Light; N] {
    sample::<N, false>(scene, pixels, 0)
}

/// The same for any scene: the mean of its samples.
#[inline(always)]
#[must_use]
pub fn trace_rough<const N: usize>(scene: &Scene<'_>, pixels: &[[u16; 2]; N]) -> [Light; N] {
    let mut sums = [[0; 3]; N];
    for number in 0..scene.settings.samples {
        let light = sample::<N, true>(scene, pixels, number);
        for lane in 0..N {
            for channel in 0..3 {
                sums[lane][channel] += u32::from(light[lane][channel]);
            }
        }
    }
    sums.map(|sum| mean(sum, scene.settings.samples))
}

/// The light of one sample.
#[inline(always)]
fn sample<const N: usize, const ROUGH: bool>(scene: &Scene<'_>, pixels: &[[u16; 2]; N], number: u16) -> [Light; N] {
    let mut lanes = Lanes::new(scene, pixels);
    for generation in 0..scene.settings.generations {
        if !any(&lanes.alive) {
            break;
        }
        lanes.generation::<ROUGH>(scene, pixels, [number, generation]);
    }
    let mut light = [[0; 3]; N];
    for lane in 0..N {
        for channel in 0..3 {
            light[lane][channel] = lanes.light[channel][lane].min(LIGHT_MAX.into()) as u16;
        }
    }
    light
}

/// What the lanes hold from one generation to the next.
#[derive(Debug)]
struct Lanes<const N: usize> {
    origin: [Components<N>; 3],
    direction: [Components<N>; 3],
    /// Of the sphere that the ray has met, as long as its radius.
    normal: [Components<N>; 3],
    /// What of the light is still seen, as shares.
    share: [Row<N>; 3],
    /// What was seen: at most white in each of less than 2^16 generations.
    light: [Row<N>; 3],
    /// Of lanes whose rays go on.
    alive: Row<N>,
}

impl<const N: usize> Lanes<N> {
    #[inline(always)]
    fn new(scene: &Scene<'_>, pixels: &[[u16; 2]; N]) -> Self {
        let mut lanes = Self {
            origin: [[0; N]; 3],
            direction: [[0; N]; 3],
            normal: [[0; N]; 3],
            share: [[SHARE_ONE.into(); N]; 3],
            light: [[0; N]; 3],
            alive: [-1; N],
        };
        for lane in 0..N {
            let (origin, direction) = scene.ray(pixels[lane]);
            set(&mut lanes.origin, lane, -1, origin);
            set(&mut lanes.direction, lane, -1, direction);
        }
        lanes
    }

    /// All spheres once; then lanes that met none see the background and are done.
    #[inline(always)]
    fn generation<const ROUGH: bool>(
        &mut self,
        scene: &Scene<'_>,
        pixels: &[[u16; 2]; N],
        [sample, generation]: [u16; 2],
    ) {
        let widths = scene.settings.widths;
        let mut search = Search { a: [0; N], enabled: self.alive, t: [widths.product_max(); N], nearest: [-1; N] };
        for lane in 0..N {
            let direction = get(&self.direction, lane);
            search.a[lane] = product(direction, direction, widths);
        }
        let mut first = 0;
        for group in scene.spheres.chunks(u32::BITS as usize) {
            let mut candidates = search.candidates(self, group, widths);
            while let Some(sphere) = group.get(candidates.trailing_zeros() as usize) {
                let number = first + candidates.trailing_zeros() as i32;
                candidates &= candidates - 1;
                let Some(met) = search.sphere(self, sphere, number, widths) else { continue };
                if scene.settings.outline == Outline::Literal {
                    self.shade(scene, sphere, &search.t, &met);
                    for lane in 0..N {
                        search.enabled[lane] &= !met[lane];
                    }
                }
            }
            first += u32::BITS as i32;
        }
        if scene.settings.outline == Outline::Nearest {
            for (number, sphere) in (0..).zip(scene.spheres) {
                let mut met = [0; N];
                for lane in 0..N {
                    met[lane] = mask(search.nearest[lane] == number);
                }
                if any(&met) {
                    self.shade(scene, sphere, &search.t, &met);
                }
            }
        }
        for lane in 0..N {
            let missed = self.alive[lane] & mask(search.nearest[lane] < 0);
            for channel in 0..3 {
                let seen = share_of(scene.background[channel].into(), self.share[channel][lane]);
                self.light[channel][lane] += seen & missed;
            }
            self.alive[lane] &= !missed;
        }
        if any(&self.alive) {
            let goes_on = self.alive;
            self.reflect(widths, &goes_on);
            if ROUGH {
                for lane in 0..N {
                    let (nearest, [x, y]) = (search.nearest[lane] & goes_on[lane], pixels[lane]);
                    let met = scene.spheres.get(nearest as usize).filter(|_| goes_on[lane] != 0);
                    let roughness = met.map_or(0, |sphere| sphere.surface.roughness);
                    if roughness > 0 {
                        let (mirrored, normal) = (get(&self.direction, lane), get(&self.normal, lane));
                        let direction = strewn(mirrored, normal, roughness, [x, y, sample, generation], widths);
                        set(&mut self.direction, lane, -1, direction);
                    }
                }
            }
        }
    }

    /// Moves the enabled lanes to a sphere and shades them.
    #[inline(always)]
    fn shade(&mut self, scene: &Scene<'_>, sphere: &Sphere, t: &Row<N>, enabled: &Row<N>) {
        let widths = scene.settings.widths;
        let mut cosines = [0; N];
        for lane in 0..N {
            // A lane that met nothing has the largest t, which is too far.
            let t = t[lane] & enabled[lane];
            let origin = point(get(&self.origin, lane), get(&self.direction, lane), t, widths);
            set(&mut self.origin, lane, enabled[lane], origin);
            set(&mut self.normal, lane, enabled[lane], difference(origin, sphere.centre, widths));
        }
        let cosine = Cosine::new(sphere.radius.into(), widths);
        for lane in 0..N {
            cosines[lane] = cosine.of(product(get(&self.normal, lane), scene.light, widths));
        }
        for lane in 0..N {
            let mut left = 0;
            for channel in 0..3 {
                let share = &mut self.share[channel][lane];
                let seen = share_of(sphere.surface.sent(channel, cosines[lane]), *share);
                self.light[channel][lane] += seen & enabled[lane];
                *share = select(enabled[lane], share_of(*share, sphere.surface.mirror[channel].into()), *share);
                left |= *share;
            }
            self.alive[lane] &= mask(left != 0);
        }
    }

    /// Reflects the enabled lanes.
    #[inline(always)]
    fn reflect(&mut self, widths: Widths, enabled: &Row<N>) {
        for lane in 0..N {
            let direction = reflection(get(&self.direction, lane), get(&self.normal, lane), widths);
            set(&mut self.direction, lane, enabled[lane], direction);
        }
    }
}

/// What the lanes hold within a generation.
struct Search<const N: usize> {
    /// |d|^2.
    a: Row<N>,
    /// Of lanes that still look for a sphere.
    enabled: Row<N>,
    /// The least t so far.
    t: Row<N>,
    /// The number of its sphere, or -1.
    nearest: Row<N>,
}

impl<const N: usize> Search<N> {
    /// Which of the first 32 spheres some lane may meet, as bits: all that one does meet, and few others. There is nothing to
    /// wait for or to guess between one sphere and the next, so that a processor works on several at once.
    #[inline(always)]
    fn candidates(&self, lanes: &Lanes<N>, spheres: &[Sphere], widths: Widths) -> u32 {
        (0..u32::BITS).zip(spheres).fold(0, |candidates, (bit, sphere)| {
            let radius = i32::from(sphere.radius);
            let mut met = 0;
            for lane in 0..N {
                let (origin, direction) = (get(&lanes.origin, lane), get(&lanes.direction, lane));
                let (b, c) = coefficients(origin, direction, sphere.centre, radius * radius, widths);
                met |= self.enabled[lane] & mask(b < 0) & mask(may_be_real(self.a[lane], b, c, widths));
            }
            candidates | u32::from(met != 0) << bit
        })
    }

    /// Intersects all rays with a sphere; the lanes for which it is the nearest so far, if there are any.
    #[inline(always)]
    fn sphere(&mut self, lanes: &Lanes<N>, sphere: &Sphere, number: i32, widths: Widths) -> Option<Row<N>> {
        let radius = i32::from(sphere.radius);
        let (mut b, mut c) = ([0; N], [0; N]);
        for lane in 0..N {
            let (origin, direction) = (get(&lanes.origin, lane), get(&lanes.direction, lane));
            (b[lane], c[lane]) = coefficients(origin, direction, sphere.centre, radius * radius, widths);
        }
        // In a loop of its own: products of 64 bits would halve the vectors of the one before.
        let (mut determinants, mut met) = ([0; N], [0; N]);
        for lane in 0..N {
            determinants[lane] = determinant(self.a[lane], b[lane], c[lane]);
            let imaginary = (determinants[lane] >> 63) as i32;
            met[lane] = self.enabled[lane] & mask(b[lane] < 0) & !imaginary;
        }
        if !any(&met) {
            return None;
        }
        let roots = roots(&determinants, &met, widths);
        let mut t = [0; N];
        for lane in 0..N {
            let above = numerator(b[lane], roots[lane]);
            met[lane] &= mask(above >= 0);
            t[lane] = above & met[lane];
        }
        for lane in 0..N {
            t[lane] = parameter(t[lane], self.a[lane], widths);
        }
        for lane in 0..N {
            met[lane] &= mask(t[lane] <= self.t[lane]);
            self.t[lane] = select(met[lane], t[lane], self.t[lane]);
            self.nearest[lane] = select(met[lane], number, self.nearest[lane]);
        }
        any(&met).then_some(met)
    }
}

/// The roots of the determinants as their words hold them, a digit of all lanes at a time.
#[inline(always)]
fn roots<const N: usize>(determinants: &[i64; N], enabled: &Row<N>, widths: Widths) -> Row<N> {
    let (mut low, mut high) = ([0; N], [0; N]);
    for lane in 0..N {
        [low[lane], high[lane]] = split(held(determinants[lane], widths) & i64::from(enabled[lane]));
    }
    let (mut rest, mut root) = ([0; N], [0; N]);
    for place in (0..widths.determinant().div_ceil(2)).rev() {
        for lane in 0..N {
            (rest[lane], root[lane]) = digit(rest[lane], root[lane], pair([low[lane], high[lane]], place));
        }
    }
    root
}

#[inline(always)]
fn get<const N: usize>(triple: &[Components<N>; 3], lane: usize) -> [i16; 3] {
    [triple[0][lane], triple[1][lane], triple[2][lane]]
}

#[inline(always)]
fn set<const N: usize>(triple: &mut [Components<N>; 3], lane: usize, enabled: i32, new: [i16; 3]) {
    let enabled = enabled as i16;
    for axis in 0..3 {
        triple[axis][lane] = (new[axis] & enabled) | (triple[axis][lane] & !enabled);
    }
}
