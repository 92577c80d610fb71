//! The boards as QEMU has them.

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Stdio};

use firmware_rt::board::{Board, HIFIVE1, MICROBIT, ROOMY};
use firmware_rt::status::Status;

use super::EmulateError;
use super::elf::Elf;

/// QEMU loads no raw file that is larger than the machine's RAM: 16 KiB, wherever in the flash it is for.
pub(super) const PIECE: usize = 1 << 14;

/// The micro:bit with the memory of [`ROOMY`], byte by byte.
const ROOMY_ARGUMENTS: [&str; 6] =
    ["-M", "microbit", "-global", "nrf51-soc.flash-size=16777216", "-global", "nrf51-soc.sram-size=262144"];

/// A board in QEMU.
#[derive(Clone, Copy, Debug)]
pub struct Machine {
    board: &'static str,
    program: &'static str,
    arguments: &'static [&'static str],
}

impl Machine {
    /// The machine of a board.
    ///
    /// # Errors
    /// [`EmulateError::NoMachine`] where QEMU has none.
    pub fn of(board: &Board) -> Result<Self, EmulateError> {
        let (program, arguments): (_, &[_]) = match *board {
            MICROBIT => ("qemu-system-arm", &["-M", "microbit"]),
            ROOMY => ("qemu-system-arm", &ROOMY_ARGUMENTS),
            // Revision B starts where the flash of the real board does.
            HIFIVE1 => ("qemu-system-riscv32", &["-M", "sifive_e,revb=true", "-bios", "none"]),
            Board { name: board, chip, .. } => return Err(EmulateError::NoMachine { board, chip }),
        };
        Ok(Self { board: board.name, program, arguments })
    }

    /// The program.
    #[must_use]
    pub fn program(&self) -> &'static str {
        self.program
    }

    /// The major version of QEMU.
    ///
    /// # Errors
    /// Where it is not there.
    pub fn version(&self) -> Result<u32, EmulateError> {
        let output = Command::new(self.program).arg("--version").stdin(Stdio::null()).output();
        let text = match output {
            Ok(output) => String::from_utf8_lossy(&output.stdout).into_owned(),
            Err(_) => return Err(EmulateError::NoQemu { program: self.program }),
        };
        let number = text.split_whitespace().skip_while(|&word| word != "version").nth(1);
        let major = number.and_then(|number| number.split('.').next()?.parse().ok());
        Ok(major.unwrap_or_default())
    }

    /// QEMU with firmware, and with the pieces of a blob in its place.
    pub(super) fn command(&self, elf: &Elf, pieces: &[PathBuf], plugin: Option<&OsStr>) -> Command {
        let mut command = Command::new(self.program);
        command.args(self.arguments);
        command.args(["-nographic", "-monitor", "none", "-serial", "none"]);
        // Without semihosting both machines would wait for ever at the first word to the host.
        command.args(["-semihosting-config", "enable=on,target=native", "-kernel"]).arg(elf.path());
        let start = elf.blob_place.map_or(0, |place| place.start);
        for (piece, address) in pieces.iter().zip((start..).step_by(PIECE)) {
            let mut device = OsString::from("loader,file=");
            device.push(doubled(piece));
            device.push(format!(",addr={address:#x},force-raw=on"));
            command.arg("-device").arg(device);
        }
        if let Some(plugin) = plugin {
            command.arg("-plugin").arg(plugin);
        }
        command
    }

    /// Whether the end was a good one.
    pub(super) fn judge(&self, status: ExitStatus, complaints: &str) -> Result<(), EmulateError> {
        match status.code().and_then(Status::from_code) {
            Some(Status::Done) => Ok(()),
            Some(status) => Err(EmulateError::Firmware { board: self.board, status }),
            None => Err(EmulateError::Qemu {
                program: self.program,
                status: status.to_string(),
                complaints: complaints.trim().to_owned(),
            }),
        }
    }
}

/// A path as QEMU's option lists take it: a comma is doubled.
pub(super) fn doubled(path: &Path) -> OsString {
    match path.to_str() {
        Some(text) => text.replace(',', ",,").into(),
        None => path.into(),
    }
}
