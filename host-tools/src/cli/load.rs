//! Scenes by what the command line says of them: read, put on a grid, and chosen a kernel for.

use std::ffi::OsStr;

use core_rt::blob::{BlobError, Prefix};
use core_rt::exact::Exact14;
use core_rt::kernel::Kernel;
use core_rt::profile::Prefer;

use super::failure::{Failure, note, warn};
use super::input::{AUTO, SceneArguments};
use super::progress;
use crate::choose::auto::auto;
use crate::choose::budget::{Budget, Search, search};
use crate::decimate;
use crate::engine::{self, ENGINES, Engine};
use crate::files;
use crate::import::{self, Imported};
use crate::model::Model;
use crate::picture::{SIZES, size_is_allowed};
use crate::planes;
use crate::prepare::{Blob, Degenerates, Loss, Options, losses, tree_for, unplaced};
use crate::textures;
use crate::tree::TreeOptions;

/// A blob, with the kernel that it is for and what it was made from.
#[derive(Debug)]
pub struct Scene {
    /// The kernel.
    pub engine: &'static dyn Engine,
    /// The blob.
    pub blob: Blob,
    /// Where the scene was not a blob already.
    pub(super) degenerates: Option<Degenerates>,
    /// Why the kernel was chosen, where nobody named it.
    pub(super) choice: Option<String>,
}

impl SceneArguments {
    /// Reads the scene and prepares it. Warnings go to stderr.
    pub(super) fn load(&self) -> Result<Scene, Failure> {
        self.load_for(ENGINES[0])
    }

    /// The same, and the model that it was made from, if it was.
    pub(super) fn load_with_model(&self) -> Result<(Scene, Option<Model>), Failure> {
        self.load_by(self.engine_or(ENGINES[0]))
    }

    /// Reads the scene and prepares it for a chip: with another kernel than a host's unless one is asked for. Warnings go to
    /// stderr.
    ///
    /// # Errors
    /// Where it cannot be read, or the kernel cannot hold it.
    pub fn load_for_chip(&self) -> Result<Scene, Failure> {
        self.load_for(engine::by_id(Exact14::ID).unwrap_or(ENGINES[0]))
    }

    /// The same, where the mesh is to say which kernel will do unless one is asked for.
    pub(super) fn load_for_mesh(&self) -> Result<Scene, Failure> {
        self.load_by(self.engine()).map(|(scene, _)| scene)
    }

    /// The same, with the cheapest kernel and the coarsest grid that stay inside a budget.
    pub(super) fn load_within(&self, budget: &Budget) -> Result<Scene, Failure> {
        let path = self.scene.display();
        if !self.is_model() {
            return Err(Failure::input(format!(
                "{path}: a blob is for one kernel; a budget needs the scene that it was made from"
            )));
        }
        let mut model = self.model()?;
        if let (Some(asked), Some(size)) = (self.size, budget.size)
            && asked != size
        {
            return Err(Failure::input(format!(
                "--size is {}x{}, and the budget is for {}x{}; leave one out",
                asked[0], asked[1], size[0], size[1]
            )));
        }
        model.render.size = budget.size.unwrap_or(model.render.size);
        let spinner = progress::spinner("looking for the cheapest kernel");
        let Search { chosen, tries } =
            search(&model, &self.options(), budget, &mut |tried| spinner.suspend(|| note(tried)));
        spinner.finish_and_clear();
        let Some((engine, grid_bits)) = chosen else {
            let closest = tries.last().map_or_else(String::new, |tried| format!("; the closest: {tried}"));
            return Err(Failure::check(format!("{path}: no kernel stays inside the budget{closest}")));
        };
        self.prepare(&model, engine, &Options { grid_bits: Some(grid_bits), ..self.options() }, None)
    }

    /// Reads the scene and prepares it, for `default` where neither it nor the user names a kernel.
    fn load_for(&self, default: &'static dyn Engine) -> Result<Scene, Failure> {
        self.load_by(self.engine_or(default)).map(|(scene, _)| scene)
    }

