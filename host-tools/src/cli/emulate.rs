//! `intray emulate`: a scene by a board's firmware, in QEMU.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::time::Duration;

use firmware_rt::board::Board;
use firmware_rt::build::Traits;
use firmware_rt::hits::Way;
use indicatif::ProgressBar;
use serde::Serialize;

use super::failure::{Failure, warn};
use super::help::smaller;
use super::input::SceneArguments;
use super::load::Scene;
use super::planes::Emulation;
use super::{board, output, progress};
use crate::emulate::breakdown::Breakdown;
use crate::emulate::counter::{Counter, Counts};
use crate::emulate::elf::Elf;
use crate::emulate::firmware::{self, Wanted};
use crate::emulate::machine::Machine;
use crate::emulate::{EmulateError, Observer, Outcome, Run, room};
use crate::files;

/// Render a scene by a board's firmware, in QEMU
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// The board
    #[arg(long, value_parser = board::named())]
    board: &'static Board,

    /// Where the picture goes
    #[arg(short, value_name = "PNG")]
    output: PathBuf,

    /// Find the nearest hits of camera rays and nothing else, and show the triangles' numbers as colours
    #[arg(long, value_enum)]
    hits: Option<Hits>,

    /// Count the instructions by part of the program and by kind of ray
    #[arg(long)]
    breakdown: bool,

    /// Stop QEMU after so long
    #[arg(long, value_name = "SECONDS", default_value_t = 600, value_parser = clap::value_parser!(u64).range(1..))]
    timeout: u64,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// How the nearest hits are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, clap::ValueEnum)]
#[serde(rename_all = "lowercase")]
enum Hits {
    /// One ray at a time
    Single,
    /// A tile of rays at a time
    Tile,
}

impl From<Hits> for Way {
    fn from(hits: Hits) -> Self {
        match hits {
            Hits::Single => Self::Single,
            Hits::Tile => Self::Tile,
        }
    }
}

/// The answer.
#[derive(Debug, Serialize)]
struct Report {
    board: &'static str,
    chip: &'static str,
    kernel: &'static str,
    hits: Option<Hits>,
    width: u32,
    height: u32,
    /// CRC-32 of the RGB888 bytes.
    image_crc32: String,
    rays: u64,
    primary_rays: u64,
    shadow_rays: u64,
    reflection_rays: u64,
    refraction_rays: u64,
    box_tests: u64,
    triangle_tests: u64,
    /// From the first camera ray of each tile to its last pixel; none where they cannot be counted.
    instructions: Option<u64>,
    instructions_per_ray: Option<f64>,
    /// Checking the blob, sending, start and end.
    instructions_apart: Option<u64>,
    /// Of the counted instructions, by the name of the model.
    cycles: Option<BTreeMap<String, u64>>,
    /// Code and constants.
    text_bytes: u64,
    /// The blob.
    scene_bytes: u64,
    /// Variables, and the stack at its deepest.
    ram_bytes: u64,
    stack_bytes: u64,
    elf: PathBuf,
    #[serde(skip_serializing_if = "Option::is_none")]
    breakdown: Option<Breakdown>,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    files::check_writable(&arguments.output)?;
    let board = arguments.board;
    let machine = Machine::of(board)?;
    if arguments.scene.is_planes() {
        if arguments.hits.is_some() || arguments.breakdown {
            return Err(Failure::input("--hits and --breakdown are of kernels with a tree; planes12 has neither"));
        }
        let limit = Duration::from_secs(arguments.timeout);
        let (scene, path, as_json) = (&arguments.scene, arguments.output.as_path(), arguments.json);
        return super::planes::emulate(Emulation { scene, board, path, limit, as_json });
    }
    let scene = arguments.scene.load_for_chip()?;
    let (header, sizes) = scene.engine.inspect(scene.blob.bytes())?;
    let failure = |error: EmulateError| match error {
        error if error.is_input() => Failure::input(format!("{}: {error}", arguments.scene.scene.display())),
        error => Failure::check(error.to_string()),
    };
    let bytes = scene.blob.bytes();
    firmware::check(board, &Traits::new(scene.engine.id(), &header)).map_err(failure)?;
    let place = board.blob(scene.engine.id());
    room(board, place, bytes.len() as u64, || smaller(&scene, &header, &sizes, place.length.into()))
        .map_err(failure)?;

    machine.version().map_err(failure)?;
    let hits = arguments.hits.map(Way::from);
    let wanted = Wanted { board, blob: bytes, hits, count: false };
    let spinner = progress::spinner("building the firmware");
    let elf = wanted.provide().map_err(failure)?;
    let counting = Wanted { count: true, ..wanted }.provide().map_err(failure)?;
    let marked = arguments.breakdown.then(|| wanted.provide_marked()).transpose().map_err(failure)?;
    let counter = Counter::provide(&machine);
    spinner.finish_and_clear();
    let counter = counter.inspect_err(|reason| warn(format_args!("instructions are not counted: {reason}"))).ok();

