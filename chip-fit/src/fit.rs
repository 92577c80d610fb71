//! Whether a scene fits a chip, by how much, and how long a picture takes there.

use serde::Serialize;

use crate::core::Core;
use crate::database::{Chip, Kind};
use crate::need::Need;

/// What is left of a chip's memory, bytes; negative where it is not enough.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Margin {
    /// Of its flash.
    #[serde(rename = "flash_margin")]
    pub flash: i64,
    /// Of its RAM.
    #[serde(rename = "ram_margin")]
    pub ram: i64,
}

impl Margin {
    /// What a need leaves of so much flash and RAM.
    #[must_use]
    pub const fn new(need: &Need, flash: u64, ram: u64) -> Self {
        // Sizes of 32-bit machines.
        Self {
            flash: flash.cast_signed() - need.flash().cast_signed(),
            ram: ram.cast_signed() - need.ram().cast_signed(),
        }
    }

    /// Whether it is enough.
    #[must_use]
    pub const fn fits(self) -> bool {
        self.flash >= 0 && self.ram >= 0
    }

    /// Bytes that are missing, of both.
    #[must_use]
    pub const fn missing(self) -> u64 {
        let (flash, ram) = (self.flash.saturating_neg(), self.ram.saturating_neg());
        (if flash > 0 { flash.unsigned_abs() } else { 0 }) + if ram > 0 { ram.unsigned_abs() } else { 0 }
    }
}

/// How long a picture takes: a model, never a measurement.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Time {
    /// Seconds from the first camera ray to the last pixel, without what flash and bus make it wait.
    pub seconds: f64,
    /// The model of cycles; `None` where an instruction is taken to need one cycle, which is the least.
    pub cycle_model: Option<&'static str>,
}

impl Time {
    /// At the clock of the table, if the instructions were counted.
    #[must_use]
    pub fn new(need: &Need, core: Core, clock_mhz: u32) -> Option<Self> {
        let cycle_model = core.model();
        let cycles = match cycle_model {
            Some(model) => *need.cycles.get(model)?,
            None => need.instructions?,
        };
        Some(Self { seconds: cycles as f64 / (f64::from(clock_mhz) * 1e6), cycle_model })
    }
}

/// A chip, judged.
#[derive(Clone, Copy, Debug)]
pub struct Judged<'a> {
    /// The chip.
    pub chip: &'a Chip,
    /// What it is.
    pub kind: Kind,
    /// What is left of it; `None` where nothing is linked for it, or its memory is not known.
    pub margin: Option<Margin>,
    /// How long a picture takes, if its clock is known.
    pub time: Option<Time>,
}

impl<'a> Judged<'a> {
    /// Judges a chip by what the scene takes on each instruction set.
    #[must_use]
    pub fn new(chip: &'a Chip, needs: &[Need]) -> Self {
        let kind = chip.kind();
        let need = needs.iter().find(|need| Some(need.isa) == chip.isa()).filter(|_| kind != Kind::Unmapped);
        let time = need.zip(chip.known).and_then(|(need, row)| Time::new(need, row.core, row.clock_mhz));
        Self { chip, kind, margin: need.map(|need| Margin::new(need, chip.flash, chip.ram)), time }
    }

    /// Whether the scene fits: known to have no FPU, and enough memory.
    #[must_use]
    pub fn fits(&self) -> bool {
        self.kind == Kind::Integer && self.margin.is_some_and(Margin::fits)
    }

    /// Whether it is known to have no FPU, and has not enough memory.
    #[must_use]
    pub fn misses(&self) -> bool {
        self.kind == Kind::Integer && self.margin.is_some_and(|margin| !margin.fits())
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::core::Isa;

    fn need() -> Need {
        Need {
            isa: Isa::Thumbv6m,
            board: "microbit",
            // Not a multiple of 8: the blob begins at 1008.
            text_bytes: 1001,
            scene_bytes: 500,
            static_bytes: 300,
            stack_bytes: 200,
            stack_is_measured: true,
            instructions: Some(1_000_000),
            cycles: BTreeMap::from([("cortex-m0".into(), 1_500_000)]),
        }
    }

    #[test]
    fn what_fits_exactly_fits_and_a_byte_less_does_not() {
        let need = need();
        assert_eq!([need.flash(), need.ram()], [1508, 500]);
        let exact = Margin::new(&need, 1508, 500);
        assert_eq!((exact, exact.fits(), exact.missing()), (Margin { flash: 0, ram: 0 }, true, 0));
        let flash = Margin::new(&need, 1507, 500);
        assert_eq!((flash, flash.fits(), flash.missing()), (Margin { flash: -1, ram: 0 }, false, 1));
        let ram = Margin::new(&need, 1508, 499);
        assert_eq!((ram, ram.fits(), ram.missing()), (Margin { flash: 0, ram: -1 }, false, 1));
        // Much of one does not make up for the other.
        let both = Margin::new(&need, 1507, 1 << 20);
        assert_eq!((both.fits(), both.missing()), (false, 1));
        assert_eq!(Margin::new(&need, 0, 0).missing(), 2008);
        assert_eq!([need.room(1508), need.room(1009), need.room(1008), need.room(0)], [500, 1, 0, 0]);
    }

    #[test]
    fn seconds_are_cycles_of_the_cores_own_model_over_the_clock() {
        let seconds = |core, clock| Time::new(&need(), core, clock);
        assert_eq!(seconds(Core::CortexM0, 15), Some(Time { seconds: 0.1, cycle_model: Some("cortex-m0") }));
        assert_eq!(seconds(Core::CortexM3, 15), seconds(Core::CortexM0, 15));
        assert_eq!(seconds(Core::CortexM0Plus, 15), None, "it was not counted");
        assert_eq!(seconds(Core::Rv32imac, 10), Some(Time { seconds: 0.1, cycle_model: None }));
        let uncounted = Need { instructions: None, ..need() };
        assert_eq!(Time::new(&uncounted, Core::Rv32imac, 10), None);
    }
}
