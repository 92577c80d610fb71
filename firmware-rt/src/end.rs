//! How every run ends: with a line in the log and a status, never by standing still.

use core::sync::atomic::{AtomicU8, Ordering};

use crate::board::Region;
use crate::status::Status;
use crate::transport;

/// No status.
const NOT_YET: u8 = u8::MAX;

/// The status of an end that has begun.
static ENDING: AtomicU8 = AtomicU8::new(NOT_YET);

/// Ends the run. What goes wrong while an end is told of does not change its status.
pub fn end(status: Status, tell: impl FnOnce()) -> ! {
    let begun = ENDING.load(Ordering::Relaxed);
    if begun != NOT_YET {
        transport::stop(begun);
    }
    ENDING.store(status as u8, Ordering::Relaxed);
    tell();
    transport::exit(status)
}

/// Ends the run because of a fault. `stack_pointer` is that of the code that took it; the caller has a stack again.
pub fn fault(stack: Region, stack_pointer: u32, cause: u32) -> ! {
    if stack_pointer < stack.start || stack_pointer > stack.end() {
        end(Status::StackOverflow, || {
            defmt::error!(
                "stack overflow: the stack pointer is {=u32:#010x}, and the stack has {=u32:#010x} to {=u32:#010x}",
                stack_pointer,
                stack.start,
                stack.end()
            );
        });
    }
    end(Status::Fault, || defmt::error!("fault at {=u32:#010x}", cause));
}

#[panic_handler]
fn panic(info: &core::panic::PanicInfo<'_>) -> ! {
    end(Status::Panicked, || match info.location() {
        Some(place) => defmt::error!("panic at {=str}:{=u32}", place.file(), place.line()),
        None => defmt::error!("panic"),
    })
}
