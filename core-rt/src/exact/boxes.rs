//! Child boxes in pairs, and the conservative slab test (Kay & Kajiya 1986; Williams et al. 2005).
//!
//! **No false miss.** Let a ray hit a triangle in the box at t, and let T be t in the unit of its [`Slopes`]. Along each
//! axis the hit lies between the near and the far plane, so true entry <= T <= true exit. The computed entry is never
//! above the true one where that is not negative, and negative where it is, while T >= 0. The computed exit is below the true one by
//! at most the slack where that is not beyond the largest T, and not below that less the slack where it is, since distances keep
//! the order of planes. So entry <= exit + slack, exit >= -slack, and entry <= limit for the limit of every depth that is at
//! most the slack below T. `docs/EXACTNESS.md` has it step by step.
//!
//! High corners are stored plus one: a ray that does not move along an axis and lies in the box's last plane then has
//! a difference of 1 to it, not 0.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use super::slopes::Slopes;
use super::width::{Distance, Width};
use crate::kernel::Bounds;
use crate::num::Word;
use crate::record::Record;

/// Two child boxes: child, low or high (plus one), axis.
pub(super) type Planes<P> = [[[P; 3]; 2]; 2];

/// A node's record, for planes of one type.
pub trait BoxNode: Record {
    /// A plane's coordinate, 0 to `2^GRID_BITS`.
    type Plane: Copy + TryFrom<i32> + Default;
    /// The record.
    fn new(planes: Planes<Self::Plane>, children: [u32; 2]) -> Self;
    /// The boxes of its children.
    fn planes(&self) -> &Planes<Self::Plane>;
    /// Packed references; see [`bvh`](crate::bvh).
    fn children(&self) -> [u32; 2];
}

/// Two children on a 14-bit grid, in 32 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct BoxNode14 {
    planes: Planes<u16>,
    children: [u32; 2],
}

/// Two children on a 29-bit grid, in 56 bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(C)]
pub struct BoxNode29 {
    planes: Planes<u32>,
    children: [u32; 2],
}

// Two types and not one generic one: zerocopy proves the absence of padding for concrete types only.
macro_rules! box_node {
    ($name:ident, $plane:ty) => {
        impl BoxNode for $name {
            type Plane = $plane;
            #[inline]
            fn new(planes: Planes<$plane>, children: [u32; 2]) -> Self {
                Self { planes, children }
            }
            #[inline(always)]
            fn planes(&self) -> &Planes<$plane> {
                &self.planes
            }
            #[inline(always)]
            fn children(&self) -> [u32; 2] {
                self.children
            }
        }
    };
}
box_node!(BoxNode14, u16);
box_node!(BoxNode29, u32);

/// The node's record. Corners must lie on the grid.
pub(super) fn pack<N: BoxNode>(boxes: [Bounds; 2], children: [u32; 2]) -> N {
    let plane = |c: i32| N::Plane::try_from(c).unwrap_or_default();
    N::new(boxes.map(|b| [b.low.map(plane), b.high.map(|c| plane(c + 1))]), children)
}

/// The boxes of a record.
pub(super) fn unpack<W: Width>(node: &W::Node) -> [Bounds; 2] {
    node.planes().map(|[low, high]| Bounds {
        low: low.map(|p| p.into().low_i32()),
        high: high.map(|p| p.into().low_i32().wrapping_sub(1)),
    })
}

/// Where a ray enters a child, if it does before the limit.
#[cfg_attr(not(prefer_size), inline(always))]
#[cfg_attr(prefer_size, inline(never))]
pub(super) fn enter<W: Width, const OCTANT: usize>(
    slopes: &W::Slopes,
    node: &W::Node,
    child: usize,
    limit: Distance<W>,
) -> Option<Distance<W>> {
    let [low, high] = &node.planes()[child];
    let crossed = |axis: usize| slopes.crossed::<OCTANT>(axis, low[axis].into(), high[axis].into());
    slab(limit, slopes.slack::<OCTANT>(), crossed)
}

/// Whether a box is left as soon as two axes decide. What predicts branches and runs ahead is quicker without.
const LEAVES_EARLY: bool = cfg!(target_pointer_width = "32");

/// Where a ray enters a box, if it does within the limit; `crossed` says at which distances it crosses the near and the far
/// plane of an axis, and an exit is low by at most `slack`.
#[inline(always)]
pub(crate) fn slab<T: Word>(limit: T, slack: T, crossed: impl Fn(usize) -> (T, T)) -> Option<T> {
    let ((x_near, x_far), (y_near, y_far)) = (crossed(0), crossed(1));
    let (entry, exit) = (x_near.max(y_near), x_far.min(y_far));
    if LEAVES_EARLY && entry > exit + slack {
        return None;
    }
    let (z_near, z_far) = crossed(2);
    // Not clamped to 0: where the ray starts inside, a negative entry is as good a lower bound.
    let (entry, exit) = (entry.max(z_near), exit.min(z_far) + slack);
    if entry > exit || entry > limit || exit < T::ZERO { None } else { Some(entry) }
}
