//! The status that a run ends with: the process's exit code under QEMU.

use core::fmt::{Display, Formatter};

/// How firmware ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum Status {
    /// The picture is whole.
    Done = 0,
    /// The blob was refused.
    Refused = 10,
    /// The scene needs more storage than the firmware was built with.
    Storage = 11,
    /// The host does not take what is sent.
    Wire = 12,
    /// Code panicked.
    Panicked = 13,
    /// The core took a fault.
    Fault = 14,
    /// The stack grew out of its memory.
    StackOverflow = 15,
}

impl Status {
    /// All of them.
    pub const ALL: [Self; 7] =
        [Self::Done, Self::Refused, Self::Storage, Self::Wire, Self::Panicked, Self::Fault, Self::StackOverflow];

    /// The status of an exit code. QEMU has codes of its own, 1 among them.
    #[must_use]
    pub fn from_code(code: i32) -> Option<Self> {
        Self::ALL.into_iter().find(|&status| i32::from(status as u8) == code)
    }
}

impl Display for Status {
    fn fmt(&self, f: &mut Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Done => "the picture is whole",
            Self::Refused => "the blob was refused",
            Self::Storage => "the scene needs more storage than this firmware was built with",
            Self::Wire => "the host did not take what was sent",
            Self::Panicked => "the code panicked",
            Self::Fault => "the core took a fault",
            Self::StackOverflow => "the stack overflowed: it grew out of the RAM that it has",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_told_apart() {
        for status in Status::ALL {
            assert_eq!(Status::from_code(status as i32), Some(status));
        }
        assert_eq!(Status::from_code(1), None);
        assert_eq!(Status::from_code(256), None);
    }
}