    /// The kernel that the user names, or `default`; none where the scene is to say.
    fn engine_or(&self, default: &'static dyn Engine) -> Option<&'static dyn Engine> {
        let is_auto = self.kernel.as_deref() == Some(AUTO);
        self.engine().or((!is_auto).then_some(default))
    }

    /// Reads the scene and prepares it, for the cheapest kernel that it stands on well where none is given.
    fn load_by(&self, engine: Option<&'static dyn Engine>) -> Result<(Scene, Option<Model>), Failure> {
        if self.is_planes() {
            return Err(Failure::input(
                "planes12, the tracer of 1994, draws spheres alone and has no blobs: render, trace, emulate, report, stress, \
                 pixel-planes and view know it; choose another kernel, such as exact29, or exact14 for a chip",
            ));
        }
        if !self.is_model() {
            return Ok((self.load_blob()?, None));
        }
        let model = self.model()?;
        let choice = engine.is_none().then(|| auto(&model));
        let engine = choice.as_ref().map(|choice| choice.engine).or(engine).unwrap_or(ENGINES[0]);
        let text = choice.as_ref().map(ToString::to_string);
        // It was chosen by its finest grid.
        let lost = choice.map(|choice| choice.losses).filter(|_| self.grid_bits.is_none());
        let scene = self.prepare(&model, engine, &self.options(), lost)?;
        Ok((Scene { choice: text, ..scene }, Some(model)))
    }

    /// Whether the kernel is the one that has no blobs.
    pub(super) fn is_planes(&self) -> bool {
        self.kernel.as_deref() == Some(planes::NAME)
    }

    /// Reads a model for that kernel, which has no tree.
    pub(super) fn model_for_planes(&self) -> Result<Model, Failure> {
        let path = self.scene.display();
        if !self.is_model() {
            return Err(Failure::input(format!("{path}: planes12 has no blobs; give a scene.toml or an .obj")));
        }
        if self.leaf.is_some()
            || self.prefer.is_some()
            || self.grid_bits.is_some()
            || self.format.is_some()
            || self.knobs.any()
        {
            return Err(Failure::input(
                "--leaf, --prefer, --grid-bits, --format and the knobs of arithmetic are other kernels'; planes12 has none of them",
            ));
        }
        self.model()
    }

    /// Whether the scene is not a blob, by its name.
    fn is_model(&self) -> bool {
        let extension = self.scene.extension().map(|extension| extension.to_ascii_lowercase());
        matches!(extension.as_deref().and_then(OsStr::to_str), Some("obj" | "toml"))
    }

    /// Reads a model for the reference, which has neither a tree to set nor knobs.
    pub(super) fn model_for_reference(&self) -> Result<Model, Failure> {
        if self.leaf.is_some() || self.prefer.is_some() || self.grid_bits.is_some() || self.knobs.any() {
            return Err(Failure::input(
                "--leaf, --prefer, --grid-bits and the knobs of arithmetic are the kernels'; the reference has none",
            ));
        }
        self.model()
    }

    /// Reads a model, with the size and the number of triangles that are asked for.
    pub(super) fn model(&self) -> Result<Model, Failure> {
        let Imported { mut model, warnings } = import::load(&self.scene)?;
        warnings.iter().for_each(warn);
        if let Some(size) = self.size {
            model.render.size = size;
        }
        if let Some(samples) = self.samples {
            model.render.samples = samples;
        }
        if let Some(paths) = self.paths {
            model.render.paths = paths;
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

    /// Prepares a model for a kernel; `lost` is what is lost on its grid, where that is known.
    fn prepare(
        &self,
        model: &Model,
        engine: &'static dyn Engine,
        options: &Options,
        lost: Option<Vec<Loss>>,
    ) -> Result<Scene, Failure> {
        let losses = |grid| {
            losses(engine.name(), options.grid_bits.unwrap_or(engine.grid_bits()), engine.radius_min(), model, &grid)
        };
        // Before there is a blob beside what looking takes. Where there is no grid, preparing says why.
        let lost = lost.unwrap_or_else(|| engine.grid(model, options.grid_bits).map_or_else(|_| Vec::new(), losses));
        if let Some(what) = unplaced(model) {
            warn(format_args!("{}: {what}", self.scene.display()));
        }
        let prepared = engine
            .prepare(model, options)
            .map_err(|error| Failure::input(format!("{}: {error}", self.scene.display())))?;
        warn_of_degenerates(prepared.degenerates, model.triangles.len());
        lost.iter().for_each(warn);
        Ok(Scene { engine, blob: prepared.blob, degenerates: Some(prepared.degenerates), choice: None })
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
            || self.paths.is_some()
            || self.depth.is_some()
            || self.grid_bits.is_some()
            || self.prefer.is_some()
            || self.format.is_some()
        {
            return Err(Failure::input(format!(
                "{path}: the blob is for {}x{} pixels, and its tree is built; --size, --samples, --paths, --depth, \
                 --format, --leaf, --prefer, --grid-bits, --triangles, --texture-size, --texels and the knobs of its arithmetic need the scene \
                 that it was made from",
                own[0], own[1]
            )));
        }
        Ok(Scene { engine, blob, degenerates: None, choice: None })
    }

    fn engine(&self) -> Option<&'static dyn Engine> {
        engine::by_name(self.kernel.as_deref()?)
    }

    fn options(&self) -> Options {
        let prefer = Prefer::from(self.prefer.unwrap_or_default());
        let tree = tree_for(prefer);
        Options {
            prefer,
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
