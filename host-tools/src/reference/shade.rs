//! The colour of a point, by the [policy](super) that the integer core follows too.

use std::ops::ControlFlow;

use glam::DVec3;

use super::ray::Ray;
use super::triangle::Triangle;
use super::{Hit, Reference, Sample, lookup};
use crate::model::LightKind;

impl Reference<'_> {
    /// What a viewer looking along `direction` sees at `hit`.
    pub(super) fn shade(&self, direction: DVec3, hit: Hit) -> Sample {
        let model = self.model;
        let triangle = &model.triangles[hit.prim as usize];
        let weights = [1.0 - hit.u - hit.v, hit.u, hit.v];
        let blend = |values: &[DVec3], indices: [u32; 3]| {
            let [a, b, c] = indices.map(|i| values[i as usize]);
            a * weights[0] + b * weights[1] + c * weights[2]
        };
        let point = blend(&model.positions, triangle.vertices);
        let front = lookup(model, hit.prim).cross().normalize();
        let geometric_normal = if front.dot(direction) > 0.0 { -front } else { front };
        let smooth = triangle
            .normals
            .and_then(|normals| blend(&model.normals, normals).try_normalize())
            .unwrap_or(geometric_normal);
        let normal = if smooth.dot(geometric_normal) < 0.0 { -smooth } else { smooth };

        let mut irradiance = model.render.ambient;
        let mut lights = 0;
        for (i, light) in model.lights.iter().enumerate() {
            let (towards, end) = match light.kind {
                LightKind::Point(position) => (position - point, Some(position)),
                LightKind::Directional(travel) => (-travel, None),
            };
            let ray = Ray::new(point, towards);
            // Not a number if the light is at the point, which then counts as unlit.
            let l = ray.step.normalize();
            let cosine = normal.dot(l);
            if cosine > 0.0 && geometric_normal.dot(l) > 0.0 && !self.blocked(&ray, hit.prim, end) {
                irradiance += light.radiance * cosine;
                lights |= 1_u64.checked_shl(i as u32).unwrap_or(0);
            }
        }
        let material = &model.materials[triangle.material as usize];
        Sample {
            colour: material.emission + material.diffuse * irradiance,
            hit: Some(hit),
            lights,
            normal,
            geometric_normal,
        }
    }

    /// Whether a triangle other than `start`, on which `ray` starts, lies between there and `end`, a
    /// point light; without one, anywhere along `ray`.
    fn blocked(&self, ray: &Ray, start: u32, end: Option<DVec3>) -> bool {
        let limit = if end.is_some() { ray.scale } else { f64::INFINITY };
        let blocks = |triangle: &Triangle| {
            triangle.prim != start
                && triangle.intersect(ray).is_some_and(|crossing| crossing.depth < limit)
                && !self.in_plane(triangle, ray.origin)
                && !end.is_some_and(|light| self.in_plane(triangle, light))
        };
        let mut blocked = false;
        self.bvh.traverse(ray, limit, |triangles| {
            blocked = triangles.iter().any(blocks);
            if blocked { ControlFlow::Break(()) } else { ControlFlow::Continue(limit) }
        });
        blocked
    }

    /// Whether the triangle's plane contains `point`, to within [`Reference::contact`].
    fn in_plane(&self, triangle: &Triangle, point: DVec3) -> bool {
        let normal = triangle.cross();
        normal.dot(point - triangle.corners[0]).abs() <= self.contact * normal.length()
    }
}
