//! One addition of floats, which must be found.
#![cfg_attr(target_os = "none", no_std, no_main)]

use core::hint::black_box;

fn add() {
    black_box(black_box(1.0_f32) + black_box(2.0_f32));
}

probe::program!(add);
