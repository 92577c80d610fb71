//! `exact29` on the vector units that the machine turns out to have when it runs: the same hits, bit for bit, eight boxes or
//! eight triangles at a time.
//!
//! The tree of a blob becomes one of eight children a node, and triangles become packets of eight, both in lanes of 32 bits.
//! Lanes leave out what is certainly missed; whatever they leave is asked of the kernel itself, which decides without error
//! and orders hits exactly. So lanes need no more than to be conservative, and they are integers as the kernel's are.
//!
//! `f32` stands in the same layout, for comparison. A program for any x86-64 has it all and asks the processor, as
//! `planes-simd` does; on another machine, and for a ray that lanes do not hold, the tree is walked in place.
#![deny(unsafe_code)]

#[cfg(not(target_arch = "x86_64"))]
mod absent;
#[cfg(target_arch = "x86_64")]
mod avx2;
mod eights;

#[cfg(not(target_arch = "x86_64"))]
pub use absent::{Tree, Tree32};
#[cfg(target_arch = "x86_64")]
pub use avx2::{Tree, Tree32};
pub use eights::{ByEights, Eights};

/// The vector units that are used on this machine, by name; `None` where there are none.
#[must_use]
pub fn unit() -> Option<&'static str> {
    #[cfg(target_arch = "x86_64")]
    if std::arch::is_x86_feature_detected!("avx2") {
        return Some("avx2");
    }
    None
}
