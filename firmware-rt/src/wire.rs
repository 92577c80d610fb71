//! The way of frames to the host: a file, by semihosting. On a chip without a debugger there is none.

use semihosting::fs::File;
use semihosting::io::{Error, Write};

use crate::frame;

/// Takes frames.
#[derive(Debug)]
pub struct Wire(File);

impl Wire {
    /// Opens the way.
    ///
    /// # Errors
    /// The host's.
    pub fn open() -> Result<Self, Error> {
        File::create(frame::FILE).map(Self)
    }

    /// Sends a frame of `parts`.
    ///
    /// # Errors
    /// The host's.
    pub fn send(&mut self, kind: u16, parts: &[&[u8]]) -> Result<(), Error> {
        frame::write(kind, parts, |bytes| self.0.write_all(bytes))
    }
}
