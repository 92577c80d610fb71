//! Rays, and what the box test needs of them, worked out once a traversal.

use core_rt::num::Triple;

use crate::real::Real;

/// A ray or a segment. `t` is in units of the direction, which has any length.
#[derive(Clone, Copy, Debug)]
pub struct Ray<F> {
    /// The origin, grid units.
    pub origin: Triple<F>,
    /// The direction.
    pub direction: Triple<F>,
    /// Only hits with `t` below this.
    pub reach: F,
    /// The primitive that it starts on.
    pub skip: u32,
}

/// A ray, prepared for boxes.
#[derive(Clone, Copy, Debug)]
pub struct Path<F> {
    pub(crate) origin: Triple<F>,
    /// Where the reciprocal is negative: of a direction of -0 it is, so the sign of the direction will not do.
    pub(crate) negative: [bool; 3],
    /// 1 / direction, for entries.
    pub(crate) entering: Triple<F>,
    /// 1 / direction, longer by [`padding`], for exits.
    pub(crate) leaving: Triple<F>,
}

/// 1 + 8 e, with e the largest relative error of a rounding: see [`boxes`](crate::boxes).
#[inline(always)]
pub(crate) fn padding<F: Real>() -> F {
    F::ONE + F::EPSILON * F::from_i32(4)
}

impl<F: Real> Ray<F> {
    /// The part of a ray with `t` below `reach`, or `None` where the direction is zero.
    #[inline]
    #[must_use]
    pub fn new(origin: Triple<F>, direction: Triple<F>, reach: F, skip: u32) -> Option<Self> {
        if direction == [F::ZERO; 3] {
            return None;
        }
        Some(Self { origin, direction, reach, skip })
    }

    /// The ray, prepared for boxes.
    #[inline]
    #[must_use]
    pub fn path(&self) -> Path<F> {
        let entering = self.direction.map(|c| F::ONE / c);
        Path {
            origin: self.origin,
            negative: entering.map(|c| c < F::ZERO),
            entering,
            leaving: entering.map(|c| c * padding()),
        }
    }
}
