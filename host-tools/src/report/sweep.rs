//! Measures what is planned, and keeps every row as it comes.

use std::collections::{BTreeMap, VecDeque};
use std::fs;
use std::io::ErrorKind;
use std::panic::resume_unwind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::ScopedJoinHandle;
use std::time::Duration;

use clap::ValueEnum;

use super::chip::Chips;
use super::measure::{Bench, PICTURES, pictures};
use super::page::page;
use super::plan::{self, Selection, Traits, asked};
use super::row::{Machine, Measured, Outcome, Point, Row, SCHEMA, Study};
use super::scene::Scene;
use super::store::{Header, Store};
use super::trouble::{SweepError, Trouble};
use super::{Report, csv, facts};
use crate::decimate::{DecimateError, decimate};
use crate::engine::ENGINES;
use crate::files::{self, FileError};
use crate::model::Model;
use crate::prepare::Options;

/// The names of a report's files in its folder.
pub const FILES: [&str; 3] = ["report.json", "report.csv", "index.html"];

/// A sweep.
#[derive(Debug)]
pub struct Sweep<'a> {
    /// What is drawn.
    pub scenes: &'a [Scene],
    /// Which points.
    pub selection: &'a Selection,
    /// Where the report goes; made where it is not there.
    pub folder: &'a Path,
    /// Whether rows that are there are left away.
    pub fresh: bool,
    /// How long a run on a chip may take.
    pub limit: Duration,
    /// The command line that makes the report.
    pub command: String,
}

/// What is told of a sweep while it goes on, from any thread.
pub trait Watch: Sync {
    /// What a person should know.
    fn say(&self, line: &str);
    /// So much is to be done, in units of about the same time.
    fn begin(&self, work: u64);
    /// So much of it is done.
    fn done(&self, work: u64);
}

/// What came of a sweep.
#[derive(Clone, Debug)]
pub struct Swept {
    /// The report, as it was written.
    pub report: Report,
    /// How many rows were there already.
    pub kept: usize,
    /// What failed but should not have; it is in the report, and the next run tries again.
    pub broken: Vec<String>,
}

