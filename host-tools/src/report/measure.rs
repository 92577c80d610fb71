//! The figures of a point: the picture on the host, its distance from the reference, and what it takes.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

use core_rt::arithmetic::Knobs;
use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

use super::causes::{Drawn, causes};
use super::row::{Causes, Cost, Machine, Measured, Point, Study, Time};
use super::scene::Scene;
use super::trouble::{SweepError, Trouble};
use super::truth::{Truth, Truths};
use crate::compare::compare;
use crate::decimate::decimate;
use crate::engine::{self, Engine};
use crate::model::Model;
use crate::picture::Picture;
use crate::prepare::{Blob, Options};
use crate::tree::TreeOptions;

/// Tiles of the host's pictures.
const TILE: [u16; 2] = [32, 32];

/// The folder of pictures in a report's folder.
pub(super) const PICTURES: &str = "pictures";

/// A mesh of fewer triangles, or why there is none.
type Decimated = Result<Arc<Model>, String>;

/// What every point needs.
#[derive(Debug)]
pub(super) struct Bench<'a> {
    scenes: &'a [Scene],
    folder: &'a Path,
    truths: Truths,
    /// Meshes by scene and number of triangles.
    decimated: Mutex<BTreeMap<(String, u32), Decimated>>,
    /// Pictures that were written in this run.
    written: Mutex<BTreeSet<String>>,
    /// What times are compared with, of the last point.
    base: Mutex<Option<(Point, Arc<Blob>)>>,
    /// One thread, for times.
    alone: ThreadPool,
    quick: bool,
}

/// A point's blob, and all of its figures but the cost.
pub(super) struct Picked {
    pub(super) engine: &'static dyn Engine,
    pub(super) blob: Blob,
    pub(super) picture: Picture,
    /// With a cost of nothing.
    pub(super) measured: Measured,
}

impl<'a> Bench<'a> {
    pub(super) fn new(scenes: &'a [Scene], folder: &'a Path, quick: bool) -> Result<Self, ThreadPoolBuildError> {
        Ok(Self {
            scenes,
            folder,
            truths: Truths::default(),
            decimated: Mutex::default(),
            written: Mutex::default(),
            base: Mutex::default(),
            alone: ThreadPoolBuilder::new().num_threads(1).build()?,
            quick,
        })
    }

    /// Draws a point on the host, on all cores, and compares.
    pub(super) fn draw(&self, point: &Point) -> Result<Picked, Trouble> {
        let engine = engine::by_name(&point.kernel).ok_or_else(|| Trouble::Unfit("no such kernel".into()))?;
        let model = self.model(point)?;
        let prepared = engine.prepare(&model, &options(point)).map_err(Trouble::prepare)?;
        let (header, _) = engine.inspect(prepared.blob.bytes()).map_err(Trouble::blob)?;
        let (rendered, seen) = engine.witness(prepared.blob.bytes(), TILE, &|_| ()).map_err(Trouble::blob)?;
        let truth_name = truth_name(point);
        let truth = self.truths.of(point, || {
            let mut model = self.model(&plain(point))?;
            model.render.samples = truth_samples(point);
            let truth = Truth::of(&model);
            self.write(&truth_name, &truth.picture)?;
            Ok::<_, Trouble>(truth)
        })?;
        let name = picture_name(point);
        self.write(&name, &rendered.picture)?;
        let drawn = Drawn { picture: &rendered.picture, seen: &seen };
        let reference = Drawn { picture: &truth.picture, seen: &truth.seen };
        // Another mesh has other numbers of triangles: what is seen cannot be compared.
        // Nor can it where rays are random.
        let causes = if point.triangles.is_none() && point.reference_samples.is_none() {
            causes(drawn, reference, model.render.format).map_err(Trouble::size)?
        } else {
            Causes::default()
        };
        let measured = Measured {
            error: compare(&rendered.picture, &truth.picture).map_err(Trouble::size)?,
            causes,
            cost: Cost::Time(Time { seconds: 0.0, ratio: [0.0; 3], rounds: 0 }),
            blob_bytes: prepared.blob.bytes().len() as u64,
            primitives: u64::from(header.counts.triangles) + u64::from(header.counts.spheres),
            rays: rendered.counts.rays(),
            box_tests: rendered.counts.box_tests,
            triangle_tests: rendered.counts.triangle_tests,
            image_crc32: format!("{:08x}", rendered.picture.crc32()),
            picture: name,
            truth: truth_name,
        };
        Ok(Picked { engine, blob: prepared.blob, picture: rendered.picture, measured })
    }

    /// The figures of a point on the host.
    pub(super) fn on_host(&self, point: &Point) -> Result<Measured, Trouble> {
        let picked = self.draw(point)?;
        Ok(Measured { cost: Cost::Time(self.time(point, &picked)?), ..picked.measured })
    }

