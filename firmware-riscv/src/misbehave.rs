//! What firmware for a hifive1 should never do, on purpose.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod chip;

#[cfg(target_os = "none")]
#[riscv_rt::entry]
fn main() -> ! {
    firmware_rt::misbehave::misbehave(&firmware_rt::board::HIFIVE1)
}

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is firmware for a hifive1");
    std::process::exit(2);
}
