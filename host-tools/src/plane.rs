//! The plane that parallel camera rays start in.

use glam::DVec3;

use crate::model::{Model, Projection};

/// How much of its longest side the geometry keeps from a plane that was moved towards it: far more than origins are
/// rounded by, on any grid that tells the geometry's points apart.
const CLEARANCE: f64 = 1.0 / 16.0;

/// A plane with the picture on it, scene units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// The picture's middle.
    pub middle: DVec3,
    /// The direction of all rays; a unit vector, as are the next two.
    pub forward: DVec3,
    /// To the picture's right.
    pub right: DVec3,
    /// To its top.
    pub up: DVec3,
    /// Half of the picture's width and height.
    pub half: [f64; 2],
}

impl Plane {
    /// The plane of a model's camera; `None` where its rays are not parallel.
    #[must_use]
    pub fn of(model: &Model) -> Option<Self> {
        match model.camera.projection {
            Projection::Perspective { .. } => None,
            Projection::Orthographic { height } => Some(Self::new(model, height)),
        }
    }

    /// The plane of a model's camera, for a picture of a height in scene units.
    ///
    /// It goes through the camera's position, or, where all geometry is far beyond that, just before the geometry: the same
    /// is seen from there, and the grid need not reach as far.
    #[must_use]
    pub fn new(model: &Model, height: f64) -> Self {
        let camera = &model.camera;
        let forward = (camera.look_at - camera.position).normalize();
        let right = forward.cross(camera.up).normalize();
        let [across, down] = model.render.size.map(f64::from);
        let corners = model.triangles.iter().flat_map(|t| t.vertices).map(|v| (model.positions[v as usize], 0.0));
        let spheres = model.spheres.iter().map(|sphere| (sphere.centre, sphere.radius));
        let (mut nearest, mut low, mut high) =
            (f64::INFINITY, DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY));
        for (point, radius) in corners.chain(spheres) {
            nearest = nearest.min((point - camera.position).dot(forward) - radius);
            (low, high) = (low.min(point - radius), high.max(point + radius));
        }
        let ahead = nearest - CLEARANCE * (high - low).max_element();
        let moved = if ahead > 0.0 && ahead.is_finite() { forward * ahead } else { DVec3::ZERO };
        Self {
            middle: camera.position + moved,
            forward,
            right,
            up: right.cross(forward),
            half: [height / 2.0 * across / down, height / 2.0],
        }
    }

    /// The corners of the picture.
    #[must_use]
    pub fn corners(&self) -> [DVec3; 4] {
        let (across, up) = (self.right * self.half[0], self.up * self.half[1]);
        [-across - up, across - up, up - across, across + up].map(|from_middle| self.middle + from_middle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Camera, Sphere};

    fn looking_down(y: f64) -> Model {
        let mut model = Model {
            camera: Camera {
                position: DVec3::new(1.0, y, 3.0),
                look_at: DVec3::new(1.0, y - 2.0, 3.0),
                up: DVec3::X,
                projection: Projection::Orthographic { height: 4.0 },
            },
            spheres: vec![Sphere { centre: DVec3::ZERO, radius: 2.0, material: 0 }],
            ..Model::default()
        };
        model.render.size = [200, 100];
        model
    }

    #[test]
    fn the_picture_lies_in_the_plane() {
        let plane = Plane::of(&looking_down(1.0)).unwrap();
        let expected = [[-1.0, 1.0, -1.0], [-1.0, 1.0, 7.0], [3.0, 1.0, -1.0], [3.0, 1.0, 7.0]];
        assert_eq!(plane.corners(), expected.map(DVec3::from));
        assert_eq!(Plane::of(&Model::default()), None);
    }

    #[test]
    fn a_far_plane_is_brought_to_the_geometry_and_not_into_it() {
        let middle = |y: f64| Plane::of(&looking_down(y)).unwrap().middle;
        // The sphere is 4 across, so that a quarter is kept.
        assert_eq!(middle(1e6), DVec3::new(1.0, 2.25, 3.0));
        for y in [2.25, 2.1, 0.0, -9.0] {
            assert_eq!(middle(y).y, y);
        }
    }
}
