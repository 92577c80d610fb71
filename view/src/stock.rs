//! Stages in stock: scenes made ready for kernels, so that switching and moving need nothing to be made again.

use glam::DVec3;
use host_tools::engine::Engine;
use host_tools::model::{Format, Model, Projection};
use host_tools::prepare::{Blob, Options};
use host_tools::stage::Stage;
use self_cell::self_cell;

type Opened<'a> = Box<dyn Stage + 'a>;

self_cell!(
    /// A blob, and the stage that is a view of it.
    struct Held {
        owner: Blob,
        #[not_covariant]
        dependent: Opened,
    }

    impl {Debug}
);

/// How many are kept.
const ROOM: usize = 6;

/// How much farther from the scene than asked for a camera may go before a new blob is needed.
const ROAMING: f64 = 2.0;

/// Stages, the one used last in front.
#[derive(Debug, Default)]
pub struct Stock {
    kept: Vec<Entry>,
}

#[derive(Debug)]
struct Entry {
    kernel: u16,
    format: Format,
    held: Held,
}

impl Stock {
    /// A stage that looks through a model's camera, whatever its grid, and says what `then` makes of it: for drafts, which
    /// should come soon.
    ///
    /// # Errors
    /// Where the kernel cannot hold the scene, for a person.
    pub fn soon<T>(
        &mut self,
        engine: &'static dyn Engine,
        model: &Model,
        then: impl FnOnce(&dyn Stage) -> T,
    ) -> Result<T, String> {
        if !self.fetch(engine, model, |_| true) {
            // Whoever moves goes on moving: a grid that reaches farther serves for a while.
            let roaming = roaming(model);
            let prepared = engine.prepare(&roaming, &Options::default());
            let held = prepared.ok().and_then(|prepared| open(engine, prepared.blob, model).ok());
            match held {
                Some(held) => self.put(engine, model, held),
                None => self.add(engine, model)?,
            }
        }
        self.first(then)
    }

    /// The same, with the very picture that a blob for this camera would have.
    ///
    /// # Errors
    /// Where the kernel cannot hold the scene, for a person.
    pub fn exact<T>(
        &mut self,
        engine: &'static dyn Engine,
        model: &Model,
        then: impl FnOnce(&dyn Stage) -> T,
    ) -> Result<T, String> {
        // Where there is none, making a blob says why.
        let is_ready =
            engine.grid(model, None).is_ok_and(|grid| self.fetch(engine, model, |stage| stage.grid() == grid));
        if !is_ready {
            self.add(engine, model)?;
        }
        self.first(then)
    }

    /// Brings to the front what is suitable and looks through the camera; false where there is nothing.
    fn fetch(&mut self, engine: &dyn Engine, model: &Model, is_suitable: impl Fn(&dyn Stage) -> bool) -> bool {
        let place = self.kept.iter_mut().position(|entry| {
            entry.kernel == engine.id()
                && entry.format == model.render.format
                && entry.held.with_dependent_mut(|_, stage| is_suitable(stage.as_ref()) && stage.look(model))
        });
        if let Some(place) = place {
            self.kept[..=place].rotate_right(1);
        }
        place.is_some()
    }

    /// Makes a blob for the model as it is.
    fn add(&mut self, engine: &'static dyn Engine, model: &Model) -> Result<(), String> {
        let prepared = engine.prepare(model, &Options::default()).map_err(|error| error.to_string())?;
        self.put(engine, model, open(engine, prepared.blob, model)?);
        Ok(())
    }

    fn put(&mut self, engine: &dyn Engine, model: &Model, held: Held) {
        self.kept.truncate(ROOM - 1);
        self.kept.insert(0, Entry { kernel: engine.id(), format: model.render.format, held });
    }

    fn first<T>(&self, then: impl FnOnce(&dyn Stage) -> T) -> Result<T, String> {
        let entry = self.kept.first().ok_or("there is nothing to look at")?;
        Ok(entry.held.with_dependent(|_, stage| then(stage.as_ref())))
    }
}

/// A blob's stage, with the camera of a model.
fn open(engine: &'static dyn Engine, blob: Blob, model: &Model) -> Result<Held, String> {
    let mut held = Held::try_new(blob, |blob| engine.stage(blob.bytes())).map_err(|error| error.to_string())?;
    let reaches = held.with_dependent_mut(|_, stage| stage.look(model));
    if reaches { Ok(held) } else { Err(format!("{} cannot hold the camera", engine.name())) }
}

/// The model with its camera farther away from the middle of the scene.
fn roaming(model: &Model) -> Model {
    let mut model = model.clone();
    let ends = model.spheres.iter().map(|sphere| sphere.centre);
    let count = (model.positions.len() + model.spheres.len()).max(1) as f64;
    let middle: DVec3 = model.positions.iter().copied().chain(ends).map(|point| point / count).sum();
    for point in [&mut model.camera.position, &mut model.camera.look_at] {
        *point = middle + (*point - middle) * ROAMING;
    }
    if let Projection::Orthographic { height } = &mut model.camera.projection {
        *height *= ROAMING;
    }
    model
}
