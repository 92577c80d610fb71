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

use core_rt::random;

use crate::colour::{Cosine, LIGHT_MAX, Light, SHARE_ONE, mean, share_of};
use crate::jitter::strewn;
use crate::path::{Onward, onward};
use crate::scene::{Outline, Sample, Scene, Sphere};
use crate::step::{difference, point, product, reflection};
use crate::widths::Widths;

mod search;

use search::Search;

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

/// The light of a tile's pixels, for a [plain](Scene::is_plain) scene, which has nothing of chance in its code: one function with
/// both would be slower by a third on a Cortex-M0. Places beyond the picture are those of its edge.
#[inline(always)]
#[must_use]
pub fn trace<const N: usize>(scene: &Scene<'_>, pixels: &[[u16; 2]; N]) -> [Light; N] {
    sample::<N, false>(scene, pixels, Sample::numbered(0))
}

/// The same for any scene: the mean of its samples.
#[inline(always)]
#[must_use]
pub fn trace_sampled<const N: usize>(scene: &Scene<'_>, pixels: &[[u16; 2]; N]) -> [Light; N] {
    let mut sums = [[0; 3]; N];
    for sample in scene.samples() {
        let light = self::sample::<N, true>(scene, pixels, sample);
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
fn sample<const N: usize, const SAMPLED: bool>(
    scene: &Scene<'_>,
    pixels: &[[u16; 2]; N],
    sample: Sample,
) -> [Light; N] {
    let mut lanes =
        Lanes::new(|lane| if SAMPLED { scene.ray_of(pixels[lane], sample) } else { scene.ray(pixels[lane]) });
    for generation in 0..scene.settings.generations {
        if !any(&lanes.alive) {
            break;
        }
        lanes.generation::<SAMPLED>(scene, pixels, sample, generation);
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
    fn new(ray: impl Fn(usize) -> ([i16; 3], [i16; 3])) -> Self {
        let mut lanes = Self {
            origin: [[0; N]; 3],
            direction: [[0; N]; 3],
            normal: [[0; N]; 3],
            share: [[SHARE_ONE.into(); N]; 3],
            light: [[0; N]; 3],
            alive: [-1; N],
        };
        for lane in 0..N {
            let (origin, direction) = ray(lane);
            set(&mut lanes.origin, lane, -1, origin);
            set(&mut lanes.direction, lane, -1, direction);
        }
        lanes
    }

    /// All spheres once; then lanes that met none see the background and are done.
    #[inline(always)]
    fn generation<const SAMPLED: bool>(
        &mut self,
        scene: &Scene<'_>,
        pixels: &[[u16; 2]; N],
        sample: Sample,
        generation: u16,
    ) {
        let widths = scene.settings.widths;
        let mut search = Search::new(self, widths);
        let mut first = 0;
        for group in scene.spheres.chunks(u32::BITS as usize) {
            let mut candidates = search.candidates(self, group, widths);
            while let Some(sphere) = group.get(candidates.trailing_zeros() as usize) {
                let number = first + candidates.trailing_zeros() as i32;
                candidates &= candidates - 1;
                let Some(met) = search.sphere(self, sphere, number, widths) else { continue };
                if scene.settings.outline == Outline::Literal {
                    self.shade::<SAMPLED>(scene, sphere, &search.t, &met);
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
                    self.shade::<SAMPLED>(scene, sphere, &search.t, &met);
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
            if SAMPLED && scene.settings.paths {
                for lane in 0..N {
                    self.go_on(lane, scene, search.nearest[lane], sample.of(pixels[lane]), generation);
                }
                return;
            }
            let goes_on = self.alive;
            self.reflect(widths, &goes_on);
            if SAMPLED {
                for lane in 0..N {
                    let met = usize::try_from(search.nearest[lane]).ok().filter(|_| goes_on[lane] != 0);
                    let met = met.and_then(|number| scene.spheres.get(number));
                    let roughness = met.map_or(0, |sphere| sphere.surface.roughness);
                    if roughness > 0 {
                        let (mirrored, normal) = (get(&self.direction, lane), get(&self.normal, lane));
                        let [height, turn, ..] = sample.of(pixels[lane]).numbers(generation.into());
                        let direction = strewn(mirrored, normal, roughness, [height, turn], widths);
                        set(&mut self.direction, lane, -1, direction);
                    }
                }
            }
        }
    }

    /// A lane's path goes on from the sphere that it met, or ends.
    #[inline(always)]
    fn go_on(&mut self, lane: usize, scene: &Scene<'_>, met: i32, of: random::Sample, generation: u16) {
        let met = usize::try_from(met).ok().filter(|_| self.alive[lane] != 0);
        let Some(sphere) = met.and_then(|number| scene.spheres.get(number)) else { return };
        let along = [get(&self.direction, lane), get(&self.normal, lane)];
        let share = [0, 1, 2].map(|channel| self.share[channel][lane]);
        match onward(&sphere.surface, along, share, (of, u32::from(generation) + 1), scene.settings.widths) {
            Some(Onward { direction, share }) => {
                set(&mut self.direction, lane, -1, direction);
                (0..3).for_each(|channel| self.share[channel][lane] = share[channel]);
            }
            None => self.alive[lane] = 0,
        }
    }

    /// Moves the enabled lanes to a sphere and shades them.
    #[inline(always)]
    fn shade<const SAMPLED: bool>(&mut self, scene: &Scene<'_>, sphere: &Sphere, t: &Row<N>, enabled: &Row<N>) {
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
        if SAMPLED && scene.settings.paths {
            for lane in 0..N {
                for channel in 0..3 {
                    let seen = share_of(sphere.surface.sent(channel, cosines[lane]), self.share[channel][lane]);
                    let light = &mut self.light[channel][lane];
                    *light = (*light + (seen & enabled[lane])).min(LIGHT_MAX.into());
                }
            }
            return;
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
