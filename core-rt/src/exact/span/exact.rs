//! Where a hit is, where size is preferred: at an exact t alone. One way to a hit is less code than two.

use core::cmp::Ordering;

use super::ray::Ray;
use super::triangle::{self, Depth, TriangleRecord};
use super::width::Width;

/// Where a hit is.
pub type Span<W> = Depth<W>;

impl<W: Width> Depth<W> {
    /// Whether every one is of an exact t.
    pub const IS_EXACT: bool = true;

    /// Between which t it is.
    #[must_use]
    pub fn ends(&self) -> [W::Word; 2] {
        [self.t - W::SLACK, self.t + W::SLACK]
    }
}

/// That of a hit whose t is known.
#[inline(always)]
pub(super) fn of<W: Width>(depth: &Depth<W>) -> Span<W> {
    *depth
}

/// The order of two hits of a ray.
#[inline(always)]
pub(super) fn order<W: Width>(a: &Span<W>, b: &Span<W>) -> Option<Ordering> {
    Some(triangle::order(a, b))
}

/// A depth that is low by the slack at most.
#[inline(always)]
pub(super) fn depth<W: Width>(span: &Span<W>) -> W::Word {
    span.t
}

/// The hit with a triangle.
#[inline(always)]
pub(super) fn meet<W: Width>(ray: &Ray<W>, triangle: &TriangleRecord<W::Short>) -> Option<Span<W>> {
    triangle::intersect(ray, triangle)
}
