//! The camera: as a scene gives it, or so placed that the whole scene is in view.

use glam::DVec3;
use toml::Spanned;

use super::document::Document;
use super::error::ImportError;
use super::schema::{CameraToml, ProjectionToml};
use super::{LARGEST, SMALLEST};
use crate::model::{Camera, Projection, Sphere};

/// Vertical field of view where none is given, degrees.
const FOV_Y: f64 = 40.0;
/// Where the sine of the angle between up and the view is below this, up gives no direction in the
/// picture.
const PARALLEL: f64 = 1e-9;

/// The bounding box of a scene's vertices and spheres, of some extent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    /// Least coordinates, scene units.
    pub low: DVec3,
    /// Greatest coordinates, scene units.
    pub high: DVec3,
}

/// The direction from the scene to the camera, before it is normalised: right, above, in front.
const TOWARDS_CAMERA: DVec3 = DVec3::new(1.0, 0.75, 1.5);

impl Bounds {
    /// The box around some points and spheres; around none, a point at the origin.
    pub(super) fn of(points: &[DVec3], spheres: &[Sphere]) -> Self {
        let ends = spheres.iter().flat_map(|sphere| [sphere.centre - sphere.radius, sphere.centre + sphere.radius]);
        let mut points = points.iter().copied().chain(ends);
        let first = points.next().unwrap_or_default();
        points.fold(Self { low: first, high: first }, |b, p| Self { low: b.low.min(p), high: b.high.max(p) })
    }

    /// The length of the diagonal, scene units.
    pub(super) fn diagonal(&self) -> f64 {
        (self.high - self.low).length()
    }

    /// The middle of the box.
    pub(super) fn centre(&self) -> DVec3 {
        0.5 * (self.low + self.high)
    }

    /// Where a camera of vertical field of view `fov_y` (radians) stands that looks at the centre
    /// and has the sphere around the box just in view; `None` if that is out of range.
    pub(super) fn camera_position(&self, fov_y: f64) -> Option<DVec3> {
        let radius = 0.5 * self.diagonal();
        let distance = radius / libm::sin(0.5 * fov_y);
        let position = self.centre() + distance * TOWARDS_CAMERA.normalize();
        (position.abs().max_element() <= LARGEST).then_some(position)
    }
}

impl Document {
    /// The camera of a scene of the given bounds.
    pub(super) fn camera(&self, bounds: Bounds) -> Result<Camera, ImportError> {
        let none = Spanned::new(0..0, CameraToml::default());
        let table = self.scene.camera.as_ref().unwrap_or(&none);
        let camera = table.get_ref();
        let projection = self.projection(table)?;
        let place = camera.fov_y.as_ref().or(camera.height.as_ref()).map_or(table.span(), Spanned::span);
        let (position, look_at) = match (&camera.position, &camera.look_at) {
            (Some(position), Some(look_at)) => (self.point(position)?, self.point(look_at)?),
            (None, None) => {
                // Parallel rays start from where the default field of view would see it all.
                let fov_y = match projection {
                    Projection::Perspective { fov_y } => fov_y,
                    Projection::Orthographic { .. } => FOV_Y.to_radians(),
                };
                let position = bounds
                    .camera_position(fov_y)
                    .ok_or_else(|| self.error(place, "fov_y is too narrow to frame the scene; give a position"))?;
                (position, bounds.centre())
            }
            (Some(given), None) => {
                return Err(self.error(given.span(), "a position needs a look_at as well"));
            }
            (None, Some(given)) => {
                return Err(self.error(given.span(), "a look_at needs a position as well"));
            }
        };
        let view = look_at - position;
        if view.abs().max_element() < SMALLEST {
            let place = camera.look_at.as_ref().map_or(table.span(), Spanned::span);
            return Err(self.error(place, "the camera is at its own look_at; move one of them"));
        }
        let up = match &camera.up {
            Some(up) => self.direction("up", up)?,
            None => DVec3::Y,
        };
        if unit(up).cross(unit(view)).length() < PARALLEL {
            let place = camera.up.as_ref().map_or(table.span(), Spanned::span);
            let message = "up is parallel to the view; give an up that is upwards in the picture";
            return Err(self.error(place, message));
        }
        Ok(Camera { position, look_at, up, projection })
    }

    /// How the camera's rays go.
    fn projection(&self, table: &Spanned<CameraToml>) -> Result<Projection, ImportError> {
        let camera = table.get_ref();
        match (camera.projection, &camera.fov_y, &camera.height) {
            (None | Some(ProjectionToml::Perspective), fov_y, None) => {
                let degrees = fov_y.as_ref().map_or(FOV_Y, |fov_y| fov_y.get_ref().0);
                if !(degrees > 0.0 && degrees < 180.0) {
                    let place = fov_y.as_ref().map_or(table.span(), Spanned::span);
                    let message = format!("fov_y of {degrees} degrees; it must be above 0 and below 180");
                    return Err(self.error(place, message));
                }
                Ok(Projection::Perspective { fov_y: degrees.to_radians() })
            }
            (None | Some(ProjectionToml::Perspective), _, Some(height)) => {
                Err(self.error(height.span(), "height goes with an orthographic projection; use fov_y"))
            }
            (Some(ProjectionToml::Orthographic), None, Some(height)) => {
                let value = height.get_ref().0;
                if !(SMALLEST..=LARGEST).contains(&value) {
                    let message = format!("height of {value}; it must be above 0 and at most {LARGEST:e}");
                    return Err(self.error(height.span(), message));
                }
                Ok(Projection::Orthographic { height: value })
            }
            (Some(ProjectionToml::Orthographic), Some(fov_y), _) => {
                Err(self.error(fov_y.span(), "fov_y goes with a perspective projection; use height"))
            }
            (Some(ProjectionToml::Orthographic), None, None) => {
                let message = "an orthographic camera has a height: what the picture's is in the scene";
                Err(self.error(table.span(), message))
            }
        }
    }
}

