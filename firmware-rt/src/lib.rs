//! What firmware and host agree on, and what the firmware of every board shares.
//!
//! # Agreed on
//! [`board`]s with their memory maps, [`frame`]s that carry the picture and the [`digits`] that they are by RTT, the [`status`] that a run ends with, and what
//! the picture of the nearest [`hits`] is. Which operations' [`costs`] are counted.
//!
//! # On the chip
//! `run` checks the blob where it lies in flash and renders it tile by tile, between the marks of `window`,
//! and with those of `marks` where rays are told apart.
//! `planes` is the same for the tracer of 1994, with the feature of that name.
//! `transport` takes log and frames to the host, `stack` measures, `end` is how every run ends, well or not.
//!
//! # Building
//! `build` turns a board into a linker script, and a blob's header into a profile.
#![cfg_attr(not(any(feature = "host", test)), no_std)]

pub mod board;
pub mod costs;
pub mod digits;
pub mod frame;
pub mod hits;
pub mod status;

#[cfg(feature = "host")]
pub mod build;

#[cfg(target_os = "none")]
mod by_hand;
#[cfg(target_os = "none")]
pub mod end;
#[cfg(target_os = "none")]
mod marks;
#[cfg(target_os = "none")]
pub mod misbehave;
#[cfg(all(target_os = "none", feature = "planes"))]
pub mod planes;
#[cfg(target_os = "none")]
mod refusal;
#[cfg(target_os = "none")]
pub mod run;
#[cfg(target_os = "none")]
pub mod stack;
#[cfg(target_os = "none")]
pub mod transport;
#[cfg(target_os = "none")]
pub mod window;
