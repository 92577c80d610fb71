//! A gamepad or a joystick, as steering.
//!
//! Read from Linux's event devices by `evdev`, in Rust alone: `gilrs` would link libudev, which is in C and not everywhere.
//! Other systems have none yet.

use crate::walk::Steer;

/// What of a stick's way is taken for its middle.
const DEAD: f64 = 0.15;

/// Where sticks and buttons are: sticks from -1, left or up, to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pad {
    /// The left stick, or the only one.
    pub left: [f64; 2],
    /// The right stick.
    pub right: [f64; 2],
    /// Whether there is a right stick.
    pub has_right: bool,
    /// Whether the shoulder buttons are held that sink and rise.
    pub shoulders: [bool; 2],
}

impl Pad {
    /// What it asks for: with two sticks to go by the left one and to look by the right, with one to turn and to go ahead.
    #[must_use]
    pub fn steer(&self) -> Steer {
        let [left, right] = [self.left, self.right].map(|stick| stick.map(live));
        let up = f64::from(i8::from(self.shoulders[1]) - i8::from(self.shoulders[0]));
        if self.has_right {
            Steer { ahead: -left[1], right: left[0], up, yaw: right[0], pitch: -right[1] }
        } else {
            Steer { ahead: -left[1], yaw: left[0], up, ..Steer::default() }
        }
    }
}

/// What is beyond the middle, from 0 on. Not -0, so that a stick at rest asks for nothing.
fn live(way: f64) -> f64 {
    let beyond = (way.abs().min(1.0) - DEAD).max(0.0) / (1.0 - DEAD);
    if beyond > 0.0 { beyond.copysign(way) } else { 0.0 }
}

#[cfg(target_os = "linux")]
pub use linux::listen;

/// Listens to the first pad there is and tells how it stands whenever that changes; `None` where there is none.
#[cfg(not(target_os = "linux"))]
pub fn listen(_: impl Fn(Pad) + Send + 'static) -> Option<String> {
    None
}

#[cfg(target_os = "linux")]
mod linux {
    use evdev::{AbsoluteAxisCode as Axis, Device, EventSummary, KeyCode};

    use super::Pad;

    /// Listens to the first pad there is, on a thread of its own, and tells how it stands whenever that changes; its name.
    /// `None` where there is none that this user may read.
    pub fn listen(tell: impl Fn(Pad) + Send + 'static) -> Option<String> {
        let (_, mut device) = evdev::enumerate().find(|(_, device)| is_pad(device))?;
        let name = device.name().unwrap_or("a gamepad").to_owned();
        let axes = Axes::of(&device);
        let thread = std::thread::Builder::new().name("pad".into());
        let listened = thread.spawn(move || {
            let mut pad = Pad { has_right: axes.has_right(), ..Pad::default() };
            // Until it is unplugged, at rest then.
            while let Ok(events) = device.fetch_events() {
                for event in events {
                    match event.destructure() {
                        EventSummary::AbsoluteAxis(_, axis, value) => axes.put(&mut pad, axis, value),
                        EventSummary::Key(_, KeyCode::BTN_TL, value) => pad.shoulders[0] = value != 0,
                        EventSummary::Key(_, KeyCode::BTN_TR, value) => pad.shoulders[1] = value != 0,
                        _ => {}
                    }
                }
                tell(pad);
            }
            tell(Pad::default());
        });
        listened.is_ok().then_some(name)
    }

    /// Whether it has a stick, and a button that sticks have: not a touch screen, nor an accelerometer.
    fn is_pad(device: &Device) -> bool {
        let has_stick = device.supported_absolute_axes().is_some_and(|axes| axes.contains(Axis::ABS_X));
        let buttons = [KeyCode::BTN_SOUTH, KeyCode::BTN_TRIGGER];
        has_stick && device.supported_keys().is_some_and(|keys| buttons.iter().any(|&button| keys.contains(button)))
    }

    /// The axes of both sticks with their ends.
    pub(super) struct Axes {
        known: Vec<(Axis, [f64; 2])>,
        right: [Axis; 2],
    }

