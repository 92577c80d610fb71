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
    /// What is seen of what is behind.
    pub refracted: Albedo,
    /// How sharp highlights are, Q2.
    pub exponent_q2: u16,
    /// Highlights are twice as strong so many times over, at most 15.
    pub gain: u16,
    /// [`Lustre::PHONG`] and [`Lustre::FRESNEL`].
    pub flags: u16,
    /// Schlick's reflectance at a right angle; 65535 is 1.
    pub r0: u16,
    /// Zero.
    pub reserved: u16,
}

impl Lustre {
    /// Highlights by Phong's law, and not by Blinn's.
    pub const PHONG: u16 = 1;
    /// Reflection and refraction share the light by Schlick's law, on top of their colours.
    pub const FRESNEL: u16 = 1 << 1;

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
}

impl Light {
    /// A point light.
    pub const POINT: u32 = 0;
    /// Parallel light.
    pub const DIRECTIONAL: u32 = 1;
}
