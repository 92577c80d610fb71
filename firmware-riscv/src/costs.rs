//! What operations of shading cost on a hifive1.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod chip;

#[cfg(target_os = "none")]
#[riscv_rt::entry]
fn main() -> ! {
    firmware_rt::costs::run()
}

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is firmware for a hifive1");
    std::process::exit(2);
}
