//! The cheapest kernel whose grid a mesh stands on well: decided from the mesh and the view of it, without a picture.
//!
//! A grid moves a corner by at most half its step along each axis. Seen from the camera, that is a part of a pixel; it is by
//! that part that edges of shapes and of shadows are off, and pixels that an edge goes through are wrong with as much
//! chance. A kernel will do where the part is small nearly everywhere in view, and where no shape is lost.

use std::fmt;

use glam::DVec3;

use super::engines;
use super::view::View;
use crate::engine::Engine;
use crate::grid::Grid;
use crate::model::Model;
use crate::prepare::{Examiner, Loss};

/// The greatest part of a pixel by which corners may be moved: with an edge through every tenth pixel, three of a thousand
/// are wrong.
pub const MOST: f64 = 1.0 / 32.0;

/// Of so many corners in view, one may be moved by more: what is close before the camera is few triangles.
const ONE_OF: usize = 100;

/// What was found of a kernel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finding {
    /// Its name.
    pub kernel: &'static str,
    /// By how much its grid moves corners in view, pixels, but for the hundredth that it moves most; `None` where it has no
    /// grid for the scene, or nothing is in view.
    pub moved: Option<f64>,
    /// Whether shapes are lost on it, or bits are.
    pub loses: bool,
}

impl Finding {
    fn will_do(&self) -> bool {
        !self.loses && self.moved.is_none_or(|moved| moved <= MOST)
    }
}

/// The kernel that was chosen, and why.
#[derive(Clone, Debug)]
pub struct Choice {
    /// The kernel.
    pub engine: &'static dyn Engine,
    /// What was found, the cheapest kernel first, the chosen one last.
    pub findings: Vec<Finding>,
    /// What is lost on the finest grid of the chosen one.
    pub losses: Vec<Loss>,
}

/// Chooses a kernel for a model. The last of [`CHEAPEST_FIRST`](super::CHEAPEST_FIRST) is chosen where none will do.
///
/// # Panics
/// Never: there are kernels to choose from.
#[must_use]
pub fn auto(model: &Model) -> Choice {
    let (pixel, examiner) = (pixel(model), Examiner::new(model));
    let mut findings = Vec::new();
    let mut chosen = (engines().next().expect("there are kernels"), Vec::new());
    for engine in engines() {
        let (finding, losses) = find(engine, model, pixel, &examiner);
        findings.push(finding);
        chosen = (engine, losses);
        if finding.will_do() {
            break;
        }
    }
    let (engine, losses) = chosen;
    Choice { engine, findings, losses }
}

/// The side of a pixel, scene units, at the corners in view, but for the hundredth of them where it is least; `None` where
/// nothing is in view.
fn pixel(model: &Model) -> Option<f64> {
    let view = View::of(model);
    let mut pixels = Vec::new();
    for triangle in &model.triangles {
        pixels.extend(view.pixels_at(triangle.vertices.map(|v| model.positions[v as usize])));
    }
    let towards = (model.camera.position - model.camera.look_at).normalize();
    for sphere in &model.spheres {
        let side = |x: f64, y: f64| sphere.centre + sphere.radius * (towards + DVec3::new(x, y, 0.0));
        pixels.extend(view.pixels_at([side(0.0, 0.0), side(0.5, 0.0), side(0.0, 0.5)]));
    }
    let place = pixels.len() / ONE_OF;
    // Which is there where there are any.
    (place < pixels.len()).then(|| *pixels.select_nth_unstable_by(place, f64::total_cmp).1)
}

fn find(engine: &dyn Engine, model: &Model, pixel: Option<f64>, examiner: &Examiner<'_>) -> (Finding, Vec<Loss>) {
    let kernel = engine.name();
    let Ok(grid) = engine.grid(model, None) else {
        return (Finding { kernel, moved: None, loses: true }, Vec::new());
    };
    let losses = examiner.losses(kernel, engine.grid_bits(), engine.radius_min(), &grid);
    let moved = pixel.map(|pixel| moved(&grid) / pixel);
    (Finding { kernel, moved, loses: !losses.is_empty() }, losses)
}

/// How far a grid moves a point at most, scene units: half the diagonal of a cell.
fn moved(grid: &Grid) -> f64 {
    3f64.sqrt() / 2.0 / grid.scale
}

impl fmt::Display for Choice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, finding) in self.findings.iter().enumerate() {
            let is_last = i + 1 == self.findings.len();
            write!(f, "{}{} ", if i == 0 { "" } else { "; " }, finding.kernel)?;
            match (finding.loses, finding.moved) {
                (true, _) => write!(f, "loses shapes")?,
                (false, Some(moved)) => write!(f, "moves corners in view by up to {moved:.2e} pixels")?,
                (false, None) => write!(f, "has nothing in view to move")?,
            }
            if is_last && !finding.will_do() {
                write!(f, ", and there is no finer one")?;
            }
        }
        Ok(())
    }
}
