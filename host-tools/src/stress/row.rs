//! What came of a case.

use serde::Serialize;

use super::Group;
use crate::report::row::Machine;

/// Whether a case came out as it is expected to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// Within the bound.
    Pass,
    /// Not, and nothing said so before.
    Fail,
    /// `prep` or the chip refuses it, or `prep` warned of what is lost, and it is.
    Refused,
}

impl Outcome {
    /// As it is printed.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Pass => "pass",
            Self::Fail => "fail",
            Self::Refused => "refused",
        }
    }
}

/// A case by a kernel on a machine.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// The case.
    pub name: &'static str,
    /// What it strains.
    pub group: Group,
    /// The kernel.
    pub kernel: &'static str,
    /// The machine.
    pub machine: Machine,
    /// What came of it.
    pub outcome: Outcome,
    /// Pixels and rays that stray; `None` where nothing was drawn.
    pub measured: Option<u64>,
    /// How many may.
    pub bound: u64,
    /// Why; what `prep` warned of, if it did.
    pub reason: String,
    /// The figures of the picture.
    #[serde(flatten)]
    pub figures: Option<Figures>,
    /// Work a ray: box and primitive tests on the host, instructions on a chip.
    pub work: Option<f64>,
    /// The same over that of the case `benign` by the same kernel on the same machine.
    pub relative_work: Option<f64>,
    /// Whether nothing but grids of their own for its parts would let a coarse grid hold it.
    pub part_grids: bool,
}

/// What a picture is against the reference's.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Figures {
    /// Pixels whose difference exceeds 4, and 64.
    pub over_4: u64,
    /// See `over_4`.
    pub over_64: u64,
    /// Pixels and rays that see nothing where the reference sees something all around.
    pub holes: u64,
    /// Pixels that a light does not reach, or reaches, where the reference has it otherwise all around.
    pub self_hits: u64,
    /// Stray pixels with a channel at an end where the reference's is at none.
    pub saturated: u64,
    /// CRC-32 of the picture's RGB888 bytes.
    pub image_crc32: String,
}
