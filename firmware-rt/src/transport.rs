//! The way to the host: for the log, for the frames of the picture, and for the end.
//!
//! One of two is compiled in. By semihosting the chip asks an emulator or a debugger to do what is to be done on the host.
//! With the feature `rtt` it puts everything into ring buffers, which a probe reads while the chip runs.

#[cfg(feature = "rtt")]
mod rtt;
#[cfg(not(feature = "rtt"))]
mod semihosting;

#[cfg(feature = "rtt")]
pub use rtt::{Error, Link, Wire, exit, stop};
#[cfg(not(feature = "rtt"))]
pub use semihosting::{Error, Link, Wire, exit, stop};

use crate::frame;

impl Wire {
    /// Sends a frame of `parts`.
    ///
    /// # Errors
    /// Where the host does not take it.
    pub fn send(&mut self, kind: u16, parts: &[&[u8]]) -> Result<(), Error> {
        frame::write(kind, parts, |bytes| self.put(bytes))
    }
}
