//! What a sweep measures: a [`Point`] is one way to draw one scene on one machine, and a [`Row`] is what came of it.
//!
//! Rows are what is stored, and all that the page, the CSV and the JSON are made from: a page can be made anew without
//! measuring anything. Pictures stand beside them as files.

use std::fmt::{self, Display, Formatter};

use clap::ValueEnum;
use firmware_rt::board::{Board, HIFIVE1, MICROBIT};
use serde::{Deserialize, Serialize};

use crate::compare::Comparison;

/// The version of everything in this file, as it stands in the JSON. A sweep does not go on from rows of another.
pub const SCHEMA: &str = "intray-report/1";

/// Where a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "lowercase")]
pub enum Machine {
    /// This computer, one thread; its cost is a time, as a ratio to f32's in the same run.
    Host,
    /// The hifive1's FE310 in QEMU; its cost is instructions.
    Rv32imac,
    /// The micro:bit's Cortex-M0 in QEMU; its cost is instructions.
    Thumbv6m,
}

impl Machine {
    /// The board; the host is none.
    #[must_use]
    pub fn board(self) -> Option<&'static Board> {
        match self {
            Self::Host => None,
            Self::Rv32imac => Some(&HIFIVE1),
            Self::Thumbv6m => Some(&MICROBIT),
        }
    }
}

/// What is varied: points of one study and scene make one series of a plot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize, ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Study {
    /// Every kernel as it comes.
    Kernels,
    /// C of the 2009 report, with the `hanika-*` kernels.
    C,
    /// D of the 2009 report.
    D,
    /// E of the 2009 report.
    E,
    /// The number of triangles of a leaf.
    Leaf,
    /// The bits of the grid.
    Grid,
    /// Camera rays a pixel.
    Samples,
    /// How often a ray may go on.
    Depth,
    /// Pixels.
    Size,
    /// Triangles, by decimation.
    Triangles,
}

/// One way to draw one scene on one machine.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Point {
    /// The scene's name: the file's without its end, or its folder's where that is `scene`.
    pub scene: String,
    /// What is varied.
    pub study: Study,
    /// The kernel.
    pub kernel: String,
    /// Where.
    pub machine: Machine,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Camera rays a pixel.
    pub samples: u32,
    /// How often a ray may go on.
    pub depth: u32,
    /// The most triangles of a leaf; `None` where their cost decides.
    pub leaf: Option<u32>,
    /// The bits of the grid; `None` for the kernel's own.
    pub grid_bits: Option<u32>,
    /// How many triangles the mesh is decimated to; `None` for all.
    pub triangles: Option<u32>,
    /// C, D and E of the 2009 report, where they are set.
    pub knobs: [Option<u8>; 3],
    /// Camera rays a pixel of the reference's picture, where they are random and it has more of them; `None` for as many.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub reference_samples: Option<u32>,
}

/// For messages: kernel, machine, scene and what is varied.
impl Display for Point {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { scene, study, kernel, machine, size: [width, height], samples, depth, .. } = self;
        write!(f, "{scene} by {kernel} on {} ({}, ", name(machine), name(study))?;
        write!(f, "{width}x{height}, {samples} samples, depth {depth}")?;
        for (name, value) in self.set() {
            write!(f, ", {name} {value}")?;
        }
        f.write_str(")")
    }
}

impl Point {
    /// The names and values of what is not as it comes.
    pub fn set(&self) -> impl Iterator<Item = (&'static str, u32)> {
        let [c, d, e] = self.knobs.map(|knob| knob.map(u32::from));
        let all = [
            ("leaf", self.leaf),
            ("grid", self.grid_bits),
            ("triangles", self.triangles),
            ("c", c),
            ("d", d),
            ("e", e),
        ];
        all.into_iter().filter_map(|(name, value)| Some((name, value?)))
    }
}

/// The name of a study or a machine, as on the command line and in JSON.
#[must_use]
pub fn name(value: &impl ValueEnum) -> String {
    // No value is hidden.
    value.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
}

/// A point and what came of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Row {
    /// What was measured.
    pub point: Point,
    /// What came of it.
    pub outcome: Outcome,
}

/// What came of a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// It was drawn.
    Measured(Box<Measured>),
    /// It could not be drawn, and why: the scene does not fit the chip, the kernel cannot hold it, or a tool failed.
    Failed(String),
}

/// The figures of a point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Measured {
    /// Against the reference, of the scene as it was given: neither decimated nor on a grid, at the same size, samples and
    /// depth.
    pub error: Comparison,
    /// The pixels that differ, by cause.
    pub causes: Causes,
    /// What it took.
    pub cost: Cost,
    /// The blob, bytes.
    pub blob_bytes: u64,
    /// Triangles and spheres in the blob.
    pub primitives: u64,
    /// All rays.
    pub rays: u64,
    /// Ray-box tests.
    pub box_tests: u64,
    /// Ray-triangle and ray-sphere tests.
    pub triangle_tests: u64,
    /// CRC-32 of the picture's RGB888 bytes; equal on all machines.
    pub image_crc32: String,
    /// The picture's file, from the report's folder.
    pub picture: String,
    /// The reference's picture, likewise.
    pub truth: String,
}

/// Pixels by the first cause that applies, in this order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Causes {
    /// A camera ray sees nothing where the reference sees a surface.
    pub holes: Cause,
    /// A camera ray sees another surface than the reference's does.
    pub visibility: Cause,
    /// A mirrored or refracted ray does, or is followed where the reference's is not.
    pub secondary: Cause,
    /// The same surfaces; a light reaches one of them in one picture alone.
    pub shadow: Cause,
    /// The same surfaces and shadows; colours of more than one step in a channel apart.
    pub shading: Cause,
    /// The same, and no channel more than one step of the output apart.
    pub quantisation: Cause,
}

/// How many pixels differ for one cause.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Cause {
    /// By anything.
    pub pixels: u64,
    /// By more than 4.
    pub over_4: u64,
    /// By more than 64.
    pub over_64: u64,
}

/// What drawing took.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Cost {
    /// On the host.
    Time(Time),
    /// On a chip.
    Instructions(Instructions),
}

/// Time on the host, of one thread, over rounds in which every kernel takes its turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Time {
    /// Seconds of the median round.
    pub seconds: f64,
    /// The time over that of f32 with the scene, size, samples and depth of this point: the least ratio of a round, the
    /// median and the greatest.
    pub ratio: [f64; 3],
    /// How many rounds.
    pub rounds: u32,
}

/// Work on a chip.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Instructions {
    /// From the first camera ray of each tile to its last pixel: exact.
    pub instructions: u64,
    /// The same in cycles, by the model of that name: a model.
    pub cycles: std::collections::BTreeMap<String, u64>,
    /// Code and constants, bytes.
    pub text_bytes: u64,
    /// Variables and the stack at its deepest, bytes.
    pub ram_bytes: u64,
}
