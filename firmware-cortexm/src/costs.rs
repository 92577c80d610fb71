//! What operations of shading cost on a Cortex-M0.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod chip;

#[cfg(target_os = "none")]
#[cortex_m_rt::entry]
fn main() -> ! {
    chip::start();
    firmware_rt::costs::run()
}

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is firmware for a Cortex-M0");
    std::process::exit(2);
}
