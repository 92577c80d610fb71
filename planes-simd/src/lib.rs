//! [`planes_rt::lanes`] on the vector units that the machine turns out to have when it runs.
//!
//! The lanes are plain integer code. Compiled once more with AVX2 enabled, the same code becomes vectors of eight words, and
//! cannot differ in its results. A program for any x86-64 has both and asks the processor. This crate is apart from the
//! tracer for the one `unsafe` block that calling such a function takes; crates that wrap it in a macro, such as
//! `multiversion`, would do the same inside their users.
#![deny(unsafe_code)]

use planes_rt::colour::Light;
use planes_rt::lanes;
use planes_rt::scene::Scene;

/// What lanes are traced with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lockstep(Unit);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unit {
    Portable,
    /// Made by [`Lockstep::detected`] alone, where the processor has AVX2.
    #[cfg(target_arch = "x86_64")]
    Avx2,
}

impl Lockstep {
    /// Whatever every machine of the target has.
    pub const PORTABLE: Self = Self(Unit::Portable);

    /// The best that this machine has.
    #[must_use]
    pub fn detected() -> Self {
        #[cfg(target_arch = "x86_64")]
        if std::arch::is_x86_feature_detected!("avx2") {
            return Self(Unit::Avx2);
        }
        Self::PORTABLE
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.0 {
            Unit::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            Unit::Avx2 => "avx2",
        }
    }

    /// The light of a tile's pixels, as [`lanes::trace`] or [`lanes::trace_sampled`].
    #[must_use]
    pub fn trace<const N: usize>(self, scene: &Scene<'_>, pixels: &[[u16; 2]; N]) -> [Light; N] {
        match self.0 {
            Unit::Portable if scene.is_plain() => lanes::trace(scene, pixels),
            Unit::Portable => lanes::trace_sampled(scene, pixels),
            #[cfg(target_arch = "x86_64")]
            Unit::Avx2 => {
                let trace: unsafe fn(&Scene<'_>, &[[u16; 2]; N]) -> [Light; N] =
                    if scene.is_plain() { trace_avx2 } else { trace_sampled_avx2 };
                // SAFETY: the variant is private, and `detected` makes it only where the processor has AVX2, which is all
                // that the functions ask for.
                #[allow(unsafe_code)]
                unsafe {
                    trace(scene, pixels)
                }
            }
        }
    }
}

/// Everything that [`lanes::trace`] calls is inlined here, and so compiled for AVX2.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn trace_avx2<const N: usize>(scene: &Scene<'_>, pixels: &[[u16; 2]; N]) -> [Light; N] {
    lanes::trace(scene, pixels)
}

/// Likewise.
#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2")]
fn trace_sampled_avx2<const N: usize>(scene: &Scene<'_>, pixels: &[[u16; 2]; N]) -> [Light; N] {
    lanes::trace_sampled(scene, pixels)
}
