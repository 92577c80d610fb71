//! Renders the blob in a board's flash. On the host there is nothing to do but to say so.
#![cfg_attr(target_os = "none", no_std, no_main)]

#[cfg(target_os = "none")]
mod chip;

#[cfg(target_os = "none")]
mod program {
    use firmware_rt::end::end;
    use firmware_rt::{run, stack};

    use crate::chip;

    include!(concat!(env!("OUT_DIR"), "/firmware.rs"));

    #[cortex_m_rt::entry]
    fn main() -> ! {
        // SAFETY: the linker script is made from the board; nothing but the stack lies there.
        unsafe { stack::paint(chip::BOARD.stack) };
        chip::start();
        let storage = &raw mut STORAGE;
        // SAFETY: this function is entered once, and nothing else names the storage.
        let storage = unsafe { &mut *storage };
        end(run::run::<This, _, _, _>(storage), || ())
    }
}

#[cfg(not(target_os = "none"))]
fn main() {
    eprintln!("this is firmware: cargo run -p firmware-cortexm --target thumbv6m-none-eabi");
    std::process::exit(2);
}