impl Sweep<'_> {
    /// Measures the points that have no row yet, and writes the report.
    ///
    /// # Errors
    /// Where nothing can be drawn, the folder is not a report's, or what is measured cannot be kept.
    pub fn run(&self, watch: &impl Watch) -> Result<Swept, SweepError> {
        if self.scenes.iter().all(|scene| scene.content.is_none()) {
            let reasons: Vec<&str> = self.scenes.iter().filter_map(|scene| scene.facts.failed.as_deref()).collect();
            return Err(SweepError::NoScene(reasons.join("\n")));
        }
        let machines = Machine::value_variants().iter().copied();
        let (chips, notes) =
            Chips::find(machines.filter(|machine| asked(&self.selection.machines, machine)), self.limit);
        notes.iter().for_each(|note| watch.say(note));
        let mut plan: Vec<Point> = self.scenes.iter().flat_map(|scene| self.plan(scene)).collect();
        plan.retain(|point| chips.has(point.machine));

        create(self.folder)?;
        let pictures = plan.iter().flat_map(pictures);
        let others = FILES.map(PathBuf::from).into_iter().chain(pictures).map(|name| self.folder.join(name));
        let (store, rows) = Store::open(self.folder, &self.header(), self.fresh, others)?;
        create(&self.folder.join(PICTURES))?;
        let missing: Vec<&Point> = plan.iter().filter(|point| !rows.contains_key(*point)).collect();
        let kept = plan.len() - missing.len();
        if kept > 0 {
            watch.say(&format!("{}: going on, {kept} of {} points are there", self.folder.display(), plan.len()));
        }
        watch.begin(missing.iter().map(|point| work(point)).sum());
        let kept_rows = Kept::new(store, rows);
        let bench = Bench::new(self.scenes, self.folder, self.selection.quick)?;
        let (on_host, on_chips): (Vec<&Point>, Vec<&Point>) =
            missing.into_iter().partition(|point| point.machine == Machine::Host);
        // One after the other, so that nothing disturbs a time.
        for point in on_host {
            kept_rows.measure(point, || bench.on_host(point))?;
            watch.done(work(point));
        }
        // Instructions are the same whatever else goes on.
        let queue = Mutex::new(VecDeque::from(on_chips));
        let worker = || {
            // Another that failed has emptied the queue; what it was at is nothing to this one.
            while let Some(point) = held(&queue).pop_front() {
                let measured = kept_rows.measure(point, || chips.run(point.machine, bench.draw(point)?));
                if measured.is_err() {
                    held(&queue).clear();
                }
                measured?;
                watch.done(work(point));
            }
            Ok(())
        };
        let ends: Vec<Result<(), SweepError>> = std::thread::scope(|scope| {
            let workers: Vec<_> = (0..rayon::current_num_threads()).map(|_| scope.spawn(worker)).collect();
            let join = |worker: ScopedJoinHandle<'_, _>| worker.join().unwrap_or_else(|panic| resume_unwind(panic));
            workers.into_iter().map(join).collect()
        });
        ends.into_iter().collect::<Result<(), SweepError>>()?;
        let (rows, broken) = kept_rows.of(&plan);
        let report = self.report(rows, notes);
        self.write(&report)?;
        Ok(Swept { report, kept, broken })
    }

    /// The points of a scene; none where it could not be read.
    fn plan(&self, scene: &Scene) -> Vec<Point> {
        let Some(content) = &scene.content else { return Vec::new() };
        let model = &content.model;
        let studies = |study| asked(&self.selection.studies, &study);
        let triangles = model.triangles.len() as u32;
        plan::points(
            &Traits {
                name: scene.facts.name.clone(),
                size: model.render.size,
                samples: model.render.samples,
                depth: model.render.max_depth,
                branches: studies(Study::Depth) && (model.render.paths || branches(model)),
                is_random: model.render.paths || model.materials.iter().any(|material| material.roughness > 0.0),
                triangles,
                fewest: if studies(Study::Triangles) { fewest(model) } else { triangles },
            },
            self.selection,
        )
    }

    /// What rows must be of to stand beside those of this sweep.
    fn header(&self) -> Header {
        let digest = |scene: &Scene| Some((scene.facts.name.clone(), scene.content.as_ref()?.digest.clone()));
        Header {
            schema: SCHEMA.into(),
            program: facts::program(),
            machine: facts::machine().cpu,
            options: self.selection.to_string(),
            scenes: self.scenes.iter().filter_map(digest).collect(),
        }
    }

    fn report(&self, rows: Vec<Row>, notes: Vec<String>) -> Report {
        Report {
            schema: SCHEMA.into(),
            command: self.command.clone(),
            machine: facts::machine(),
            versions: facts::versions(),
            scenes: self.scenes.iter().map(|scene| scene.facts.clone()).collect(),
            rows,
            notes,
        }
    }

    /// Writes all files that are made from rows.
    fn write(&self, report: &Report) -> Result<(), SweepError> {
        let [json, csv, html] = FILES.map(|name| self.folder.join(name));
        // Maps have text for keys, and nothing else in a report can fail.
        let text = serde_json::to_string(report).unwrap_or_default() + "\n";
        files::write_atomically(&json, text.as_bytes())?;
        files::write_atomically(&csv, csv::table(&report.rows).as_bytes())?;
        files::write_atomically(&html, page(report, self.folder)?.as_bytes())?;
        Ok(())
    }
}

/// Rows, on disk and in memory.
struct Kept(Mutex<Rows>);

struct Rows {
    store: Store,
    rows: BTreeMap<Point, Row>,
    /// What is known of points whatever their study: most studies have a point in common with that of the kernels.
    twins: BTreeMap<Point, Outcome>,
    /// Rows that are not kept on disk.
    broken: BTreeMap<Point, String>,
}

