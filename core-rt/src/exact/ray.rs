//! Rays, scaled for the box test.
//!
//! A direction is scaled by a power of two until its largest component fills the format: a conservative box test
//! needs the bits, and a test with |D| = 1 fails without it. A segment's end moves with the scale, so a segment is a
//! ray whose reach is a power of two.

use super::width::Width;
use crate::num::{Triple, Word, round_shift, sub};

/// A ray or a segment.
#[derive(Clone, Copy, Debug)]
pub struct Ray<W: Width> {
    /// The origin, grid units.
    pub origin: Triple<W::Word>,
    /// The direction, scaled.
    pub direction: Triple<W::Word>,
    /// Only hits with t below 2 to this count; `None` for a ray without end.
    pub reach: Option<i32>,
    /// The primitive that it starts on.
    pub skip: u32,
}

impl<W: Width> Ray<W> {
    /// A ray without end, or `None` where the direction is zero. Any direction that the word holds below 2^62 (2^30).
    #[inline]
    pub fn new(origin: Triple<W::Word>, direction: Triple<W::Word>, skip: u32) -> Option<Self> {
        Self::scaled(origin, direction, skip).map(|(ray, _)| ray)
    }

    /// The open segment between two points, or `None` where they are the same. Where the difference has more bits than
    /// a direction, it is rounded, and the segment ends within half a unit times the scale of `to`.
    #[inline]
    pub fn segment(origin: Triple<W::Word>, to: Triple<W::Word>, skip: u32) -> Option<Self> {
        let (ray, shift) = Self::scaled(origin, sub(to, origin), skip)?;
        Some(Self { reach: Some(-shift), ..ray })
    }

    /// The ray, and by how many bits the direction was shifted to the left.
    #[inline]
    fn scaled(origin: Triple<W::Word>, direction: Triple<W::Word>, skip: u32) -> Option<(Self, i32)> {
        let [x, y, z] = direction.map(Word::magnitude);
        let largest = x.max(y).max(z);
        // Most camera rays fill the format as they are, and their bits need no counting.
        if cfg!(not(prefer_size)) && largest >> (W::DIRECTION_BITS - 1) == W::Word::ONE {
            return Some((Self { origin, direction, reach: None, skip }, 0));
        }
        let bits = largest.magnitude_bits();
        if bits == 0 {
            return None;
        }
        let shift = W::DIRECTION_BITS as i32 - bits as i32;
        let direction = match shift {
            0.. => direction.map(|c| c << shift.unsigned_abs()),
            // Rounding could carry into one more bit; one unit less is within the rounding.
            _ => {
                let most = (W::Word::ONE << W::DIRECTION_BITS) - W::Word::ONE;
                direction.map(|c| round_shift(c, shift.unsigned_abs()).clamp(-most, most))
            }
        };
        Some((Self { origin, direction, reach: None, skip }, shift))
    }

    /// The `t`, in [`Width::T_BITS`], beyond which nothing counts.
    #[inline]
    pub(super) fn reach_limit(&self) -> W::Word {
        match self.reach {
            None => W::T_MAX,
            // At least 1: a direction is scaled by less than T_BITS.
            Some(reach) => W::Word::ONE << (W::T_BITS as i32 + reach).unsigned_abs(),
        }
    }
}
