//! By RTT, Segger's Real-Time Transfer: ring buffers in RAM, which a probe finds by the symbol `_SEGGER_RTT` and reads
//! while the chip runs. Channel 0 has the log, channel 1 the frames,
//! in [`digits`]. Nothing is dropped: where a buffer is full, the chip
//! waits for the probe.

use core::arch::asm;
use core::convert::Infallible;

use rtt_target::ChannelMode::BlockIfFull;
use rtt_target::{UpChannel, rtt_init, set_defmt_channel};
use semihosting::process;

use crate::digits;
use crate::status::Status;

/// Nothing goes wrong: there is only waiting.
pub type Error = Infallible;

/// The way to the host.
#[expect(missing_debug_implementations, reason = "a channel has none")]
pub struct Link(UpChannel);

impl Link {
    /// Sets the channels up; the log reaches the host from here on. To be called once.
    #[must_use]
    pub fn start() -> Self {
        // Probes know by its name that the first one is defmt's. The log is short; a frame of the picture is about 1600 digits, and goes in parts.
        let channels = rtt_init! {
            up: {
                0: { size: 256, mode: BlockIfFull, name: "defmt" }
                1: { size: 1024, mode: BlockIfFull, name: "picture" }
            }
        };
        set_defmt_channel(channels.up.0);
        Self(channels.up.1)
    }

    /// Opens the way for frames.
    ///
    /// # Errors
    /// Never.
    pub fn open(self) -> Result<Wire, Error> {
        Ok(Wire(self.0))
    }
}

/// Takes frames.
#[expect(missing_debug_implementations, reason = "a channel has none")]
pub struct Wire(UpChannel);

impl Wire {
    pub(super) fn put(&mut self, bytes: &[u8]) -> Result<(), Error> {
        for &byte in bytes {
            self.0.write(&digits::of(byte));
        }
        Ok(())
    }
}

/// Ends the run: the last line of the log says so. A probe that knows semihosting ends too, with the status; without one
/// the breakpoint is a fault, and the chip stops there. After a fault it stops at once, for a second one would lock it up.
pub fn exit(status: Status) -> ! {
    defmt::info!("the end, status {=u8}", status as u8);
    match status {
        Status::Fault | Status::StackOverflow => stop(status as u8),
        _ => process::exit(i32::from(status as u8)),
    }
}

/// Waits for ever, at rest; all that there was to say has been said.
pub fn stop(_: u8) -> ! {
    loop {
        // SAFETY: it waits for an interrupt; none is enabled.
        unsafe { asm!("wfi", options(nomem, nostack, preserves_flags)) }
    }
}
