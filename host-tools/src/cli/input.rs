//! What the verbs share: scenes, kernels, sizes, threads.

use std::path::{Path, PathBuf};

use clap::Args;
use clap::builder::PossibleValuesParser;
use core_rt::blob::MAGIC;
use core_rt::bvh::Child;

use super::failure::Failure;
use crate::engine::{self, ENGINES, Engine};
use crate::files;
use crate::import::{self, Imported};
use crate::model::Model;
use crate::picture::size_is_allowed;
use crate::prepare::{Blob, Degenerates, Options};
use crate::tree::TreeOptions;

/// A scene, and how it is prepared.
#[derive(Debug, Args)]
pub(super) struct SceneArguments {
    /// A scene.toml, a bare .obj, or a blob
    pub(super) scene: PathBuf,

    /// The arithmetic; of a blob, its own [default: exact29]
    #[arg(long, value_parser = PossibleValuesParser::new(ENGINES.map(|engine| engine.name())))]
    pub(super) kernel: Option<String>,

    /// The picture's size in pixels, instead of the scene's
    #[arg(long, value_name = "WxH", value_parser = size)]
    pub(super) size: Option<[u32; 2]>,

    /// Make leaves of so many triangles or fewer, without weighing their cost
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(Child::COUNT_MAX)))]
    pub(super) leaf: Option<u32>,
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
        if is_blob(&self.scene)? { self.load_blob() } else { self.load_model() }
    }

    /// Reads and prepares a model for the kernel asked for.
    fn load_model(&self) -> Result<Scene, Failure> {
        let mut model = model(&self.scene)?;
        if let Some(size) = self.size {
            model.render.size = size;
        }
        let engine = self.engine().unwrap_or(ENGINES[0]);
        let prepared = engine
            .prepare(&model, &self.options())
            .map_err(|error| Failure::input(format!("{}: {error}", self.scene.display())))?;
        warn_of_degenerates(prepared.degenerates, model.triangles.len());
        Ok(Scene { engine, blob: prepared.blob, degenerates: Some(prepared.degenerates) })
    }

    /// Reads a blob; what would need its source is refused.
    fn load_blob(&self) -> Result<Scene, Failure> {
        let path = self.scene.display();
        let blob = Blob::from_bytes(&files::read(&self.scene)?);
        let refuse = |error| Failure::input(format!("{path}: {error}; make it anew with `intray prep`"));
        let engine = engine::of_blob(blob.bytes()).map_err(refuse)?;
        if let Some(asked) = self.engine().filter(|asked| asked.id() != engine.id()) {
            return Err(Failure::input(format!(
                "{path} is a blob for {}, not for {}; leave out --kernel, or give the scene it was made from",
                engine.name(),
                asked.name()
            )));
        }
        let (header, _) = engine.inspect(blob.bytes()).map_err(refuse)?;
        let own = header.size.map(u32::from);
        if self.leaf.is_some() || self.size.is_some_and(|size| size != own) {
            return Err(Failure::input(format!(
                "{path} is a blob for {}x{} pixels, and its tree is built: --size and --leaf need the scene it was made from",
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
        }
    }
}

/// Imports a scene.toml or an OBJ; warnings go to stderr.
fn model(path: &Path) -> Result<Model, Failure> {
    let Imported { model, warnings } = import::load(path)?;
    for warning in &warnings {
        eprintln!("warning: {warning}");
    }
    Ok(model)
}

fn warn_of_degenerates(degenerates: Degenerates, triangles: usize) {
    if degenerates.total() > 0 {
        eprintln!(
            "warning: {} of {triangles} triangles have no area on the grid and were left out ({} with two corners in one \
             point, {} with all three in a line)",
            degenerates.total(),
            degenerates.zero_edge,
            degenerates.zero_area
        );
    }
}

/// Whether a file begins as a blob does. One with a scene's extension is a scene, so that its errors are a scene's.
fn is_blob(path: &Path) -> Result<bool, Failure> {
    let extension = path.extension().map(|e| e.to_ascii_lowercase());
    if extension.is_some_and(|e| e == "obj" || e == "toml") {
        return Ok(false);
    }
    let mut start = Vec::new();
    let opened = std::fs::File::open(path);
    if let Ok(file) = opened {
        // A folder opens and does not read; the importer says what it is.
        let _ = std::io::Read::read_to_end(&mut std::io::Read::take(file, MAGIC.len() as u64), &mut start);
    }
    Ok(!start.is_empty() && MAGIC.starts_with(&start))
}

/// `WxH`.
fn size(text: &str) -> Result<[u32; 2], String> {
    let sides = text.split_once(['x', 'X']).and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    match sides {
        Some((width, height)) if width > 0 && height > 0 && size_is_allowed(width, height) && width.max(height) <= 16_384 => {
            Ok([width, height])
        }
        Some((0, _) | (_, 0)) => Err("a picture has at least one pixel each way".into()),
        Some(_) => Err("a picture has at most 16384 pixels a side and 2^26 in all".into()),
        None => Err("expected WIDTHxHEIGHT in pixels, such as 640x480".into()),
    }
}
