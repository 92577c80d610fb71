//! Why firmware could not be built or run.

use std::io;
use std::path::PathBuf;
use std::time::Duration;

use firmware_rt::status::Status;
use thiserror::Error;

use crate::files::FileError;

/// Why an emulation has no picture.
#[derive(Debug, Error)]
pub enum EmulateError {
    /// The blob is larger than its place.
    #[error(
        "the blob has {bytes} bytes, and {board} has {room} for it in its flash: {} too many. What would help: {help}",
        bytes - room
    )]
    TooLarge {
        /// The board's name.
        board: &'static str,
        /// The blob's.
        bytes: u64,
        /// The place's.
        room: u64,
        /// What would make it smaller.
        help: String,
    },
    /// There is no firmware for the kernel.
    #[error("no firmware has the kernel {kernel}; {known} have one")]
    NoFirmware {
        /// The kernel asked for.
        kernel: &'static str,
        /// Those that there are.
        known: String,
    },
    /// The program runs outside the repository.
    #[error(
        "the sources of the firmware are not at {}, where this program was built; run it from a copy of the repository, by \
         `cargo run --release -- emulate`",
        .0.display()
    )]
    NoSources(PathBuf),
    /// The compiler has no library for the chip.
    #[error("the compiler has no library for {target}: `rustup target add {target}`, or `cargo xtask setup`")]
    NoTarget {
        /// What rustc calls it.
        target: &'static str,
    },
    /// The firmware did not build.
    #[error("the firmware {package} cannot be built:\n{output}")]
    Build {
        /// Its package.
        package: String,
        /// What cargo says.
        output: String,
    },
    /// QEMU has no such board.
    #[error(
        "{board} ({chip}) cannot be emulated: QEMU has no such machine; microbit and hifive1 can, and `intray flash` takes a \
         scene to a real {board}"
    )]
    NoMachine {
        /// The board's name.
        board: &'static str,
        /// Its chip.
        chip: &'static str,
    },
    /// QEMU is not there.
    #[error(
        "{program} is not installed; `cargo xtask setup` installs it where it can (Debian has it in qemu-system-arm and \
         qemu-system-misc; version 10 or later)"
    )]
    NoQemu {
        /// The program that is missing.
        program: &'static str,
    },
    /// A program cannot be started.
    #[error("{program} cannot be started: {source}")]
    Start {
        /// The program.
        program: String,
        /// The system's reason.
        source: io::Error,
    },
    /// The time is up.
    #[error("{program} was stopped after {} s without an end; more time: --timeout SECONDS", limit.as_secs())]
    Timeout {
        /// The program.
        program: String,
        /// The time it had.
        limit: Duration,
    },
    /// The firmware says what went wrong.
    #[error("on {board}, {status}")]
    Firmware {
        /// The board's name.
        board: &'static str,
        /// How it ended.
        status: Status,
    },
    /// QEMU itself gave up.
    #[error("{program} ended with {status}, which is no status of the firmware{}", separated(complaints))]
    Qemu {
        /// The program.
        program: &'static str,
        /// How it ended.
        status: String,
        /// What it said.
        complaints: String,
    },
    /// What came from the chip is not what a chip sends.
    #[error("what came from the chip is damaged: {0}")]
    Damaged(&'static str),
    /// The ELF is none, or not one of ours.
    #[error("{}: not firmware of this project ({reason})", path.display())]
    Elf {
        /// The file.
        path: PathBuf,
        /// What it lacks.
        reason: String,
    },
    /// The counts of the plugin cannot be read.
    #[error("the instruction counter failed: {0}")]
    Counter(String),
    /// A second run, which counts tests, drew something else.
    #[error("two runs of the same scene on {board} drew different pictures ({first:08x} and {second:08x})")]
    Unequal {
        /// The board's name.
        board: &'static str,
        /// The first picture's CRC-32.
        first: u32,
        /// The second picture's.
        second: u32,
    },
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// A folder for the run cannot be made.
    #[error("no temporary folder: {0}")]
    Folder(io::Error),
}

impl EmulateError {
    pub(crate) fn folder(error: io::Error) -> Self {
        Self::Folder(error)
    }

    /// Whether what was given is at fault, and not what became of it.
    #[must_use]
    pub fn is_input(&self) -> bool {
        !matches!(
            self,
            Self::Timeout { .. }
                | Self::Firmware { .. }
                | Self::Qemu { .. }
                | Self::Damaged(_)
                | Self::Counter(_)
                | Self::Unequal { .. }
        )
    }
}

fn separated(complaints: &str) -> String {
    if complaints.is_empty() { String::new() } else { format!(": {complaints}") }
}
