//! What is traced: spheres, one light, what is behind them, and from where it is looked at.

use core::fmt::{Display, Formatter};

use core_rt::random;
use core_rt::samples::{MAX_SAMPLES, Place, Places};
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::camera::Camera;
use crate::colour::{LIGHT_MAX, Light, Surface};
use crate::widths::Widths;

/// A sphere, in components.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Sphere {
    /// The centre.
    pub centre: [i16; 3],
    /// The radius, from 1.
    pub radius: i16,
    /// What it sends.
    pub surface: Surface,
}

/// Where a pixel ends in a generation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outline {
    /// At the nearest sphere; of those that are as near, the last of the list.
    #[default]
    Nearest,
    /// At the first sphere of the list that the ray meets, as the text's outline has it when it is taken by the word.
    Literal,
}

/// How a scene is traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// The words.
    pub widths: Widths,
    /// Width and height of the picture, pixels.
    pub size: [u16; 2],
    /// How many spheres a ray meets at most, one after the other.
    pub generations: u16,
    /// Where a pixel ends.
    pub outline: Outline,
    /// Samples of a pixel, 1 to [`MAX_SAMPLES`]: one through its middle, several through places all over it.
    pub samples: u16,
    /// Whether rays go on at random, from what is matt too.
    pub paths: bool,
}

/// One of a pixel's samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sample {
    /// Its number, from 0.
    pub number: u16,
    /// How far right and down of the middle it is, Q16 in [-2^15, 2^15), where that is the same in all pixels; a path is where chance
    /// says.
    off_middle_q16: [i32; 2],
}

impl Sample {
    /// The one through the middle, or a path of this number.
    #[must_use]
    pub const fn numbered(number: u16) -> Self {
        Self { number, off_middle_q16: [0; 2] }
    }

    /// What random numbers are drawn for.
    #[inline(always)]
    pub(crate) fn of(self, pixel: [u16; 2]) -> random::Sample {
        random::Sample { pixel, number: self.number }
    }
}

/// A scene that was found to be within its words.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a> {
    pub(crate) spheres: &'a [Sphere],
    /// Towards the light; as long as the largest component where it is of unit length.
    pub(crate) light: [i16; 3],
    pub(crate) background: Light,
    pub(crate) camera: Camera,
    pub(crate) settings: Settings,
    /// Whether one ray through the middle of a pixel, by sharp mirrors, is all there is.
    pub(crate) is_plain: bool,
}

/// Why a scene cannot be traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneError {
    /// A sphere of this index exceeds its words, has no radius, or sends more than white; or goes on diffusely without paths.
    Sphere(usize),
    /// There are more spheres than numbers for them: 2^15 - 1.
    Count(usize),
    /// A component of the light's vector exceeds its word.
    Light,
    /// The background is more than white.
    Background,
    /// The picture has no pixels, or rays that exceed their words.
    Camera,
    /// There are no samples, or more than [`MAX_SAMPLES`].
    Samples(u16),
}

impl Display for SceneError {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Sphere(index) => write!(f, "sphere {index} is out of range: its place, its radius or what it sends"),
            Self::Count(count) => write!(f, "{count} spheres; there are numbers for 32767"),
            Self::Light => f.write_str("the light's vector exceeds its words"),
            Self::Background => f.write_str("the background is brighter than white"),
            Self::Samples(count) => write!(f, "{count} samples of a pixel; there are 1 to {MAX_SAMPLES}"),
            Self::Camera => f.write_str("the picture has no pixels, or its rays exceed their words"),
        }
    }
}

impl core::error::Error for SceneError {}

