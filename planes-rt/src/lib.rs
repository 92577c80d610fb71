//! The real-time ray tracer of 1994: spheres in words of 12 and 24 bits, one processor a pixel, all in lockstep.
//!
//! L. Kesteloot, "Real Time Ray Tracing on Pixel-Planes 5" (University of North Carolina, 1994). No float, no allocation, no
//! panic, no I/O, no `unsafe`; the same bits on every machine.
//!
//! # Numbers
//! [`widths`] are the words and what happens beyond them, [`root`] is the square root, [`colour`] light.
//!
//! # A scene
//! A [`scene::Scene`] is spheres, one light and a [`camera`], checked once against its words; a [`blob`] has one as bytes.
//!
//! # Tracing
//! `step` has what a processor does with one ray and one sphere. [`pixel`] does it for one pixel, and skips what is not
//! needed; [`lanes`] does it for a tile of pixels at once, and skips what none of them needs. The pictures are the same.
//! Where there are several samples of a pixel, they are averaged; [`jitter`] strews what rough mirrors reflect, and where a scene
//! follows paths, `path` says which way they go on.
#![no_std]
#![forbid(unsafe_code)]

pub mod blob;
pub mod camera;
pub mod colour;
pub mod jitter;
pub mod lanes;
mod path;
pub mod pixel;
pub mod root;
pub mod scene;
mod step;
pub mod widths;
