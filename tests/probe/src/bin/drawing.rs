//! Renders a scene that was checked elsewhere, under the profile of the blob that the program is built for: what `probe` has
//! more is the check.
#![cfg_attr(target_os = "none", no_std, no_main)]

use core::convert::Infallible;
use core::hint::black_box;

use core_rt::bvh::Waiting;
use core_rt::render::{Sink, Tile, Workspace, render};
use core_rt::scene::Scene;
use core_rt::stats::NoStats;
use core_rt::whitted::Branch;

include!(concat!(env!("OUT_DIR"), "/profile.rs"));

/// Takes pixels that must be made, since it may look at them.
struct Somewhere;

impl Sink for Somewhere {
    type Error = Infallible;

    fn tile(&mut self, tile: Tile, pixels: &[u8]) -> Result<(), Infallible> {
        black_box((tile, pixels));
        Ok(())
    }
}

fn draw() {
    let mut stack = heapless::Vec::<Waiting<Kernel>, DEPTH>::new();
    let mut branches = heapless::Vec::<Branch<Kernel>, BRANCHES>::new();
    // Of any length, for all that the compiler knows.
    let (hits, pixels) = (black_box::<&mut [u32]>(&mut []), black_box::<&mut [u8]>(&mut []));
    let mut workspace = Workspace { stack: &mut stack, branches: &mut branches, hits, pixels };
    if let Some(scene) = black_box::<Option<&Scene<'_, This>>>(None) {
        let _ = black_box(render(scene, [16; 2], &mut workspace, &mut Somewhere, &mut NoStats));
    }
}

probe::program!(draw);