    impl Axes {
        fn of(device: &Device) -> Self {
            let infos = device.get_absinfo().map(Iterator::collect::<Vec<_>>).unwrap_or_default();
            let ends =
                |(axis, info): (Axis, evdev::AbsInfo)| (axis, [f64::from(info.minimum()), f64::from(info.maximum())]);
            Self::new(infos.into_iter().map(ends).collect())
        }

        pub(super) fn new(known: Vec<(Axis, [f64; 2])>) -> Self {
            let is_known = |axis| known.iter().any(|&(known, _)| known == axis);
            // Some pads have their triggers on one pair, some on the other.
            let both = [Axis::ABS_RX, Axis::ABS_RY];
            let right = if both.into_iter().all(is_known) { both } else { [Axis::ABS_Z, Axis::ABS_RZ] };
            Self { known, right }
        }

        pub(super) fn has_right(&self) -> bool {
            self.right.iter().all(|&axis| self.known.iter().any(|&(known, _)| known == axis))
        }

        pub(super) fn put(&self, pad: &mut Pad, axis: Axis, value: i32) {
            let Some((_, [low, high])) = self.known.iter().find(|(known, _)| *known == axis) else { return };
            let way = if low < high { 2.0 * (f64::from(value) - low) / (high - low) - 1.0 } else { 0.0 };
            match axis {
                Axis::ABS_X => pad.left[0] = way,
                Axis::ABS_Y => pad.left[1] = way,
                _ if axis == self.right[0] => pad.right[0] = way,
                _ if axis == self.right[1] => pad.right[1] = way,
                _ => {}
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sticks_at_rest_ask_for_nothing() {
        assert!(Pad::default().steer().is_still());
        let off = Pad { left: [0.1, -0.14], right: [-0.15, 0.0], has_right: true, ..Pad::default() };
        assert!(off.steer().is_still());
    }

    #[test]
    fn two_sticks_go_and_look_and_one_turns() {
        let pad = Pad { left: [1.0, -1.0], right: [-1.0, 1.0], has_right: true, shoulders: [false, true] };
        let expected = Steer { ahead: 1.0, right: 1.0, up: 1.0, yaw: -1.0, pitch: -1.0 };
        assert_eq!(pad.steer(), expected);
        let joystick = Pad { has_right: false, ..pad };
        assert_eq!(joystick.steer(), Steer { ahead: 1.0, yaw: 1.0, up: 1.0, ..Steer::default() });
        let half = Pad { left: [0.575, 7.0], ..Pad::default() }.steer();
        assert!((half.yaw - 0.5).abs() < 1e-12 && half.ahead == -1.0);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn axes_are_measured_by_their_ends() {
        use evdev::AbsoluteAxisCode as Axis;

        let ends = [-32768.0, 32767.0];
        let known = [Axis::ABS_X, Axis::ABS_Y, Axis::ABS_RX, Axis::ABS_RY].map(|axis| (axis, ends));
        let axes = linux::Axes::new(known.into_iter().chain([(Axis::ABS_Z, [0.0, 255.0])]).collect());
        assert!(axes.has_right());
        let mut pad = Pad::default();
        for (axis, value) in [(Axis::ABS_X, 32767), (Axis::ABS_RY, -32768), (Axis::ABS_Z, 255), (Axis::ABS_HAT0X, 1)] {
            axes.put(&mut pad, axis, value);
        }
        assert_eq!((pad.left, pad.right), ([1.0, 0.0], [0.0, -1.0]));

        let joystick = linux::Axes::new(vec![(Axis::ABS_X, [0.0, 255.0]), (Axis::ABS_Y, [7.0, 7.0])]);
        assert!(!joystick.has_right());
        let mut pad = Pad::default();
        joystick.put(&mut pad, Axis::ABS_X, 0);
        joystick.put(&mut pad, Axis::ABS_Y, 7);
        assert_eq!(pad.left, [-1.0, 0.0]);
    }
}
