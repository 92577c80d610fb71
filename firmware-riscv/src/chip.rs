//! Traps of an FE310.

use firmware_rt::board::HIFIVE1;
use firmware_rt::end;
use riscv as _;
use riscv_rt as _;

// Where every trap ends up, instead of in riscv-rt's handler, which would push onto a stack that may have none left.
core::arch::global_asm!(
    ".section .trap.start, \"ax\"",
    ".balign 4",
    ".global _start_trap",
    "_start_trap:",
    "mv a0, sp",
    "csrr a1, mepc",
    "la sp, _stack_start",
    "tail {fault}",
    fault = sym fault,
);

extern "C" fn fault(stack_pointer: u32, counter: u32) -> ! {
    end::fault(HIFIVE1.stack, stack_pointer, counter)
}
