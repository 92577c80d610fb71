//! The thread that draws: drafts at once, full pictures tile by tile, and no longer than anyone wants them.

use std::sync::Arc;
use std::time::Instant;

use core_rt::render::Tile;
use core_rt::stats::Counts;
use host_tools::model::{Camera, Format, Light, LightKind, Model};
use host_tools::picture::Picture;
use rayon::ThreadPool;
use rayon::prelude::*;

use crate::canvas;
use crate::desk::Desk;
use crate::film::{Film, passes};
use crate::kernels::KERNELS;
use crate::stock::Stock;

/// Samples a pixel of a draft by paths: fewer are all noise, and more make it slow.
pub const DRAFT_PATHS: u32 = 2;

/// Tiles a thread between two looks at whether the picture is still wanted.
const BATCH: usize = 4;

/// What is to be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From where.
    pub camera: Camera,
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// The kernel's place among [`KERNELS`].
    pub kernel: usize,
    /// How pixels lie in memory, and so what colours there are.
    pub format: Format,
}

impl View {
    /// The model, seen so.
    pub fn of(&self, scene: &Scene) -> Model {
        let mut model = Model::clone(&scene.model);
        self.set(scene, &mut model);
        model
    }

    /// Sets what may have changed of a copy of the scene's model.
    fn set(&self, scene: &Scene, model: &mut Model) {
        model.camera = self.camera;
        model.render.size = self.size;
        model.render.format = self.format;
        model.render.samples = scene.model.render.samples;
        if scene.has_headlight {
            // As the importer has it: white, at the camera.
            for light in &mut model.lights {
                *light = Light { kind: LightKind::Point(self.camera.position), ..*light };
            }
        }
    }
}

/// What there is to look at.
#[derive(Clone, Debug)]
pub struct Scene {
    /// As it was read.
    pub model: Arc<Model>,
    /// Whether its only light is where the camera is, since it has none of its own.
    pub has_headlight: bool,
}

/// A picture that somebody waits for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wish {
    /// Its number: the later, the greater.
    pub serial: u64,
    /// What it shows.
    pub view: View,
    /// Of a draft, its size; it has one sample a pixel, or [`DRAFT_PATHS`]. `None` for the full picture.
    pub draft: Option<[u32; 2]>,
}

/// What a picture took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Took {
    /// Seconds of drawing, with whatever had to be made ready for it.
    pub seconds: f64,
    /// Rays of all kinds.
    pub rays: u64,
}

/// A tile and its pixels, row by row.
pub type Painted = (Tile, Vec<[u8; 3]>);

/// What has become of a wish.
#[derive(Clone, Debug)]
pub enum Drawn {
    /// A draft.
    Draft(Picture, Took),
    /// Tiles of the full picture.
    Tiles(Vec<Painted>),
    /// Tiles of the mean of so many samples a pixel, which are fewer than the full picture has.
    Fewer(Vec<Painted>, u16),
    /// All tiles have been told of.
    Full(Took),
    /// Why there is no picture, for a person.
    Failed(String),
}

/// Draws whatever is laid on the desk until that is closed, and tells of it.
pub fn work(scene: &Scene, desk: &Desk<Wish>, pool: &ThreadPool, tell: &(dyn Fn(u64, Drawn) + Sync)) {
    let mut stock = Stock::default();
    let mut model = Model::clone(&scene.model);
    while let Some(wish) = desk.take() {
        wish.view.set(scene, &mut model);
        let tell = |drawn| tell(wish.serial, drawn);
        let done = match wish.draft {
            Some(size) => {
                let few = if model.render.paths { DRAFT_PATHS.min(model.render.samples) } else { 1 };
                (model.render.size, model.render.samples) = (size, few);
                draft(&mut stock, &model, wish.view.kernel, pool).map(|(picture, took)| {
                    tell(Drawn::Draft(picture, took));
                })
            }
            None => full(&mut stock, &model, wish.view.kernel, pool, desk, &tell),
        };
        if let Err(reason) = done {
            tell(Drawn::Failed(reason));
        }
    }
}

fn draft(stock: &mut Stock, model: &Model, kernel: usize, pool: &ThreadPool) -> Result<(Picture, Took), String> {
    let begin = Instant::now();
    let [width, height] = model.render.size;
    stock.soon(KERNELS[kernel], model, |stage| {
        let tiles = canvas::order([width as u16, height as u16]);
        let drawn: Vec<_> = pool.install(|| tiles.par_iter().map(|&tile| stage.tile(tile)).collect());
        let mut whole = canvas::Canvas::new([width, height]);
        let mut counts = Counts::default();
        for (tile, (pixels, more)) in tiles.iter().zip(&drawn) {
            whole.tile(*tile, pixels);
            counts = counts.plus(*more);
        }
        let took = Took { seconds: begin.elapsed().as_secs_f64(), rays: counts.rays() };
        (whole.picture().clone(), took)
    })
}

fn full(
    stock: &mut Stock,
    model: &Model,
    kernel: usize,
    pool: &ThreadPool,
    desk: &Desk<Wish>,
    tell: &dyn Fn(Drawn),
) -> Result<(), String> {
    let begin = Instant::now();
    stock.exact(KERNELS[kernel], model, |stage| {
        let tiles = canvas::order(model.render.size.map(|side| side as u16));
        let mut counts = Counts::default();
        if stage.follows_paths() {
            let mut film = Film::new(stage, &tiles);
            for samples in passes(model.render.samples as u16) {
                let is_last = u32::from(samples.end) == model.render.samples;
                for first in (0..tiles.len()).step_by(BATCH * pool.current_num_threads()) {
                    if desk.is_waiting() {
                        return;
                    }
                    let batch = first..tiles.len().min(first + BATCH * pool.current_num_threads());
                    let (painted, more) = pool.install(|| film.add(batch, &samples));
                    counts = counts.plus(more);
                    tell(if is_last { Drawn::Tiles(painted) } else { Drawn::Fewer(painted, samples.end) });
                }
            }
            tell(Drawn::Full(Took { seconds: begin.elapsed().as_secs_f64(), rays: counts.rays() }));
            return;
        }
        for batch in tiles.chunks(BATCH * pool.current_num_threads()) {
            if desk.is_waiting() {
                return;
            }
            let drawn: Vec<_> = pool.install(|| batch.par_iter().map(|&tile| (tile, stage.tile(tile))).collect());
            counts = drawn.iter().fold(counts, |sum, (_, (_, more))| sum.plus(*more));
            tell(Drawn::Tiles(drawn.into_iter().map(|(tile, (pixels, _))| (tile, pixels)).collect()));
        }
        tell(Drawn::Full(Took { seconds: begin.elapsed().as_secs_f64(), rays: counts.rays() }));
    })
}
