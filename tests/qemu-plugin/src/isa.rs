//! What counting must know of an instruction set.

use crate::riscv;
use crate::thumb::{Class, MODELS};

/// The instruction set of the guest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Isa {
    /// ARMv6-M.
    Thumb,
    /// rv32imac.
    Riscv,
}

/// What executing something once adds to the sums.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cost {
    pub(crate) instructions: i64,
    /// By model; 0 where the instruction set has none.
    pub(crate) cycles: [i64; MODELS.len()],
}

impl Cost {
    /// Adds another cost, so many times.
    pub(crate) fn add(&mut self, other: Self, times: i64) {
        self.instructions += other.instructions * times;
        for (sum, cycles) in self.cycles.iter_mut().zip(other.cycles) {
            *sum += cycles * times;
        }
    }
}

impl Isa {
    /// By QEMU's name of the target.
    pub(crate) fn of_target(name: &str) -> Option<Self> {
        match name {
            "arm" => Some(Self::Thumb),
            "riscv32" => Some(Self::Riscv),
            _ => None,
        }
    }

    /// QEMU's name of the target.
    pub(crate) fn target(self) -> &'static str {
        match self {
            Self::Thumb => "arm",
            Self::Riscv => "riscv32",
        }
    }

    /// The names of its cycle models.
    pub(crate) fn models(self) -> impl Iterator<Item = &'static str> {
        let models: &[_] = if self.has_model() { &MODELS } else { &[] };
        models.iter().map(|model| model.name)
    }

    /// Whether branches that are not taken must be told from those that are.
    pub(crate) fn has_model(self) -> bool {
        self == Self::Thumb
    }

    /// Of one instruction; conditional branches are taken to be taken.
    pub(crate) fn cost(self, code: &[u8]) -> Cost {
        let cycles = match self {
            Self::Thumb => MODELS.map(|model| model.cycles(Class::of(code)).into()),
            Self::Riscv => [0; MODELS.len()],
        };
        Cost { instructions: 1, cycles }
    }

    /// What corrects the cost of a branch that was not taken.
    pub(crate) fn fall_through(self) -> Cost {
        let cycles = match self {
            Self::Thumb => MODELS.map(|model| -i64::from(model.saved_by_falling_through())),
            Self::Riscv => [0; MODELS.len()],
        };
        Cost { instructions: 0, cycles }
    }

    /// Whether what follows an instruction in its block may not be executed though the instruction was started.
    pub(crate) fn may_leave(self, code: &[u8]) -> bool {
        match self {
            Self::Thumb => Class::of(code) != Class::Register,
            Self::Riscv => !riscv::only_computes(code),
        }
    }

    /// Whether an instruction branches on a condition, as far as a model must know.
    pub(crate) fn is_conditional(self, code: &[u8]) -> bool {
        self.has_model() && Class::of(code) == Class::ConditionalBranch
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_known_by_qemus_names() {
        for isa in [Isa::Thumb, Isa::Riscv] {
            assert_eq!(Isa::of_target(isa.target()), Some(isa));
        }
        assert_eq!(Isa::of_target("aarch64"), None);
    }

    #[test]
    fn only_thumb_has_cycles() {
        let branch = [0xfe, 0xd0];
        assert_eq!(Isa::Thumb.cost(&branch), Cost { instructions: 1, cycles: [3, 2] });
        assert_eq!(Isa::Thumb.fall_through(), Cost { instructions: 0, cycles: [-2, -1] });
        assert!(Isa::Thumb.is_conditional(&branch) && !Isa::Riscv.is_conditional(&branch));
        assert_eq!(Isa::Riscv.cost(&[0x13, 0, 0, 0]), Cost { instructions: 1, cycles: [0, 0] });
        assert_eq!(Isa::Riscv.models().count(), 0);
    }
}
