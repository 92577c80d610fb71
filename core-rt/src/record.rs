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

/// A Lambert surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Material {
    /// What it adds of its own.
    pub emission: Radiance,
    /// What it gives back.
    pub albedo: Albedo,
    /// Zero.
    pub reserved: u16,
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
