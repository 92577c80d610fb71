//! One division of 64 bits, which must be found.
#![cfg_attr(target_os = "none", no_std, no_main)]

use core::hint::black_box;

fn divide() {
    black_box(black_box(u64::MAX).checked_div(black_box(3)));
}

probe::program!(divide);
