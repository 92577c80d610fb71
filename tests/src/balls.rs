//! Where rays meet spheres, by the definition and in big integers: what every exact kernel must agree with.
//!
//! With S the origin relative to the centre and a = |d|^2, the ray at t = n / a is in the ball iff |a S + n d| <= a r. That is
//! nearest to the centre at the whole number n = -S . d, falls before and rises after. So whether there is a hit is asked
//! there, and which whole number is the first at or after it is found by bisection: no root is taken.

use ethnum::I256;

/// A sphere, grid units.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Ball {
    /// The centre.
    pub centre: [i64; 3],
    /// The radius.
    pub radius: i64,
}

impl Ball {
    /// Where the ray is beside the surface at t = n / a: below 0 inside, 0 on it. Coordinates below 2^31 and n below 2^64: at
    /// most 2^190.
    fn side(&self, origin: [i64; 3], direction: [i64; 3], n: I256) -> I256 {
        let a = square(direction);
        let point = [0, 1, 2].map(|i| a * I256::from(origin[i] - self.centre[i]) + n * I256::from(direction[i]));
        let reach = a * I256::from(self.radius);
        point.into_iter().map(|c| c * c).sum::<I256>() - reach * reach
    }

    /// The first t > 0 at which a ray meets the sphere, rounded up to a fraction of |d|^2; a tangent does. A ray that `leaves` the
    /// sphere, off it on one side, meets it only from inside. The direction is not zero.
    ///
    /// # Panics
    /// Where a coordinate or a component does not fit 32 bits and a sign.
    #[must_use]
    pub fn hit(&self, origin: [i64; 3], direction: [i64; 3], leaves: bool) -> Option<(i128, i128)> {
        assert!(origin.iter().chain(&direction).chain(&self.centre).all(|c| c.unsigned_abs() <= 1 << 32));
        let side = |n: I256| self.side(origin, direction, n);
        let nearest = -(0..3).map(|i| I256::from(origin[i] - self.centre[i]) * I256::from(direction[i])).sum::<I256>();
        let start = side(I256::ZERO);
        let first = if start > I256::ZERO {
            if leaves || nearest <= I256::ZERO || side(nearest) > I256::ZERO {
                return None;
            }
            first(I256::ZERO, nearest, |n| side(n) <= I256::ZERO)
        } else {
            if start == I256::ZERO && (leaves || nearest <= I256::ZERO) {
                return None;
            }
            let from = nearest.max(I256::ZERO);
            let step = |bits: &u32| side(from + (I256::ONE << *bits)) >= I256::ZERO;
            let bits = (0..100).find(step).expect("a ball has an end");
            first(from, from + (I256::ONE << bits), |n| side(n) >= I256::ZERO)
        };
        Some((first.as_i128(), square(direction).as_i128()))
    }
}

fn square(v: [i64; 3]) -> I256 {
    v.iter().map(|&c| I256::from(c) * I256::from(c)).sum()
}

/// The first number after `low`, and not after `high`, of which something holds that holds of `high` and goes on to hold.
fn first(mut low: I256, mut high: I256, holds: impl Fn(I256) -> bool) -> I256 {
    while high - low > I256::ONE {
        let middle = (low + high) >> 1;
        if holds(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    high
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Ball = Ball { centre: [10, 20, 30], radius: 5 };

    fn hit(origin: [i64; 3], direction: [i64; 3]) -> Option<(i128, i128)> {
        UNIT.hit(origin, direction, false)
    }

    #[test]
    fn known_points() {
        assert_eq!(hit([10, 20, 0], [0, 0, 2]), Some((2 * 25, 4)), "from outside");
        assert_eq!(hit([10, 20, 0], [0, 0, -2]), None, "it is behind");
        assert_eq!(hit([10, 20, 28], [0, 0, 2]), Some((2 * 7, 4)), "from inside");
        assert_eq!(hit([10, 20, 28], [0, 0, -2]), Some((2 * 3, 4)));
        assert_eq!(hit([15, 20, 0], [0, 0, 3]), Some((3 * 30, 9)), "a tangent");
        assert_eq!(hit([16, 20, 0], [0, 0, 3]), None);
        assert_eq!(hit([10, 20, 25], [0, 0, 1]), Some((10, 1)), "from the surface inwards");
        assert_eq!(hit([10, 20, 25], [0, 0, -1]), None, "from the surface outwards");
        assert_eq!(hit([10, 20, 25], [1, 0, 0]), None, "along the surface");
        assert_eq!(UNIT.hit([10, 20, 0], [0, 0, 2], true), None);
        assert_eq!(UNIT.hit([10, 20, 28], [0, 0, 2], true), Some((2 * 7, 4)));
        // 3 units to the side: at z = 26, t = 26 / 7, in 49ths; 26 * 7 = 182. 4 beside the axis of a step of 1 in x: by hand.
        assert_eq!(hit([13, 20, 0], [0, 0, 7]), Some((182, 49)));
    }

    /// Where the root is not whole it is rounded up, from either side.
    #[test]
    fn it_is_rounded_up() {
        // sqrt(5^2 - 1) = 4.8990: 25.101 and 4.899.
        assert_eq!(hit([11, 20, 0], [0, 0, 1]), Some((26, 1)));
        assert_eq!(hit([11, 20, 30], [0, 0, 1]), Some((5, 1)));
    }
}
