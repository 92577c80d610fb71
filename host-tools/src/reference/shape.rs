//! What a ray can hit: triangles, and spheres after them.

use glam::DVec3;

use super::bounds::Bounds;
use super::ray::Ray;
use super::sphere::Sphere;
use super::triangle::{Crossing, Triangle};
use crate::model::Model;

/// A triangle or a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Shape {
    /// A triangle.
    Triangle(Triangle),
    /// A sphere.
    Sphere(Sphere),
}

impl Shape {
    /// Shape `prim` of `model`, its corners looked up.
    pub(super) fn of(model: &Model, prim: u32) -> Self {
        match model.triangles.get(prim as usize) {
            Some(triangle) => {
                Self::Triangle(Triangle { corners: triangle.vertices.map(|v| model.positions[v as usize]), prim })
            }
            None => {
                let sphere = &model.spheres[prim as usize - model.triangles.len()];
                Self::Sphere(Sphere { centre: sphere.centre, radius: sphere.radius, prim })
            }
        }
    }

    /// All shapes of `model` that have a surface.
    pub(super) fn all(model: &Model) -> impl Iterator<Item = Self> {
        let count = (model.triangles.len() + model.spheres.len()) as u32;
        (0..count).map(|prim| Self::of(model, prim)).filter(Self::has_area)
    }

    /// The place among all triangles and spheres.
    pub(super) fn prim(&self) -> u32 {
        match self {
            Self::Triangle(triangle) => triangle.prim,
            Self::Sphere(sphere) => sphere.prim,
        }
    }

    /// A box around it.
    pub(super) fn bounds(&self) -> Bounds {
        match self {
            Self::Triangle(triangle) => Bounds::around(triangle.corners),
            Self::Sphere(sphere) => sphere.bounds(),
        }
    }

    fn has_area(&self) -> bool {
        match self {
            Self::Triangle(triangle) => triangle.has_area(),
            Self::Sphere(sphere) => sphere.radius > 0.0,
        }
    }

    /// Where `ray` first meets the surface, from either side.
    #[inline]
    pub(super) fn intersect(&self, ray: &Ray) -> Option<Crossing> {
        match self {
            Self::Triangle(triangle) => triangle.intersect(ray),
            Self::Sphere(sphere) => sphere.intersect(ray).map(Crossing::without_weights),
        }
    }

    /// The same for a ray whose origin is a point of the surface of `start`. A surface that contains the origin, to within
    /// `contact`, is not met there: a triangle not at all, a sphere only where the ray goes through it.
    pub(super) fn intersect_from(&self, ray: &Ray, start: u32, contact: f64) -> Option<Crossing> {
        match self {
            Self::Triangle(triangle) => {
                triangle.intersect(ray).filter(|_| triangle.prim != start && !triangle.in_plane(ray.origin, contact))
            }
            Self::Sphere(_) => {
                let depths = self.depths_from(ray, start, contact).into_iter().flatten();
                depths.filter(|&depth| depth > 0.0).min_by(f64::total_cmp).map(Crossing::without_weights)
            }
        }
    }

    /// The depths of all crossings of such a ray, also behind its origin.
    pub(super) fn depths_from(&self, ray: &Ray, start: u32, contact: f64) -> [Option<f64>; 2] {
        match self {
            Self::Triangle(_) => [self.intersect_from(ray, start, contact).map(|crossing| crossing.depth), None],
            Self::Sphere(sphere) if sphere.prim == start || sphere.distance(ray.origin) <= contact => {
                [sphere.leave(ray), None]
            }
            Self::Sphere(sphere) => sphere.crossings(ray).map_or([None; 2], |depths| depths.map(Some)),
        }
    }

    /// Whether a light at `end` lies on the surface, to within `contact`, and a crossing of the ray to it at `depth` of
    /// `limit` is the light's own place.
    pub(super) fn ends_at(&self, end: DVec3, ray: &Ray, depth: f64, limit: f64, contact: f64) -> bool {
        match self {
            Self::Triangle(triangle) => triangle.in_plane(end, contact),
            Self::Sphere(_) => (limit - depth) * ray.step.length() <= contact,
        }
    }
}
