//! How long a board takes for a picture: exact instructions of its firmware in an emulator, and the cycles of a model.

use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

use firmware_rt::board::{Board, HIFIVE1, MICROBIT, PICO, ROOMY};
use firmware_rt::build::Traits;
use host_tools::emulate::counter::Counter;
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware::{self, Wanted};
use host_tools::emulate::machine::Machine;
use host_tools::emulate::{EmulateError, Run, planes};
use host_tools::engine::{Engine, PLANES12};
use host_tools::picture::Picture;
use host_tools::prepare::Options;

use crate::desk::Desk;
use crate::kernels::KERNELS;
use crate::painter::{Scene, View};

/// How long an emulator may take.
const LIMIT: Duration = Duration::from_secs(600);

/// A board that a picture can be timed for.
#[derive(Clone, Copy, Debug)]
pub struct Target {
    /// The board.
    pub board: &'static Board,
    /// Its clock, as `docs/BOARDS.md` has it; of the FE310, the greatest.
    pub clock_mhz: u32,
    /// The counter's model of its cycles; `None` where an instruction is taken to need one, which is the least.
    pub model: Option<&'static str>,
    /// The boards whose firmware runs in an emulator for it, by the same instructions: the first that a scene fits.
    emulated: &'static [&'static Board],
}

/// All of them.
pub const TARGETS: [Target; 3] = [
    Target { board: &MICROBIT, clock_mhz: 16, model: Some("cortex-m0"), emulated: &[&MICROBIT] },
    Target { board: &HIFIVE1, clock_mhz: 320, model: None, emulated: &[&HIFIVE1] },
    Target { board: &PICO, clock_mhz: 125, model: Some("cortex-m0plus"), emulated: &[&MICROBIT, &ROOMY] },
];

/// What a board takes for a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Exact, of the emulated firmware.
    pub instructions: u64,
    /// Of the model, where there is one.
    pub cycles: u64,
    /// Cycles over the clock.
    pub seconds: f64,
    /// Bytes of the scene.
    pub blob_bytes: u64,
    /// Whether the emulated chip's picture is the one that is shown, bit for bit.
    pub is_same: bool,
}

/// A picture to be timed.
#[derive(Clone, Debug)]
pub struct Job {
    /// The number of the wish that it is of.
    pub serial: u64,
    /// What it shows.
    pub view: View,
    /// The full picture.
    pub picture: Picture,
    /// Where: a place among [`TARGETS`].
    pub target: usize,
}

/// Times whatever is laid on the desk until that is closed. A job is not begun where `newest` is no longer its wish.
pub fn work(scene: &Scene, desk: &Desk<Job>, newest: &AtomicU64, tell: &dyn Fn(u64, Result<Effort, String>)) {
    while let Some(job) = desk.take() {
        if newest.load(Ordering::Relaxed) == job.serial {
            tell(job.serial, effort(scene, &job));
        }
    }
}

/// What a picture takes.
///
/// # Errors
/// Why that cannot be said, for a person.
pub fn effort(scene: &Scene, job: &Job) -> Result<Effort, String> {
    let target = &TARGETS[job.target];
    let engine = KERNELS[job.view.kernel];
    let prepared = engine.prepare(&job.view.of(scene), &Options::default()).map_err(|error| error.to_string())?;
    let blob = prepared.blob.bytes();
    let room = planes::place(target.board, engine.id()).length;
    let blob_bytes = blob.len() as u64;
    if blob_bytes > u64::from(room) {
        return Err(format!("the scene has {blob_bytes} bytes, and {} has room for {room}", target.board.name));
    }
    let short = |error: EmulateError| error.to_string().lines().next().unwrap_or_default().to_owned();
    let (last, others) = target.emulated.split_last().ok_or("it cannot be emulated")?;
    let fits = |board: &&&'static Board| blob_bytes <= u64::from(planes::place(board, engine.id()).length);
    let board = others.iter().find(fits).unwrap_or(last);
    run(target, board, engine, blob, &job.picture).map_err(short)
}

/// Runs the firmware, and counts.
fn run(
    target: &Target,
    board: &'static Board,
    engine: &dyn Engine,
    blob: &[u8],
    shown: &Picture,
) -> Result<Effort, EmulateError> {
    let elf = elf(board, engine, blob)?;
    let machine = Machine::of(board)?;
    machine.version()?;
    let counter = Counter::provide(&machine).map_err(EmulateError::Counter)?;
    let run = Run { board, elf: &elf, blob: Some(blob), counter: Some(&counter), limit: LIMIT };
    let outcome = run.perform(&mut Vec::new())?;
    let instructions = outcome.counts.as_ref().map(|counts| counts.instructions);
    let cycles = match (target.model, &outcome.counts) {
        (Some(model), Some(counts)) => counts.cycles.get(model).copied(),
        _ => instructions,
    };
    let (Some(instructions), Some(cycles)) = (instructions, cycles) else {
        return Err(EmulateError::Counter("nothing was counted".into()));
    };
    let seconds = cycles as f64 / (f64::from(target.clock_mhz) * 1e6);
    let is_same = outcome.picture == *shown;
    Ok(Effort { instructions, cycles, seconds, blob_bytes: blob.len() as u64, is_same })
}

/// The kernel's firmware for a board.
fn elf(board: &'static Board, engine: &dyn Engine, blob: &[u8]) -> Result<Elf, EmulateError> {
    if engine.id() == PLANES12.id() {
        return planes::provide(board);
    }
    let (header, _) = engine.inspect(blob).map_err(|_| EmulateError::Damaged("the blob is not the kernel's"))?;
    firmware::check(board, &Traits::new(engine.id(), &header))?;
    Wanted { board, blob, hits: None, count: false }.provide()
}
