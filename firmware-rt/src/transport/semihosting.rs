//! By semihosting: the log is standard output, the picture a file, the end an exit code.

// The logger is found by the linker alone.
use defmt_semihosting as _;
pub use semihosting::io::Error;

use semihosting::fs::File;
use semihosting::io::Write;
use semihosting::process;

use crate::frame;
use crate::status::Status;

/// The way to the host, which is there from the beginning.
#[derive(Clone, Copy, Debug)]
pub struct Link;

impl Link {
    /// Nothing has to be done before the first line of the log.
    #[must_use]
    pub fn start() -> Self {
        Self
    }

    /// Opens the way for frames.
    ///
    /// # Errors
    /// The host's.
    pub fn open(self) -> Result<Wire, Error> {
        File::create(frame::FILE).map(Wire)
    }
}

/// Takes frames.
#[derive(Debug)]
pub struct Wire(File);

impl Wire {
    pub(super) fn put(&mut self, bytes: &[u8]) -> Result<(), Error> {
        self.0.write_all(bytes)
    }
}

/// Ends the run.
pub fn exit(status: Status) -> ! {
    process::exit(i32::from(status as u8))
}

/// Ends a run whose end has gone wrong, with the status that it was to have.
pub fn stop(status: u8) -> ! {
    process::exit(status.into())
}
