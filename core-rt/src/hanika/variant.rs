//! What the three kernels differ in.

use core::fmt::Debug;

use super::boxes::{ConservativeSlab, Slab, TightSlab};
use crate::arithmetic::Knobs;

/// A kernel of the report: its box test, and which knobs of it can be set.
pub trait Variant: Copy + Debug + Default + Send + Sync + 'static {
    /// See [`Kernel::ID`](crate::kernel::Kernel::ID).
    const ID: u16;
    /// See [`Kernel::NAME`](crate::kernel::Kernel::NAME).
    const NAME: &'static str;
    /// See [`Kernel::KNOBS`](crate::kernel::Kernel::KNOBS).
    const KNOBS: &'static str;

    /// The box test.
    type Slab: Slab;

    /// C and D where these knobs are set; `None` where the variant has none.
    fn shifts(knobs: &Knobs) -> Option<[u8; 2]>;
    /// Whether it computes with this C and D.
    fn holds(c_bits: u8, d_bits: u8) -> bool;
}

/// C and D are at most this. With more a difference across the whole grid would vanish.
const SHIFT_MAX: u8 = 28;

/// The bits that the report finds unused in the product of a difference and a reciprocal: two, and four of a direction of at
/// least 16 units. C - D is at most this.
const UNUSED_BITS: u8 = 6;

/// Differences are shifted by C, as reciprocals are.
#[derive(Clone, Copy, Debug, Default)]
pub struct PlainC;

impl Variant for PlainC {
    const ID: u16 = 30;
    const NAME: &'static str = "hanika-c";
    const KNOBS: &'static str =
        "--c-bits is 0 to 28, and --d-bits the same; --edge-shift is 0 to 29, and --epsilon 1 to 64";

    type Slab = TightSlab<1>;

    fn shifts(knobs: &Knobs) -> Option<[u8; 2]> {
        let c_bits = knobs.c_bits.unwrap_or(12);
        Some([c_bits, knobs.d_bits.unwrap_or(c_bits)])
    }

    fn holds(c_bits: u8, d_bits: u8) -> bool {
        c_bits <= SHIFT_MAX && d_bits == c_bits
    }
}

/// Differences are shifted by fewer bits than reciprocals.
#[derive(Clone, Copy, Debug, Default)]
pub struct RefinedCd;

impl Variant for RefinedCd {
    const ID: u16 = 31;
    const NAME: &'static str = "hanika-cd";
    const KNOBS: &'static str = "--c-bits is 0 to 28, and --d-bits that or up to 6 less; --edge-shift is 0 to 29, and \
                                 --epsilon 1 to 64";

    type Slab = TightSlab<16>;

    fn shifts(knobs: &Knobs) -> Option<[u8; 2]> {
        let c_bits = knobs.c_bits.unwrap_or(15);
        Some([c_bits, knobs.d_bits.unwrap_or(c_bits.saturating_sub(UNUSED_BITS))])
    }

    fn holds(c_bits: u8, d_bits: u8) -> bool {
        c_bits <= SHIFT_MAX && d_bits <= c_bits && c_bits - d_bits <= UNUSED_BITS
    }
}

/// No rounding of the box test loses a hit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Conservative;

impl Variant for Conservative {
    const ID: u16 = 32;
    const NAME: &'static str = "hanika-cons";
    const KNOBS: &'static str = "--edge-shift is 0 to 29, and --epsilon 1 to 64; it has no --c-bits and no --d-bits";

    type Slab = ConservativeSlab;

    fn shifts(knobs: &Knobs) -> Option<[u8; 2]> {
        knobs.c_bits.or(knobs.d_bits).is_none().then_some([0, 0])
    }

    fn holds(c_bits: u8, d_bits: u8) -> bool {
        c_bits == 0 && d_bits == 0
    }
}
