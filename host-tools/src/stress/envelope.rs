//! Which pixels are wrong: those that are not what the reference shows there, nor within as many pixels as the kernel's grid
//! may move an image by.
//!
//! The reference is asked at the pixel's middle first, and only where that differs around it, on finer and finer squares:
//! a colour is right if every channel is between the least and the greatest of those found, or off by no more than the
//! shading may be. So a silhouette that moves by a hundredth of a pixel excuses the pixels that it crosses, and no others.

use core_rt::kernel::{NONE, Vertices};
use glam::DVec3;
use rayon::prelude::*;

use super::Case;
use super::promise::Promise;
use crate::grid::Grid;
use crate::model::{Model, Projection};
use crate::picture::Picture;
use crate::reference::{Hit, Reference, Sample, encode};
use crate::witness::Seen;

/// What the grid moves by more pixels than this is lost, and not excused: `prep` has to say so.
const FARTHEST: f64 = 1.0;

/// What is seen by way of other surfaces may turn by so many pixels at most.
const FARTHEST_BENT: f64 = 8.0;

/// The most gray levels that are excused for facets that turn on the grid, likewise.
const MOST_LEVELS: f64 = 16.0;

/// Samples on either side of a pixel's middle, coarse and fine.
const SIDES: [i32; 3] = [1, 4, 16];

/// What is wrong with a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Strays {
    /// Pixels that are not what the reference shows within the bound.
    pub pixels: u64,
    /// Those of them that see nothing where the reference sees a surface everywhere within the bound.
    pub holes: u64,
    /// Those that see a surface that the reference sees within the bound, reached by other lights than there is anywhere:
    /// the surface, or its neighbour, is in its own way, or lets through what it should not.
    pub self_hits: u64,
    /// Those with a channel at an end where the reference has none there within the bound.
    pub saturated: u64,
}

/// What the reference shows within a pixel's bound.
struct Shown {
    /// The least and the greatest of each channel, and what shading may be off by.
    range: [DVec3; 2],
    /// What its rays saw.
    seen: Vec<Seen>,
}

/// The reference of a case, and what a kernel may do to it.
#[derive(Debug)]
pub struct Envelope<'m> {
    model: &'m Model,
    reference: &'m Reference<'m>,
    truth: &'m [Sample],
    promise: Promise,
    /// What shading may be off by besides facets that turn, gray levels.
    levels: f64,
    steepness: f64,
    /// How far images move at distance 1, pixels times scene units; of parallel rays, pixels.
    moved: f64,
    /// And because directions are rounded, pixels.
    turned: f64,
    /// Pixels a radian; and how many unit vectors turn what is seen by way of other surfaces.
    per_radian: f64,
    bends: f64,
    grazes: bool,
    /// How many pixels are as close to a concave corner as where a ray leaves a surface is off.
    in_corners: f64,
    /// By how many radians each triangle and sphere turns on the grid.
    turns: Vec<f64>,
}

/// What the reference sees through the middle of every pixel, row by row.
#[must_use]
pub fn truth(model: &Model, reference: &Reference<'_>) -> Vec<Sample> {
    let [width, height] = model.render.size;
    (0..height * width).into_par_iter().map(|i| reference.pixel([width, height], i % width, i / width)).collect()
}

impl<'m> Envelope<'m> {
    /// For a kernel's grid.
    #[must_use]
    pub fn new(
        case: &Case,
        model: &'m Model,
        reference: &'m Reference<'m>,
        truth: &'m [Sample],
        promise: Promise,
        grid: &Grid,
    ) -> Self {
        let [width, height] = model.render.size.map(f64::from);
        let units = promise.seen + case.leverage * promise.between;
        // Pixels a unit of distance from the axis: at distance 1 where rays come from an eye.
        let (per_unit, largest) = match model.camera.projection {
            Projection::Perspective { fov_y } => {
                let half = libm::tan(fov_y / 2.0);
                (height / (2.0 * half), 1.0 + half * (1.0 + width / height))
            }
            Projection::Orthographic { height: side } => (height / side, 0.0),
        };
        Self {
            model,
            reference,
            truth,
            promise,
            levels: promise.levels + 255.0 * case.steepness * promise.turn + case.dropped / 4.0,
            steepness: case.steepness,
            moved: units / grid.scale * per_unit,
            turned: largest * per_unit / libm::exp2(f64::from(promise.direction_bits)),
            per_radian: if largest > 0.0 { per_unit * largest } else { 0.0 },
            bends: case.bends,
            grazes: case.grazes,
            in_corners: case.corners * promise.between / grid.scale * per_unit / mean_depth(truth),
            turns: turns(model, grid),
        }
    }

    /// How many pixels may stray.
    #[must_use]
    pub fn bound(&self) -> u64 {
        (self.promise.strays * self.truth.len() as f64).ceil() as u64 + self.in_corners as u64
    }