    /// Rounds in which f32, with the scene as it comes, and the point's kernel take turns, on one thread. Their number is odd,
    /// and follows from the time that they take.
    fn time(&self, point: &Point, picked: &Picked) -> Result<Time, Trouble> {
        let (least, most, budget) = if self.quick { (3, 15, 0.2) } else { (5, 31, 1.0) };
        let f32 = engine::by_name("f32").ok_or_else(|| Trouble::Unfit("there is no f32".into()))?;
        let base = self.base(point, f32)?;
        let (mut seconds, mut ratios): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        let mut spent = 0.0;
        while ratios.len() < least || ratios.len() < most && spent < budget || ratios.len() % 2 == 0 {
            let [of_f32, own] = [(f32, &*base), (picked.engine, &picked.blob)]
                .map(|(engine, blob)| self.alone.install(|| engine.seconds(blob.bytes(), TILE)));
            let (of_f32, own) = (of_f32.map_err(Trouble::blob)?, own.map_err(Trouble::blob)?);
            seconds.push(own);
            ratios.push(own / of_f32);
            spent += of_f32 + own;
        }
        seconds.sort_by(f64::total_cmp);
        ratios.sort_by(f64::total_cmp);
        let rounds = ratios.len();
        Ok(Time {
            seconds: seconds[rounds / 2],
            ratio: [ratios[0], ratios[rounds / 2], ratios[rounds - 1]],
            rounds: rounds as u32,
        })
    }

    /// f32's blob of the scene as it comes, at a point's size, samples and depth.
    fn base(&self, point: &Point, f32: &dyn Engine) -> Result<Arc<Blob>, Trouble> {
        let plain = plain(point);
        let mut there = self.base.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((known, blob)) = &*there
            && *known == plain
        {
            return Ok(Arc::clone(blob));
        }
        let prepared = f32.prepare(&self.model(&plain)?, &Options::default()).map_err(Trouble::prepare)?;
        let blob = Arc::new(prepared.blob);
        *there = Some((plain, Arc::clone(&blob)));
        Ok(blob)
    }

    /// The scene as a point has it.
    fn model(&self, point: &Point) -> Result<Model, Trouble> {
        let scene = self.scenes.iter().find(|scene| scene.facts.name == point.scene);
        let content = scene.and_then(|scene| scene.content.as_ref());
        let model = &content.ok_or_else(|| Trouble::Unfit("no such scene".into()))?.model;
        let mut model = match point.triangles {
            None => model.clone(),
            Some(target) => (*self.decimated(&point.scene, model, target).map_err(Trouble::Unfit)?).clone(),
        };
        model.render.size = point.size;
        model.render.samples = point.samples;
        model.render.max_depth = point.depth;
        Ok(model)
    }

    /// A mesh of fewer triangles.
    fn decimated(&self, scene: &str, model: &Model, target: u32) -> Decimated {
        // Others wait: they would do the same.
        let mut there = self.decimated.lock().unwrap_or_else(PoisonError::into_inner);
        let make = || decimate(model.clone(), target as usize).map(Arc::new).map_err(|error| error.to_string());
        there.entry((scene.to_owned(), target)).or_insert_with(make).clone()
    }

    /// Writes a picture, once in a run: points that share one draw the same.
    fn write(&self, name: &str, picture: &Picture) -> Result<(), SweepError> {
        let mut written = self.written.lock().unwrap_or_else(PoisonError::into_inner);
        if written.insert(name.to_owned()) {
            picture.write_png(&self.folder.join(name))?;
        }
        Ok(())
    }
}

/// The point of f32 as it comes, of the same scene, size, samples and depth: what its truth and its time's base depend on.
fn plain(point: &Point) -> Point {
    Point {
        study: Study::Kernels,
        kernel: "f32".into(),
        machine: Machine::Host,
        leaf: None,
        grid_bits: None,
        triangles: None,
        knobs: [None; 3],
        reference_samples: None,
        ..point.clone()
    }
}

/// How a point's scene is prepared.
fn options(point: &Point) -> Options {
    let tree = TreeOptions::default();
    let [c_bits, d_bits, edge_shift] = point.knobs;
    Options {
        tree: point.leaf.map_or(tree, |leaf_max| TreeOptions { leaf_max, leaf_always: true, ..tree }),
        knobs: Knobs { c_bits, d_bits, edge_shift, epsilon: None },
        grid_bits: point.grid_bits,
        ..Options::default()
    }
}

/// The files of a point in the report's folder: its picture and the reference's.
#[must_use]
pub(super) fn pictures(point: &Point) -> [PathBuf; 2] {
    [picture_name(point), truth_name(point)].map(PathBuf::from)
}

/// Camera rays a pixel of the reference's picture.
pub(super) fn truth_samples(point: &Point) -> u32 {
    point.reference_samples.unwrap_or(point.samples)
}

/// Scene, size, samples and depth.
fn truth_name(point: &Point) -> String {
    named(&Point { samples: truth_samples(point), ..point.clone() }, "reference", "")
}

/// The same for all machines and studies.
fn picture_name(point: &Point) -> String {
    let knobs: String = point.set().map(|(name, value)| format!("-{name}{value}")).collect();
    named(point, &point.kernel, &knobs)
}

fn named(point: &Point, kernel: &str, knobs: &str) -> String {
    let Point { scene, size: [width, height], samples, depth, .. } = point;
    format!("{PICTURES}/{scene}-{kernel}-{width}x{height}-samples{samples}-depth{depth}{knobs}.png")
}
