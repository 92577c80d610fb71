//! Cases on this computer.

use std::panic::{AssertUnwindSafe, catch_unwind};

use glam::DVec3;
use rayon::prelude::*;

use super::envelope::{Envelope, Strays, truth};
use super::promise::Promise;
use super::row::{Figures, Outcome, Row};
use super::{Case, Subject, rays};
use crate::compare::difference;
use crate::engine::Engine;
use crate::model::Model;
use crate::picture::Picture;
use crate::prepare::{Blob, Options};
use crate::reference::{Reference, Sample, encode};
use crate::report::row::Machine;
use crate::tree::TreeOptions;

/// A tile's sides, pixels.
const TILE: [u16; 2] = [16, 16];

/// A case by a kernel: the row, and what a chip is to draw, and be the same as.
#[derive(Clone, Debug)]
pub struct Done {
    /// The host's row.
    pub row: Row,
    /// What was drawn; `None` where nothing was.
    pub drawn: Option<Drawn>,
}

/// A blob and its picture.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The blob.
    pub blob: Blob,
    /// The picture.
    pub picture: Picture,
    /// How many rays it took.
    pub rays: u64,
}

/// A case by every kernel, in their order. Whatever a case does, there is a row for it.
#[must_use]
pub fn run(case: &Case, kernels: &[&'static dyn Engine]) -> Vec<Done> {
    let empty = |engine: &&'static dyn Engine, outcome, reason| Done {
        row: blank(case, *engine, outcome, reason),
        drawn: None,
    };
    let made = catch_unwind(|| (case.subject)());
    let Ok(Subject { model, rays }) = made else {
        return kernels.iter().map(|engine| empty(engine, Outcome::Fail, "its generator panicked".into())).collect();
    };
    let prepared = catch_unwind(AssertUnwindSafe(|| {
        let reference = Reference::new(&model);
        let truth = truth(&model, &reference);
        (reference, truth)
    }));
    let Ok((reference, truth)) = prepared else {
        return kernels.iter().map(|engine| empty(engine, Outcome::Fail, "the reference panicked".into())).collect();
    };
    let subject = Subject { model: model.clone(), rays };
    kernels
        .par_iter()
        .map(|engine| {
            let done = catch_unwind(AssertUnwindSafe(|| one(case, &subject, &reference, &truth, *engine)));
            done.unwrap_or_else(|panic| empty(engine, Outcome::Fail, said(panic.as_ref())))
        })
        .collect()
}

/// What a panic says.
fn said(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<&str>().copied().or_else(|| panic.downcast_ref::<String>().map(String::as_str));
    format!("it panicked: {}", text.unwrap_or("without a word"))
}

/// A row of which nothing is measured.
fn blank(case: &Case, engine: &dyn Engine, outcome: Outcome, reason: String) -> Row {
    Row {
        name: case.name,
        group: case.group,
        kernel: engine.name(),
        machine: Machine::Host,
        outcome,
        measured: None,
        bound: 0,
        reason,
        figures: None,
        work: None,
        relative_work: None,
        part_grids: case.part_grids,
    }
}

/// How a scene with leaves of so many triangles is prepared; by their cost, if `None`.
#[must_use]
pub fn options(leaf: Option<u32>) -> Options {
    let tree = TreeOptions::default();
    let tree = leaf.map_or(tree, |leaf_max| TreeOptions { leaf_max, leaf_always: true, ..tree });
    Options { tree, ..Options::default() }
}

fn one(case: &Case, subject: &Subject, reference: &Reference<'_>, truth: &[Sample], engine: &dyn Engine) -> Done {
    let model = &subject.model;
    let blank = |outcome, reason| Done { row: blank(case, engine, outcome, reason), drawn: None };
    let prepared = match engine.prepare(model, &options(case.leaf)) {
        Ok(prepared) => prepared,
        Err(error) => return blank(Outcome::Refused, error.to_string()),
    };
    let warnings = engine.losses(model, &prepared.grid);
    let (rendered, seen) = match engine.witness(prepared.blob.bytes(), TILE, &|_| {}) {
        Ok(witnessed) => witnessed,
        Err(error) => return blank(Outcome::Fail, format!("its own blob is refused: {error}")),
    };
    let promise = Promise::of(engine.name());
    let envelope = Envelope::new(case, model, reference, truth, promise, &prepared.grid);
    let Strays { pixels, holes, self_hits, saturated } = envelope.strays(&rendered.picture, &seen);
    // A direction is off by sqrt(3)/2 of a unit of which it has at least 2^(bits - 1), along sqrt(3) sides of the grid.
    let finer = engine.grid_bits() as i32 - promise.direction_bits as i32;
    let turned = libm::ldexp(3.0, finer) / prepared.grid.scale;
    let of_rays = match engine.tracer(prepared.blob.bytes()) {
        Ok(tracer) => {
            rays::stray(&subject.rays, tracer.as_ref(), reference, &promise, &prepared.grid, [extent(model), turned])
        }
        Err(error) => return blank(Outcome::Fail, format!("its own blob cannot be traced: {error}")),
    };
    let judged = if promise.edges { of_rays.rays } else { 0 };
    let (measured, bound) = (pixels + of_rays.rays, envelope.bound() + of_rays.rays - judged);
    let mut reasons: Vec<String> = Vec::new();
    if !warnings.is_empty() {
        reasons.push(format!("prep warns: {}", warnings.join("; ")));
    }
    if of_rays.rays > judged {
        let all = subject.rays.len();
        reasons.push(format!("{} of {all} rays stray, and nothing is promised of those through edges", of_rays.rays));
    }
    let outcome = match (pixels <= envelope.bound() && judged == 0, warnings.is_empty()) {
        (true, _) => Outcome::Pass,
        (false, false) => Outcome::Refused,
        (false, true) => {
            reasons.push(format!("{pixels} pixels and {judged} rays stray, and prep says nothing"));
            Outcome::Fail
        }
    };
    let reason = reasons.join("; ");
    let [width, height] = model.render.size;
    let expected =
        Picture::from_fn(width, height, |x, y| encode(truth[(y * width + x) as usize].colour, model.render.transfer));
    let gray = difference(&rendered.picture, &expected);
    let over =
        |most: u8| gray.as_ref().map_or(0, |gray| gray.pixels().iter().filter(|pixel| pixel[0] > most).count() as u64);
    let counts = &rendered.counts;
    let row = Row {
        measured: Some(measured),
        bound,
        figures: Some(Figures {
            over_4: over(4),
            over_64: over(64),
            holes: holes + of_rays.holes,
            self_hits,
            saturated,
            image_crc32: format!("{:08x}", rendered.picture.crc32()),
        }),
        work: Some((counts.box_tests + counts.triangle_tests) as f64 / counts.rays().max(1) as f64),
        ..blank(outcome, reason).row
    };
    Done { row, drawn: Some(Drawn { blob: prepared.blob, picture: rendered.picture, rays: counts.rays() }) }
}

/// The diagonal of a scene's box.
fn extent(model: &Model) -> f64 {
    let [low, high] = model
        .positions
        .iter()
        .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], &p| [low.min(p), high.max(p)]);
    if model.positions.is_empty() { 0.0 } else { (high - low).length() }
}
