//! What a kernel's grid makes of a model, counted. What takes a tree is not: see [`Layers`](super::layers::Layers).

use core_rt::arithmetic::Knobs;
use core_rt::hanika::{HanikaC, HanikaCd};
use core_rt::kernel::{Bounds, Kernel, Vertices};
use core_rt::num::{cross, sub};
use glam::DVec3;

use super::layers;
use crate::grid::{Grid, Snapped};
use crate::model::{Falloff, Light, LightKind, Model, Projection, Sphere, Triangle};

/// Of so many triangles one may collapse without a word. One that does is thinner than a step of the grid, and its neighbours
/// close over it; where more do, they are neighbours, and shapes vanish.
const ONE_OF: u32 = 100;

/// A normal that turns by more than a 16th of a radian changes a matt surface by more than 16 gray levels.
const MOST_TURN: f64 = 1.0 / 16.0;

/// The strongest light that a blob holds, rounded down.
pub(super) const MOST_LIGHT: f64 = 32_767.0;

/// Whether so many of all are few enough to say nothing of.
pub(super) fn few(some: u32, all: u32) -> bool {
    u64::from(some) * u64::from(ONE_OF) <= u64::from(all)
}

/// What a kernel's grid makes of a model.
pub(super) struct Survey {
    /// Triangles that have an area in the model.
    pub(super) triangles: u32,
    /// Those of them that have none on the grid.
    pub(super) lost: u32,
    /// Spheres.
    pub(super) spheres: u32,
    /// Those of them that are too small for the grid.
    pub(super) lost_spheres: u32,
    /// Materials, by number, of which nothing is left.
    pub(super) materials: Vec<usize>,
    /// Bits of the geometry.
    pub(super) bits: u32,
    /// Flat triangles with an area on the grid, and those of them that face another way there.
    pub(super) turned: [u32; 2],
    /// Whether the camera or a light may be.
    pub(super) is_near: bool,
}

impl Survey {
    pub(super) fn of(radius_min: i32, model: &Model, grid: &Grid) -> Self {
        let is_kept = |sphere: &&Sphere| grid.ball(sphere).radius >= radius_min;
        let mut of_spheres = vec![false; model.materials.len()];
        for sphere in model.spheres.iter().filter(is_kept) {
            of_spheres[sphere.material as usize] = true;
        }
        let spheres = model.spheres.len() as u32;
        let mut counts = vec![[0u32; 2]; model.materials.len()];
        let mut turned = [0; 2];
        let snapped = grid.snap(model);
        for (triangle, corners) in model.triangles.iter().zip(snapped.iter()) {
            let normal = normal(triangle.vertices.map(|v| model.positions[v as usize]));
            if normal != DVec3::ZERO {
                let [all, lost] = &mut counts[triangle.material as usize];
                *all += 1;
                *lost += u32::from(!has_area(corners));
            }
            if normal != DVec3::ZERO && has_area(corners) && triangle.normals.is_none() {
                let on_grid = self::normal(corners.map(|c| DVec3::from_array(c.map(f64::from))));
                turned[0] += u32::from(libm::atan2(normal.cross(on_grid).length(), normal.dot(on_grid)) > MOST_TURN);
                turned[1] += 1;
            }
        }
        Self {
            triangles: counts.iter().map(|[all, _]| all).sum(),
            lost: counts.iter().map(|[_, lost]| lost).sum(),
            spheres,
            lost_spheres: spheres - model.spheres.iter().filter(is_kept).count() as u32,
            materials: (0..)
                .zip(&counts)
                .filter(|&(i, [all, lost])| *all > 0 && all == lost && !of_spheres[i])
                .map(|(i, _)| i)
                .collect(),
            bits: grid.bits(model),
            turned,
            is_near: is_near(model, grid),
        }
    }

    pub(super) fn turns_shapes(&self) -> bool {
        let [turned, all] = self.turned;
        !few(turned, all)
    }

    pub(super) fn loses_shapes(&self) -> bool {
        !self.materials.is_empty() || !few(self.lost, self.triangles)
    }
}

/// The normal of a triangle, of its area's length.
pub(super) fn normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Whether the camera's eye or a point light is so close to a triangle that a grid may put it on the other side.
fn is_near(model: &Model, grid: &Grid) -> bool {
    let eye = matches!(model.camera.projection, Projection::Perspective { .. }).then_some(model.camera.position);
    let lights = model.lights.iter().filter_map(|light| match light.kind {
        LightKind::Point(place) => Some(place),
        LightKind::Directional(_) => None,
    });
    let near = layers::APART / grid.scale;
    let places: Vec<DVec3> = eye.into_iter().chain(lights).collect();
    let is_close = |triangle: &Triangle| {
        let corners = triangle.vertices.map(|v| model.positions[v as usize]);
        // On it, it is so in the file too, and on neither side.
        places.iter().any(|&place| (f64::MIN_POSITIVE..near).contains(&layers::distance(place, corners)))
    };
    model.triangles.iter().any(is_close)
}

/// How many triangles' boxes are lost by the box test of a kernel of the 2009 report, as it comes: their second-longest
/// side is shorter than what the two planes that it lies between are rounded by.
pub(super) fn lost_boxes(kernel: &str, snapped: &Snapped<'_>) -> u32 {
    let none = Knobs::default();
    let arithmetic = match kernel {
        "hanika-c" => HanikaC::settle(&none, std::iter::empty()),
        "hanika-cd" => HanikaCd::settle(&none, std::iter::empty()),
        _ => None,
    };
    let Some(arithmetic) = arithmetic else { return 0 };
    let is_lost = |corners: Vertices| {
        let Bounds { low, high } = Bounds::of(&corners);
        let mut sides = sub(high, low);
        sides.sort_unstable();
        has_area(corners) && sides[1] < 2 << arithmetic.d_bits
    };
    snapped.iter().filter(|&corners| is_lost(corners)).count() as u32
}

/// How many inverse-square lights are stronger than what a blob holds. Of lights that do not fade, and of what is seen itself, all
/// that strong is white.
pub(super) fn too_strong(model: &Model) -> u32 {
    let is_strong = |light: &&Light| {
        // What is a little more than that is drawn as it is.
        matches!(light.falloff, Falloff::InverseSquare { .. }) && light.radiance.max_element() >= MOST_LIGHT + 1.0
    };
    model.lights.iter().filter(is_strong).count() as u32
}

/// Whether a triangle on a grid has an area.
pub(super) fn has_area(corners: Vertices) -> bool {
    let [a, b, c] = corners.map(|v| v.map(i64::from));
    cross(sub(b, a), sub(c, a)) != [0; 3]
}
