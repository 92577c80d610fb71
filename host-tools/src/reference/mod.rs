//! The reference: an independent f64 tracer of the undiscretised scene, which every error is measured
//! against.
//!
//! It shares nothing with the integer core but the [`Model`], so that a mistake made there is not
//! made here too: its own tree, triangle test, camera and shading. Only IEEE 754 operations and `libm`
//! are used, so that its pictures are the same on every machine.
//!
//! # Shading policy
//!
//! What the integer core follows too, each in its own arithmetic. In short; `docs/SHADING.md` has the formulas, the
//! defaults and the sources:
//!
//! - The nearest hit is the least t > 0; of equal ones, the lowest triangle. Triangles have two sides,
//!   and their edges belong to them. Spheres come after the triangles. A ray that hits nothing sees the background.
//! - The hit's point is (1-u-v) v0 + u v1 + v v2. The geometric normal ng is e1 x e2 normalised and
//!   flipped to face the viewer. The shading normal ns is the corners' normals, interpolated likewise
//!   and normalised, or ng if there are none or they cancel; it is flipped if ns . ng < 0.
//! - A light at the direction l contributes where ng . l > 0 and ns . l > 0 and nothing lies in the
//!   open segment to it, or, if it is directional, along the open half-line; surfaces that tint their shadow let their
//!   tint through.
//! - colour = emission + kd albedo (ambient + sum of E ns . l) + ks specular colour (sum of E lobe) +
//!   kr tint trace(reflected) + kt tint trace(refracted), with E the light's radiance by its falloff: no 1/pi.
//!   Emission shows on both sides. [`encode`] clamps to [0, 1], applies the transfer and rounds to nearest.
//! - After the scene's number of bounces a ray sees the background.
//! - Mirrored rays of a rough surface are strewn about the mirrored direction. With `paths` a sample is one path that goes on
//!   in one direction at random, diffusely too, and ambient light is left out, since paths gather it.
//!
//! Of a tree of rays, a branch whose share of the pixel is below 2^-20 in every channel is left out: a 4096th of a byte's
//! step, so that what others leave out is measured.
//!
//! # Where a secondary ray starts and ends
//!
//! A triangle whose plane contains an end of a segment cannot block its inside, unless the segment
//! lies in that plane. So a shadow ray starts at the point itself and ends at the light, and the
//! triangles whose planes contain the point or the light, as the hit triangle's does, are passed over;
//! reflected and refracted rays pass over those that contain the point. A sphere that contains it is met again at the
//! other end of the chord, if the ray goes inside.
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
mod optics;
mod paths;
mod pattern;
mod random;
mod ray;
mod shade;
mod shape;
mod sphere;
mod surface;
#[cfg(test)]
mod tests;
mod texture;
mod trace;
mod triangle;

use std::ops::{ControlFlow, Range};

use core_rt::kernel::NONE;
use glam::DVec3;
use rayon::prelude::*;

use crate::model::Model;
use crate::picture::Picture;
use crate::witness::Seen;
use bvh::Bvh;
use camera::View;
use random::Random;
use ray::Ray;
use shape::Shape;
use trace::Bounce;
use triangle::Crossing;

pub use encode::encode;

/// Where a ray meets a triangle or a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Positive, with point = origin + t direction for the direction as it was given.
    pub t: f64,
    /// The triangle, in file order; spheres come after all triangles.
    pub prim: u32,
    /// Weight of v1: point = (1-u-v) v0 + u v1 + v v2; 0 on a sphere.
    pub u: f64,
    /// Weight of v2; 0 on a sphere.
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
    /// Bit i is set where light i contributes to the surface itself; lights from the 65th on are not recorded.
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
    /// Distance, in scene units, up to which a surface contains a point.
    contact: f64,
}

impl<'m> Reference<'m> {
    /// Prepares `model`, whose indices must be in range as [`Model`] says. Triangles without area are
    /// left out; duplicates are kept.
    pub fn new(model: &'m Model) -> Self {
        let bvh = Bvh::build(Shape::all(model));
        let bounds = bvh.bounds();
        let largest = bounds.low.abs().max(bounds.high.abs()).max_element();
        Self { model, bvh, view: View::new(&model.camera), contact: libm::ldexp(largest, -40) }
    }

