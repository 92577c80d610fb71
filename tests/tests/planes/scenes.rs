//! Random scenes, of all widths and to their ends.

use planes_rt::camera::{Camera, FRACTION_BITS, Linear};
use planes_rt::colour::{LIGHT_MAX, SHARE_ONE, Surface};
use planes_rt::scene::{Outline, Scene, Settings, Sphere};
use planes_rt::widths::Widths;
use tests::random::SplitMix64;

/// What a scene is made of.
pub(crate) struct Parts {
    pub(crate) spheres: Vec<Sphere>,
    pub(crate) light: [i16; 3],
    pub(crate) camera: Camera,
    pub(crate) settings: Settings,
}

/// What is seen behind all spheres.
pub(crate) const BACKGROUND: [u16; 3] = [300, 1000, LIGHT_MAX];

impl Parts {
    pub(crate) fn scene(&self) -> Scene<'_> {
        Scene::new_checked(&self.spheres, self.light, BACKGROUND, self.camera, self.settings).unwrap()
    }
}

/// The text's widths, or any.
pub(crate) fn widths(random: &mut SplitMix64) -> Widths {
    let mut within = |range: std::ops::RangeInclusive<u32>| {
        random.within([i64::from(*range.start()), i64::from(*range.end())]) as u32
    };
    let [coordinate, product, determinant, t] =
        [Widths::COORDINATE, Widths::PRODUCT, Widths::DETERMINANT, Widths::T_FRACTION].map(&mut within);
    if within(0..=1) == 0 {
        return Widths::new(12, 24, 36, t).unwrap();
    }
    Widths::new(coordinate, product, determinant, t).unwrap()
}

/// A scene of up to `most` spheres in a picture of `size`. Half of all spheres are where rays go; the rest may be anywhere.
pub(crate) fn scene(random: &mut SplitMix64, most: u64, size: [u16; 2]) -> Parts {
    let settings = Settings {
        widths: widths(random),
        size,
        generations: 1 + random.below(5) as u16,
        outline: if random.coin() { Outline::Nearest } else { Outline::Literal },
        samples: 1,
        paths: false,
    };
    let edge = i64::from(settings.widths.coordinate_max());
    let triple = |random: &mut SplitMix64, most: i64| [(); 3].map(|()| random.within([-most, most]) as i16);
    let spheres = (0..1 + random.below(most)).map(|_| {
        let reach = if random.coin() { edge / 2 } else { edge };
        let colour = |random: &mut SplitMix64, most: u16| [(); 3].map(|()| random.within([0, most.into()]) as u16);
        Sphere {
            centre: triple(random, reach),
            radius: random.within([1, (reach / 2).max(1)]) as i16,
            surface: Surface {
                lit: colour(random, LIGHT_MAX),
                own: colour(random, LIGHT_MAX / 8),
                mirror: if random.below(4) == 0 { [0; 3] } else { colour(random, SHARE_ONE) },
                roughness: 0,
                matt: [0; 3],
            },
        }
    });
    let spheres = spheres.collect();
    // From one triple in the first pixel to another in the last.
    let linear = |random: &mut SplitMix64| {
        let [from, to] = [(); 2].map(|()| triple(random, edge).map(i32::from));
        let step = |axis: usize, side: u16| ((to[axis] - from[axis]) << (FRACTION_BITS - 1)) / i32::from(side);
        Linear {
            first: from.map(|c| c << FRACTION_BITS),
            right: [0, 1, 2].map(|axis| step(axis, size[0])),
            down: [0, 1, 2].map(|axis| step(axis, size[1])),
        }
    };
    let constant = |random: &mut SplitMix64| Linear::constant(triple(random, edge));
    let camera = if random.coin() {
        Camera { origin: constant(random), direction: linear(random) }
    } else {
        Camera { origin: linear(random), direction: constant(random) }
    };
    Parts { spheres, light: triple(random, edge), camera, settings }
}

/// Makes some spheres rough, the first for certain, and a pixel the mean of a few samples.
pub(crate) fn roughen(random: &mut SplitMix64, parts: &mut Parts) {
    for (number, sphere) in parts.spheres.iter_mut().enumerate() {
        if number == 0 || random.coin() {
            sphere.surface.roughness = random.within([1, SHARE_ONE.into()]) as u16;
        }
    }
    parts.settings.samples = 1 + random.below(4) as u16;
}

/// Follows paths, from surfaces that are matt, mirrors, both or rough; of few samples.
pub(crate) fn follow_paths(random: &mut SplitMix64, parts: &mut Parts) {
    roughen(random, parts);
    parts.settings.paths = true;
    for sphere in &mut parts.spheres {
        // To the end: surfaces that send on more than they get.
        let least = if random.coin() { 0 } else { SHARE_ONE.into() };
        let mut colour = || [(); 3].map(|()| random.within([least, SHARE_ONE.into()]) as u16);
        (sphere.surface.matt, sphere.surface.mirror) = (colour(), colour());
        match random.below(4) {
            0 => sphere.surface.matt = [0; 3],
            1 => sphere.surface.mirror = [0; 3],
            2 => sphere.surface.roughness = 0,
            _ => (),
        }
    }
}
