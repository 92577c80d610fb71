//! Draws spheres in a hifive1's flash as the tracer of 1994 does. On the host there is nothing to do but to say so.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod chip;

#[cfg(target_os = "none")]
#[riscv_rt::entry]
fn main() -> ! {
    use firmware_rt::board::HIFIVE1;
    // SAFETY: the linker script is made from the board; nothing but the stack lies there.
    unsafe { firmware_rt::stack::paint(HIFIVE1.stack) };
    firmware_rt::end::end(firmware_rt::planes::run(&HIFIVE1), || ())
}

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is firmware: intray emulate SCENE --kernel planes12 --board hifive1 -o chip.png");
    std::process::exit(2);
}
