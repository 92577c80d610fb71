//! A board's firmware in QEMU: built for a blob, run with it in flash, listened to, measured.
//!
//! The picture comes in [`frames`] through a file, the [`log`] through standard output, the end as an exit status, and
//! the number of instructions from a [plugin](counter) that watches from outside.

pub mod breakdown;
pub mod costs;
pub mod counter;
pub mod elf;
mod error;
pub mod firmware;
pub mod frames;
pub mod log;
pub mod machine;
pub mod parts;
pub mod planes;
pub mod probe;
pub mod process;
mod repository;
pub mod routines;

pub use error::EmulateError;

use std::fs;
use std::path::Path;
use std::time::Duration;

use firmware_rt::board::{Board, Region};
use firmware_rt::frame::Report;

use crate::picture::Picture;
use counter::{Counter, Counts};
use elf::Elf;
use frames::Frames;
use log::Log;
use machine::Machine;
use process::Process;

/// Checks that a board can be emulated here: that QEMU, the compiler's library and the sources of its firmware are there.
///
/// # Errors
/// What is missing.
pub fn check(board: &Board) -> Result<(), EmulateError> {
    Machine::of(board)?.version()?;
    firmware::check_board(board)
}

/// Checks that a blob fits its place in a board's flash; `help` says what would make it smaller.
///
/// # Errors
/// [`EmulateError::TooLarge`].
pub fn room(board: &Board, place: Region, bytes: u64, help: impl FnOnce() -> String) -> Result<(), EmulateError> {
    let room = u64::from(place.length);
    if bytes <= room {
        return Ok(());
    }
    Err(EmulateError::TooLarge { board: board.name, bytes, room, help: help() })
}

/// What is told of a run while it goes on.
pub trait Observer {
    /// A line of the firmware's log.
    fn log(&mut self, line: &str);
    /// So many more pixels have come.
    fn pixels(&mut self, count: u64);
}

/// Keeps the log, and nothing else.
impl Observer for Vec<String> {
    fn log(&mut self, line: &str) {
        self.push(line.into());
    }

    fn pixels(&mut self, _: u64) {}
}

/// A run.
#[derive(Debug)]
pub struct Run<'a> {
    /// Where.
    pub board: &'a Board,
    /// The firmware.
    pub elf: &'a Elf,
    /// What to put into the blob's place; `None` where the firmware has it in itself.
    pub blob: Option<&'a [u8]>,
    /// What counts instructions, if anything does.
    pub counter: Option<&'a Counter>,
    /// How long it may take.
    pub limit: Duration,
}

/// What came of a run that ended well.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// The picture.
    pub picture: Picture,
    /// What the firmware says of itself.
    pub report: Report,
    /// Instructions, if they were counted.
    pub counts: Option<Counts>,
}

impl Run<'_> {
    /// Runs the firmware to its end.
    ///
    /// # Errors
    /// Where QEMU cannot be run, the time is up, or the firmware ends in anything but a whole picture.
    pub fn perform(&self, observer: &mut impl Observer) -> Result<Outcome, EmulateError> {
        let mut frames = Frames::default();
        let counts = self.listen(observer, &mut frames)?;
        let (picture, report) = frames.finish()?;
        Ok(Outcome { picture, report, counts })
    }

    /// Runs a firmware that sends no picture to its end, and counts.
    ///
    /// # Errors
    /// As [`Run::perform`], and where there is no counter.
    pub fn count(&self) -> Result<Counts, EmulateError> {
        let counts = self.listen(&mut Vec::new(), &mut Frames::default())?;
        counts.ok_or_else(|| EmulateError::Counter("there is none".into()))
    }

    fn listen(&self, observer: &mut impl Observer, frames: &mut Frames) -> Result<Option<Counts>, EmulateError> {
        let machine = Machine::of(self.board)?;
        let folder = tempfile::Builder::new().prefix("intray-").tempdir().map_err(EmulateError::folder)?;
        let mut pieces = Vec::new();
        for (number, piece) in self.blob.unwrap_or_default().chunks(machine::PIECE).enumerate() {
            let path = folder.path().join(format!("blob.{number}"));
            fs::write(&path, piece).map_err(EmulateError::folder)?;
            pieces.push(path);
        }
        let out = folder.path().join("counts.json");
        let plugin = self.counter.map(|counter| counter.argument(self.elf, &out)).transpose()?;
        let mut command = machine.command(self.elf, &pieces, plugin.as_deref());
        command.current_dir(folder.path());

        let mut log = Log::new(self.elf)?;
        let mut process = Process::start(command, &folder.path().join(frame_file()), self.limit)?;
        while let Some(received) = process.listen()? {
            log.take(&received.output, &mut |line| observer.log(line));
            observer.pixels(frames.take(&received.frames)?);
        }
        let status = process.status();
        machine.judge(status, process.complaints())?;
        self.counter.map(|_| Counts::read(&out)).transpose()
    }
}

/// The name of the file that frames come in.
fn frame_file() -> &'static Path {
    // An ASCII literal.
    Path::new(firmware_rt::frame::FILE.to_str().unwrap_or_default())
}
