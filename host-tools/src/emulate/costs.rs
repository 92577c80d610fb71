//! What each need of a scene costs on a board: bytes of code, by linking rendering code with it and without it, and
//! instructions, by the [routines](super::routines) that are there for it and by the rays that are.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

use core_rt::profile::{Need, Needs, Prefer};
use firmware_rt::board::Board;

use super::counter::{Counter, Counts};
use super::elf::Elf;
use super::firmware::Wanted;
use super::probe::{EMPTY, Probe, WHOLE, without};
use super::routines::routines;
use super::{EmulateError, Observer, Run};

/// What a need costs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cost {
    /// The need.
    pub need: Need,
    /// Bytes of code and constants that would not be there without it; negative where the optimiser does better with it.
    pub code_bytes: i64,
    /// Instructions of its routines, and of the rays that it adds: shadows, mirror images, rays through surfaces; none where
    /// nothing counts them. Rays' shading is also that of other needs, so these do not sum up to all.
    pub instructions: Option<u64>,
}

/// What all needs cost.
#[derive(Clone, Debug)]
pub struct Costs {
    /// Bytes of code and constants for checking and rendering.
    pub code_bytes: u64,
    /// Instructions of the picture; none where nothing counts them.
    pub instructions: Option<u64>,
    /// Bytes of RAM: variables, and the stack at its deepest.
    pub ram_bytes: u64,
    /// A need each, in the order of their bits.
    pub needs: Vec<Cost>,
}

/// What is left of an address that no need asks for.
const REST: &str = "rest";

/// The name in a list of ranges of a need's routines.
fn name(need: Need) -> String {
    format!("need-{}", need.bit())
}

/// The kind of rays that a need adds, by its place in counts.
const fn kind(need: Need) -> Option<usize> {
    match need {
        Need::Shadows => Some(1),
        Need::Reflection => Some(2),
        Need::Refraction => Some(3),
        _ => None,
    }
}

/// The ranges of an ELF's code by need, as the counter reads them: what no need asks for is the rest's, and what serves
/// whoever calls it is the caller's.
pub(super) fn ranges(elf: &Elf, needs: Needs, shared: &str) -> Result<String, EmulateError> {
    let mut by_need = BTreeMap::new();
    for routine in routines(elf.bytes()).map_err(|error| elf.unfit(error))? {
        let Some(&need) = routine.needs.iter().find(|&&need| needs.has(need)) else { continue };
        by_need.extend((routine.start..routine.start + routine.size).step_by(2).map(|address| (address, need)));
    }
    let mut list = String::new();
    for part in elf.parts()? {
        for address in (part.start..part.start + part.size).step_by(2) {
            let name = match (by_need.get(&address), part.part) {
                (Some(&need), _) => name(need),
                (None, Some(_)) => REST.into(),
                (None, None) => shared.into(),
            };
            // A string takes text.
            let _ = writeln!(list, "{address:#x} 2 {name}");
        }
    }
    Ok(list)
}

/// The instructions of each need.
fn of_needs(counts: &Counts, needs: Needs) -> BTreeMap<u32, u64> {
    let of = |need: Need| {
        let own = name(need);
        let rays = |rays: [u64; 4], is_own: bool| match kind(need) {
            _ if is_own => rays.iter().sum(),
            Some(kind) => rays[kind],
            None => 0,
        };
        counts.symbols.iter().map(|named| rays(named.rays.unwrap_or_default(), named.name == own)).sum()
    };
    needs.iter().map(|need| (need.bit(), of(need))).collect()
}

/// Measures what the needs of a blob cost on a board. `done` is told of each step, of as many as there are needs and three.
///
/// # Errors
/// Where firmware cannot be built or run.
pub fn measure(
    board: &'static Board,
    blob: &[u8],
    needs: Needs,
    counter: Option<&Counter>,
    limit: Duration,
    done: &mut dyn FnMut(),
) -> Result<Costs, EmulateError> {
    let folder = tempfile::Builder::new().prefix("intray-").tempdir().map_err(EmulateError::folder)?;
    let path = folder.path().join("scene.blob");
    std::fs::write(&path, blob).map_err(EmulateError::folder)?;
    let size = |program: &str, needs: Option<Needs>, blob: Option<&Path>| {
        Probe { board, program, prefer: Prefer::Speed, blob, needs }.provide().map(|elf| elf.text_bytes)
    };
    let empty = size(EMPTY, None, None)?;
    let whole = size(WHOLE, Some(needs), Some(&path))?;
    done();

    let wanted = Wanted { board, blob, hits: None, count: false };
    let run = |elf: &Elf, counter| {
        Run { board, elf, blob: Some(blob), counter, limit }
            .perform(&mut Silent)
            .map(|outcome| (outcome.counts, elf.static_bytes + u64::from(outcome.report.stack_bytes)))
    };
    let (counts, ram_bytes) = run(&wanted.provide()?, counter)?;
    done();
    let by_need = match counter {
        Some(counter) => run(&wanted.provide_marked()?, Some(&counter.by_need(needs)))?.0,
        None => None,
    };
    let by_need = by_need.map(|counts| of_needs(&counts, needs));
    done();

    let mut found = Vec::new();
    for need in needs.iter() {
        let less = size(WHOLE, Some(without(needs, need)), Some(&path))?;
        let instructions = by_need.as_ref().map(|by_need| by_need.get(&need.bit()).copied().unwrap_or_default());
        found.push(Cost { need, code_bytes: whole.cast_signed() - less.cast_signed(), instructions });
        done();
    }
    let instructions = counts.map(|counts| counts.instructions);
    Ok(Costs { code_bytes: whole.saturating_sub(empty), instructions, ram_bytes, needs: found })
}

/// Shows nothing.
struct Silent;

impl Observer for Silent {
    fn log(&mut self, _: &str) {}

    fn pixels(&mut self, _: u64) {}
}