    /// The nearest hit along `direction`, which may have any length but zero; `None` if there is none.
    pub fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let ray = Ray::new(origin, direction);
        let (crossing, prim) = self.closest(&ray, Shape::intersect)?;
        Some(Hit::new(&ray, crossing, prim))
    }

    /// All hits no farther than (1 + `tolerance`) times the nearest, in order of (t, prim), so the
    /// nearest first; empty for a miss. Of a sphere, the nearer one.
    ///
    /// More than one is what tells a tie between coplanar surfaces from an error.
    pub fn candidates(&self, origin: DVec3, direction: DVec3, tolerance: f64) -> Vec<Hit> {
        let ray = Ray::new(origin, direction);
        let Some((nearest, _)) = self.closest(&ray, Shape::intersect) else {
            return Vec::new();
        };
        let limit = nearest.depth * (1.0 + tolerance);
        let mut found = Vec::new();
        self.bvh.traverse(&ray, limit, |shapes| {
            found.extend(shapes.iter().filter_map(|shape| {
                let crossing = shape.intersect(&ray)?;
                (crossing.depth <= limit).then_some((crossing, shape.prim()))
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

    /// Linear RGB in [0, 1] of pixel `(x, y)` of a picture of `size`: the mean of the scene's number of samples, each
    /// clamped, as the picture's is in the end.
    pub fn pixel_colour(&self, size: [u32; 2], x: u32, y: u32) -> DVec3 {
        self.pixel_witness(size, x, y).0
    }

    /// The same, and what the rays behind it saw.
    fn pixel_witness(&self, size: [u32; 2], x: u32, y: u32) -> (DVec3, Seen) {
        let samples = self.model.render.samples.max(1);
        let mut seen = Seen::default();
        let places = pattern::points(samples).map(|place| (!self.model.render.paths).then_some(place));
        let numbered = (0..).zip(places);
        let sum: DVec3 = numbered.map(|(number, place)| self.clamped(size, [x, y], number, place, &mut seen)).sum();
        (sum / f64::from(samples), seen)
    }

    /// The sum of paths, by their numbers, of pixel `(x, y)` of a picture of `size`, linear RGB, each clamped to [0, 1]. Divided by
    /// their number that of `0..n` is [`Reference::pixel_colour`] for a scene with paths and n samples.
    pub fn path_sum(&self, size: [u32; 2], x: u32, y: u32, paths: Range<u32>) -> DVec3 {
        let mut seen = Seen::default();
        paths.map(|number| self.clamped(size, [x, y], number, None, &mut seen)).sum()
    }

    /// A sample of a pixel, at a place in it or at a random one, clamped to [0, 1].
    fn clamped(
        &self,
        size: [u32; 2],
        [x, y]: [u32; 2],
        number: u32,
        place: Option<[f64; 2]>,
        seen: &mut Seen,
    ) -> DVec3 {
        let mut random = Random::new([x, y], number);
        let [right, down] = place.unwrap_or_else(|| [random.unit(), random.unit()]);
        let (origin, direction) = self.camera_ray(size, f64::from(x) + right, f64::from(y) + down);
        let colour = self.sample_witness(origin, direction, number, &mut random, seen).colour;
        colour.clamp(DVec3::ZERO, DVec3::ONE)
    }

    /// What a ray sees.
    pub fn sample(&self, origin: DVec3, direction: DVec3) -> Sample {
        self.sample_seen(origin, direction).0
    }

    /// What a ray sees, and what the rays behind it saw. What is random is so as in the first sample of the first pixel.
    pub fn sample_seen(&self, origin: DVec3, direction: DVec3) -> (Sample, Seen) {
        let mut seen = Seen::default();
        let sample = self.sample_witness(origin, direction, 0, &mut Random::new([0, 0], 0), &mut seen);
        (sample, seen)
    }

    /// What the camera ray of a pixel's sample sees, by the sample's number.
    fn sample_witness(
        &self,
        origin: DVec3,
        direction: DVec3,
        number: u32,
        random: &mut Random,
        seen: &mut Seen,
    ) -> Sample {
        let ray = Ray::new(origin, direction);
        let bounce = Bounce::first(number);
        let nearest = self.closest(&ray, Shape::intersect);
        seen.surface(bounce.place, nearest.map_or(NONE, |(_, prim)| prim));
        match nearest {
            Some((crossing, prim)) => {
                let surface = self.surface(&ray, crossing, prim);
                let (colour, lights) = if self.model.render.paths {
                    self.path(surface, random, bounce.place, seen)
                } else {
                    self.shade(&surface, bounce, random, seen)
                };
                Sample {
                    colour,
                    hit: Some(Hit::new(&ray, crossing, prim)),
                    lights,
                    normal: surface.normal,
                    geometric_normal: surface.geometric_normal,
                }
            }
            None => Sample {
                colour: self.background(direction),
                hit: None,
                lights: 0,
                normal: DVec3::ZERO,
                geometric_normal: DVec3::ZERO,
            },
        }
    }

    /// The picture of `size` (width, height) as RGB bytes, and the nearest hits at the centres of pixels, both row by row
    /// from the top. `progress` is called by any thread with the number of pixels it has just finished.
    pub fn render(&self, size: [u32; 2], progress: &(dyn Fn(u64) + Sync)) -> (Vec<[u8; 3]>, Vec<Option<Hit>>) {
        self.each(size, progress, |x, y| {
            let centre = self.pixel(size, x, y);
            let is_one = self.model.render.samples <= 1 && !self.model.render.paths;
            let colour = if is_one { centre.colour } else { self.pixel_colour(size, x, y) };
            (encode(colour, self.model.render.transfer), centre.hit)
        })
    }

    /// The picture in the scene's own size.
    pub fn picture(&self, progress: &(dyn Fn(u64) + Sync)) -> Picture {
        let [width, height] = self.model.render.size;
        let (pixels, _) = self.render([width, height], progress);
        Picture::from_fn(width, height, |x, y| pixels[(y * width + x) as usize])
    }

    /// The picture, and what the rays behind each pixel saw, in the same order.
    pub fn witness(&self, size: [u32; 2], progress: &(dyn Fn(u64) + Sync)) -> (Vec<[u8; 3]>, Vec<Seen>) {
        self.each(size, progress, |x, y| {
            let (colour, seen) = self.pixel_witness(size, x, y);
            (encode(colour, self.model.render.transfer), seen)
        })
    }

    /// What `pixel` gives for each pixel, row by row from the top.
    fn each<T: Send>(
        &self,
        size: [u32; 2],
        progress: &(dyn Fn(u64) + Sync),
        pixel: impl Fn(u32, u32) -> ([u8; 3], T) + Sync,
    ) -> (Vec<[u8; 3]>, Vec<T>) {
        let [width, height] = size;
        (0..height)
            .into_par_iter()
            .flat_map_iter(|y| {
                let row: Vec<_> = (0..width).map(|x| pixel(x, y)).collect();
                progress(u64::from(width));
                row
            })
            .unzip()
    }

    /// The crossing of least (depth, prim) among those of `intersect`, and its prim.
    fn closest(&self, ray: &Ray, intersect: impl Fn(&Shape, &Ray) -> Option<Crossing>) -> Option<(Crossing, u32)> {
        let mut best: Option<(Crossing, u32)> = None;
        self.bvh.traverse(ray, f64::INFINITY, |shapes| {
            for shape in shapes {
                if let Some(crossing) = intersect(shape, ray) {
                    let found = (crossing.depth, shape.prim());
                    if best.is_none_or(|(least, prim)| found < (least.depth, prim)) {
                        best = Some((crossing, shape.prim()));
                    }
                }
            }
            ControlFlow::Continue(best.map_or(f64::INFINITY, |(least, _)| least.depth))
        });
        best
    }
}
