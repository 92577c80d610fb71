//! Spheres on the grid, and the record that integer kernels keep of one.

use zerocopy::{FromBytes, Immutable, IntoBytes, KnownLayout};

use crate::kernel::{Bounds, Kernel};
use crate::num::{Triple, Word};

/// A sphere in grid units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ball {
    /// The centre.
    pub centre: Triple<i32>,
    /// The radius.
    pub radius: i32,
}

impl Ball {
    /// The box of the sphere; of one that is on no grid, whatever stays an integer.
    #[must_use]
    pub fn bounds(&self) -> Bounds {
        Bounds {
            low: self.centre.map(|c| c.saturating_sub(self.radius)),
            high: self.centre.map(|c| c.saturating_add(self.radius)),
        }
    }

    /// Whether a grid point is inside; what is on the sphere is not. Differences are below 2^30, so that squares sum
    /// to less than 2^62.
    #[must_use]
    pub fn contains(&self, point: Triple<i32>) -> bool {
        let square = |c: i32| i64::from(c) * i64::from(c);
        let away = |axis: usize| square(point[axis].wrapping_sub(self.centre[axis]));
        away(0) + away(1) + away(2) < square(self.radius)
    }

    /// Whether a kernel can hold it: all of it is where vertices may be, and the radius is at least the kernel's least.
    #[must_use]
    pub fn fits<K: Kernel>(&self) -> bool {
        let grid = Bounds { low: [K::MARGIN; 3], high: [(1 << K::GRID_BITS) - 1 - K::MARGIN; 3] };
        self.radius >= K::RADIUS_MIN && grid.contains(&self.bounds())
    }
}

/// Centre, radius and material, as numbers of one type.
#[derive(Clone, Copy, Debug, PartialEq, Eq, FromBytes, IntoBytes, Immutable, KnownLayout)]
#[repr(transparent)]
pub struct SphereRecord<T>([T; 5]);

impl<T: Copy> SphereRecord<T> {
    /// The record; `None` where a number does not fit its type.
    pub(crate) fn new(ball: &Ball, material: u32) -> Option<Self>
    where
        T: TryFrom<i64>,
    {
        let number = |value: i64| T::try_from(value).ok();
        let [x, y, z] = ball.centre.map(|c| number(c.into()));
        Some(Self([x?, y?, z?, number(ball.radius.into())?, number(material.into())?]))
    }

    /// The centre, grid units.
    #[inline(always)]
    pub(crate) fn centre<W: Word>(&self) -> Triple<W>
    where
        T: Into<W>,
    {
        let [x, y, z, ..] = self.0;
        [x.into(), y.into(), z.into()]
    }

    /// The radius, grid units.
    #[inline(always)]
    pub(crate) fn radius<W: Word>(&self) -> W
    where
        T: Into<W>,
    {
        self.0[3].into()
    }

    /// The sphere.
    pub(crate) fn ball<W: Word>(&self) -> Ball
    where
        T: Into<W>,
    {
        Ball { centre: self.centre().map(Word::low_i32), radius: self.radius().low_i32() }
    }

    /// The material; of a record that [`SphereRecord::new`] did not make, any number.
    #[inline]
    pub(crate) fn material<W: Word>(&self) -> u32
    where
        T: Into<W>,
    {
        self.0[4].into().low_i32() as u32
    }
}
