//! The marks between which instructions are counted: a counter outside the chip watches for their addresses.

use core::arch::asm;

/// Work begins.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn intray_window_begin() {
    // SAFETY: it does nothing. That it could touch memory, for all the compiler knows, keeps the work between the marks;
    // and its text keeps the two functions from becoming one.
    unsafe { asm!("nop // begin", options(nostack, preserves_flags)) }
}

/// Work ends.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn intray_window_end() {
    // SAFETY: as above.
    unsafe { asm!("nop // end", options(nostack, preserves_flags)) }
}
