//! Which sphere each lane's ray meets.

use super::{Lanes, Row, any, get, mask, select};
use crate::root::{digit, pair, split};
use crate::scene::Sphere;
use crate::step::{coefficients, determinant, held, may_be_real, numerator, parameter, product};
use crate::widths::Widths;

/// What the lanes hold within a generation.
pub(super) struct Search<const N: usize> {
    /// |d|^2.
    a: Row<N>,
    /// Of lanes that still look for a sphere.
    pub(super) enabled: Row<N>,
    /// The least t so far.
    pub(super) t: Row<N>,
    /// The number of its sphere, or -1.
    pub(super) nearest: Row<N>,
}

impl<const N: usize> Search<N> {
    /// Of the lanes that are alive.
    #[inline(always)]
    pub(super) fn new(lanes: &Lanes<N>, widths: Widths) -> Self {
        let mut search = Self { a: [0; N], enabled: lanes.alive, t: [widths.product_max(); N], nearest: [-1; N] };
        for lane in 0..N {
            let direction = get(&lanes.direction, lane);
            search.a[lane] = product(direction, direction, widths);
        }
        search
    }

    /// Which of the first 32 spheres some lane may meet, as bits: all that one does meet, and few others. There is nothing to
    /// wait for or to guess between one sphere and the next, so that a processor works on several at once.
    #[inline(always)]
    pub(super) fn candidates(&self, lanes: &Lanes<N>, spheres: &[Sphere], widths: Widths) -> u32 {
        (0..u32::BITS).zip(spheres).fold(0, |candidates, (bit, sphere)| {
            let radius = i32::from(sphere.radius);
            let mut met = 0;
            for lane in 0..N {
                let (origin, direction) = (get(&lanes.origin, lane), get(&lanes.direction, lane));
                let (b, c) = coefficients(origin, direction, sphere.centre, radius * radius, widths);
                met |= self.enabled[lane] & mask(b < 0) & mask(may_be_real(self.a[lane], b, c, widths));
            }
            candidates | u32::from(met != 0) << bit
        })
    }

    /// Intersects all rays with a sphere; the lanes for which it is the nearest so far, if there are any.
    #[inline(always)]
    pub(super) fn sphere(&mut self, lanes: &Lanes<N>, sphere: &Sphere, number: i32, widths: Widths) -> Option<Row<N>> {
        let radius = i32::from(sphere.radius);
        let (mut b, mut c) = ([0; N], [0; N]);
        for lane in 0..N {
            let (origin, direction) = (get(&lanes.origin, lane), get(&lanes.direction, lane));
            (b[lane], c[lane]) = coefficients(origin, direction, sphere.centre, radius * radius, widths);
        }
        // In a loop of its own: products of 64 bits would halve the vectors of the one before.
        let (mut determinants, mut met) = ([0; N], [0; N]);
        for lane in 0..N {
            determinants[lane] = determinant(self.a[lane], b[lane], c[lane]);
            let imaginary = (determinants[lane] >> 63) as i32;
            met[lane] = self.enabled[lane] & mask(b[lane] < 0) & !imaginary;
        }
        if !any(&met) {
            return None;
        }
        let roots = roots(&determinants, &met, widths);
        let mut t = [0; N];
        for lane in 0..N {
            let above = numerator(b[lane], roots[lane]);
            met[lane] &= mask(above >= 0);
            t[lane] = above & met[lane];
        }
        for lane in 0..N {
            t[lane] = parameter(t[lane], self.a[lane], widths);
        }
        for lane in 0..N {
            met[lane] &= mask(t[lane] <= self.t[lane]);
            self.t[lane] = select(met[lane], t[lane], self.t[lane]);
            self.nearest[lane] = select(met[lane], number, self.nearest[lane]);
        }
        any(&met).then_some(met)
    }
}

/// The roots of the determinants as their words hold them, a digit of all lanes at a time.
#[inline(always)]
fn roots<const N: usize>(determinants: &[i64; N], enabled: &Row<N>, widths: Widths) -> Row<N> {
    let (mut low, mut high) = ([0; N], [0; N]);
    for lane in 0..N {
        [low[lane], high[lane]] = split(held(determinants[lane], widths) & i64::from(enabled[lane]));
    }
    let (mut rest, mut root) = ([0; N], [0; N]);
    for place in (0..widths.determinant().div_ceil(2)).rev() {
        for lane in 0..N {
            (rest[lane], root[lane]) = digit(rest[lane], root[lane], pair([low[lane], high[lane]], place));
        }
    }
    root
}
