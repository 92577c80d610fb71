//! What firmware for a Cortex-M0 should never do, on purpose.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod chip;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    chip::start();
    firmware_rt::misbehave::misbehave(&chip::BOARD)
}

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is firmware for a microbit");
    std::process::exit(2);
}
