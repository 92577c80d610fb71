//! What a scene takes on an instruction set: from a real link of its firmware, and from a run of that in an emulator.

use std::collections::BTreeMap;
use std::time::Duration;

use firmware_rt::board::Board;
use host_tools::emulate::counter::Counter;
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware::Wanted;
use host_tools::emulate::machine::Machine;
use host_tools::emulate::{EmulateError, Observer, Run};
use serde::Serialize;

use crate::core::Isa;

/// What blobs are aligned to.
const ALIGNMENT: u64 = 8;

/// What a scene takes.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Need {
    /// Where.
    pub isa: Isa,
    /// The board whose firmware was linked.
    pub board: &'static str,
    /// Code and constants: of the whole firmware, with start-up, log and the sending of the picture.
    pub text_bytes: u64,
    /// The blob.
    pub scene_bytes: u64,
    /// Variables.
    pub static_bytes: u64,
    /// The stack at its deepest while the picture was drawn; where it was not, what the firmware reserves.
    pub stack_bytes: u64,
    /// Whether the stack was measured.
    pub stack_is_measured: bool,
    /// Instructions of a picture, if they could be counted.
    pub instructions: Option<u64>,
    /// Cycles of a picture, by the name of the model.
    pub cycles: BTreeMap<String, u64>,
}

impl Need {
    /// Bytes of flash.
    #[must_use]
    pub const fn flash(&self) -> u64 {
        self.text_bytes.next_multiple_of(ALIGNMENT) + self.scene_bytes
    }

    /// Bytes of RAM.
    #[must_use]
    pub const fn ram(&self) -> u64 {
        self.static_bytes + self.stack_bytes
    }

    /// Bytes for the blob in so much flash.
    #[must_use]
    pub const fn room(&self, flash: u64) -> u64 {
        flash.saturating_sub(self.text_bytes.next_multiple_of(ALIGNMENT))
    }
}

/// A need, and why it is not whole, if so.
#[derive(Clone, Debug)]
pub struct Measured {
    /// What was found.
    pub need: Need,
    /// What could not be found, for a person.
    pub notes: Vec<String>,
}

/// Links the firmware of a blob, and draws its picture in the emulator if both are there.
///
/// # Errors
/// Where the firmware cannot be built, or ends in anything but a picture.
pub fn measure(
    isa: Isa,
    blob: &[u8],
    kernel: u16,
    limit: Duration,
    observer: &mut impl Observer,
) -> Result<Measured, EmulateError> {
    let (board, elf) = linked(isa, blob, kernel)?;
    let mut measured = Measured {
        need: Need {
            isa,
            board: board.name,
            text_bytes: elf.text_bytes,
            scene_bytes: blob.len() as u64,
            static_bytes: elf.static_bytes,
            stack_bytes: isa.boards().first().map_or(0, |board| board.stack.length).into(),
            stack_is_measured: false,
            instructions: None,
            cycles: BTreeMap::new(),
        },
        notes: Vec::new(),
    };
    let Measured { need, notes } = &mut measured;
    let unmeasured = "so there are no seconds, and the stack is taken to be what firmware reserves for it";
    if !takes(board, blob, kernel) {
        let room = board.blob(kernel).length;
        notes.push(format!("{}: the emulated {} has {room} bytes for a blob, {unmeasured}", isa.name(), board.name));
        return Ok(measured);
    }
    let machine = Machine::of(board)?;
    if let Err(error) = machine.version() {
        notes.push(format!("{}: {error}; {unmeasured}", isa.name()));
        return Ok(measured);
    }
    let counter = Counter::provide(&machine);
    if let Err(reason) = &counter {
        notes.push(format!("{}: there are no seconds, as instructions cannot be counted: {reason}", isa.name()));
    }
    let run = Run { board, elf: &elf, blob: Some(blob), counter: counter.as_ref().ok(), limit };
    let outcome = run.perform(observer)?;
    need.stack_bytes = outcome.report.stack_bytes.into();
    need.stack_is_measured = true;
    if let Some(counts) = outcome.counts {
        need.instructions = Some(counts.instructions);
        need.cycles = counts.cycles;
    }
    Ok(measured)
}

/// Whether a board's flash has room for a blob.
fn takes(board: &Board, blob: &[u8], kernel: u16) -> bool {
    blob.len() as u64 <= u64::from(board.blob(kernel).length)
}

/// The firmware of a blob, for the first board that has room for both, else for the last.
fn linked(isa: Isa, blob: &[u8], kernel: u16) -> Result<(&'static Board, Elf), EmulateError> {
    let provide = |board| Ok((board, Wanted { board, blob, hits: None, count: false }.provide()?));
    let Some((last, smaller)) = isa.boards().split_last() else {
        return Err(EmulateError::Damaged("no board is emulated"));
    };
    for board in smaller.iter().filter(|board| takes(board, blob, kernel)) {
        match provide(board) {
            // Its code may be too large for its part of the flash.
            Err(EmulateError::Build { .. }) => {}
            done => return done,
        }
    }
    provide(last)
}
