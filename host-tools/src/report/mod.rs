//! Error against run time: scenes by kernels and their knobs, on the host and on chips.

pub mod causes;
mod chip;
pub mod csv;
pub mod facts;
mod measure;
pub mod page;
pub mod plan;
pub mod row;
pub mod scene;
pub mod store;
pub mod sweep;
mod trouble;
mod truth;

pub use trouble::SweepError;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use row::Row;

/// A sweep and what it was made with: all that a page is made from, but the pictures.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Report {
    /// [`row::SCHEMA`].
    pub schema: String,
    /// The command line that makes this again.
    pub command: String,
    /// The computer that the host's rows are of.
    pub machine: MachineFacts,
    /// Versions of what was measured and of what measured it, by name: `intray`, `rustc`, `qemu-system-arm`.
    pub versions: BTreeMap<String, String>,
    /// The scenes, in the order of the command line.
    pub scenes: Vec<SceneFacts>,
    /// What was measured, in the order of the plan.
    pub rows: Vec<Row>,
    /// What is missing from the report as a whole, and why, a sentence each.
    pub notes: Vec<String>,
}

/// A computer.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct MachineFacts {
    /// Its processor, as the system calls it.
    pub cpu: String,
    /// How many threads it runs at a time.
    pub cores: u32,
    /// The operating system and the architecture.
    pub os: String,
}

/// A scene of the command line.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct SceneFacts {
    /// What [`row::Point::scene`] calls it.
    pub name: String,
    /// As it stood on the command line.
    pub path: String,
    /// Triangles in the file.
    pub triangles: u64,
    /// Spheres in the file.
    pub spheres: u64,
    /// Why it could not be read, if it could not.
    pub failed: Option<String>,
}
