//! Cores, and which of our programs run on them.

use firmware_rt::board::{Board, HIFIVE1, MICROBIT, ROOMY};
use serde::Serialize;

/// An instruction set that firmware is built for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Isa {
    /// ARMv6-M, which every Cortex-M runs.
    Thumbv6m,
    /// RV32 with multiplication, atomic and compressed instructions.
    Rv32imac,
}

impl Isa {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Thumbv6m, Self::Rv32imac];

    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Thumbv6m => "thumbv6m",
            Self::Rv32imac => "rv32imac",
        }
    }

    /// The boards whose firmware is linked, and run in an emulator, for all chips of it: the first that a scene fits.
    #[must_use]
    pub const fn boards(self) -> &'static [&'static Board] {
        match self {
            Self::Thumbv6m => &[&MICROBIT, &ROOMY],
            Self::Rv32imac => &[&HIFIVE1],
        }
    }
}

/// A core, as far as a program without floats minds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Core {
    /// ARMv6-M, three stages.
    CortexM0,
    /// ARMv6-M, two stages.
    CortexM0Plus,
    /// ARMv7-M.
    CortexM3,
    /// ARMv7E-M without an FPU.
    CortexM4,
    /// The same with one.
    CortexM4F,
    /// ARMv7E-M, with an FPU wherever the table has one.
    CortexM7F,
    /// ARMv8-M, the small one.
    CortexM23,
    /// ARMv8-M with an FPU.
    CortexM33F,
    /// RISC-V without atomic instructions.
    Rv32imc,
    /// RISC-V as firmware is built for.
    Rv32imac,
    /// RISC-V with an FPU.
    Rv32imafc,
    /// RISC-V with half the registers.
    Rv32ec,
}

impl Core {
    /// Its name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::CortexM0 => "Cortex-M0",
            Self::CortexM0Plus => "Cortex-M0+",
            Self::CortexM3 => "Cortex-M3",
            Self::CortexM4 => "Cortex-M4",
            Self::CortexM4F => "Cortex-M4F",
            Self::CortexM7F => "Cortex-M7F",
            Self::CortexM23 => "Cortex-M23",
            Self::CortexM33F => "Cortex-M33F",
            Self::Rv32imc => "rv32imc",
            Self::Rv32imac => "rv32imac",
            Self::Rv32imafc => "rv32imafc",
            Self::Rv32ec => "rv32ec",
        }
    }

    /// Whether it computes with floats itself.
    #[must_use]
    pub const fn has_fpu(self) -> bool {
        matches!(self, Self::CortexM4F | Self::CortexM7F | Self::CortexM33F | Self::Rv32imafc)
    }

    /// What it runs of ours; `None` where that is nothing.
    #[must_use]
    pub const fn isa(self) -> Option<Isa> {
        match self {
            Self::Rv32ec => None,
            // Without atomic instructions it is built for another target of the compiler, with the same instructions else.
            Self::Rv32imc | Self::Rv32imac | Self::Rv32imafc => Some(Isa::Rv32imac),
            _ => Some(Isa::Thumbv6m),
        }
    }

    /// The counter's model of its cycles, or of the nearest Cortex-M that has one; `None` on RISC-V, which has none, so that an
    /// instruction takes a cycle at the least.
    #[must_use]
    pub const fn model(self) -> Option<&'static str> {
        match self {
            Self::CortexM0Plus | Self::CortexM23 => Some("cortex-m0plus"),
            _ => match self.isa() {
                Some(Isa::Thumbv6m) => Some("cortex-m0"),
                _ => None,
            },
        }
    }
}