impl<'a> Scene<'a> {
    /// The scene. `light` goes towards the light, and is [`Widths::coordinate_max`] long, or zero where there is none.
    ///
    /// # Errors
    /// Where something exceeds its words.
    pub fn new_checked(
        spheres: &'a [Sphere],
        light: [i16; 3],
        background: Light,
        camera: Camera,
        settings: Settings,
    ) -> Result<Self, SceneError> {
        let most = settings.widths.coordinate_max();
        let is_held = |triple: [i16; 3]| triple.iter().all(|&c| i32::from(c).abs() <= most);
        if spheres.len() > i16::MAX as usize {
            return Err(SceneError::Count(spheres.len()));
        }
        let is_wrong = |sphere: &Sphere| {
            let radius_is_held = sphere.radius >= 1 && i32::from(sphere.radius) <= most;
            let is_followed = settings.paths || sphere.surface.matt == [0; 3];
            !(is_held(sphere.centre) && radius_is_held && sphere.surface.is_in_range() && is_followed)
        };
        if let Some(index) = spheres.iter().position(is_wrong) {
            return Err(SceneError::Sphere(index));
        }
        if !is_held(light) {
            return Err(SceneError::Light);
        }
        if background.iter().any(|&channel| channel > LIGHT_MAX) {
            return Err(SceneError::Background);
        }
        if !(1..=MAX_SAMPLES).contains(&settings.samples) {
            return Err(SceneError::Samples(settings.samples));
        }
        let size = settings.size;
        if size.contains(&0) || !camera.origin.holds(size) || !camera.direction.holds(size) {
            return Err(SceneError::Camera);
        }
        let is_sharp = spheres.iter().all(|sphere| sphere.surface.roughness == 0);
        let is_plain = is_sharp && settings.samples == 1 && !settings.paths;
        Ok(Self { spheres, light, background, camera, settings, is_plain })
    }

    /// Whether one ray through the middle of a pixel, by sharp mirrors, is all there is.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.is_plain
    }

    /// The samples of every pixel.
    #[inline(always)]
    pub fn samples(&self) -> impl Iterator<Item = Sample> {
        let Settings { samples, paths, .. } = self.settings;
        // One is in the middle, and takes no division.
        let mut places = (samples > 1 && !paths).then(|| Places::of(samples));
        (0..samples).map(move |number| {
            let place = places.as_mut().and_then(Iterator::next);
            Sample { number, off_middle_q16: place.map_or([0; 2], Place::off_middle) }
        })
    }

    /// How it is traced.
    #[must_use]
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The spheres.
    #[must_use]
    pub fn spheres(&self) -> &'a [Sphere] {
        self.spheres
    }

    /// The vector towards the light.
    #[must_use]
    pub fn light(&self) -> [i16; 3] {
        self.light
    }

    /// What is seen behind all spheres.
    #[must_use]
    pub fn background(&self) -> Light {
        self.background
    }

    /// The nearest pixel of the picture.
    #[inline(always)]
    fn within(&self, [x, y]: [u16; 2]) -> [i32; 2] {
        let [width, height] = self.settings.size;
        [i32::from(x.min(width - 1)), i32::from(y.min(height - 1))]
    }

    /// The origin and the direction of a pixel's ray; places beyond the picture are those of its edge.
    #[inline(always)]
    #[must_use]
    pub fn ray(&self, pixel: [u16; 2]) -> ([i16; 3], [i16; 3]) {
        let [x, y] = self.within(pixel);
        let widths = self.settings.widths;
        (self.camera.origin.at(x, y, widths), self.camera.direction.at(x, y, widths))
    }

    /// The same of one of its samples.
    #[inline(always)]
    pub(crate) fn ray_of(&self, pixel: [u16; 2], sample: Sample) -> ([i16; 3], [i16; 3]) {
        let off_q16 = if self.settings.paths {
            let [right, down, ..] = sample.of(pixel).numbers(0);
            Place { right_q16: (right >> 16) as u16, down_q16: (down >> 16) as u16 }.off_middle()
        } else {
            sample.off_middle_q16
        };
        if off_q16 == [0; 2] {
            return self.ray(pixel);
        }
        let [x, y] = self.within(pixel);
        let Camera { origin, direction } = &self.camera;
        let widths = self.settings.widths;
        (origin.off_middle(x, y, off_q16, widths), direction.off_middle(x, y, off_q16, widths))
    }
}
