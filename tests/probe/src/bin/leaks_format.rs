//! One number as text, which must be found.
#![cfg_attr(target_os = "none", no_std, no_main)]

use core::fmt::{self, Write};
use core::hint::black_box;

/// Takes text that must be made, since it may look at it.
struct Somewhere;

impl Write for Somewhere {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        black_box(text);
        Ok(())
    }
}

fn write() {
    black_box(write!(Somewhere, "{}", black_box(7_u32)).is_ok());
}

probe::program!(write);
