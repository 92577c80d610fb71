//! Why a board has no firmware, or has sent no picture.

use std::path::PathBuf;

use thiserror::Error;

use crate::emulate::EmulateError;
use crate::files::FileError;

/// Why nothing came from a board.
#[derive(Debug, Error)]
pub enum FlashError {
    /// The program is not there.
    #[error(
        "probe-rs is not installed, which takes firmware to a board: `cargo install probe-rs-tools --locked`, or see \
         https://probe.rs{help}"
    )]
    NoProbeRs {
        /// What would do without it.
        help: String,
    },
    /// It sees no probe.
    #[error("probe-rs finds no debug probe; plug one in that is wired to the board (`probe-rs list` shows them){help}")]
    NoProbe {
        /// What would do without one.
        help: String,
    },
    /// It failed before the firmware said how it ended.
    #[error("probe-rs {verb} ended with {status}{}", separated(complaints))]
    ProbeRs {
        /// What it was to do.
        verb: &'static str,
        /// How it ended.
        status: String,
        /// What it said.
        complaints: String,
    },
    /// The firmware would not lie where the board has memory for it.
    #[error("{}: not firmware for {board}: {reason}", elf.display())]
    Image {
        /// The firmware.
        elf: PathBuf,
        /// The board's name.
        board: &'static str,
        /// What lies where it should not.
        reason: String,
    },
    /// The board takes no such files.
    #[error("{board} has no drive that takes a UF2 file; pico has one")]
    NoUf2 {
        /// The board's name.
        board: &'static str,
    },
    /// What an emulation may meet with as well.
    #[error(transparent)]
    Emulate(#[from] EmulateError),
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
}

impl FlashError {
    /// Whether what was given, or what is missing here, is at fault, and not what became of it.
    #[must_use]
    pub fn is_input(&self) -> bool {
        match self {
            Self::NoProbeRs { .. } | Self::NoProbe { .. } | Self::NoUf2 { .. } | Self::File(_) => true,
            Self::ProbeRs { .. } | Self::Image { .. } => false,
            Self::Emulate(error) => error.is_input(),
        }
    }
}

fn separated(complaints: &str) -> String {
    if complaints.is_empty() { String::new() } else { format!(": {complaints}") }
}