/// Scales to unit length, whatever the length.
fn unit(v: DVec3) -> DVec3 {
    (v / v.abs().max_element()).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::testing::{refused, room};

    #[test]
    fn the_sphere_around_the_box_touches_the_edge_of_the_view() {
        let bounds = Bounds::of(&[DVec3::new(3.0, -1.0, 2.0), DVec3::new(1.0, 1.0, 3.0)], &[]);
        assert_eq!(bounds.centre(), DVec3::new(2.0, 0.0, 2.5));
        assert_eq!(bounds.diagonal(), 3.0);
        let fov = 40f64.to_radians();
        let position = bounds.camera_position(fov).unwrap();
        let offset = position - bounds.centre();
        assert!((offset.length() * libm::sin(fov / 2.0) - 1.5).abs() < 1e-12);
        assert!(offset.cross(TOWARDS_CAMERA).length() < 1e-12 && offset.dot(TOWARDS_CAMERA) > 0.0);
    }

    #[test]
    fn a_view_too_narrow_to_stand_back_from_is_none() {
        let bounds = Bounds::of(&[DVec3::ZERO, DVec3::ONE], &[]);
        assert_eq!(bounds.camera_position(1e-40), None);
        assert_eq!(bounds.camera_position(0.0), None);
    }

    #[test]
    fn a_camera_that_sees_nothing_is_refused() {
        let parallel = "up is parallel to the view; give an up that is upwards in the picture";
        refused(&[
            (
                "[camera]\nposition = [1, 1, 1]\nlook_at = [1, 1, 1]",
                "4: the camera is at its own look_at; move one of them",
            ),
            ("[camera]\nposition = [1, 1, 1]\nlook_at = [1, 9, 1]", &format!("2: {parallel}")),
            ("[camera]\nposition = [1, 1, 1]\nlook_at = [1, 1, 9]\nup = [0, 0, -3]", &format!("5: {parallel}")),
            ("[camera]\nup = [0, 0, 0]", "3: up [0, 0, 0] is not a direction; give one of length 1 or so"),
            (
                "[camera]\nposition = [0, 0, 2e30]\nlook_at = [0, 0, 0]",
                "3: [0, 0, 2000000000000000000000000000000] is beyond 1e30",
            ),
            ("[camera]\nposition = [0, 0, 9]", "3: a position needs a look_at as well"),
            ("[camera]\nlook_at = [0, 0, 9]", "3: a look_at needs a position as well"),
            ("[camera]\nfov_y = 0", "3: fov_y of 0 degrees; it must be above 0 and below 180"),
            ("[camera]\nfov_y = 180.0", "3: fov_y of 180 degrees; it must be above 0 and below 180"),
            ("[camera]\nfov_y = 400", "3: fov_y of 400 degrees; it must be above 0 and below 180"),
            ("[camera]\nfov_y = -40", "3: fov_y of -40 degrees; it must be above 0 and below 180"),
            ("[camera]\nfov_y = 1e-300", "3: fov_y is too narrow to frame the scene; give a position"),
            (
                "[camera]\nprojection = 'orthographic'",
                "2: an orthographic camera has a height: what the picture's is in the scene",
            ),
            (
                "[camera]\nprojection = 'orthographic'\nheight = 2\nfov_y = 40",
                "5: fov_y goes with a perspective projection; use height",
            ),
            (
                "[camera]\nprojection = 'orthographic'\nheight = 0",
                "4: height of 0; it must be above 0 and at most 1e30",
            ),
            ("[camera]\nheight = 2", "3: height goes with an orthographic projection; use fov_y"),
        ]);
    }

    #[test]
    fn a_camera_table_without_a_place_keeps_the_framing_for_its_angle() {
        let camera = room("[camera]\nfov_y = 60\nup = [0, 0, 1]").unwrap().model.camera;
        let distance = (camera.position - DVec3::ONE).length();
        assert!((distance - 2.0 * 3f64.sqrt()).abs() < 1e-12, "sqrt 3 / sin 30 degrees");
        assert_eq!(camera.look_at, DVec3::ONE);
        assert_eq!(camera.up, DVec3::Z);
    }

    #[test]
    fn a_camera_of_parallel_rays_has_the_height_that_it_is_given() {
        let camera = room("[camera]\nprojection = 'orthographic'\nheight = 3").unwrap().model.camera;
        assert_eq!(camera.projection, Projection::Orthographic { height: 3.0 });
        assert_eq!(camera.look_at, DVec3::ONE);
    }

    #[test]
    fn spheres_are_in_view() {
        let ball = Sphere { centre: DVec3::ONE, radius: 2.0, material: 0 };
        let both = Bounds::of(&[DVec3::X * 9.0], &[ball]);
        assert_eq!((both.low, both.high), (DVec3::new(-1.0, -1.0, -1.0), DVec3::new(9.0, 3.0, 3.0)));
    }
}
