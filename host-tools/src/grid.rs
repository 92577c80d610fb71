//! The grid: scene units to integers, as finely as a kernel's ranges allow.
//!
//! All axes share one scale. It is the largest for which the geometry fits the kernel's grid, and every camera and point
//! light is within the kernel's span of all of it.

use core_rt::kernel::{Bounds, Kernel, Vertices};
use core_rt::num::{bits, sub};
use core_rt::sphere::Ball;
use glam::DVec3;
use thiserror::Error;

use crate::model::{LightKind, Model, Sphere, Triangle};
use crate::plane::Plane;

/// The fewest bits that a grid may be asked to have: with margins, enough for a shape to be told.
pub const LEAST_BITS: u32 = 8;

/// Why a model has no grid.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum GridError {
    /// All points are one.
    #[error("the scene has no extent: all its triangles lie in one point")]
    NoExtent,
    /// The steps of f64 are coarser than the grid's.
    #[error(
        "the scene is too small for where it is: its points are closer together than 64-bit numbers can tell; bring it \
         closer to (0, 0, 0), and the camera and the lights to it"
    )]
    TooFar,
}

/// `grid = round((scene - origin) * scale)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// The scene's place of the grid's zero.
    pub origin: DVec3,
    /// Grid units per scene unit.
    pub scale: f64,
}

impl Grid {
    /// The finest grid of a kernel for a model.
    ///
    /// # Errors
    /// Where the geometry has no extent, or so little for its distance from zero that f64 cannot place it.
    pub fn fit<K: Kernel>(model: &Model) -> Result<Self, GridError> {
        Self::fit_to::<K>(model, K::GRID_BITS)
    }

    /// The finest grid of so many bits, from [`LEAST_BITS`] to the kernel's own, for a model: what a kernel of fewer bits
    /// would have.
    ///
    /// # Errors
    /// As [`Grid::fit`].
    ///
    /// With k = origin * scale, an axis asks for `g s - k` of the geometry in `[m, M]`, and for `|o s - g s|` of every
    /// origin at most the kernel's span.
    pub fn fit_to<K: Kernel>(model: &Model, grid_bits: u32) -> Result<Self, GridError> {
        let geometry = Extent::of(ends(model)).ok_or(GridError::NoExtent)?;
        let lights = model.lights.iter().filter_map(|light| match light.kind {
            LightKind::Point(position) => Some(position),
            LightKind::Directional(_) => None,
        });
        let plane = Plane::of(model);
        let cameras = match &plane {
            None => vec![model.camera.position],
            Some(plane) => plane.corners().into(),
        };
        let origins = Extent::of(lights.chain(cameras)).ok_or(GridError::NoExtent)?;
        if geometry.low == geometry.high {
            return Err(GridError::NoExtent);
        }

        // A unit less than the range, so that no rounding leaves it; and whole units, so that what is on a grid stays there.
        let (grid_low, grid_high) = (f64::from(K::MARGIN) + 1.0, f64::from((1 << grid_bits) - K::MARGIN) - 2.0);
        // Origins in a plane are rounded with their coefficients, by two units more.
        let span = ((1 << grid_bits) - K::MARGIN).min(K::SPAN);
        let room_for_origins = f64::from(span) - if plane.is_some() { 3.0 } else { 1.0 };
        let mut scale = f64::INFINITY;
        for axis in 0..3 {
            let (g0, g1) = (geometry.low[axis], geometry.high[axis]);
            let (o0, o1) = (origins.low[axis], origins.high[axis]);
            for (extent, room) in
                [(g1 - g0, grid_high - grid_low), (g1 - o0, room_for_origins), (o1 - g0, room_for_origins)]
            {
                if extent > 0.0 {
                    scale = scale.min(room / extent);
                }
            }
        }
        // The geometry begins where the grid does.
        let axis_origin = |axis: usize| geometry.low[axis] - grid_low / scale;
        let grid = Self { origin: DVec3::new(axis_origin(0), axis_origin(1), axis_origin(2)), scale };
        // Placing rounds, but keeps order: if the ends are in range, all is.
        let whole = Bounds { low: [K::MARGIN; 3], high: [(1 << grid_bits) - 1 - K::MARGIN; 3] };
        let placed = Bounds { low: grid.place(geometry.low), high: grid.place(geometry.high) };
        // Of a sphere centre and radius are rounded, half a unit each: what was left over has room for that.
        let placed = model.spheres.iter().fold(placed, |all, sphere| all.union(&grid.ball(sphere).bounds()));
        let spanned = |origin| placed.spanned_from(grid.place(origin), span);
        let fits = whole.contains(&placed) && spanned(origins.low) && spanned(origins.high);
        if fits { Ok(grid) } else { Err(GridError::TooFar) }
    }

    /// The nearest grid point, halves up.
    #[must_use]
    pub fn place(&self, point: DVec3) -> [i32; 3] {
        ((point - self.origin) * self.scale).to_array().map(|c| (c + 0.5).floor() as i32)
    }

    /// The sphere with the nearest centre and the nearest radius, halves up.
    #[must_use]
    pub fn ball(&self, sphere: &Sphere) -> Ball {
        Ball { centre: self.place(sphere.centre), radius: (sphere.radius * self.scale + 0.5).floor() as i32 }
    }

    /// The bits that tell a model's points apart along their longest side. A camera or a light outside takes some of a
    /// kernel's, and the farther it is, the more.
    #[must_use]
    pub fn bits(&self, model: &Model) -> u32 {
        let steps =
            Extent::of(ends(model)).map_or([0; 3], |geometry| sub(self.place(geometry.high), self.place(geometry.low)));
        bits(steps)
    }

    /// The model on the grid.
    #[must_use]
    pub fn snap<'m>(&self, model: &'m Model) -> Snapped<'m> {
        Snapped { triangles: &model.triangles, positions: model.positions.iter().map(|&p| self.place(p)).collect() }
    }
}

/// A model's vertices on a grid, shared as in the model.
#[derive(Clone, Debug)]
pub struct Snapped<'m> {
    triangles: &'m [Triangle],
    positions: Vec<[i32; 3]>,
}

impl Snapped<'_> {
    /// The corners of a triangle of the model.
    #[must_use]
    pub fn corners(&self, id: u32) -> Vertices {
        self.triangles[id as usize].vertices.map(|v| self.positions[v as usize])
    }

    /// How many triangles there are.
    pub(crate) fn len(&self) -> usize {
        self.triangles.len()
    }

    /// The corners of every triangle, in file order.
    pub fn iter(&self) -> impl ExactSizeIterator<Item = Vertices> {
        (0..self.triangles.len() as u32).map(|id| self.corners(id))
    }
}

/// Vertices, and the corners of the boxes of spheres.
fn ends(model: &Model) -> impl Iterator<Item = DVec3> {
    let vertices = model.triangles.iter().flat_map(|t| t.vertices).map(|v| model.positions[v as usize]);
    vertices.chain(model.spheres.iter().flat_map(|s| [s.centre - s.radius, s.centre + s.radius]))
}

struct Extent {
    low: DVec3,
    high: DVec3,
}

impl Extent {
    fn of(mut points: impl Iterator<Item = DVec3>) -> Option<Self> {
        let first = points.next()?;
        let whole = Self { low: first, high: first };
        Some(points.fold(whole, |e, p| Self { low: e.low.min(p), high: e.high.max(p) }))
    }
}
