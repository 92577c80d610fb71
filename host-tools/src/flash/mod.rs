//! A board's firmware on a real chip: by [probe-rs](https://probe.rs), or as a file for the chip's own boot loader.
//!
//! The firmware is what an [emulation](crate::emulate) runs, but that it reaches the host by RTT. `probe-rs` puts the blob
//! into its place, and then the firmware, and runs that; it decodes the log, and writes both channels to files, where they
//! are read as they come.
//!
//! `probe-rs run` (0.32, `util/cli.rs`) takes a channel of the name `defmt` for a log, and every other one for UTF-8; none is
//! handed over as it is. So the picture's frames are sent as [digits].

pub mod digits;
mod error;
pub mod image;
mod probe;
pub mod uf2;

pub use error::FlashError;
pub use probe::Probe;
