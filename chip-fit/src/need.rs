//! What a scene takes on an instruction set: from a real link of its firmware, and from a run of that in an emulator.

use std::collections::BTreeMap;
use std::time::Duration;

use host_tools::emulate::counter::Counter;
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

/// Links the firmware of a blob, and draws its picture in the emulator if both are there: a blob may be too large for the
/// board that is emulated, and still fit a chip.
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
    let board = isa.board();
    let elf = Wanted { board, blob, hits: None, count: false }.provide()?;
    let mut measured = Measured {
        need: Need {
            isa,
            board: board.name,
            text_bytes: elf.text_bytes,
            scene_bytes: blob.len() as u64,
            static_bytes: elf.static_bytes,
            stack_bytes: board.stack.length.into(),
            stack_is_measured: false,
            instructions: None,
            cycles: BTreeMap::new(),
        },
        notes: Vec::new(),
    };
    let Measured { need, notes } = &mut measured;
    let room = board.blob(kernel).length;
    let unmeasured = "so there are no seconds, and the stack is taken to be what is reserved for it";
    if blob.len() as u64 > u64::from(room) {
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
