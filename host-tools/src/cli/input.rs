//! What the verbs share: scenes, kernels, sizes, threads.

use std::ffi::OsStr;
use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;
use core_rt::arithmetic::Knobs;
use core_rt::blob::{BlobError, Prefix};
use core_rt::bvh::Child;
use core_rt::exact::Exact14;
use core_rt::kernel::Kernel;
use core_rt::texture::LARGEST_SIDE;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::failure::{Failure, warn};
use crate::decimate;
use crate::engine::{self, ENGINES, Engine};
use crate::files;
use crate::import::{self, GREATEST_DEPTH, Imported, MOST_SAMPLES};
use crate::model::{Format, Model};
use crate::picture::{SIZES, size_is_allowed};
use crate::prepare::{Blob, Degenerates, Options, losses, unplaced};
use crate::textures::{self, Texels};
use crate::tree::TreeOptions;

/// A scene, and how it is prepared.
#[derive(Debug, Args)]
pub(super) struct SceneArguments {
    /// A scene.toml, a bare .obj, or a blob
    pub(super) scene: PathBuf,

    /// The arithmetic; of a blob, its own [default: exact29, on a chip exact14]
    #[arg(long, value_parser = PossibleValuesParser::new(ENGINES.map(|engine| engine.name())))]
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
    textures: TextureArguments,

    #[command(flatten)]
    knobs: KnobArguments,
}

/// What textures take.
#[derive(Clone, Copy, Debug, Args)]
struct TextureArguments {
    /// Average textures down to so many texels a side or fewer
    #[arg(
        long,
        value_name = "N",
        value_parser = clap::value_parser!(u32).range(1..=i64::from(LARGEST_SIDE)),
        allow_negative_numbers = true
    )]
    texture_size: Option<u32>,

    /// Store texels so; those of gray textures take a byte in any case [default: as the output's pixels]
    #[arg(long, value_name = "FORMAT", value_enum)]
    texels: Option<Texels>,
}

