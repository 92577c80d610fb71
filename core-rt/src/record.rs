//! What stands in a blob's sections: fixed-size records, read in place.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::colour::{Albedo, Radiance};

#[cfg(target_endian = "big")]
compile_error!("blobs are little-endian and read in place: a big-endian machine would need a copy");

/// A type that a little-endian section of bytes can be read as, in place.
pub trait Record:
    Copy + core::fmt::Debug + PartialEq + Send + Sync + FromBytes + IntoBytes + Immutable + KnownLayout + 'static
{
}

impl<T> Record for T where
    T: Copy + core::fmt::Debug + PartialEq + Send + Sync + FromBytes + IntoBytes + Immutable + KnownLayout + 'static
{
}

/// A surface, with Lambert's law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Material {
    /// What it adds of its own.
    pub emission: Radiance,
    /// What it gives back.
    pub albedo: Albedo,
    /// Its lustre's number and 1; 0 for a matt surface.
    pub lustre: u16,
    /// Its checker's number and 1; 0 for a surface of one colour.
    pub checker: u16,
}

/// A pattern of cubes, every other one of a different albedo.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Checker {
    /// A 256th of a grid unit in cubes, Q63.
    pub step_q63: u64,
    /// Where grid point (0, 0, 0) is, in cubes, Q63, modulo 2.
    pub start_q63: [u64; 3],
    /// The albedo of odd cubes.
    pub other: Albedo,
    /// Zero.
    pub reserved: u16,
}

/// What a surface does with light beyond Lambert's law.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Lustre {
    /// The index of refraction outside by that inside, and the inverse, in Q28: for entering, and for leaving.
    pub eta_q28: [u32; 2],
    /// The colour of highlights, up to a power of two.
    pub specular: Albedo,
    /// What is seen of the mirror image.
    pub reflected: Albedo,
    /// What is seen of the mirror image where nothing passes.
    pub mirrored: Albedo,
    /// What is seen of what is behind.
    pub refracted: Albedo,
    /// What each crossing leaves of light on its way to another surface.
    pub shadow: Albedo,
    /// How sharp highlights are, Q2.
    pub exponent_q2: u16,
    /// Highlights are twice as strong so many times over, at most 15.
    pub gain: u16,
    /// [`Lustre::PHONG`], [`Lustre::FRESNEL`] and [`Lustre::METAL`].
    pub flags: u16,
    /// Schlick's reflectance at a right angle; 65535 is 1.
    pub r0: u16,
    /// How far mirrored rays are strewn about the mirrored direction; 65535 is 1.
    pub roughness: u16,
}

impl Lustre {
    /// Highlights by Phong's law, and not by Blinn's.
    pub const PHONG: u16 = 1;
    /// Reflection and refraction share the light by Schlick's law, on top of their colours.
    pub const FRESNEL: u16 = 1 << 1;

    /// Highlights and mirror images go towards white at grazing angles, by Schlick's law.
    pub const METAL: u16 = 1 << 2;

    /// Whether there are highlights.
    #[must_use]
    pub fn shines(&self) -> bool {
        !self.specular_is_black()
    }

    /// Whether there are no highlights.
    #[must_use]
    pub fn specular_is_black(&self) -> bool {
        self.specular == [0; 3]
    }
}

/// A light without extent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Light {
    /// [`Light::POINT`] or [`Light::DIRECTIONAL`].
    pub kind: u32,
    /// The grid position of a point light; of a directional one, the unit vector towards it in Q30.
    pub place: [i32; 3],
    /// Its strength.
    pub radiance: Radiance,
    /// Where it is so strong.
    pub reach: Reach,
}

/// The square of the distance at which an inverse-square light is as strong as it says: `mantissa * 2^exponent` grid units.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Reach {
    /// At least 2^15; 0 for a light that is as strong everywhere.
    pub mantissa: u16,
    /// In `EXPONENTS`.
    pub exponent: i16,
}

impl Reach {
    /// Beyond these a light is at its brightest or black wherever the grid is.
    pub const EXPONENTS: core::ops::RangeInclusive<i16> = -256..=256;
}

impl Light {
    /// A point light.
    pub const POINT: u32 = 0;
    /// Parallel light.
    pub const DIRECTIONAL: u32 = 1;
}
