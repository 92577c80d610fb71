//! A point on an emulated chip.

use std::collections::BTreeMap;
use std::time::Duration;

use firmware_rt::build::Traits;

use super::measure::Picked;
use super::row::{Cost, Instructions, Machine, Measured};
use super::trouble::Trouble;
use crate::emulate::counter::Counter;
use crate::emulate::firmware::{self, Wanted};
use crate::emulate::{self, EmulateError, Outcome, Run, machine, planes, room};
use crate::engine::PLANES12;

/// The chips that can be emulated here.
#[derive(Debug)]
pub(super) struct Chips {
    counters: BTreeMap<Machine, Counter>,
    limit: Duration,
}

impl Chips {
    /// Those of `machines` that there are, and why there are no others. A run has `limit`.
    pub(super) fn find(machines: impl Iterator<Item = Machine>, limit: Duration) -> (Self, Vec<String>) {
        let (mut counters, mut notes) = (BTreeMap::new(), Vec::new());
        for (machine, board) in machines.filter_map(|machine| Some((machine, machine.board()?))) {
            let there = emulate::check(board).and_then(|()| machine::Machine::of(board));
            match there.map_err(|error| error.to_string()).and_then(|emulator| Counter::provide(&emulator)) {
                Ok(counter) => drop(counters.insert(machine, counter)),
                Err(reason) => notes.push(format!("There are no rows of {} ({}): {reason}.", board.name, board.chip)),
            }
        }
        (Self { counters, limit }, notes)
    }

    /// Whether points can be measured on a machine; on the host they always can.
    pub(super) fn has(&self, machine: Machine) -> bool {
        machine == Machine::Host || self.counters.contains_key(&machine)
    }

    /// Runs a point's blob. Rays and tests are the host's: the picture is, and tests of the firmware hold it to the same
    /// counts.
    pub(super) fn run(&self, machine: Machine, picked: Picked) -> Result<Measured, Trouble> {
        let (Some(board), Some(counter)) = (machine.board(), self.counters.get(&machine)) else {
            return Err(Trouble::Broken("no such chip".into()));
        };
        let Picked { engine, blob, picture, measured } = picked;
        let blob = blob.bytes();
        let is_planes = engine.id() == PLANES12.id();
        if !is_planes {
            let traits = Traits::of(blob).ok_or_else(|| Trouble::Broken("the blob has no header".into()))?;
            firmware::check(board, &traits).map_err(Trouble::emulate)?;
        }
        let help = || "fewer triangles, or the kernel exact14, whose records are the smallest".into();
        room(board, planes::place(board, engine.id()), blob.len() as u64, help).map_err(Trouble::emulate)?;
        let wanted = Wanted { board, blob, hits: None, count: false };
        let elf = if is_planes { planes::provide(board) } else { wanted.provide() }.map_err(Trouble::emulate)?;
        let run = Run { board, elf: &elf, blob: Some(blob), counter: Some(counter), limit: self.limit };
        let Outcome { picture: drawn, report, counts } = run.perform(&mut Vec::new()).map_err(Trouble::emulate)?;
        if drawn != picture {
            let (chip, host) = (drawn.crc32(), picture.crc32());
            return Err(Trouble::Broken(format!(
                "the picture of {} is not the host's (CRC-32 {chip:08x} and {host:08x})",
                board.name
            )));
        }
        let none = || Trouble::emulate(EmulateError::Counter("nothing was counted".into()));
        let counts = counts.ok_or_else(none)?;
        let cost = Cost::Instructions(Instructions {
            instructions: counts.instructions,
            cycles: counts.cycles,
            text_bytes: elf.text_bytes,
            ram_bytes: elf.static_bytes + u64::from(report.stack_bytes),
        });
        Ok(Measured { cost, ..measured })
    }
}