impl TextureArguments {
    fn any(self) -> bool {
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
struct KnobArguments {
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
    fn any(self) -> bool {
        Knobs::from(self) != Knobs::default()
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

/// A blob, with the kernel that it is for and what it was made from.
pub(super) struct Scene {
    pub(super) engine: &'static dyn Engine,
    pub(super) blob: Blob,
    /// Where the scene was not a blob already.
    pub(super) degenerates: Option<Degenerates>,
}

impl SceneArguments {
    /// Reads the scene and prepares it. Warnings go to stderr.
    pub(super) fn load(&self) -> Result<Scene, Failure> {
        self.load_for(ENGINES[0])
    }

    /// The same, where a chip is to render it: with another kernel unless one is asked for.
    pub(super) fn load_for_chip(&self) -> Result<Scene, Failure> {
        self.load_for(engine::by_id(Exact14::ID).unwrap_or(ENGINES[0]))
    }

    /// Reads the scene and prepares it, for `default` where neither it nor the user names a kernel.
    fn load_for(&self, default: &'static dyn Engine) -> Result<Scene, Failure> {
        let extension = self.scene.extension().map(|extension| extension.to_ascii_lowercase());
        match extension.as_deref().and_then(OsStr::to_str) {
            Some("obj" | "toml") => self.load_model(default),
            _ => self.load_blob(),
        }
    }

    /// Reads a model for the reference, which has neither a tree to set nor knobs.
    pub(super) fn model_for_reference(&self) -> Result<Model, Failure> {
        if self.leaf.is_some() || self.grid_bits.is_some() || self.knobs.any() {
            return Err(Failure::input(
                "--leaf, --grid-bits and the knobs of arithmetic are the kernels'; the reference has none",
            ));
        }
        self.model()
    }

    /// Reads a model, with the size and the number of triangles that are asked for.
    fn model(&self) -> Result<Model, Failure> {
        let Imported { mut model, warnings } = import::load(&self.scene)?;
        warnings.iter().for_each(warn);
        if let Some(size) = self.size {
            model.render.size = size;
        }
        if let Some(samples) = self.samples {
            model.render.samples = samples;
        }
        if let Some(depth) = self.depth {
            model.render.max_depth = depth;
        }
        if let Some(format) = self.format {
            model.render.format = format.into();
        }
        if let Some(side) = self.textures.texture_size {
            textures::shrink(&mut model, side);
        }
        let Some(target) = self.triangles else { return Ok(model) };
        let is_painted = |model: &Model| !model.uvs.is_empty() || !model.colours.is_empty();
        let was_painted = is_painted(&model);
        let path = self.scene.display();
        let model =
            decimate::decimate(model, target as usize).map_err(|error| Failure::input(format!("{path}: {error}")))?;
        if was_painted && !is_painted(&model) {
            warn(format_args!("{path}: decimated, and drawn without textures and colours of vertices"));
        }
        Ok(model)
    }

    /// Reads and prepares a model for the kernel asked for.
    fn load_model(&self, default: &'static dyn Engine) -> Result<Scene, Failure> {
        let model = self.model()?;
        if let Some(what) = unplaced(&model) {
            warn(format_args!("{}: {what}", self.scene.display()));
        }
        let engine = self.engine().unwrap_or(default);
        let prepared = engine
            .prepare(&model, &self.options())
            .map_err(|error| Failure::input(format!("{}: {error}", self.scene.display())))?;
        warn_of_degenerates(prepared.degenerates, model.triangles.len());
        losses(
            engine.name(),
            self.grid_bits.unwrap_or(engine.grid_bits()),
            engine.radius_min(),
            &model,
            &prepared.grid,
        )
        .iter()
        .for_each(warn);
        Ok(Scene { engine, blob: prepared.blob, degenerates: Some(prepared.degenerates) })
    }

    /// Reads a blob; what would need its source is refused.
    fn load_blob(&self) -> Result<Scene, Failure> {
        let path = self.scene.display();
        let blob = Blob::from_bytes(&files::read(&self.scene)?);
        let refuse = |error| match error {
            BlobError::Foreign => Failure::input(format!(
                "{path}: not a scene; that is a .toml or .obj file by its name, or a blob that `intray prep` made"
            )),
            _ => Failure::input(format!("{path}: {error}; make it anew with `intray prep`")),
        };
        let number = Prefix::read(blob.bytes()).map_err(refuse)?.kernel;
        let engine = engine::by_id(number).ok_or_else(|| {
            let known = ENGINES.map(|engine| format!("{} ({})", engine.name(), engine.id())).join(", ");
            Failure::input(format!(
                "{path}: the blob is for a kernel of number {number}, and this program has {known}; make it anew with \
                 `intray prep`"
            ))
        })?;
        if let Some(asked) = self.engine().filter(|asked| asked.id() != engine.id()) {
            return Err(Failure::input(format!(
                "{path}: the blob is for {}, not for {}; leave out --kernel, or give the scene it was made from",
                engine.name(),
                asked.name()
            )));
        }
        let (header, _) = engine.inspect(blob.bytes()).map_err(refuse)?;
        let own = header.size.map(u32::from);
        if !size_is_allowed(own[0], own[1]) {
            return Err(Failure::input(format!("{path}: the blob is for {}x{} pixels; {SIZES}", own[0], own[1])));
        }
        if self.leaf.is_some()
            || self.triangles.is_some()
            || self.textures.any()
            || self.knobs.any()
            || self.size.is_some_and(|size| size != own)
            || self.samples.is_some()
            || self.depth.is_some()
            || self.grid_bits.is_some()
            || self.format.is_some()
        {
            return Err(Failure::input(format!(
                "{path}: the blob is for {}x{} pixels, and its tree is built; --size, --samples, --depth, --format, \
                 --leaf, --grid-bits, --triangles, --texture-size, --texels and the knobs of its arithmetic need the scene \
                 that it was made from",
                own[0], own[1]
            )));
        }
        Ok(Scene { engine, blob, degenerates: None })
    }

    fn engine(&self) -> Option<&'static dyn Engine> {
        engine::by_name(self.kernel.as_deref()?)
    }

    fn options(&self) -> Options {
        let tree = TreeOptions::default();
        Options {
            tree: self.leaf.map_or(tree, |leaf_max| TreeOptions { leaf_max, leaf_always: true, ..tree }),
            knobs: self.knobs.into(),
            grid_bits: self.grid_bits,
            texels: self.textures.texels,
        }
    }
}

fn warn_of_degenerates(degenerates: Degenerates, triangles: usize) {
    if degenerates.total() > 0 {
        warn(format_args!(
            "{} of {triangles} triangles have no area on the grid and were left out ({} with two corners in one \
             point, {} with all three in a line)",
            degenerates.total(),
            degenerates.zero_edge,
            degenerates.zero_area
        ));
    }
}

/// `WxH`.
fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some([w.trim().parse().ok()?, h.trim().parse().ok()?]));
    let Some::<[i64; 2]>(sides) = sides else {
        return Err("expected WIDTHxHEIGHT in pixels, such as 640x480".into());
    };
    let size = sides.map(|side| u32::try_from(side).unwrap_or(0));
    if size_is_allowed(size[0], size[1]) { Ok(size) } else { Err(SIZES.into()) }
}
