//! The pinhole camera, and the camera of parallel rays.

use glam::DVec3;

use crate::model::{Camera, Projection};

/// A camera's frame: where it looks and how far its picture reaches.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    position: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    /// Half the picture's height: at distance 1, or of parallel rays, in scene units.
    half_height: f64,
    is_parallel: bool,
}

impl View {
    /// The frame of `camera`.
    pub(super) fn new(camera: &Camera) -> Self {
        let forward = (camera.look_at - camera.position).normalize();
        let right = forward.cross(camera.up).normalize();
        let (half_height, is_parallel) = match camera.projection {
            Projection::Perspective { fov_y } => (libm::tan(fov_y / 2.0), false),
            Projection::Orthographic { height } => (height / 2.0, true),
        };
        Self { position: camera.position, forward, right, up: right.cross(forward), half_height, is_parallel }
    }

    /// Origin and direction, of any length, of the ray through `(x, y)` in pixels, y down.
    pub(super) fn ray(&self, size: [u32; 2], x: f64, y: f64) -> (DVec3, DVec3) {
        let [width, height] = size.map(f64::from);
        let pixel = 2.0 * self.half_height / height;
        let right = (x - width / 2.0) * pixel;
        let up = (height / 2.0 - y) * pixel;
        let across = self.right * right + self.up * up;
        if self.is_parallel { (self.position + across, self.forward) } else { (self.position, self.forward + across) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_frame_and_the_corners_are_where_the_field_of_view_says() {
        let view = View::new(&Camera {
            position: DVec3::new(1.0, 2.0, 3.0),
            look_at: DVec3::new(1.0, 2.0, -7.0),
            up: DVec3::new(0.0, 5.0, 1.0),
            projection: Projection::Perspective { fov_y: core::f64::consts::FRAC_PI_2 },
        });
        let close = |(origin, direction): (DVec3, DVec3), expected: [f64; 3]| {
            assert_eq!(origin, DVec3::new(1.0, 2.0, 3.0));
            assert!((direction - DVec3::from(expected)).length() < 1e-15, "{direction}");
        };
        close(view.ray([200, 100], 100.0, 50.0), [0.0, 0.0, -1.0]);
        close(view.ray([200, 100], 0.0, 0.0), [-2.0, 1.0, -1.0]);
        close(view.ray([200, 100], 200.0, 100.0), [2.0, -1.0, -1.0]);
        close(view.ray([3, 1], 1.5, 0.0), [0.0, 1.0, -1.0]);
    }

    #[test]
    fn parallel_rays_start_across_the_plane_of_the_camera() {
        let view = View::new(&Camera {
            position: DVec3::new(1.0, 2.0, 3.0),
            look_at: DVec3::new(1.0, 2.0, -7.0),
            up: DVec3::Y,
            projection: Projection::Orthographic { height: 8.0 },
        });
        let expected =
            [([0.0, 0.0], [-7.0, 6.0, 3.0]), ([100.0, 50.0], [1.0, 2.0, 3.0]), ([200.0, 75.0], [9.0, 0.0, 3.0])];
        for ([x, y], origin) in expected {
            assert_eq!(view.ray([200, 100], x, y), (DVec3::from(origin), -DVec3::Z));
        }
    }
}
