//! The reference: an independent f64 tracer of the undiscretised scene, which every error is measured
//! against.
//!
//! It shares nothing with the integer core but the [`Model`], so that a mistake made there is not
//! made here too: its own tree, triangle test, camera and shading. Only IEEE 754 operations and `libm`
//! are used, so that its pictures are the same on every machine.
//!
//! # Shading policy
//!
//! What the integer core follows too, each in its own arithmetic:
//!
//! - The nearest hit is the least t > 0; of equal ones, the lowest triangle. Triangles have two sides,
//!   and their edges belong to them. A ray that hits nothing sees the background.
//! - The hit's point is (1-u-v) v0 + u v1 + v v2. The geometric normal ng is e1 x e2 normalised and
//!   flipped to face the viewer. The shading normal ns is the corners' normals, interpolated likewise
//!   and normalised, or ng if there are none or they cancel; it is flipped if ns . ng < 0.
//! - A light at the direction l contributes where ng . l > 0 and ns . l > 0 and nothing lies in the
//!   open segment to it, or, if it is directional, along the open half-line.
//! - colour = emission + diffuse * (ambient + sum over those lights of radiance * ns . l): no 1/pi, no
//!   falloff. Emission shows on both sides. [`encode`] clamps to [0, 1], applies the transfer and
//!   rounds to nearest.
//!
//! # Where a shadow ray starts and ends
//!
//! A triangle whose plane contains an end of a segment cannot block its inside, unless the segment
//! lies in that plane. So a shadow ray starts at the point itself and ends at the light, and the
//! triangles whose planes contain the point or the light, as the hit triangle's does, are passed over.
//! That is the open segment of the policy. An origin moved off the surface, which fixed-point
//! arithmetic needs, would be its approximation: in a concave corner it crosses the other wall.
//!
//! *Contains* means: to within 2^-40 of the largest coordinate M of the scene. The point is off its
//! plane by a few roundings of M, a few times 2^-53 M, and 2^-40 M is a thousand times that; while a
//! shadow that starts 2^-40 M late is off by 2^-30 pixels in a picture of the whole scene, 1024 wide.
//! With such a margin on either side, nothing depends on the choice.

mod bounds;
mod bvh;
mod camera;
mod encode;
mod ray;
mod shade;
#[cfg(test)]
mod tests;
mod triangle;

use std::ops::ControlFlow;

use glam::DVec3;
use rayon::prelude::*;

use crate::model::Model;
use bvh::Bvh;
use camera::View;
use ray::Ray;
use triangle::{Crossing, Triangle};

pub use encode::encode;

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Positive, with point = origin + t direction for the direction as it was given.
    pub t: f64,
    /// The triangle, in file order.
    pub prim: u32,
    /// Weight of v1: point = (1-u-v) v0 + u v1 + v v2.
    pub u: f64,
    /// Weight of v2.
    pub v: f64,
}

impl Hit {
    fn new(ray: &Ray, crossing: Crossing, prim: u32) -> Self {
        Self { t: crossing.depth / ray.scale, prim, u: crossing.u, v: crossing.v }
    }
}

/// What one camera ray saw, and why.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Linear RGB, not clamped.
    pub colour: DVec3,
    /// The surface; `None` for the background.
    pub hit: Option<Hit>,
    /// Bit i is set where light i contributes; lights from the 65th on are not recorded.
    pub lights: u64,
    /// Unit shading normal ns; zero for the background.
    pub normal: DVec3,
    /// Unit geometric normal ng, towards the viewer; zero for the background.
    pub geometric_normal: DVec3,
}

/// A model made ready to be traced.
#[derive(Clone, Debug)]
pub struct Reference<'m> {
    model: &'m Model,
    bvh: Bvh,
    view: View,
    /// Distance, in scene units, up to which a plane contains a point.
    contact: f64,
}

impl<'m> Reference<'m> {
    /// Prepares `model`, whose indices must be in range as [`Model`] says. Triangles without area are
    /// left out; duplicates are kept.
    pub fn new(model: &'m Model) -> Self {
        let triangles = (0..model.triangles.len() as u32).map(|prim| lookup(model, prim));
        let bvh = Bvh::build(triangles.filter(Triangle::has_area));
        let bounds = bvh.bounds();
        let largest = bounds.low.abs().max(bounds.high.abs()).max_element();
        Self { model, bvh, view: View::new(&model.camera), contact: libm::ldexp(largest, -40) }
    }

