//! What can be wrong with a blob.

use core::fmt::{Display, Formatter};

use crate::profile::Need;

/// Why a blob was refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlobError {
    /// Shorter than it says, or than any blob is.
    Truncated {
        /// The length that it should have.
        expected: u64,
        /// The length that it has.
        found: u64,
    },
    /// Longer than it says.
    Oversized {
        /// The length that it should have.
        expected: u64,
        /// The length that it has.
        found: u64,
    },
    /// Not a blob.
    Foreign,
    /// Made by another version of the format.
    Version {
        /// Its version.
        found: u16,
    },
    /// Made for another kernel.
    Kernel {
        /// The kernel's number in the blob.
        found: u16,
        /// The number of the one that would read it.
        expected: u16,
    },
    /// Its bytes are not what they were when it was written.
    Checksum {
        /// The CRC-32 that it states.
        stated: u32,
        /// The CRC-32 that it has.
        computed: u32,
    },
    /// Not at an address that is a multiple of 8.
    Misaligned,
    /// The header cannot be decoded, or has a value out of range.
    Header,
    /// Sections do not fill the body.
    Sections,
    /// The tree is not one: a reference leads elsewhere than to the next node, triangle or sphere.
    Tree {
        /// The node that holds the reference.
        node: u32,
    },
    /// The tree is deeper than it says.
    Depth {
        /// The depth that it states.
        stated: u8,
    },
    /// A child's box is not inside its parent's, or a primitive not inside its leaf's.
    Bounds {
        /// The node that holds the box.
        node: u32,
    },
    /// A triangle is not what the kernel would make of its vertices, or its material or normals do not exist.
    Triangle {
        /// The record's index.
        index: u32,
    },
    /// A sphere is not one that the kernel holds, or its material does not exist.
    Sphere {
        /// The record's index among spheres.
        index: u32,
    },
    /// The eye or a light is farther from the geometry than the kernel's numbers reach.
    Origin,
    /// A material, a light or a normal has a value out of range.
    Shading,
    /// The contents use what the header does not declare.
    Undeclared(Need),
    /// The profile lacks what the scene needs.
    Missing(Need),
}

impl Display for BlobError {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        match *self {
            Self::Truncated { expected, found } => {
                write!(f, "the blob is cut short: {found} bytes where {expected} are expected")
            }
            Self::Oversized { expected, found } => {
                write!(f, "the blob is followed by something else: {found} bytes where {expected} are expected")
            }
            Self::Foreign => f.write_str("this is not an intray blob"),
            Self::Version { found } => {
                write!(f, "the blob has format version {found}, and this program reads version {}", super::VERSION)
            }
            Self::Kernel { found, expected } => {
                write!(f, "the blob is for kernel {found}, not for kernel {expected}")
            }
            Self::Checksum { stated, computed } => {
                write!(f, "the blob is damaged: its CRC-32 is {computed:08x} and should be {stated:08x}")
            }
            Self::Misaligned => f.write_str("the blob must lie at an address that is a multiple of 8"),
            Self::Header => f.write_str("the blob's header is damaged"),
            Self::Sections => f.write_str("the blob's sections do not fit its size"),
            Self::Tree { node } => write!(f, "the blob's tree is broken at node {node}"),
            Self::Depth { stated } => write!(f, "the blob's tree is deeper than the {stated} levels that it states"),
            Self::Bounds { node } => write!(f, "a box does not enclose what is in it, at node {node}"),
            Self::Triangle { index } => write!(f, "triangle record {index} is inconsistent"),
            Self::Sphere { index } => write!(f, "sphere record {index} is inconsistent"),
            Self::Origin => f.write_str("the camera or a light is too far from the geometry for the blob's kernel"),
            Self::Shading => f.write_str("a material, a light or a normal is out of range"),
            Self::Undeclared(need) => write!(f, "the blob has {need}, which its header does not declare"),
            Self::Missing(need) => write!(f, "the scene needs {need}, which this profile leaves out"),
        }
    }
}

impl core::error::Error for BlobError {}
