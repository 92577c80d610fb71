//! The linker script of the board and the profile of the blob.

fn main() -> std::io::Result<()> {
    firmware_rt::build::script(&firmware_rt::board::HIFIVE1, "HIFIVE1")
}
