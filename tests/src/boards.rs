//! The boards that can be emulated here, and programs for them.

use std::path::{Path, PathBuf};
use std::process::Command;

use firmware_rt::board::{BOARDS, Board};
use host_tools::emulate;
use host_tools::emulate::counter::Counter;
use host_tools::emulate::elf::Elf;
use host_tools::emulate::machine::Machine;

/// The boards that can be emulated and whose emulator and target are installed; of those that lack these it is said that they are skipped.
pub fn boards() -> impl Iterator<Item = &'static Board> {
    BOARDS.into_iter().filter(|board| Machine::of(board).is_ok()).filter(|board| match emulate::check(board) {
        Ok(()) => true,
        Err(error) => {
            println!("skipped {}: {error}", board.name);
            false
        }
    })
}

/// Those of them whose instructions can be counted, each with what counts them.
pub fn counted() -> impl Iterator<Item = (&'static Board, Counter)> {
    boards().filter_map(|board| {
        match Machine::of(board).map_err(|error| error.to_string()).and_then(|machine| Counter::provide(&machine)) {
            Ok(counter) => Some((board, counter)),
            Err(reason) => {
                println!("skipped {}: {reason}", board.name);
                None
            }
        }
    })
}

/// A program of a board's package other than its firmware, by the first part of its name.
///
/// # Panics
/// If it cannot be built.
#[must_use]
pub fn program(board: &Board, kind: &str) -> Elf {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let target = std::path::absolute(target).expect("there is a current folder");
    let name = board.package.replace("firmware", kind);
    let status = Command::new(env!("CARGO"))
        .args(["build", "--quiet", "--profile", "firmware", "--package", board.package, "--bin", &name])
        .args(["--target", board.target])
        .env("CARGO_TARGET_DIR", &target)
        .current_dir(&root)
        .status();
    assert!(status.expect("cargo can be started").success());
    Elf::read(&target.join(board.target).join("firmware").join(name), board).expect("it was just built")
}
