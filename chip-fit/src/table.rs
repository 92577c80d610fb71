//! What the database does not say of chips: the core exactly, and the greatest clock that the data sheet allows.

use crate::core::Core::{
    self, CortexM0, CortexM0Plus, CortexM3, CortexM4, CortexM4F, CortexM7F, CortexM23, CortexM33F, Rv32ec, Rv32imac,
    Rv32imafc, Rv32imc,
};

/// What is known of the chips whose names begin so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// The beginning.
    pub prefix: &'static str,
    /// The core that a program starts on.
    pub core: Core,
    /// MHz.
    pub clock_mhz: u32,
    /// Whether the flash is another chip, so that the database has the addresses for it and not its size.
    pub flash_is_apart: bool,
}

const fn row(prefix: &'static str, core: Core, clock_mhz: u32) -> Row {
    Row { prefix, core, clock_mhz, flash_is_apart: false }
}

const fn apart(prefix: &'static str, core: Core, clock_mhz: u32) -> Row {
    Row { flash_is_apart: true, ..row(prefix, core, clock_mhz) }
}

/// All rows; the longest beginning counts. Tests hold each against the database's core types.
pub const ROWS: [Row; 94] = [
    // Cortex-M0
    row("nRF51", CortexM0, 16),
    row("STM32F0", CortexM0, 48),
    row("W7500", CortexM0, 48),
    row("VA108", CortexM0, 50),
    row("PAC52", CortexM0, 50),
    // Cortex-M0+
    apart("RP2040", CortexM0Plus, 133),
    row("STM32C0", CortexM0Plus, 48),
    row("STM32G0", CortexM0Plus, 64),
    row("STM32L0", CortexM0Plus, 32),
    row("STM32U0", CortexM0Plus, 56),
    row("STM32WB0", CortexM0Plus, 64),
    row("ATSAMD10", CortexM0Plus, 48),
    row("ATSAMD11", CortexM0Plus, 48),
    row("ATSAMD21", CortexM0Plus, 48),
    row("ATSAMDA1", CortexM0Plus, 48),
    row("ATSAML21", CortexM0Plus, 48),
    row("ATSAML22", CortexM0Plus, 32),
    row("LPC80", CortexM0Plus, 15),
    row("LPC81", CortexM0Plus, 30),
    row("LPC82", CortexM0Plus, 30),
    row("LPC83", CortexM0Plus, 30),
    row("LPC84", CortexM0Plus, 30),
    row("LPC86", CortexM0Plus, 60),
    row("LPC8N04", CortexM0Plus, 8),
    row("EFM32HG", CortexM0Plus, 25),
    row("EFM32TG11", CortexM0Plus, 48),
    row("MSPM0C", CortexM0Plus, 24),
    row("MSPM0G", CortexM0Plus, 80),
    row("MSPM0L", CortexM0Plus, 32),
    row("CC2340", CortexM0Plus, 48),
    row("PY32F002A", CortexM0Plus, 24),
    row("PY32F003", CortexM0Plus, 32),
    row("PY32F030", CortexM0Plus, 48),
    row("AIR001", CortexM0Plus, 48),
    row("HC32F005", CortexM0Plus, 32),
    // Cortex-M3
    row("STM32F100", CortexM3, 24),
    row("STM32F101", CortexM3, 36),
    row("STM32F102", CortexM3, 48),
    row("STM32F103", CortexM3, 72),
    row("STM32F105", CortexM3, 72),
    row("STM32F107", CortexM3, 72),
    row("STM32F2", CortexM3, 120),
    row("STM32L1", CortexM3, 32),
    row("GD32F101", CortexM3, 56),
    row("GD32F103", CortexM3, 108),
    row("GD32F105", CortexM3, 108),
    row("GD32F107", CortexM3, 108),
    row("CH32F103", CortexM3, 72),
    row("ATSAM3U", CortexM3, 96),
    row("ATSAM3X", CortexM3, 84),
    row("ADuCM302", CortexM3, 26),
    // Cortex-M4 without an FPU
    row("nRF52805", CortexM4, 64),
    row("nRF52810", CortexM4, 64),
    row("nRF52811", CortexM4, 64),
    row("nRF52820", CortexM4, 64),
    row("STM32WL", CortexM4, 48),
    row("ATSAM4L", CortexM4, 48),
    row("ATSAM4N", CortexM4, 100),
    row("ATSAM4S", CortexM4, 120),
    // Cortex-M23
    row("GD32E23", CortexM23, 72),
    // With an FPU
    row("nRF52832", CortexM4F, 64),
    row("nRF52833", CortexM4F, 64),
    row("nRF52840", CortexM4F, 64),
    row("nRF9160", CortexM33F, 64),
    row("STM32F3", CortexM4F, 72),
    row("STM32F401", CortexM4F, 84),
    row("STM32F405", CortexM4F, 168),
    row("STM32F407", CortexM4F, 168),
    row("STM32F411", CortexM4F, 100),
    row("STM32F429", CortexM4F, 180),
    row("STM32G4", CortexM4F, 170),
    row("STM32L4", CortexM4F, 80),
    row("STM32L4P", CortexM4F, 120),
    row("STM32L4Q", CortexM4F, 120),
    row("STM32L4R", CortexM4F, 120),
    row("STM32L4S", CortexM4F, 120),
    row("STM32F7", CortexM7F, 216),
    row("ATSAMD51", CortexM4F, 120),
    row("ATSAME5", CortexM4F, 120),
    apart("RP235x", CortexM33F, 150),
    // RISC-V
    apart("RP235x_riscv", Rv32imac, 150),
    apart("fe310", Rv32imac, 320),
    row("GD32VF103", Rv32imac, 108),
    row("CH32V103", Rv32imac, 80),
    row("CH32V203", Rv32imac, 144),
    row("CH32V208", Rv32imac, 144),
    row("CH32L103", Rv32imac, 96),
    row("CH32X03", Rv32imac, 48),
    row("earlgrey", Rv32imc, 100),
    row("CH32V30", Rv32imafc, 144),
    row("CH32V00", Rv32ec, 48),
    row("CH32M00", Rv32ec, 48),
    row("CH641", Rv32ec, 48),
    row("HPM53", Rv32imafc, 480),
];

/// What is known of a chip.
#[must_use]
pub fn by_name(name: &str) -> Option<&'static Row> {
    let begins = |row: &&Row| name.get(..row.prefix.len()).is_some_and(|start| start.eq_ignore_ascii_case(row.prefix));
    ROWS.iter().filter(begins).max_by_key(|row| row.prefix.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_beginning_counts_whatever_the_case() {
        assert_eq!(by_name("rp235X").map(|row| row.core), Some(CortexM33F));
        assert_eq!(by_name("RP235x_riscv").map(|row| row.core), Some(Rv32imac));
        assert_eq!(by_name("STM32F030C6").map(|row| row.clock_mhz), Some(48));
        assert_eq!(by_name("nRF52840_xxAA").map(|row| row.core.has_fpu()), Some(true));
        for none in ["", "R", "STM32", "Zü", "LM3S101"] {
            assert_eq!(by_name(none), None, "{none}");
        }
    }
}
