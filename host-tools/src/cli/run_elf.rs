//! `intray run-elf`: the runner of `cargo run` for firmware, by the root's `.cargo/config.toml`.

use std::path::{Path, PathBuf};
use std::time::Duration;

use firmware_rt::board::{Board, Region};

use super::emulate::Shown;
use super::failure::Failure;
use super::{board, output, progress};
use crate::emulate::elf::Elf;
use crate::emulate::machine::Machine;
use crate::emulate::{EmulateError, Run, room};
use crate::files;

/// Run a firmware in QEMU
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// The firmware
    elf: PathBuf,

    /// The board
    #[arg(long, value_parser = board::named())]
    board: &'static Board,

    /// What to put into the blob's place [default: what the firmware has there]
    #[arg(long)]
    blob: Option<PathBuf>,

    /// Where the picture goes [default: beside the firmware]
    #[arg(short, value_name = "PNG")]
    output: Option<PathBuf>,

    /// Stop QEMU after so long
    #[arg(long, value_name = "SECONDS", default_value_t = 600, value_parser = clap::value_parser!(u64).range(1..))]
    timeout: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let board = arguments.board;
    let path = arguments.output.clone().unwrap_or_else(|| arguments.elf.with_extension("png"));
    files::check_writable(&path)?;
    let failure = |error: EmulateError| {
        if error.is_input() { Failure::input(error.to_string()) } else { Failure::check(error.to_string()) }
    };
    let machine = Machine::of(board).map_err(failure)?;
    let elf = Elf::read(&arguments.elf, board).map_err(failure)?;
    let blob = arguments.blob.as_deref().map(files::read).transpose()?;
    if let Some(blob) = &blob {
        let place = elf.blob_place.unwrap_or(Region { start: 0, length: 0 });
        room(board, place, blob.len() as u64, || "a smaller blob".into()).map_err(failure)?;
    }
    machine.version().map_err(failure)?;

    let bar = progress::spinner("running");
    let limit = Duration::from_secs(arguments.timeout);
    let outcome = Run { board, elf: &elf, blob: blob.as_deref(), counter: None, limit }
        .perform(&mut Shown { bar: &bar, is_logged: true });
    bar.finish_and_clear();
    let outcome = outcome.map_err(failure)?;
    outcome.picture.write_png(&path)?;
    shown(&path, &elf, &outcome)
}

fn shown(path: &Path, elf: &Elf, outcome: &crate::emulate::Outcome) -> Result<(), Failure> {
    let stack = u64::from(outcome.report.stack_bytes);
    output::line(&format!(
        "{}: {}x{}, CRC-32 {:08x}\nflash {} bytes of code and {} of scene; RAM {} bytes, {stack} of them stack",
        path.display(),
        outcome.picture.width(),
        outcome.picture.height(),
        outcome.picture.crc32(),
        elf.text_bytes,
        elf.blob_bytes,
        elf.static_bytes + stack,
    ))
}
