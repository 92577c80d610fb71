//! Records in a blob, little-endian and read in place like every kernel's.
//!
//! Two types each and not one generic one: zerocopy proves the absence of padding for concrete types only.

use core_rt::num::Triple;
use core_rt::record::Record;
use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

/// Two child boxes: child, low or high, axis.
type Planes<F> = [[Triple<F>; 2]; 2];

/// A node's record.
pub trait NodeRecord<F>: Record {
    /// The record: the children's boxes as (child, low or high, axis), and packed references to them.
    fn new(planes: [[Triple<F>; 2]; 2], children: [u32; 2]) -> Self;
    /// The boxes of its children.
    fn planes(&self) -> &[[Triple<F>; 2]; 2];
    /// Packed references; see [`bvh`](core_rt::bvh).
    fn children(&self) -> [u32; 2];
}

/// A triangle's record.
pub trait TriangleRecord<F>: Record {
    /// The record of v0, e1 = v1 - v0, e2 = v2 - v0, and a material.
    fn new(rows: [Triple<F>; 3], material: u32) -> Self;
    /// v0, e1, e2.
    fn rows(&self) -> &[Triple<F>; 3];
    /// The material.
    fn material(&self) -> u32;
}

/// A sphere's record.
pub trait SphereRecord<F>: Record {
    /// The record of a centre, a radius and a material.
    fn new(centre: Triple<F>, radius: F, material: u32) -> Self;
    /// The centre.
    fn centre(&self) -> &Triple<F>;
    /// The radius.
    fn radius(&self) -> F;
    /// The material.
    fn material(&self) -> u32;
}

/// Two children in `f32`, in 56 bytes.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Node32 {
    planes: Planes<f32>,
    children: [u32; 2],
}

/// Two children in `f64`, in 104 bytes.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Node64 {
    planes: Planes<f64>,
    children: [u32; 2],
}

/// A triangle in `f32`, in 40 bytes.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Triangle32 {
    rows: [Triple<f32>; 3],
    material: u32,
}

/// A triangle in `f64`, in 80 bytes.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Triangle64 {
    rows: [Triple<f64>; 3],
    /// As wide as a number, so that there is no padding.
    material: u64,
}

/// A sphere in `f32`, in 20 bytes.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Sphere32 {
    centre: Triple<f32>,
    radius: f32,
    material: u32,
}

/// A sphere in `f64`, in 40 bytes.
#[derive(Clone, Copy, Debug, PartialEq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct Sphere64 {
    centre: Triple<f64>,
    radius: f64,
    /// As wide as a number, so that there is no padding.
    material: u64,
}

macro_rules! records {
    ($float:ty, $node:ident, $triangle:ident, $sphere:ident) => {
        impl NodeRecord<$float> for $node {
            #[inline]
            fn new(planes: Planes<$float>, children: [u32; 2]) -> Self {
                Self { planes, children }
            }
            #[inline(always)]
            fn planes(&self) -> &Planes<$float> {
                &self.planes
            }
            #[inline(always)]
            fn children(&self) -> [u32; 2] {
                self.children
            }
        }

        impl SphereRecord<$float> for $sphere {
            #[inline]
            fn new(centre: Triple<$float>, radius: $float, material: u32) -> Self {
                Self { centre, radius, material: material.into() }
            }
            #[inline(always)]
            fn centre(&self) -> &Triple<$float> {
                &self.centre
            }
            #[inline(always)]
            fn radius(&self) -> $float {
                self.radius
            }
            #[inline(always)]
            fn material(&self) -> u32 {
                self.material as u32
            }
        }

        impl TriangleRecord<$float> for $triangle {
            #[inline]
            fn new(rows: [Triple<$float>; 3], material: u32) -> Self {
                Self { rows, material: material.into() }
            }
            #[inline(always)]
            fn rows(&self) -> &[Triple<$float>; 3] {
                &self.rows
            }
            #[inline(always)]
            fn material(&self) -> u32 {
                self.material as u32
            }
        }
    };
}
records!(f32, Node32, Triangle32, Sphere32);
records!(f64, Node64, Triangle64, Sphere64);
