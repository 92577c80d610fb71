//! Faults of a Cortex-M0, and the board that all of this is for.

#[cfg(feature = "pico")]
mod pico;

use cortex_m as _;
use cortex_m_rt as _;
#[cfg(not(any(feature = "pico", feature = "roomy")))]
pub(crate) use firmware_rt::board::MICROBIT as BOARD;
#[cfg(feature = "pico")]
pub(crate) use firmware_rt::board::PICO as BOARD;
#[cfg(all(feature = "roomy", not(feature = "pico")))]
pub(crate) use firmware_rt::board::ROOMY as BOARD;
use firmware_rt::end;

/// What a board needs before anything else; to be called first.
#[inline(always)]
pub(crate) fn start() {
    #[cfg(feature = "pico")]
    pico::start_clocks();
}

/// Where every fault ends up; the stack pointer is that of the frame that the core has pushed, or tried to. The stack may
/// have no room left, so that nothing can be pushed before it begins anew.
///
/// # Safety
/// The core calls it.
#[unsafe(no_mangle)]
#[unsafe(naked)]
unsafe extern "C" fn HardFault() -> ! {
    core::arch::naked_asm!(
        "mrs r0, msp",
        "ldr r1, =_stack_start",
        "msr msp, r1",
        "ldr r1, ={fault}",
        "bx r1",
        ".ltorg",
        fault = sym fault,
    )
}

extern "C" fn fault(frame: u32) -> ! {
    const LENGTH: u32 = 32;
    const COUNTER: u32 = 24;
    let stack = BOARD.stack;
    let is_whole = (stack.start..=stack.end() - LENGTH).contains(&frame);
    // SAFETY: an aligned word of the stack, where the core has pushed the program counter.
    let counter =
        is_whole.then(|| unsafe { core::ptr::without_provenance::<u32>((frame + COUNTER) as usize).read_volatile() });
    end::fault(stack, frame, counter.unwrap_or_default())
}
