//! `intray flash`: a scene by a board's firmware, on the board.

use std::path::{Path, PathBuf};
use std::time::Duration;

use firmware_rt::board::Board;
use firmware_rt::build::Traits;
use serde::Serialize;

use super::emulate::Shown;
use super::failure::Failure;
use super::help::smaller;
use super::input::SceneArguments;
use super::load::Scene;
use super::{board, output, progress};
use crate::emulate::elf::Elf;
use crate::emulate::firmware::{self, Transport, Wanted};
use crate::emulate::{Outcome, room};
use crate::files;
use crate::flash::{FlashError, Probe, image, uf2};

/// Render a scene by a board's firmware, on the board: by a debug probe and probe-rs
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// The board
    #[arg(long, value_parser = board::named())]
    board: &'static Board,

    /// Where the picture goes [default: it is received and not kept]
    #[arg(short, value_name = "PNG")]
    output: Option<PathBuf>,

    /// Write a file for the board's own drive instead, and use no probe
    #[arg(long, value_name = "FILE", conflicts_with_all = ["output", "probe", "timeout"])]
    uf2: Option<PathBuf>,

    /// The probe, where there are several (`probe-rs list`)
    #[arg(long, value_name = "VID:PID[:SERIAL]")]
    probe: Option<String>,

    /// Stop after so long
    #[arg(long, value_name = "SECONDS", default_value_t = 600, value_parser = clap::value_parser!(u64).range(1..))]
    timeout: u64,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// The answer.
#[derive(Debug, Serialize)]
struct Report {
    board: &'static str,
    chip: &'static str,
    kernel: &'static str,
    #[serde(flatten)]
    picture: Option<PictureReport>,
    /// Code and constants.
    text_bytes: u64,
    /// The blob.
    scene_bytes: u64,
    elf: PathBuf,
    #[serde(skip_serializing_if = "Option::is_none")]
    uf2: Option<PathBuf>,
}

/// What has come from the board.
#[derive(Debug, Serialize)]
struct PictureReport {
    width: u32,
    height: u32,
    /// CRC-32 of the RGB888 bytes.
    image_crc32: String,
    /// Variables, and the stack at its deepest.
    ram_bytes: u64,
    stack_bytes: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    for path in [&arguments.output, &arguments.uf2].into_iter().flatten() {
        files::check_writable(path)?;
    }
    let board = arguments.board;
    let family = match (&arguments.uf2, board.uf2_family) {
        (None, _) => None,
        (Some(path), Some(family)) => Some((path.as_path(), family)),
        (Some(_), None) => return Err(FlashError::NoUf2 { board: board.name }.into()),
    };
    let scene = arguments.scene.load_for_chip()?;
    let (header, sizes) = scene.engine.inspect(scene.blob.bytes())?;
    let blob = scene.blob.bytes();
    let path = arguments.scene.scene.display();
    let failure = |error: FlashError| match error {
        error if error.is_input() => Failure::input(format!("{path}: {error}")),
        error => Failure::check(error.to_string()),
    };
    firmware::check(board, &Traits::new(scene.engine.id(), &header)).map_err(|error| failure(error.into()))?;
    let place = board.blob(scene.engine.id());
    room(board, place, blob.len() as u64, || smaller(&scene, &header, &sizes, place.length.into()))
        .map_err(|error| failure(error.into()))?;
    let probe = Probe { board, selector: arguments.probe.as_deref() };
    if family.is_none() {
        probe.check()?;
    }

    let spinner = progress::spinner("building the firmware");
    let wanted = Wanted { board, blob, hits: None, count: false };
    let elf = wanted.provide_over(Transport::Rtt).map_err(|error| failure(error.into()))?;
    spinner.finish_and_clear();
    if let Some((path, family)) = family {
        let pieces = image::pieces(board, &elf, blob).map_err(failure)?;
        files::write_atomically(path, &uf2::file(family, &pieces))?;
        return shown(arguments, &report(board, &scene, &elf, None, Some(path)));
    }

    let spinner = progress::spinner("flashing the scene");
    probe.download(&elf, blob).map_err(failure)?;
    spinner.finish_and_clear();
    let bar = progress::bar("flashing the firmware and rendering", header.size.map(u64::from).iter().product());
    let limit = Duration::from_secs(arguments.timeout);
    let outcome = probe.run(&elf, limit, &mut Shown { bar: &bar, is_logged: true });
    bar.finish_and_clear();
    let outcome = outcome.map_err(failure)?;
    if let Some(path) = &arguments.output {
        outcome.picture.write_png(path)?;
    }
    shown(arguments, &report(board, &scene, &elf, Some(&outcome), None))
}

fn report(board: &Board, scene: &Scene, elf: &Elf, outcome: Option<&Outcome>, uf2: Option<&Path>) -> Report {
    Report {
        board: board.name,
        chip: board.chip,
        kernel: scene.engine.name(),
        picture: outcome.map(|Outcome { picture, report, .. }| PictureReport {
            width: picture.width(),
            height: picture.height(),
            image_crc32: format!("{:08x}", picture.crc32()),
            ram_bytes: elf.static_bytes + u64::from(report.stack_bytes),
            stack_bytes: report.stack_bytes.into(),
        }),
        text_bytes: elf.text_bytes,
        scene_bytes: scene.blob.bytes().len() as u64,
        elf: elf.path().into(),
        uf2: uf2.map(Into::into),
    }
}

/// Prints the answer.
fn shown(arguments: &Arguments, report: &Report) -> Result<(), Failure> {
    if arguments.json {
        return output::json(report);
    }
    let Report { board, chip, kernel, picture, text_bytes, scene_bytes, elf, uf2 } = report;
    let flash = format!("flash {text_bytes} bytes of code and {scene_bytes} of scene");
    let elf = elf.display();
    output::line(&match (picture, uf2) {
        (Some(PictureReport { width, height, image_crc32, ram_bytes, stack_bytes }), _) => {
            let place = arguments.output.as_ref().map_or_else(String::new, |path| format!("{}: ", path.display()));
            format!(
                "{place}{width}x{height} by {kernel} on {board} ({chip}), CRC-32 {image_crc32}\n\
                 {flash}; RAM {ram_bytes} bytes, {stack_bytes} of them stack\n{elf}"
            )
        }
        (None, uf2) => {
            let path = uf2.as_ref().map_or_else(String::new, |path| path.display().to_string());
            format!("{path}: {kernel} for {board} ({chip}); {flash}\n{elf}")
        }
    })
}
