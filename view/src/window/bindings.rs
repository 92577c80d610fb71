//! What keys are for.

use winit::keyboard::KeyCode;

use crate::keys::Hold;
use crate::viewer::Action;

/// What a key is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Key {
    /// As long as it is held.
    Hold(Hold),
    /// Once.
    Act(Action),
    /// Notches of the wheel.
    Zoom(i8),
}

/// By the place on the keyboard, whatever stands on the key.
pub(super) fn key(code: KeyCode) -> Option<Key> {
    Some(match code {
        KeyCode::KeyW => Key::Hold(Hold::Ahead),
        KeyCode::KeyS => Key::Hold(Hold::Back),
        KeyCode::KeyA => Key::Hold(Hold::Left),
        KeyCode::KeyD => Key::Hold(Hold::Right),
        KeyCode::KeyE => Key::Hold(Hold::Up),
        KeyCode::KeyQ => Key::Hold(Hold::Down),
        KeyCode::ArrowLeft => Key::Hold(Hold::TurnLeft),
        KeyCode::ArrowRight => Key::Hold(Hold::TurnRight),
        KeyCode::ArrowUp => Key::Hold(Hold::LookUp),
        KeyCode::ArrowDown => Key::Hold(Hold::LookDown),
        KeyCode::ShiftLeft | KeyCode::ShiftRight => Key::Hold(Hold::Fast),
        KeyCode::ControlLeft | KeyCode::ControlRight => Key::Hold(Hold::Slow),
        KeyCode::Equal | KeyCode::NumpadAdd => Key::Zoom(1),
        KeyCode::Minus | KeyCode::NumpadSubtract => Key::Zoom(-1),
        KeyCode::Digit1 | KeyCode::Numpad1 => Key::Act(Action::Kernel(0)),
        KeyCode::Digit2 | KeyCode::Numpad2 => Key::Act(Action::Kernel(1)),
        KeyCode::Digit3 | KeyCode::Numpad3 => Key::Act(Action::Kernel(2)),
        KeyCode::Digit4 | KeyCode::Numpad4 => Key::Act(Action::Kernel(3)),
        KeyCode::Digit5 | KeyCode::Numpad5 => Key::Act(Action::Kernel(4)),
        KeyCode::Digit6 | KeyCode::Numpad6 => Key::Act(Action::Kernel(5)),
        KeyCode::Digit7 | KeyCode::Numpad7 => Key::Act(Action::Kernel(6)),
        KeyCode::Digit8 | KeyCode::Numpad8 => Key::Act(Action::Kernel(7)),
        KeyCode::Digit9 | KeyCode::Numpad9 => Key::Act(Action::Kernel(8)),
        KeyCode::KeyC => Key::Act(Action::Chip),
        KeyCode::KeyB => Key::Act(Action::Board),
        KeyCode::KeyP => Key::Act(Action::Save),
        KeyCode::KeyO => Key::Act(Action::WriteCamera),
        KeyCode::KeyR => Key::Act(Action::Home),
        KeyCode::KeyH => Key::Act(Action::Overlay),
        KeyCode::Escape => Key::Act(Action::Quit),
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernels::KERNELS;

    #[test]
    fn every_kernel_has_a_key() {
        let digits = [
            KeyCode::Digit1,
            KeyCode::Digit2,
            KeyCode::Digit3,
            KeyCode::Digit4,
            KeyCode::Digit5,
            KeyCode::Digit6,
            KeyCode::Digit7,
            KeyCode::Digit8,
            KeyCode::Digit9,
        ];
        for (kernel, digit) in digits.into_iter().enumerate() {
            assert_eq!(key(digit), Some(Key::Act(Action::Kernel(kernel))));
        }
        assert!(KERNELS.len() <= digits.len());
        assert_eq!(key(KeyCode::F12), None);
    }
}
