//! Random numbers without a state: a hash of where in a picture they are for.
//!
//! pcg4d of M. Jarzynski and M. Olano, "Hash Functions for GPU Rendering", Journal of Computer Graphics Techniques 9(3), 2020:
//! an affine map of each of four words, and two rounds in which the product of two is added to another and then the upper half of
//! each to its lower one. (In the paper the second round ends before that, which leaves the lowest bits of neighbours alike.)
//! Products are of 32 bits, one instruction each on a Cortex-M0. No tile, thread or frame is among the words, so that a picture
//! depends on none of them.

/// A sample of a pixel: what random numbers are drawn for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Sample {
    /// Column and row.
    pub pixel: [u16; 2],
    /// Its number, from 0.
    pub number: u16,
}

impl Sample {
    /// Four independent numbers, all of whose values are equally likely, for the `event`th thing that chance has a say in.
    #[must_use]
    pub fn numbers(self, event: u32) -> [u32; 4] {
        let [x, y] = self.pixel;
        pcg4d([x.into(), y.into(), self.number.into(), event])
    }
}

/// The hash. A bijection of 2^128 states.
fn pcg4d(words: [u32; 4]) -> [u32; 4] {
    round(round(words.map(|word| word.wrapping_mul(1_664_525).wrapping_add(1_013_904_223))))
}

/// To each word the product of two others is added, one after the other; then halves are.
fn round([mut x, mut y, mut z, mut w]: [u32; 4]) -> [u32; 4] {
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w].map(|word| word ^ (word >> 16))
}

/// A whole number from 0 to below `end`, which is at most 2^18, from 28 bits of a random number: each is as likely as any other
/// within `end` 2^-28 of itself. By halves, so that products fit 32 bits.
#[inline]
#[must_use]
pub fn below(number: u32, end: u32) -> u32 {
    let (high, low) = (number >> 18, (number >> 4) & 0x3fff);
    (high * end + ((low * end) >> 14)) >> 14
}