    /// The pixels of a picture that stray.
    #[must_use]
    pub fn strays(&self, picture: &Picture, seen: &[Seen]) -> Strays {
        let width = picture.width();
        let all = picture.pixels().par_iter().zip(seen).enumerate().map(|(i, (pixel, seen))| {
            let (x, y) = (i as u32 % width, i as u32 / width);
            let Some(Shown { range, seen: shown }) = self.stray(x, y, *pixel) else { return Strays::default() };
            let ends = |c: usize| (pixel[c] == 255 && range[1][c] < 255.0) || (pixel[c] == 0 && range[0][c] > 0.0);
            let is_hole = seen.first == NONE && shown.iter().all(|other| other.first != NONE);
            let is_first = |other: &&Seen| other.first == seen.first && seen.first != NONE;
            let mut same = shown.iter().filter(is_first).peekable();
            let is_self_hit = same.peek().is_some() && same.all(|other| other.shadows != seen.shadows);
            Strays {
                pixels: 1,
                holes: is_hole.into(),
                self_hits: is_self_hit.into(),
                saturated: (0..3).any(ends).into(),
            }
        });
        all.reduce(Strays::default, |a, b| Strays {
            pixels: a.pixels + b.pixels,
            holes: a.holes + b.holes,
            self_hits: a.self_hits + b.self_hits,
            saturated: a.saturated + b.saturated,
        })
    }

    /// What a pixel should have been, where it is not.
    fn stray(&self, x: u32, y: u32, pixel: [u8; 3]) -> Option<Shown> {
        let near = self.near(x, y);
        let turn = near.iter().filter_map(|hit| self.turns.get(hit.prim as usize)).fold(0.0, |a: f64, &b| a.max(b));
        let levels = self.levels + (255.0 * self.steepness * turn).min(MOST_LEVELS);
        let depth = near.iter().map(|hit| self.depth(x, y, hit)).fold(f64::INFINITY, f64::min);
        // A mirror that turns turns what is seen in it by twice as much.
        let each = self.promise.turn + 2.0 * turn;
        let grazing = if self.grazes { (2.0 * each).sqrt() } else { 0.0 };
        let bent = (self.bends * each + grazing) * self.per_radian;
        let radius = (self.moved / depth + self.turned).min(FARTHEST) + bent.min(FARTHEST_BENT);
        let pixel = DVec3::from_array(pixel.map(f64::from));
        let mut range = [DVec3::INFINITY, DVec3::NEG_INFINITY];
        let mut take = |colour: DVec3| {
            let byte = encode(colour, self.model.render.transfer).map(f64::from);
            let byte = DVec3::from_array(byte);
            range = [range[0].min(byte - levels), range[1].max(byte + levels)];
            pixel.cmpge(range[0]).all() && pixel.cmple(range[1]).all()
        };
        if take(self.truth[(y * self.model.render.size[0] + x) as usize].colour) {
            return None;
        }
        let mut seen = Vec::new();
        for side in SIDES {
            for (i, j) in (-side..=side).flat_map(|i| (-side..=side).map(move |j| (i, j))) {
                let step = radius / f64::from(side);
                let [dx, dy] = [i, j].map(|k| 0.5 + step * f64::from(k));
                let (origin, direction) =
                    self.reference.camera_ray(self.model.render.size, f64::from(x) + dx, f64::from(y) + dy);
                let (sample, witness) = self.reference.sample_seen(origin, direction);
                seen.push(witness);
                if take(sample.colour) {
                    return None;
                }
            }
        }
        Some(Shown { range, seen })
    }

    /// What is seen of a pixel and its neighbours.
    fn near(&self, x: u32, y: u32) -> Vec<Hit> {
        let [width, height] = self.model.render.size;
        let around = |c: u32, end: u32| c.saturating_sub(1)..(c + 2).min(end);
        let places = around(y, height).flat_map(|y| around(x, width).map(move |x| (y * width + x) as usize));
        places.filter_map(|place| self.truth[place].hit).collect()
    }

    /// How far a hit is along the view, scene units; 1 for parallel rays, whose images do not shrink.
    fn depth(&self, x: u32, y: u32, hit: &Hit) -> f64 {
        match self.model.camera.projection {
            Projection::Orthographic { .. } => 1.0,
            Projection::Perspective { .. } => {
                let camera = &self.model.camera;
                let (_, direction) =
                    self.reference.camera_ray(self.model.render.size, f64::from(x) + 0.5, f64::from(y) + 0.5);
                hit.t * direction.dot((camera.look_at - camera.position).normalize())
            }
        }
    }
}

/// How far what is seen is away, in the mean over the pixels that see something; infinite where none does.
fn mean_depth(truth: &[Sample]) -> f64 {
    let depths: Vec<f64> = truth.iter().filter_map(|sample| Some(sample.hit?.t)).collect();
    if depths.is_empty() { f64::INFINITY } else { depths.iter().sum::<f64>() / depths.len() as f64 }
}

/// By how many radians the normals of triangles, and of spheres after them, turn on a grid.
fn turns(model: &Model, grid: &Grid) -> Vec<f64> {
    let on_grid = |corners: Vertices| corners.map(|c| DVec3::from_array(c.map(f64::from)));
    let normal = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).normalize_or_zero();
    let snapped = grid.snap(model);
    let triangles = model.triangles.iter().zip(snapped.iter()).map(|(triangle, snapped)| {
        let (a, b) = (normal(triangle.vertices.map(|v| model.positions[v as usize])), normal(on_grid(snapped)));
        libm::atan2(a.cross(b).length(), a.dot(b))
    });
    // Centre and radius are rounded, a unit and a half in all.
    let spheres = model.spheres.iter().map(|sphere| 1.5 / (sphere.radius * grid.scale).max(1.0));
    triangles.chain(spheres).collect()
}