    let limit = Duration::from_secs(arguments.timeout);
    let run = |elf, counter, what, is_logged| {
        let bar = progress::bar(what, header.size.map(u64::from).iter().product());
        let outcome =
            Run { board, elf, blob: Some(bytes), counter, limit }.perform(&mut Shown { bar: &bar, is_logged });
        bar.finish_and_clear();
        outcome.map_err(failure)
    };
    let outcome = run(&elf, counter.as_ref(), "rendering", true)?;
    // Counting rays and tests takes instructions, so it is done by itself.
    let counted = run(&counting, None, "counting", false)?;
    let (first, second) = (outcome.picture.crc32(), counted.picture.crc32());
    if first != second {
        return Err(failure(EmulateError::Unequal { board: board.name, first, second }));
    }
    let breakdown = match (&marked, &counter) {
        (Some(marked), Some(counter)) => {
            let third = run(marked, Some(&counter.by_part()), "breaking down", false)?;
            Some(broken_down(&outcome, &counted, &third).map_err(failure)?)
        }
        _ => None,
    };
    outcome.picture.write_png(&arguments.output)?;
    let report = Report { breakdown, ..report(arguments, board, &scene, &elf, outcome, &counted) };
    if arguments.json { output::json(&report) } else { output::line(&text(arguments, &report)) }
}

/// Shows a run on the terminal.
pub(super) struct Shown<'a> {
    pub(super) bar: &'a ProgressBar,
    pub(super) is_logged: bool,
}

impl Observer for Shown<'_> {
    fn log(&mut self, line: &str) {
        if self.is_logged {
            self.bar.suspend(|| super::failure::note(line));
        }
    }

    fn pixels(&mut self, count: u64) {
        self.bar.inc(count);
    }
}

/// What the instructions were for, from runs without marks, with counts of rays, and with marks.
fn broken_down(plain: &Outcome, counted: &Outcome, marked: &Outcome) -> Result<Breakdown, EmulateError> {
    let instructions = |outcome: &Outcome| outcome.counts.as_ref().map_or(0, |counts| counts.instructions);
    let work = &counted.report;
    let rays = [work.primary_rays, work.shadow_rays, work.reflection_rays, work.refraction_rays];
    let none = || EmulateError::Counter("nothing was counted".into());
    Breakdown::new(marked.counts.as_ref().ok_or_else(none)?, instructions(plain), rays)
}

fn report(
    arguments: &Arguments,
    board: &Board,
    scene: &Scene,
    elf: &Elf,
    outcome: Outcome,
    counted: &Outcome,
) -> Report {
    let Outcome { picture, report, counts } = outcome;
    let work = counted.report;
    let rays = work.primary_rays + work.shadow_rays + work.reflection_rays + work.refraction_rays;
    let instructions = counts.as_ref().map(|counts| counts.instructions);
    let apart = |counts: &Counts| counts.run.instructions.saturating_sub(counts.instructions);
    Report {
        board: board.name,
        chip: board.chip,
        kernel: scene.engine.name(),
        hits: arguments.hits,
        width: picture.width(),
        height: picture.height(),
        image_crc32: format!("{:08x}", picture.crc32()),
        rays,
        primary_rays: work.primary_rays,
        shadow_rays: work.shadow_rays,
        reflection_rays: work.reflection_rays,
        refraction_rays: work.refraction_rays,
        box_tests: work.box_tests,
        triangle_tests: work.triangle_tests,
        instructions,
        instructions_per_ray: instructions.map(|instructions| instructions as f64 / rays.max(1) as f64),
        instructions_apart: counts.as_ref().map(apart),
        cycles: counts.map(|counts| counts.cycles),
        text_bytes: elf.text_bytes,
        scene_bytes: scene.blob.bytes().len() as u64,
        ram_bytes: elf.static_bytes + u64::from(report.stack_bytes),
        stack_bytes: report.stack_bytes.into(),
        elf: elf.path().into(),
        breakdown: None,
    }
}

/// The answer for a person.
fn text(arguments: &Arguments, report: &Report) -> String {
    let per_ray = |count: u64| count as f64 / report.rays.max(1) as f64;
    let instructions = match (report.instructions, report.instructions_per_ray) {
        (Some(all), Some(per_ray)) => format!("{all} instructions, {per_ray:.0} a ray"),
        _ => "instructions not counted".into(),
    };
    let breakdown = report.breakdown.as_ref().map_or_else(String::new, |breakdown| format!("\n{}", breakdown.table()));
    format!(
        "{}: {}x{} by {} on {} ({}), {} rays: {instructions}, {:.1} box and {:.1} triangle tests a ray, CRC-32 {}\n\
         flash {} bytes of code and {} of scene; RAM {} bytes, {} of them stack\n\
         {}{breakdown}",
        arguments.output.display(),
        report.width,
        report.height,
        report.kernel,
        report.board,
        report.chip,
        report.rays,
        per_ray(report.box_tests),
        per_ray(report.triangle_tests),
        report.image_crc32,
        report.text_bytes,
        report.scene_bytes,
        report.ram_bytes,
        report.stack_bytes,
        report.elf.display(),
    )
}
