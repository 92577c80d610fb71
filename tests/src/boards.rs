//! The boards that can be emulated here.

use firmware_rt::board::{BOARDS, Board};
use host_tools::emulate;

/// The boards whose emulator and whose target are installed; of others it is said that they are skipped.
pub fn boards() -> impl Iterator<Item = &'static Board> {
    BOARDS.into_iter().filter(|board| match emulate::check(board) {
        Ok(()) => true,
        Err(error) => {
            println!("skipped {}: {error}", board.name);
            false
        }
    })
}
