//! The marks that tell which kind of ray is followed, for a count by kind: a counter outside the chip watches for their
//! addresses, as for those of [`window`](crate::window). Camera rays need none: they are what is left.

use core::arch::asm;

use core_rt::stats::{RayKind, Stats};

/// Passes a mark where the kind of ray changes.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Marks;

impl Stats for Marks {
    #[inline(always)]
    fn ray(&mut self, kind: RayKind) {
        match kind {
            RayKind::Primary => {}
            RayKind::Shadow => intray_shadow(),
            RayKind::Reflection => intray_reflection(),
            RayKind::Refraction => intray_refraction(),
        }
    }

    #[inline(always)]
    fn lit(&mut self) {
        intray_lit();
    }

    #[inline(always)]
    fn next(&mut self) {
        intray_next();
    }
}

/// Defines functions that do nothing, each with a text of its own, so that they do not become one.
macro_rules! marks {
    ($($(#[$doc:meta])* $name:ident)*) => {
        $(
            $(#[$doc])*
            // SAFETY: nothing else is called this.
            #[unsafe(no_mangle)]
            #[inline(never)]
            extern "C" fn $name() {
                // SAFETY: it does nothing. That it could touch memory, for all the compiler knows, keeps the work on its side.
                unsafe { asm!(concat!("nop // ", stringify!($name)), options(nostack, preserves_flags)) }
            }
        )*
    };
}

marks! {
    /// A shadow ray begins.
    intray_shadow
    /// It has ended.
    intray_lit
    /// A mirrored ray waits.
    intray_reflection
    /// A ray through a surface waits.
    intray_refraction
    /// The last ray that waits is taken up, or none is left.
    intray_next
}
