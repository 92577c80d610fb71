//! What the verbs share: scenes, kernels, sizes, threads.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use core_rt::arithmetic::Knobs;
use core_rt::bvh::Child;
use core_rt::texture::LARGEST_SIDE;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::failure::Failure;
use crate::engine::ENGINES;
use crate::import::{GREATEST_DEPTH, MOST_SAMPLES};
use crate::model::Format;
use crate::picture::{SIZES, parse_size, size_is_allowed};
use crate::planes;
use crate::textures::Texels;

/// In a kernel's place: the mesh is to say which.
pub(super) const AUTO: &str = "auto";

/// A scene, and how it is prepared.
#[derive(Debug, Args)]
pub struct SceneArguments {
    /// A scene.toml, a bare .obj, or a blob
    pub scene: PathBuf,

    /// The arithmetic, or `auto` for the cheapest that the mesh stands on well; of a blob, its own [default: exact29, on a
    /// chip exact14, to make a blob auto]
    #[arg(long, value_parser = PossibleValuesParser::new(ENGINES.map(|engine| engine.name()).into_iter().chain([planes::NAME, AUTO])))]
    pub(super) kernel: Option<String>,

    /// The picture's size in pixels, instead of the scene's
    #[arg(long, value_name = "WxH", value_parser = size, allow_hyphen_values = true)]
    pub(super) size: Option<[u32; 2]>,

    /// Camera rays a pixel, instead of the scene's
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SAMPLES)),
        allow_negative_numbers = true
    )]
    pub(super) samples: Option<u32>,

    /// Whether a camera ray is followed as one random path, diffusely too, instead of the scene's way
    #[arg(long, value_name = "BOOL", num_args = 0..=1, require_equals = true, default_missing_value = "true")]
    pub(super) paths: Option<bool>,

    /// How often a ray may be mirrored or refracted, instead of the scene's number
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(0..=i64::from(GREATEST_DEPTH)),
        allow_negative_numbers = true
    )]
    pub(super) depth: Option<u32>,

    /// How pixels lie in memory, instead of the scene's way
    #[arg(long, value_enum)]
    pub(super) format: Option<PixelFormat>,

    /// Make leaves of so many triangles or fewer, without weighing their cost
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=i64::from(Child::COUNT_MAX)),
        allow_negative_numbers = true
    )]
    pub(super) leaf: Option<u32>,

    /// What a chip has less of: time or flash. The picture is the same [default: speed]
    #[arg(long, value_enum)]
    pub(super) prefer: Option<Prefer>,

    /// Use a grid of so many bits, instead of all that the kernel has
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32), allow_negative_numbers = true)]
    pub(super) grid_bits: Option<u32>,

    /// Decimate the scene to so many triangles or fewer, before anything else
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=i64::from(Child::INDEX_END)),
        allow_negative_numbers = true
    )]
    pub(super) triangles: Option<u32>,

    #[command(flatten)]
    pub(super) textures: TextureArguments,

    #[command(flatten)]
    pub(super) knobs: KnobArguments,
}

/// What textures take.
#[derive(Clone, Copy, Debug, Args)]
pub(super) struct TextureArguments {
    /// Average textures down to so many texels a side or fewer
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=i64::from(LARGEST_SIDE)),
        allow_negative_numbers = true
    )]
    pub(super) texture_size: Option<u32>,

    /// Store texels so; those of gray textures take a byte in any case [default: as the output's pixels]
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub(super) texels: Option<Texels>,
}

impl TextureArguments {
    pub(super) fn any(self) -> bool {
        self.texture_size.is_some() || self.texels.is_some()
    }
}

/// A format of pixels by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum PixelFormat {
    /// A byte a channel
    Rgb888,
    /// 16 bits, dithered
    Rgb565,
    /// A byte of luminance
    Gray8,
}

impl From<PixelFormat> for Format {
    fn from(format: PixelFormat) -> Self {
        match format {
            PixelFormat::Rgb888 => Self::Rgb888,
            PixelFormat::Rgb565 => Self::Rgb565,
            PixelFormat::Gray8 => Self::Gray8,
        }
    }
}

const ARITHMETIC: &str = "Arithmetic (hanika-* only)";

/// What a study sets of a kernel's arithmetic.
#[derive(Clone, Copy, Debug, Args)]
pub(super) struct KnobArguments {
    /// C: bits by which reciprocals of directions are shifted to the left
    #[arg(long, value_name = "C", allow_negative_numbers = true, help_heading = ARITHMETIC)]
    c_bits: Option<u8>,

    /// D: bits by which differences to a box's planes are shifted to the right
    #[arg(long, value_name = "D", allow_negative_numbers = true, help_heading = ARITHMETIC)]
    d_bits: Option<u8>,

    /// E: bits by which edges are shifted to the left [default: the most that the scene allows]
    #[arg(long, value_name = "E", allow_negative_numbers = true, help_heading = ARITHMETIC)]
    edge_shift: Option<u8>,

    /// How far from a surface rays leave it, grid units
    #[arg(long, value_name = "UNITS", allow_negative_numbers = true, help_heading = ARITHMETIC)]
    epsilon: Option<u8>,
}

impl From<KnobArguments> for Knobs {
    fn from(arguments: KnobArguments) -> Self {
        let KnobArguments { c_bits, d_bits, edge_shift, epsilon } = arguments;
        Self { c_bits, d_bits, edge_shift, epsilon }
    }
}

impl KnobArguments {
    pub(super) fn any(self) -> bool {
        Knobs::from(self) != Knobs::default()
    }
}

/// What a chip has less of.
#[derive(Clone, Copy, Debug, Default, clap::ValueEnum)]
pub(super) enum Prefer {
    /// A record a triangle, with all that its test wants
    #[default]
    Speed,
    /// Triangles that share vertices, at half the bytes
    Size,
}

impl From<Prefer> for core_rt::profile::Prefer {
    fn from(prefer: Prefer) -> Self {
        match prefer {
            Prefer::Speed => Self::Speed,
            Prefer::Size => Self::Size,
        }
    }
}

/// How many threads share the work.
#[derive(Debug, Args)]
pub(super) struct ThreadArguments {
    /// Threads [default: one a core]
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u16).range(1..=1024),
        allow_negative_numbers = true
    )]
    threads: Option<u16>,
}

impl ThreadArguments {
    /// The threads.
    pub(super) fn pool(&self) -> Result<ThreadPool, Failure> {
        Ok(ThreadPoolBuilder::new().num_threads(self.threads.unwrap_or(0).into()).build()?)
    }
}

/// A picture's size as `WxH`.
///
/// # Errors
/// What would be right, for a person.
pub fn size(text: &str) -> Result<[u32; 2], String> {
    let Some(size) = parse_size(text) else {
        return Err("expected WIDTHxHEIGHT in pixels, such as 640x480".into());
    };
    if size_is_allowed(size[0], size[1]) { Ok(size) } else { Err(SIZES.into()) }
}
