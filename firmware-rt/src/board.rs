//! Boards: where code, blob, stack and variables lie.
//!
//! The blob has a part of the flash of its own, so that a scene can change without a rebuild; where it begins depends on the
//! kernel, whose code is larger the wider its numbers are. The stack lies at the
//! bottom of the RAM, as flip-link has it: one that grows too far leaves the RAM and faults, instead of growing into
//! variables.

use core_rt::exact::Exact14;
use core_rt::kernel::Kernel;

/// A run of addresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// The first address.
    pub start: u32,
    /// Bytes.
    pub length: u32,
}

impl Region {
    /// The first address behind it.
    #[must_use]
    pub const fn end(self) -> u32 {
        self.start + self.length
    }
}

/// A board that firmware is built for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Board {
    /// On the command line.
    pub name: &'static str,
    /// Its chip and core.
    pub chip: &'static str,
    /// What rustc calls it.
    pub target: &'static str,
    /// The package of its firmware.
    pub package: &'static str,
    /// The feature of the package that makes it for this board; `None` where it is made for it without one.
    pub feature: Option<&'static str>,
    /// What probe-rs calls the chip.
    pub probe_rs_chip: &'static str,
    /// The number that files for its boot loader's drive have (UF2); `None` where there is no such drive.
    pub uf2_family: Option<u32>,
    /// Flash for the boot loader that is part of the firmware, if one is.
    pub boot: Option<Region>,
    /// Flash for code, constants and the blob.
    pub flash: Region,
    /// The bytes of it that are for code and constants: of `exact14`, and of the other kernels.
    pub code_lengths: [u32; 2],
    /// RAM for the stack, which grows towards the start.
    pub stack: Region,
    /// RAM for variables.
    pub ram: Region,
}

impl Board {
    /// Flash for the code and constants of a kernel's firmware.
    #[must_use]
    pub const fn code(&self, kernel: u16) -> Region {
        let [narrow, wide] = self.code_lengths;
        Region { start: self.flash.start, length: if kernel == Exact14::ID { narrow } else { wide } }
    }

    /// Flash for a kernel's blob.
    #[must_use]
    pub const fn blob(&self, kernel: u16) -> Region {
        let start = self.code(kernel).end();
        Region { start, length: self.flash.end() - start }
    }
}

const KIB: u32 = 1 << 10;

/// BBC micro:bit v1: 256 KiB of flash, 16 KiB of RAM.
pub const MICROBIT: Board = Board {
    name: "microbit",
    chip: "nRF51822, Cortex-M0",
    target: "thumbv6m-none-eabi",
    package: "firmware-cortexm",
    feature: None,
    probe_rs_chip: "nRF51822_xxAA",
    uf2_family: None,
    boot: None,
    flash: Region { start: 0, length: 256 * KIB },
    code_lengths: [80 * KIB, 96 * KIB],
    stack: Region { start: 0x2000_0000, length: 8 * KIB },
    ram: Region { start: 0x2000_2000, length: 8 * KIB },
};

/// SiFive HiFive1 Rev B: 4 MiB of flash, the first 64 KiB of it the boot loader's; 16 KiB of RAM.
pub const HIFIVE1: Board = Board {
    name: "hifive1",
    chip: "FE310, rv32imac",
    target: "riscv32imac-unknown-none-elf",
    package: "firmware-riscv",
    feature: None,
    probe_rs_chip: "fe310-g002",
    uf2_family: None,
    boot: None,
    flash: Region { start: 0x2001_0000, length: 4032 * KIB },
    code_lengths: [448 * KIB; 2],
    stack: Region { start: 0x8000_0000, length: 8 * KIB },
    ram: Region { start: 0x8000_2000, length: 8 * KIB },
};

/// Raspberry Pi Pico: 2 MiB of flash behind a serial bus, which 256 bytes of boot loader at its start set up; 264 KiB of RAM.
///
/// No emulator here has it, and it has not yet been run on hardware: what is built for it is checked, byte by byte.
pub const PICO: Board = Board {
    name: "pico",
    chip: "RP2040, Cortex-M0+",
    target: "thumbv6m-none-eabi",
    package: "firmware-cortexm",
    feature: Some("pico"),
    probe_rs_chip: "RP2040",
    uf2_family: Some(0xe48b_ff56),
    boot: Some(Region { start: 0x1000_0000, length: 0x100 }),
    flash: Region { start: 0x1000_0100, length: 2048 * KIB - 0x100 },
    // The blob begins with a sector of 4 KiB.
    code_lengths: [512 * KIB - 0x100; 2],
    stack: Region { start: 0x2000_0000, length: 16 * KIB },
    ram: Region { start: 0x2000_4000, length: 248 * KIB },
};

/// A micro:bit with more flash and RAM than any has, which an emulator can be told to have: for what fits larger chips of its
/// instruction set. It is no board to ask for.
pub const ROOMY: Board = Board {
    name: "roomy",
    chip: "nRF51822 with more memory, Cortex-M0",
    feature: Some("roomy"),
    flash: Region { start: 0, length: 16 * 1024 * KIB },
    code_lengths: [512 * KIB; 2],
    stack: Region { start: 0x2000_0000, length: 64 * KIB },
    ram: Region { start: 0x2001_0000, length: 192 * KIB },
    ..MICROBIT
};

/// All boards.
pub const BOARDS: [&Board; 3] = [&MICROBIT, &HIFIVE1, &PICO];

/// The board of a name.
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Board> {
    BOARDS.into_iter().find(|board| board.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core_rt::exact::Exact29;

    #[test]
    fn regions_do_not_overlap_and_the_stack_is_at_the_bottom() {
        for (board, all) in BOARDS.into_iter().chain([&ROOMY]).zip([16, 16, 264, 256]) {
            assert_eq!(board.stack.end(), board.ram.start, "{}", board.name);
            assert_eq!(board.stack.length + board.ram.length, all * KIB, "{}", board.name);
            assert!(board.boot.is_none_or(|boot| boot.end() == board.flash.start), "{}", board.name);
            assert_eq!(board.ram.start % 16, 0, "{}", board.name);
            for kernel in [Exact14::ID, Exact29::ID] {
                let (code, blob) = (board.code(kernel), board.blob(kernel));
                assert_eq!(
                    (code.end(), blob.end(), blob.start % 8),
                    (blob.start, board.flash.end(), 0),
                    "{}",
                    board.name
                );
            }
            assert_eq!(by_name(board.name), Some(board).filter(|&board| *board != ROOMY));
        }
        assert_eq!(by_name("no such board"), None);
    }
}
