//! The camera's motion: a head that turns about the scene's own upwards, and goes where it looks.
//!
//! A camera that has moved has coordinates of a few digits, so that what is drawn is exactly what
//! [`scene_file`](crate::scene_file) writes. One that has not moved is the scene's, to the last bit.

use glam::DVec3;
use host_tools::model::{Camera, Model, Projection};

/// How far pitch goes up and down, radians: short of upwards, where there would be no right.
const PITCH_MAX: f64 = 1.55;

/// Seconds that it takes to cross the scene.
const CROSSING: f64 = 4.0;

/// Radians a second of turning.
const TURNING: f64 = 1.2;

/// What a step of zooming leaves of the view's height.
const ZOOM: f64 = 0.95;

/// The narrowest and the widest field of view that zooming leads to, degrees.
const FOV_Y: [f64; 2] = [1.0, 150.0];

/// Digits of a coordinate behind the first one of the scene's size.
const DIGITS: i32 = 6;

/// How far away the point that it looks at is at least, in sizes of the scene.
const NEAREST: f64 = 0.1;

/// How many sizes of the scene one may go away from it.
const FAR: f64 = 100.0;

/// What is asked of the camera: each from -1 to 1, or beyond for more haste.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Steer {
    /// To where it looks, or back.
    pub ahead: f64,
    /// To the right, or left.
    pub right: f64,
    /// Up, or down.
    pub up: f64,
    /// Turning to the right, or left.
    pub yaw: f64,
    /// Turning upwards, or downwards.
    pub pitch: f64,
}

impl Steer {
    /// Whether it asks for nothing.
    #[must_use]
    pub fn is_still(&self) -> bool {
        *self == Self::default()
    }

    /// Both together.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            ahead: self.ahead + other.ahead,
            right: self.right + other.right,
            up: self.up + other.up,
            yaw: self.yaw + other.yaw,
            pitch: self.pitch + other.pitch,
        }
    }
}

/// A camera on its way.
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    home: Camera,
    /// Upwards, and at home the level directions ahead and to the right: unit vectors.
    axes: [DVec3; 3],
    place: Place,
    /// The middle of the scene, and the length of its diagonal, scene units.
    middle: DVec3,
    diagonal: f64,
}

/// Where a camera is and how it looks.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    position: DVec3,
    /// Radians to the right of home's direction.
    yaw: f64,
    /// Radians above the level.
    pitch: f64,
    /// Steps of zooming.
    zoom: f64,
}

