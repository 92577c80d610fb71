//! The pinhole camera.

use glam::DVec3;

use crate::model::Camera;

/// A camera's frame: where it looks and how far its picture reaches at unit distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    position: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    half_height: f64,
}

impl View {
    /// The frame of `camera`.
    pub(super) fn new(camera: &Camera) -> Self {
        let forward = (camera.look_at - camera.position).normalize();
        let right = forward.cross(camera.up).normalize();
        Self {
            position: camera.position,
            forward,
            right,
            up: right.cross(forward),
            half_height: libm::tan(camera.fov_y / 2.0),
        }
    }

    /// Origin and direction, of any length, of the ray through `(x, y)` in pixels, y down.
    pub(super) fn ray(&self, size: [u32; 2], x: f64, y: f64) -> (DVec3, DVec3) {
        let [width, height] = size.map(f64::from);
        let pixel = 2.0 * self.half_height / height;
        let right = (x - width / 2.0) * pixel;
        let up = (height / 2.0 - y) * pixel;
        (self.position, self.forward + self.right * right + self.up * up)
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
            fov_y: core::f64::consts::FRAC_PI_2,
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
}
