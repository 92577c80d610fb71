//! A point of a surface: where it is, how it lies, and what it is made of.

use glam::DVec3;

use super::Reference;
use super::ray::Ray;
use super::texture;
use super::triangle::Crossing;
use crate::model::{Checker, Material};

/// By what part of a cube's side a point is moved along the normal's axis, so that surfaces in the planes between cubes,
/// where checkers usually lie, are well inside some.
const SHIFT_ACROSS: f64 = 1.0 / 64.0;
/// And by what part along the other axes: rays through whole fractions of a picture meet lines at whole coordinates
/// exactly, where rounding would decide.
const SHIFT_ALONG: f64 = 1.0 / 1024.0;

/// A triangle is creased, and no part of a smooth surface, if the cosine between a corner's normal and its own is not above
/// this. An even fraction of what regular solids have (1/3 and more) would be met exactly by some.
const STEEPEST: f64 = 0.25;

/// A point that a ray has met, seen along that ray.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surface<'m> {
    /// The triangle or sphere.
    pub(super) prim: u32,
    /// Scene units.
    pub(super) point: DVec3,
    /// Unit direction in which the ray came.
    pub(super) direction: DVec3,
    /// Whether the ray came from the front, which is the outside of what is closed.
    pub(super) is_front: bool,
    /// Unit normal ng of the triangle or the sphere, towards the viewer.
    pub(super) geometric_normal: DVec3,
    /// Unit shading normal ns, on the same side as ng.
    pub(super) normal: DVec3,
    /// From where lights are looked for, if the surface is smooth, and not creased: above it, where that is convex.
    pub(super) lifted: Option<DVec3>,
    /// What the surface is made of.
    pub(super) material: &'m Material,
    /// Its diffuse reflectance here, linear RGB.
    pub(super) albedo: DVec3,
}

impl<'m> Reference<'m> {
    /// The point at which `ray` meets primitive `prim`.
    pub(super) fn surface(&self, ray: &Ray, crossing: Crossing, prim: u32) -> Surface<'m> {
        let direction = ray.step.normalize();
        if (prim as usize) < self.model.triangles.len() {
            self.on_triangle(direction, crossing, prim)
        } else {
            self.on_sphere(direction, ray.at(crossing.depth), prim)
        }
    }

    fn on_triangle(&self, direction: DVec3, crossing: Crossing, prim: u32) -> Surface<'m> {
        let model = self.model;
        let triangle = &model.triangles[prim as usize];
        let weights = [1.0 - crossing.u - crossing.v, crossing.u, crossing.v];
        let blend = |values: &[DVec3], indices: [u32; 3]| {
            let [a, b, c] = indices.map(|i| values[i as usize]);
            a * weights[0] + b * weights[1] + c * weights[2]
        };
        let [a, b, c] = triangle.vertices.map(|v| model.positions[v as usize]);
        let front = (b - a).cross(c - a).normalize();
        let point = blend(&model.positions, triangle.vertices);
        let smooth = triangle.normals.and_then(|normals| blend(&model.normals, normals).try_normalize());

        let material = &model.materials[triangle.material as usize];
        let mut albedo = painted(material, point, front);
        if let (Some(texture), Some(&Some([a, b, c]))) = (&material.texture, model.uvs.get(prim as usize)) {
            let uv = a * weights[0] + b * weights[1] + c * weights[2];
            albedo *= texture::look_up(texture, uv, model.render.filter);
        }
        if !model.colours.is_empty() {
            albedo *= blend(&model.colours, triangle.vertices);
        }
        let mut surface = Surface::new(prim, point, direction, front, smooth, material, albedo);
        if let (Some(normals), Some(smooth)) = (triangle.normals, smooth) {
            let side = if surface.normal == smooth { 1.0 } else { -1.0 };
            let normals = normals.map(|n| model.normals[n as usize] * side);
            let corners = triangle.vertices.map(|v| model.positions[v as usize]);
            if normals.iter().all(|n| n.dot(surface.geometric_normal) > STEEPEST) {
                surface.lifted = Some(lifted(point, corners, normals, weights));
            }
        }
        surface
    }

    fn on_sphere(&self, direction: DVec3, crossing: DVec3, prim: u32) -> Surface<'m> {
        let sphere = &self.model.spheres[prim as usize - self.model.triangles.len()];
        let front = (crossing - sphere.centre).normalize();
        // The crossing is as far off as the ray is long; this point is on the sphere.
        let point = sphere.centre + front * sphere.radius;
        let material = &self.model.materials[sphere.material as usize];
        Surface::new(prim, point, direction, front, None, material, painted(material, point, front))
    }
}

