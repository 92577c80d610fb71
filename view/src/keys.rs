//! Keys that are held, as steering.

use crate::walk::Steer;

/// What can be held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Hold {
    /// Go to where one looks.
    Ahead,
    /// Go back.
    Back,
    /// Go to the left.
    Left,
    /// Go to the right.
    Right,
    /// Rise.
    Up,
    /// Sink.
    Down,
    /// Turn to the left.
    TurnLeft,
    /// Turn to the right.
    TurnRight,
    /// Look further up.
    LookUp,
    /// Look further down.
    LookDown,
    /// All of it faster.
    Fast,
    /// All of it slower.
    Slow,
}

/// How much faster, and slower by the inverse.
const HASTE: f64 = 4.0;

/// Keys that are held.
#[derive(Clone, Debug, Default)]
pub struct Keys {
    held: Vec<Hold>,
}

impl Keys {
    /// Notes that a key went down or up. What repeats changes nothing.
    pub fn set(&mut self, key: Hold, is_down: bool) {
        self.held.retain(|&held| held != key);
        if is_down {
            self.held.push(key);
        }
    }

    /// Lets all go, as where the window loses its keyboard.
    pub fn clear(&mut self) {
        self.held.clear();
    }

    /// What they ask for together.
    #[must_use]
    pub fn steer(&self) -> Steer {
        let is = |key| self.held.contains(&key);
        let haste = if is(Hold::Fast) { HASTE } else { 1.0 } / if is(Hold::Slow) { HASTE } else { 1.0 };
        let axis = |plus, minus| f64::from(i8::from(is(plus)) - i8::from(is(minus)));
        Steer {
            ahead: axis(Hold::Ahead, Hold::Back) * haste,
            right: axis(Hold::Right, Hold::Left) * haste,
            up: axis(Hold::Up, Hold::Down) * haste,
            // Turning has its own measure.
            yaw: axis(Hold::TurnRight, Hold::TurnLeft) * haste.min(1.0),
            pitch: axis(Hold::LookUp, Hold::LookDown) * haste.min(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn opposite_keys_cancel_and_repeats_change_nothing() {
        let mut keys = Keys::default();
        keys.set(Hold::Ahead, true);
        keys.set(Hold::Ahead, true);
        assert_eq!(keys.steer(), Steer { ahead: 1.0, ..Steer::default() });
        keys.set(Hold::Back, true);
        assert!(keys.steer().is_still());
        keys.set(Hold::Ahead, false);
        keys.set(Hold::TurnLeft, true);
        assert_eq!(keys.steer(), Steer { ahead: -1.0, yaw: -1.0, ..Steer::default() });
        keys.clear();
        assert!(keys.steer().is_still());
    }

    #[test]
    fn haste_alone_asks_for_nothing() {
        let mut keys = Keys::default();
        keys.set(Hold::Fast, true);
        assert!(keys.steer().is_still());
        keys.set(Hold::Up, true);
        keys.set(Hold::LookDown, true);
        assert_eq!(keys.steer(), Steer { up: 4.0, pitch: -1.0, ..Steer::default() });
        keys.set(Hold::Fast, false);
        keys.set(Hold::Slow, true);
        assert_eq!(keys.steer(), Steer { up: 0.25, pitch: -0.25, ..Steer::default() });
    }
}