    /// The nearest hit along `direction`, which may have any length but zero; `None` if there is none.
    pub fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let ray = Ray::new(origin, direction);
        let (crossing, prim) = self.closest(&ray)?;
        Some(Hit::new(&ray, crossing, prim))
    }

    /// All hits no farther than (1 + `tolerance`) times the nearest, in order of (t, prim), so the
    /// nearest first; empty for a miss.
    ///
    /// More than one is what tells a tie between coplanar surfaces from an error.
    pub fn candidates(&self, origin: DVec3, direction: DVec3, tolerance: f64) -> Vec<Hit> {
        let ray = Ray::new(origin, direction);
        let Some((nearest, _)) = self.closest(&ray) else {
            return Vec::new();
        };
        let limit = nearest.depth * (1.0 + tolerance);
        let mut found = Vec::new();
        self.bvh.traverse(&ray, limit, |triangles| {
            found.extend(triangles.iter().filter_map(|triangle| {
                let crossing = triangle.intersect(&ray)?;
                (crossing.depth <= limit).then_some((crossing, triangle.prim))
            }));
            ControlFlow::Continue(limit)
        });
        found.sort_by(|(a, i), (b, j)| a.depth.total_cmp(&b.depth).then(i.cmp(j)));
        found.into_iter().map(|(crossing, prim)| Hit::new(&ray, crossing, prim)).collect()
    }

    /// Origin and direction, not of unit length, of the camera ray through `(x, y)` in pixels of a
    /// picture of `size`: y down, the first pixel's centre at (0.5, 0.5), pixels square.
    pub fn camera_ray(&self, size: [u32; 2], x: f64, y: f64) -> (DVec3, DVec3) {
        self.view.ray(size, x, y)
    }

    /// What the centre of pixel `(x, y)` of a picture of `size` shows.
    pub fn pixel(&self, size: [u32; 2], x: u32, y: u32) -> Sample {
        let (origin, direction) = self.camera_ray(size, f64::from(x) + 0.5, f64::from(y) + 0.5);
        self.sample(origin, direction)
    }

    /// What a ray sees.
    pub fn sample(&self, origin: DVec3, direction: DVec3) -> Sample {
        match self.nearest(origin, direction) {
            Some(hit) => self.shade(direction, hit),
            None => Sample {
                colour: self.model.background,
                hit: None,
                lights: 0,
                normal: DVec3::ZERO,
                geometric_normal: DVec3::ZERO,
            },
        }
    }

    /// The picture of `size` (width, height) as RGB bytes, and the nearest hits, both row by row from
    /// the top. `progress` is called by any thread with the number of pixels it has just finished.
    pub fn render(&self, size: [u32; 2], progress: &(dyn Fn(u64) + Sync)) -> (Vec<[u8; 3]>, Vec<Option<Hit>>) {
        let [width, height] = size;
        (0..height)
            .into_par_iter()
            .flat_map_iter(|y| {
                let row: Vec<_> = (0..width)
                    .map(|x| {
                        let sample = self.pixel(size, x, y);
                        (encode(sample.colour, self.model.render.transfer), sample.hit)
                    })
                    .collect();
                progress(u64::from(width));
                row
            })
            .unzip()
    }

    /// The crossing of least (depth, prim), and its prim.
    fn closest(&self, ray: &Ray) -> Option<(Crossing, u32)> {
        let mut best: Option<(Crossing, u32)> = None;
        self.bvh.traverse(ray, f64::INFINITY, |triangles| {
            for triangle in triangles {
                if let Some(crossing) = triangle.intersect(ray) {
                    let found = (crossing.depth, triangle.prim);
                    if best.is_none_or(|(least, prim)| found < (least.depth, prim)) {
                        best = Some((crossing, triangle.prim));
                    }
                }
            }
            ControlFlow::Continue(best.map_or(f64::INFINITY, |(least, _)| least.depth))
        });
        best
    }
}

/// Triangle `prim` of `model`, its corners looked up.
fn lookup(model: &Model, prim: u32) -> Triangle {
    Triangle { corners: model.triangles[prim as usize].vertices.map(|v| model.positions[v as usize]), prim }
}
