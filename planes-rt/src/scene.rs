//! What is traced: spheres, one light, what is behind them, and from where it is looked at.

use core::fmt::{Display, Formatter};

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::camera::Camera;
use crate::colour::{LIGHT_MAX, Light, Surface};
use crate::jitter::SAMPLES_MAX;
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
    /// Samples of a pixel, from 1, which differ by what rough mirrors do; a scene without any has one.
    pub samples: u16,
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
    /// Whether anything strews what it reflects.
    pub(crate) is_rough: bool,
}

/// Why a scene cannot be traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SceneError {
    /// A sphere of this index exceeds its words, has no radius, or sends more than white.
    Sphere(usize),
    /// There are more spheres than numbers for them: 2^15 - 1.
    Count(usize),
    /// A component of the light's vector exceeds its word.
    Light,
    /// The background is more than white.
    Background,
    /// The picture has no pixels, or rays that exceed their words.
    Camera,
    /// There are no samples, more than [`SAMPLES_MAX`], or several of a scene in which nothing is random.
    Samples(u16),
}

impl Display for SceneError {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Sphere(index) => write!(f, "sphere {index} is out of range: its place, its radius or what it sends"),
            Self::Count(count) => write!(f, "{count} spheres; there are numbers for 32767"),
            Self::Light => f.write_str("the light's vector exceeds its words"),
            Self::Background => f.write_str("the background is brighter than white"),
            Self::Samples(count) => {
                write!(f, "{count} samples of a pixel; there are 1 to {SAMPLES_MAX}, and 1 where no mirror is rough")
            }
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
            !(is_held(sphere.centre) && radius_is_held && sphere.surface.is_in_range())
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
        let most = if spheres.iter().any(|sphere| sphere.surface.roughness > 0) { SAMPLES_MAX } else { 1 };
        if !(1..=most).contains(&settings.samples) {
            return Err(SceneError::Samples(settings.samples));
        }
        let size = settings.size;
        if size.contains(&0) || !camera.origin.holds(size) || !camera.direction.holds(size) {
            return Err(SceneError::Camera);
        }
        Ok(Self { spheres, light, background, camera, settings, is_rough: most > 1 })
    }

    /// Whether anything strews what it reflects.
    #[must_use]
    pub fn is_rough(&self) -> bool {
        self.is_rough
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

    /// The origin and the direction of a pixel's ray; places beyond the picture are those of its edge.
    #[inline(always)]
    #[must_use]
    pub fn ray(&self, [x, y]: [u16; 2]) -> ([i16; 3], [i16; 3]) {
        let [width, height] = self.settings.size;
        let (x, y) = (i32::from(x.min(width - 1)), i32::from(y.min(height - 1)));
        let widths = self.settings.widths;
        (self.camera.origin.at(x, y, widths), self.camera.direction.at(x, y, widths))
    }
}
