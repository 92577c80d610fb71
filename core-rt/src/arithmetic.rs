//! What a kernel leaves to the scene or to a study: small numbers of its arithmetic.
//!
//! A user may set some ([`Knobs`]), the kernel finds the others when a scene is prepared, and all that it then computes
//! with stands in the blob ([`Arithmetic`]), so that host and chips compute with the same.

use serde::{Deserialize, Serialize};

/// What is asked for; `None` leaves it to the kernel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Knobs {
    /// C: by how many bits reciprocals of directions are shifted to the left.
    pub c_bits: Option<u8>,
    /// D: by how many bits differences to a box's planes are shifted to the right.
    pub d_bits: Option<u8>,
    /// E: by how many bits edges of triangles are shifted to the left.
    pub edge_shift: Option<u8>,
    /// How far from a surface rays leave it, grid units along its normal.
    pub epsilon: Option<u8>,
}

/// What a kernel computes with, as it stands in the header. All zero for a kernel that leaves nothing open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Arithmetic {
    /// See [`Knobs::c_bits`].
    pub c_bits: u8,
    /// See [`Knobs::d_bits`].
    pub d_bits: u8,
    /// See [`Knobs::edge_shift`].
    pub edge_shift: u8,
    /// See [`Knobs::epsilon`].
    pub epsilon: u8,
}

impl Arithmetic {
    /// Of a kernel without knobs: `None` where one is asked for.
    #[must_use]
    pub fn fixed(knobs: &Knobs) -> Option<Self> {
        (*knobs == Knobs::default()).then(Self::default)
    }

    /// The settings of a kernel without knobs: `None` where there are some.
    #[must_use]
    pub fn none(&self) -> Option<()> {
        (*self == Self::default()).then_some(())
    }
}
