//! The linker script of the board and the profile of the blob.

use firmware_rt::board::{MICROBIT, PICO, ROOMY};

fn main() -> std::io::Result<()> {
    let (board, constant) = match (cfg!(feature = "pico"), cfg!(feature = "roomy")) {
        (true, _) => (&PICO, "PICO"),
        (_, true) => (&ROOMY, "ROOMY"),
        _ => (&MICROBIT, "MICROBIT"),
    };
    firmware_rt::build::script(board, constant)
}