impl<'m> Surface<'m> {
    fn new(
        prim: u32,
        point: DVec3,
        direction: DVec3,
        front: DVec3,
        smooth: Option<DVec3>,
        material: &'m Material,
        albedo: DVec3,
    ) -> Self {
        let is_front = front.dot(direction) <= 0.0;
        let geometric_normal = if is_front { front } else { -front };
        let smooth = smooth.unwrap_or(geometric_normal);
        let normal = if smooth.dot(geometric_normal) < 0.0 { -smooth } else { smooth };
        Self { prim, point, direction, is_front, geometric_normal, normal, lifted: None, material, albedo }
    }
}

/// A point of a triangle moved onto the mean of the planes through its corners, along their normals, weighted as the point
/// is; planes that it is above already do not move it.
///
/// J. Hanika, "Hacking the Shadow Terminator", Ray Tracing Gems II, 2021.
fn lifted(point: DVec3, corners: [DVec3; 3], normals: [DVec3; 3], weights: [f64; 3]) -> DVec3 {
    let mut lifted = point;
    for ((corner, normal), weight) in corners.into_iter().zip(normals).zip(weights) {
        lifted -= normal * (weight * (point - corner).dot(normal).min(0.0));
    }
    lifted
}

/// The material's own albedo at `point`, where the geometric normal is `normal`, of either sign.
fn painted(material: &Material, point: DVec3, normal: DVec3) -> DVec3 {
    match material.checker {
        Some(checker) if is_odd(checker, point, normal) => checker.other,
        _ => material.colour,
    }
}

/// Whether the cube of `point` is one of the other albedo. A plane parallel to an axis may lie between two layers of cubes:
/// so the point is first raised a little along the axis that the normal is closest to, the first of equally close ones;
/// and less along the others.
fn is_odd(checker: Checker, point: DVec3, normal: DVec3) -> bool {
    let size = normal.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    };
    let mut shift = DVec3::splat(SHIFT_ALONG);
    shift[axis] = SHIFT_ACROSS;
    let place = point / checker.size + shift;
    // Halved, so that it is exact however large: an odd sum leaves a half.
    let halves = place.floor() / 2.0;
    let odd: f64 = (halves - halves.floor()).element_sum();
    odd == 0.5 || odd == 1.5
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_lifted_where_the_surface_is_convex() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let middle = DVec3::new(1.0, 1.0, 0.0) / 3.0;
        let lift = |normals| lifted(middle, corners, normals, [1.0 / 3.0; 3]) - middle;
        assert_eq!(lift([DVec3::Z; 3]), DVec3::ZERO);
        let outward = corners.map(|corner| (corner - middle + DVec3::Z).normalize());
        assert!(lift(outward).z > 0.1);
        let inward = corners.map(|corner| (middle - corner + DVec3::Z).normalize());
        assert_eq!(lift(inward), DVec3::ZERO);
    }

    #[test]
    fn cubes_alternate_and_a_plane_between_two_layers_is_in_one() {
        let checker = Checker { size: 2.0, other: DVec3::ZERO };
        let odd = |x: f64, y: f64, z: f64, normal: DVec3| is_odd(checker, DVec3::new(x, y, z), normal);
        assert!(!odd(0.5, 0.5, 0.5, DVec3::Y) && odd(2.5, 0.5, 0.5, DVec3::Y) && !odd(2.5, 2.5, 0.5, DVec3::Y));
        assert!(odd(2.5, 2.5, 2.5, DVec3::Y), "three odd ones are odd");
        assert!(odd(-0.5, 0.5, 0.5, DVec3::Y) && !odd(-0.5, -0.5, 0.5, DVec3::Y));
        // A floor at y = -4, rounded either way, seen from either side.
        for y in [-4.0 - 1e-9, -4.0, -4.0 + 1e-9] {
            for normal in [DVec3::Y, -DVec3::Y] {
                assert!(!odd(0.5, y, 0.5, normal) && odd(0.5, y, 2.5, normal) && odd(0.5, y, -0.5, normal), "{y}");
                assert!(
                    odd(1.997, y, 2.5, normal) && !odd(2.0, y, 2.5, normal),
                    "the sides stay almost where they are"
                );
            }
        }
        assert!(!odd(1e300, 0.5, 0.5, DVec3::Y), "what has no odd numbers left is even");
    }
}