impl Walk {
    /// From the camera of a model, whose up is not parallel to its view.
    #[must_use]
    pub fn new(model: &Model) -> Self {
        let home = model.camera;
        let up = home.up.normalize();
        let forward = (home.look_at - home.position).normalize();
        let right = forward.cross(up).normalize();
        let ends = model.spheres.iter().flat_map(|s| [s.centre - s.radius, s.centre + s.radius]);
        let (low, high) = model
            .positions
            .iter()
            .copied()
            .chain(ends)
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), point| (low.min(point), high.max(point)));
        let place = Place { position: home.position, yaw: 0.0, pitch: libm::asin(forward.dot(up)), zoom: 0.0 };
        Self {
            home,
            axes: [up, up.cross(right), right],
            place,
            middle: (low + high) / 2.0,
            diagonal: (high - low).length(),
        }
    }

    /// Goes and turns for a time in seconds, as far as it is possible.
    pub fn step(&mut self, steer: &Steer, seconds: f64) {
        if steer.is_still() {
            return;
        }
        let [up, ..] = self.axes;
        let forward = self.forward();
        let right = forward.cross(up).normalize();
        let way = forward * steer.ahead + right * steer.right + up * steer.up;
        let reach = DVec3::splat(FAR * self.diagonal);
        let wanted = self.place.position + way * (self.diagonal / CROSSING * seconds);
        // Who begins beyond it may stay there.
        let (low, high) = (self.middle - reach, self.middle + reach);
        self.place.position = wanted.clamp(low.min(self.place.position), high.max(self.place.position));
        self.turn(steer.yaw * TURNING * seconds, steer.pitch * TURNING * seconds);
    }

    /// Turns to the right and upwards, radians.
    pub fn turn(&mut self, yaw: f64, pitch: f64) {
        self.place.yaw += yaw;
        let reach = PITCH_MAX.max(self.place.pitch.abs());
        self.place.pitch = (self.place.pitch + pitch).clamp(-reach, reach);
    }

    /// Narrows the view by so many steps; negative ones widen it.
    pub fn zoom(&mut self, steps: f64) {
        self.place.zoom += steps;
    }

    /// Back to where the scene has it.
    pub fn go_home(&mut self) {
        self.place = self.home_place();
    }

    /// The camera where it is now.
    #[must_use]
    pub fn camera(&self) -> Camera {
        if self.place == self.home_place() {
            return self.home;
        }
        let home_place = self.home_place();
        let stays = Place { zoom: 0.0, ..self.place } == home_place;
        let (position, look_at) = if stays {
            (self.home.position, self.home.look_at)
        } else {
            // Far enough away for the direction to survive the rounding.
            let distance = (self.home.look_at - self.home.position).length().max(self.diagonal * NEAREST);
            let position = self.rounded(self.place.position);
            (position, self.rounded(position + self.forward() * distance))
        };
        Camera { position, look_at, up: self.home.up, projection: self.projection() }
    }

    fn home_place(&self) -> Place {
        let [up, ..] = self.axes;
        let forward = (self.home.look_at - self.home.position).normalize();
        Place { position: self.home.position, yaw: 0.0, pitch: libm::asin(forward.dot(up)), zoom: 0.0 }
    }

    fn projection(&self) -> Projection {
        if self.place.zoom == 0.0 {
            return self.home.projection;
        }
        let share = libm::pow(ZOOM, self.place.zoom);
        match self.home.projection {
            Projection::Perspective { fov_y } => {
                let degrees = (fov_y.to_degrees() * share).clamp(FOV_Y[0], FOV_Y[1]);
                Projection::Perspective { fov_y: decimal(degrees, 2).to_radians() }
            }
            Projection::Orthographic { height } => {
                let range = [self.diagonal / 1000.0, self.diagonal * FAR];
                let height = decimal((height * share).clamp(range[0], range[1]), self.decimals());
                Projection::Orthographic { height }
            }
        }
    }

    /// The unit vector to where it looks.
    fn forward(&self) -> DVec3 {
        let [up, ahead, right] = self.axes;
        let Place { yaw, pitch, .. } = self.place;
        let level = ahead * libm::cos(yaw) + right * libm::sin(yaw);
        level * libm::cos(pitch) + up * libm::sin(pitch)
    }

    /// Decimals that tell points of the scene apart.
    fn decimals(&self) -> usize {
        // Of a scene of 1e30 units none, of one of 1e-30 units 36.
        let size = libm::floor(libm::log10(self.diagonal)) as i32;
        (DIGITS - size).clamp(0, 40) as usize
    }

    fn rounded(&self, point: DVec3) -> DVec3 {
        DVec3::from_array(point.to_array().map(|c| decimal(c, self.decimals())))
    }
}

