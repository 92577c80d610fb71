//! Renders a scene that was checked elsewhere, under the profile of the blob that the program is built for: what `probe` has
//! more is the check.
#![cfg_attr(target_os = "none", no_std, no_main)]

use core::hint::black_box;

use core_rt::scene::Scene;

include!(concat!(env!("OUT_DIR"), "/profile.rs"));

fn draw() {
    if let Some(scene) = black_box::<Option<&Scene<'_, This>>>(None) {
        probe::draw::<This, DEPTH, BRANCHES>(scene);
    }
}

probe::program!(draw);
