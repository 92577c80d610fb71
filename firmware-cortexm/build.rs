//! The linker script of the board and the profile of the blob.

use firmware_rt::board::{MICROBIT, PICO};

fn main() -> std::io::Result<()> {
    let (board, constant) = if cfg!(feature = "pico") { (&PICO, "PICO") } else { (&MICROBIT, "MICROBIT") };
    firmware_rt::build::script(board, constant)
}
