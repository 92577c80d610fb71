//! Programs of rendering code alone, without log, wire and board, to look at what is linked. They are never run.
//!
//! A program begins with `_start`, which linkers know, and needs no linker script: where it lies does not matter. It has
//! no input either. What it works on comes from [`black_box`](core::hint::black_box), so that the compiler, which sees the
//! whole program, knows no more of it than firmware does of its blob.
//!
//! `unsafe` is only the promise that the two names which tools look for are no one else's.
#![no_std]

use core::convert::Infallible;
use core::hint::black_box;

use core_rt::bvh::Waiting;
use core_rt::profile::Profile;
use core_rt::render::{Sink, Tile, Workspace, render};
use core_rt::scene::Scene;
use core_rt::stats::NoStats;
use core_rt::whitted::Branch;

/// Takes pixels that must be made, since it may look at them.
struct Somewhere;

impl Sink for Somewhere {
    type Error = Infallible;

    fn tile(&mut self, tile: Tile, pixels: &[u8]) -> Result<(), Infallible> {
        black_box((tile, pixels));
        Ok(())
    }
}

/// Renders what a scene holds, from storage for `DEPTH` nodes and `BRANCHES` rays.
#[inline(always)]
pub fn draw<P: Profile, const DEPTH: usize, const BRANCHES: usize>(scene: &Scene<'_, P>) {
    let mut stack = heapless::Vec::<Waiting<P::Kernel>, DEPTH>::new();
    let mut branches = heapless::Vec::<Branch<P::Kernel>, BRANCHES>::new();
    // Of any length, for all that the compiler knows.
    let (hits, pixels) = (black_box::<&mut [u32]>(&mut []), black_box::<&mut [u8]>(&mut []));
    let mut workspace = Workspace { stack: &mut stack, branches: &mut branches, hits, pixels };
    let _ = black_box(render(scene, [16; 2], &mut workspace, &mut Somewhere, &mut NoStats));
}

/// Where every panic ends. It has a name of its own, and is never inlined: a program without this symbol cannot panic.
#[cfg(target_os = "none")]
// SAFETY: nothing else is called this.
#[unsafe(no_mangle)]
#[inline(never)]
pub extern "C" fn probe_panicked() -> ! {
    loop {
        core::hint::spin_loop();
    }
}

#[cfg(target_os = "none")]
#[panic_handler]
fn panicked(_: &core::panic::PanicInfo<'_>) -> ! {
    probe_panicked()
}

/// Makes a program of a function without arguments. On the host there is nothing to do but to say so.
#[macro_export]
macro_rules! program {
    ($work:path) => {
        // SAFETY: a program has one entry.
        #[cfg(target_os = "none")]
        #[unsafe(no_mangle)]
        extern "C" fn _start() -> ! {
            $work();
            loop {
                core::hint::spin_loop();
            }
        }

        #[cfg(not(target_os = "none"))]
        fn main() {
            let _: fn() = $work;
            eprintln!("this is for a chip, to look at and not to run");
            std::process::exit(2);
        }
    };
}