/// The number nearest to the decimal fraction that is nearest to a number.
fn decimal(value: f64, decimals: usize) -> f64 {
    let rounded = format!("{value:.decimals$}").parse().unwrap_or(value);
    // Not -0.
    rounded + 0.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use host_tools::model::Sphere;

    fn model(camera: Camera) -> Model {
        Model { spheres: vec![Sphere { centre: DVec3::ZERO, radius: 1.0, material: 0 }], camera, ..Model::default() }
    }

    fn camera(position: [f64; 3], look_at: [f64; 3]) -> Camera {
        Camera { position: position.into(), look_at: look_at.into(), ..Camera::default() }
    }

    fn close(a: DVec3, b: [f64; 3]) {
        assert!((a - DVec3::from(b)).length() < 1e-4, "{a} is not {b:?}");
    }

    #[test]
    fn a_camera_that_stays_is_the_scenes_own() {
        // Nothing of it is a short decimal.
        let own = camera([1.0 / 3.0, 0.1, 3.7], [0.7 / 3.0, 0.2, 0.0]);
        let mut walk = Walk::new(&model(own));
        walk.step(&Steer::default(), 1.0);
        assert_eq!(walk.camera(), own);
        walk.step(&Steer { ahead: 1.0, yaw: -0.3, ..Steer::default() }, 0.5);
        walk.zoom(2.0);
        assert_ne!(walk.camera(), own);
        walk.go_home();
        assert_eq!(walk.camera(), own);
        walk.zoom(1.0);
        assert_eq!((walk.camera().position, walk.camera().look_at), (own.position, own.look_at));
    }

    #[test]
    fn it_goes_where_it_looks() {
        let mut walk = Walk::new(&model(camera([0.0, 0.0, 4.0], [0.0, 0.0, 0.0])));
        // The diagonal is 2 sqrt 3, and takes 4 seconds.
        let step = 3f64.sqrt() / 2.0;
        for (steer, expected) in [
            (Steer { ahead: 1.0, ..Steer::default() }, [0.0, 0.0, 4.0 - step]),
            (Steer { ahead: -1.0, ..Steer::default() }, [0.0, 0.0, 4.0]),
            (Steer { right: 2.0, ..Steer::default() }, [2.0 * step, 0.0, 4.0]),
            (Steer { up: -1.0, ..Steer::default() }, [2.0 * step, -step, 4.0]),
        ] {
            walk.step(&steer, 1.0);
            close(walk.camera().position, expected);
        }
        // A quarter to the right: ahead is +x now.
        walk.go_home();
        walk.turn(core::f64::consts::FRAC_PI_2, 0.0);
        let camera = walk.camera();
        close((camera.look_at - camera.position).normalize(), [1.0, 0.0, 0.0]);
        walk.step(&Steer { ahead: 1.0, ..Steer::default() }, 1.0);
        close(walk.camera().position, [step, 0.0, 4.0]);
    }

    #[test]
    fn it_never_looks_straight_up_nor_goes_out_of_sight() {
        let mut walk = Walk::new(&model(camera([0.0, 0.0, 4.0], [0.0, 0.0, 0.0])));
        for pitch in [9.0, -30.0] {
            walk.turn(0.0, pitch);
            let Camera { position, look_at, up, .. } = walk.camera();
            assert!((look_at - position).normalize().cross(up).length() > 0.01);
        }
        walk.step(&Steer { ahead: 1.0, right: 1.0, up: 1.0, ..Steer::default() }, 1e9);
        // Rounded in the sixth decimal.
        assert!(walk.camera().position.abs().max_element() <= 100.0 * 12f64.sqrt() + 1e-6);
    }

    #[test]
    fn zooming_stays_within_what_a_view_can_be() {
        let fov = |walk: &Walk| match walk.camera().projection {
            Projection::Perspective { fov_y } => fov_y.to_degrees(),
            Projection::Orthographic { .. } => 0.0,
        };
        let mut walk = Walk::new(&model(camera([0.0, 0.0, 4.0], [0.0, 0.0, 0.0])));
        walk.zoom(1.0);
        assert!((fov(&walk) - 38.0).abs() < 1e-9);
        walk.zoom(1e4);
        assert!((fov(&walk) - 1.0).abs() < 1e-9);
        walk.zoom(-2e4);
        assert!((fov(&walk) - 150.0).abs() < 1e-9);
    }

    #[test]
    fn what_it_says_is_a_short_decimal() {
        let mut walk = Walk::new(&model(camera([0.0, 0.0, 4.0], [0.0, 0.0, 0.0])));
        walk.step(&Steer { ahead: 0.7, right: 0.1, yaw: 0.3, pitch: 0.2, ..Steer::default() }, 0.123);
        let camera = walk.camera();
        for coordinate in camera.position.to_array().into_iter().chain(camera.look_at.to_array()) {
            assert!(format!("{coordinate}").len() <= 9, "{coordinate}");
            assert_eq!(format!("{coordinate}").parse(), Ok(coordinate));
        }
    }
}