impl Kept {
    fn new(store: Store, rows: BTreeMap<Point, Row>) -> Self {
        let twins = rows.values().map(|row| (twin(&row.point), row.outcome.clone())).collect();
        Self(Mutex::new(Rows { store, rows, twins, broken: BTreeMap::new() }))
    }

    /// Measures a point by `figures` unless it is known from another study, and keeps its row.
    fn measure(&self, point: &Point, figures: impl FnOnce() -> Result<Measured, Trouble>) -> Result<(), SweepError> {
        let known = held(&self.0).twins.get(&twin(point)).cloned();
        let outcome = match known {
            Some(outcome) => outcome,
            None => match figures() {
                Ok(measured) => Outcome::Measured(Box::new(measured)),
                Err(Trouble::Unfit(reason)) => Outcome::Failed(reason),
                Err(Trouble::Broken(reason)) => {
                    held(&self.0).broken.insert(point.clone(), reason);
                    return Ok(());
                }
                Err(Trouble::Stop(error)) => return Err(error),
            },
        };
        let row = Row { point: point.clone(), outcome };
        let mut rows = held(&self.0);
        rows.store.add(&row)?;
        rows.twins.insert(twin(point), row.outcome.clone());
        rows.rows.insert(point.clone(), row);
        Ok(())
    }

    /// The rows of a plan, in its order, and what is broken of it.
    fn of(self, plan: &[Point]) -> (Vec<Row>, Vec<String>) {
        let Rows { rows, broken, .. } = self.0.into_inner().unwrap_or_else(PoisonError::into_inner);
        let failed = |point: &Point| {
            let reason = broken.get(point)?;
            Some(Row { point: point.clone(), outcome: Outcome::Failed(reason.clone()) })
        };
        let all = plan.iter().filter_map(|point| rows.get(point).cloned().or_else(|| failed(point))).collect();
        let told = |(point, reason): (&Point, &String)| format!("{point}: {reason}");
        (all, broken.iter().map(told).collect())
    }
}

/// The point without its study.
fn twin(point: &Point) -> Point {
    Point { study: Study::Kernels, ..point.clone() }
}

/// A lock's content. What a thread that panicked has left is whole: it is changed by single calls.
fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Whether rays go on from a model's surfaces.
fn branches(model: &Model) -> bool {
    let header = |engine: &dyn crate::engine::Engine| {
        let prepared = engine.prepare(model, &Options::default()).ok()?;
        Some(engine.inspect(prepared.blob.bytes()).ok()?.0.needs.branches())
    };
    // Where no kernel holds it, it does not matter.
    ENGINES.into_iter().find_map(header).unwrap_or(false)
}

/// How few triangles a mesh can be decimated to.
fn fewest(model: &Model) -> u32 {
    let fewest = match decimate(model.clone(), 1) {
        Ok(model) => model.triangles.len(),
        Err(DecimateError::Unreachable { reached, .. }) => reached,
        Err(DecimateError::Mesh(_)) => model.triangles.len(),
    };
    fewest as u32
}

/// About how long a point takes: camera rays, and how many times longer one takes in QEMU, with floats and without.
fn work(point: &Point) -> u64 {
    let [width, height] = point.size.map(u64::from);
    let times = match (point.machine, point.kernel.as_str()) {
        (Machine::Host, _) => 10,
        (_, "f32" | "f64") => 100,
        (Machine::Thumbv6m, _) => 50,
        (Machine::Rv32imac, _) => 20,
    };
    width * height * u64::from(point.samples) * times
}

/// Makes a folder, where it is not there.
fn create(folder: &Path) -> Result<(), FileError> {
    match fs::create_dir(folder) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists && folder.is_dir() => Ok(()),
        Err(source) => Err(FileError::Write { path: folder.into(), source }),
        Ok(()) => Ok(()),
    }
}
