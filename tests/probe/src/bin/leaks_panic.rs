//! One index that may lie past the end, which must be found.
#![cfg_attr(target_os = "none", no_std, no_main)]

use core::hint::black_box;

fn index() {
    black_box(black_box([1, 2])[black_box(0_usize)]);
}

probe::program!(index);
