//! How large a length is in the picture: what of the mesh is in view, and how far away it is.

use glam::DVec3;

use crate::model::{Model, Projection};

/// A half-space of camera coordinates (right, up, forward): `normal . p + offset >= 0`.
type Plane = (DVec3, f64);

/// The part of space that a picture shows.
#[derive(Clone, Debug)]
pub(super) struct View {
    position: DVec3,
    /// Right, up and forward, unit vectors.
    frame: [DVec3; 3],
    planes: Vec<Plane>,
    /// The side of a pixel, scene units: at distance 1, or of parallel rays, everywhere.
    pixel: f64,
    is_parallel: bool,
}

impl View {
    pub(super) fn of(model: &Model) -> Self {
        let camera = &model.camera;
        let [width, height] = model.render.size.map(f64::from);
        let forward = (camera.look_at - camera.position).normalize();
        let right = forward.cross(camera.up).normalize();
        let (half, is_parallel) = match camera.projection {
            Projection::Perspective { fov_y } => (libm::tan(fov_y / 2.0), false),
            Projection::Orthographic { height } => (height / 2.0, true),
        };
        let sides = [(DVec3::X, half * width / height), (DVec3::Y, half)].into_iter().flat_map(|(axis, reach)| {
            [axis, -axis].map(|axis| if is_parallel { (axis, reach) } else { (axis + DVec3::Z * reach, 0.0) })
        });
        let planes = sides.chain([(DVec3::Z, 0.0)]).collect();
        let frame = [right, right.cross(forward), forward];
        Self { position: camera.position, frame, planes, pixel: 2.0 * half / height, is_parallel }
    }

    /// The pixels' side where the corners of what is in view of a polygon are, scene units; nothing is said of what hides it.
    pub(super) fn pixels_at<const N: usize>(&self, corners: [DVec3; N]) -> impl Iterator<Item = f64> {
        let local = |corner: DVec3| {
            let from = corner - self.position;
            DVec3::from_array(self.frame.map(|axis| axis.dot(from)))
        };
        let seen = self.planes.iter().fold(corners.map(local).to_vec(), clipped);
        seen.into_iter().map(|corner| if self.is_parallel { self.pixel } else { self.pixel * corner.z })
    }
}

/// What of a convex polygon is in a half-space: I. Sutherland and G. Hodgman, "Reentrant Polygon Clipping", Communications
/// of the ACM 17(1), 1974.
fn clipped(polygon: Vec<DVec3>, &(normal, offset): &Plane) -> Vec<DVec3> {
    let inside = |point: &DVec3| normal.dot(*point) + offset;
    // Most are.
    if polygon.iter().all(|corner| inside(corner) >= 0.0) {
        return polygon;
    }
    let previous = polygon.iter().cycle().skip(polygon.len().saturating_sub(1));
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (from, to) in previous.zip(&polygon) {
        let (a, b) = (inside(from), inside(to));
        if (a < 0.0) != (b < 0.0) {
            kept.push(from + (to - from) * (a / (a - b)));
        }
        if b >= 0.0 {
            kept.push(*to);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Camera;

    fn model(projection: Projection) -> Model {
        let camera = Camera { position: DVec3::Z * 5.0, look_at: DVec3::ZERO, up: DVec3::Y, projection };
        let mut model = Model { camera, ..Model::default() };
        model.render.size = [200, 100];
        model
    }

    #[test]
    fn a_wall_larger_than_the_picture_is_cut_to_it() {
        let wall = [[-9.0, -9.0], [9.0, -9.0], [9.0, 9.0], [-9.0, 9.0]].map(|[x, y]| DVec3::new(x, y, 0.0));
        let perspective = model(Projection::Perspective { fov_y: core::f64::consts::FRAC_PI_2 });
        let seen: Vec<f64> = View::of(&perspective).pixels_at(wall).collect();
        // At distance 5, with a slope of 1, the picture is 10 high.
        assert!(seen.len() >= 4 && seen.iter().all(|pixel| (pixel - 0.1).abs() < 1e-12), "{seen:?}");
        let parallel = model(Projection::Orthographic { height: 4.0 });
        let seen: Vec<f64> = View::of(&parallel).pixels_at(wall).collect();
        assert!(seen.len() >= 4 && seen.iter().all(|pixel| (pixel - 0.04).abs() < 1e-12), "{seen:?}");
    }

    #[test]
    fn what_is_behind_or_beside_is_not_in_view() {
        let view = View::of(&model(Projection::Perspective { fov_y: 1.0 }));
        for shift in [DVec3::Z * 6.0, DVec3::X * 50.0, DVec3::Y * -50.0] {
            let away = [DVec3::X, DVec3::Y, DVec3::ZERO].map(|corner| corner + shift);
            assert_eq!(view.pixels_at(away).count(), 0, "{shift}");
        }
        // One corner is behind the camera: what is before it is in view, and begins at no distance at all.
        let through = [DVec3::new(0.0, -1.0, -50.0), DVec3::new(1.0, -1.0, -50.0), DVec3::new(0.0, -1.0, 50.0)];
        assert!(view.pixels_at(through).count() >= 3);
    }
}
