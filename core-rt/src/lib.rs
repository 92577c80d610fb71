//! Integer ray tracing for chips without an FPU: a blob in, pixels out, the same bits on every machine.
//!
//! No float, no allocation, no panic on a scene that was accepted, no I/O, no `unsafe`. The way of the data:
//!
//! # A scene
//! [`scene::Scene::new_checked`] checks a [`blob`] once; after that no accessor fails. Its sections hold
//! [`record`]s, read in place.
//!
//! # Numbers
//! [`num`] has the integers, [`space`] the formats and operations of shading, [`colour`] linear light and pixels.
//!
//! # Kernels
//! A [`kernel::Kernel`] is a space with its records, its box test, its triangle test and its [`sphere`] test. [`exact`] has
//! those whose every decision is exact, [`hanika`] those of the 2009 report. [`arithmetic`] is what a kernel leaves to the
//! scene.
//!
//! # Tracing
//! [`camera`] rays go through the [`bvh`] to the triangles of a [`mesh`], a [`tile`] at a time, hits are shaded, and
//! [`render`] brings tiles to a sink. What goes on from surfaces is followed as a tree ([`whitted`]) or as one [`path`] a
//! sample, by numbers of [`random`]. A [`profile`] says what is compiled in; [`stats`] count the work.
#![no_std]
#![forbid(unsafe_code)]

mod albedo;
pub mod arithmetic;
pub mod blob;
pub mod bvh;
pub mod camera;
pub mod colour;
pub mod exact;
pub mod format;
pub mod hanika;
pub mod kernel;
mod light;
pub mod mesh;
pub mod num;
mod onward;
pub mod paint;
pub mod path;
pub mod profile;
pub mod random;
pub mod record;
pub mod render;
pub mod samples;
pub mod scene;
pub mod section;
mod shade;
pub mod space;
pub mod sphere;
mod srgb;
pub mod stats;
pub mod texture;
pub mod tile;
pub mod whitted;
