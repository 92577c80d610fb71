//! Checks a blob and renders it, under the profile of the blob that the program is built for.
#![cfg_attr(target_os = "none", no_std, no_main)]

use core::hint::black_box;

use core_rt::scene::Scene;

include!(concat!(env!("OUT_DIR"), "/profile.rs"));

fn draw() {
    match Scene::<This>::new_checked(black_box(&[])) {
        Ok(scene) => probe::draw::<This, DEPTH, BRANCHES>(&scene),
        Err(error) => {
            black_box(error);
        }
    }
}

probe::program!(draw);
