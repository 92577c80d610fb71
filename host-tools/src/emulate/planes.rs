//! Firmware of the tracer of 1994: one for a board and all of its scenes.

use std::path::Path;

use core_rt::exact::Exact14;
use core_rt::kernel::Kernel;
use core_rt::profile::Prefer;
use firmware_rt::board::{Board, Region};
use planes_rt::blob::KERNEL;

use super::EmulateError;
use super::elf::Elf;
use super::firmware::{cargo_profile, check_board, kept};
use super::repository::Repository;
use crate::files;
use crate::planes::NAME;

/// Where a board's firmware has its blob, by the kernel's number: that of this kernel has the linker script of firmware for the
/// default blob.
#[must_use]
pub fn place(board: &Board, kernel: u16) -> Region {
    board.blob(if kernel == KERNEL { Exact14::ID } else { kernel })
}

/// The firmware for QEMU, built if need be.
///
/// # Errors
/// Where it cannot be built.
pub fn provide(board: &Board) -> Result<Elf, EmulateError> {
    check_board(board)?;
    let folders = ["core-rt", "firmware-rt", "planes-rt", board.package];
    kept(board, &format!("{}-{NAME}", board.name), &folders, |repository, path| build(board, repository, path))
}

fn build(board: &Board, repository: &Repository, path: &Path) -> Result<(), EmulateError> {
    let Board { target, package, .. } = *board;
    let (profile, program) = (cargo_profile(Prefer::Speed), package.replace("firmware", "planes"));
    let mut arguments =
        vec!["build", "--package", package, "--bin", &program, "--target", target, "--profile", profile];
    arguments.extend(board.feature.into_iter().chain(["planes"]).flat_map(|feature| ["--features", feature]));
    repository.cargo(&arguments, &[]).map_err(|output| EmulateError::Build { package: package.into(), output })?;
    let built = repository.target().join(target).join(profile).join(&program);
    Ok(files::write_atomically(path, &files::read(&built)?)?)
}
