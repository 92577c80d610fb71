//! What a point took, as a number that can be set against others.

use crate::report::row::{Cost, Machine, Measured, Point};

use super::metric::pixel_count;

/// All machines, in the order of the page.
pub(super) const MACHINES: [Machine; 3] = [Machine::Host, Machine::Rv32imac, Machine::Thumbv6m];

/// What a cost is compared as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    /// Between kernels with the same picture to draw: the ratio to f32's time on the host, instructions a pixel on a chip.
    Relative,
    /// Between pictures: seconds on the host, instructions on a chip.
    Total,
}

impl Measure {
    /// A point's cost, and its spread on the host: the least and the greatest round's.
    pub(super) fn of(self, point: &Point, measured: &Measured) -> (f64, Option<[f64; 2]>) {
        match (&measured.cost, self) {
            (Cost::Time(time), Self::Relative) => (time.ratio[1], Some([time.ratio[0], time.ratio[2]])),
            (Cost::Time(time), Self::Total) => (time.seconds, None),
            (Cost::Instructions(work), Self::Relative) => (work.instructions as f64 / pixel_count(point) as f64, None),
            (Cost::Instructions(work), Self::Total) => (work.instructions as f64, None),
        }
    }

    /// What stands along its axis.
    pub(super) fn axis(self, machine: Machine) -> &'static str {
        match (machine, self) {
            (Machine::Host, Self::Relative) => "time, as a ratio to that of f32",
            (Machine::Host, Self::Total) => "time, s",
            (_, Self::Relative) => "instructions a pixel",
            (_, Self::Total) => "instructions",
        }
    }
}

/// What a machine is called in a heading.
pub(super) fn machine_name(machine: Machine) -> &'static str {
    match machine {
        Machine::Host => "Host, one thread",
        Machine::Rv32imac => "FE310 (rv32imac)",
        Machine::Thumbv6m => "Cortex-M0 (thumbv6m)",
    }
}

/// Where something is drawn, in a sentence.
pub(super) fn machine_phrase(machine: Machine) -> &'static str {
    match machine {
        Machine::Host => "on one thread of the host",
        Machine::Rv32imac => "on an FE310 (rv32imac)",
        Machine::Thumbv6m => "on a Cortex-M0 (thumbv6m)",
    }
}
