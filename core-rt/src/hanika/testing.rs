//! Random numbers for tests: SplitMix64 (Steele, Lea & Flood, "Fast Splittable Pseudorandom Number Generators", 2014).

use super::{GRID_BITS, MARGIN};
use crate::kernel::Vertices;
use crate::num::Triple;

pub(super) struct Random(pub(super) u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// In `least ..= most`.
    pub(super) fn within(&mut self, least: i64, most: i64) -> i64 {
        least + (self.next() % (most - least + 1) as u64) as i64
    }

    /// Of any magnitude to `2^bits - 1`, often at the ends.
    pub(super) fn sized(&mut self, bits: u32) -> i64 {
        let most = (1i64 << self.within(0, bits.into())) - 1;
        match self.within(0, 3) {
            0 => most,
            1 => -most,
            _ => self.within(-most, most),
        }
    }

    /// A point where a vertex may be, often at the ends.
    pub(super) fn vertex(&mut self) -> Triple<i32> {
        let (first, last) = (MARGIN, (1 << GRID_BITS) - 1 - MARGIN);
        [0; 3].map(|_| match self.within(0, 5) {
            0 => first,
            1 => last,
            _ => self.within(first.into(), last.into()) as i32,
        })
    }

    /// A triangle of any size, where vertices may be.
    pub(super) fn triangle(&mut self) -> Vertices {
        let v0 = self.vertex();
        let bits = self.within(1, GRID_BITS.into()) as u32;
        let near = |random: &mut Self| {
            v0.map(|c| (c + random.sized(bits) as i32).clamp(MARGIN, (1 << GRID_BITS) - 1 - MARGIN))
        };
        let v1 = near(self);
        [v0, v1, near(self)]
    }
}
