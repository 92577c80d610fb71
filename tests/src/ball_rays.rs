//! Spheres and rays that are hard on the test of one with the other.

use core_rt::kernel::Kernel;

use crate::balls::Ball;
use crate::random::SplitMix64;

/// Spheres of all sizes within a kernel's grid: apart, within each other, touching, twice in one place.
#[must_use]
pub fn balls<K: Kernel>(random: &mut SplitMix64, count: usize) -> Vec<Ball> {
    let (low, high) = (i64::from(K::MARGIN), (1i64 << K::GRID_BITS) - 1 - i64::from(K::MARGIN));
    let (least, most) = (i64::from(K::RADIUS_MIN), (high - low) / 2);
    let mut balls: Vec<Ball> = Vec::new();
    while balls.len() < count {
        let bits = random.within([1, most.ilog2().into()]);
        let radius = random.within([0, 1 << bits]).clamp(least, most);
        let place = |random: &mut SplitMix64, radius| [0; 3].map(|_| random.within([low + radius, high - radius]));
        let fresh = Ball { centre: place(random, radius), radius };
        let other = balls.get(random.below(balls.len().max(1) as u64) as usize).copied();
        let ball = match (random.below(8), other) {
            (0, Some(other)) => other,
            (1, Some(other)) => Ball { radius: random.within([least, other.radius]), ..other },
            // Side by side, with a point in common.
            (2, Some(other)) => {
                let [x, y, z] = other.centre;
                Ball { centre: [(x + other.radius + radius).min(high - radius), y, z], radius }
            }
            _ => fresh,
        };
        let fits = ball.centre.iter().all(|c| c - ball.radius >= low && c + ball.radius <= high);
        balls.extend(fits.then_some(ball));
    }
    balls
}

/// Origin and direction of rays that a kernel can hold: anywhere; at spheres from afar, from inside and from their surface; along tangents and almost so.
#[must_use]
pub fn rays<K: Kernel>(random: &mut SplitMix64, balls: &[Ball], count: usize) -> Vec<([i64; 3], [i64; 3])> {
    let last = (1i64 << K::GRID_BITS) - 1;
    let most = (1i64 << K::DIRECTION_BITS) - 1;
    let inside = |v: [i64; 3]| v.iter().all(|c| (0..=last).contains(c));
    let anywhere = |random: &mut SplitMix64| [0; 3].map(|_| random.within([0, last]));
    let any_direction = |random: &mut SplitMix64| {
        let bits = random.within([1, K::DIRECTION_BITS.into()]);
        let end = (1i64 << bits) - 1;
        [0; 3].map(|_| random.within([-end, end]))
    };
    let shorter = |mut d: [i64; 3]| {
        while d.iter().any(|c| c.abs() > most) {
            d = d.map(|c| c / 2);
        }
        d
    };
    let mut rays = Vec::new();
    while rays.len() < count {
        let Ball { centre, radius } = balls[random.below(balls.len() as u64) as usize];
        let nudge = |random: &mut SplitMix64, v: [i64; 3]| v.map(|c| c + random.within([-1, 1]));
        let at = |to: [i64; 3], from: [i64; 3]| shorter([0, 1, 2].map(|i| to[i] - from[i]));
        let near = |random: &mut SplitMix64| centre.map(|c| c + random.within([-radius, radius]));
        let corner = |random: &mut SplitMix64| [0; 3].map(|_| if random.coin() { 0 } else { last });
        // |(2, 3, 6)| = |(3, -6, 2)| = 7, and they are at right angles.
        let (k, j) = (radius / 7, random.within([-8, 8]));
        let [u, v] = [[2, 3, 6], [3, -6, 2]];
        let (origin, direction) = match random.below(10) {
            0 => (anywhere(random), any_direction(random)),
            1 | 2 => {
                let from = anywhere(random);
                (from, at(near(random), from))
            }
            3 => {
                let from = corner(random);
                (from, at(near(random), from))
            }
            4 => (near(random), any_direction(random)),
            5 => {
                // A tangent along an axis, or half a unit beside it, and on either side of the point.
                let mut from = [centre[0] + radius, centre[1], centre[2] + random.within([-radius, radius])];
                from[0] += random.within([-1, 1]);
                (from, [0, 0, if random.coin() { most } else { -1 }])
            }
            6 => {
                // A tangent in no plane of the grid, if the radius is a multiple of 7.
                let from = [0, 1, 2].map(|i| centre[i] + k * v[i] - j * k * u[i]);
                (from, u)
            }
            7 => {
                let from = [0, 1, 2].map(|i| centre[i] + k * v[i] - j * k * u[i]);
                (nudge(random, from), u.map(|c| c * (most / 6)))
            }
            8 => {
                // From the surface itself, or a unit beside it.
                let from = [centre[0], centre[1] - radius, centre[2]];
                (if random.coin() { from } else { nudge(random, from) }, any_direction(random))
            }
            _ => {
                let from = [0, 1, 2].map(|i| centre[i] + k * v[i]);
                let to = near(random);
                (from, at(to, from))
            }
        };
        if inside(origin) && direction != [0; 3] {
            rays.push((origin, direction));
        }
    }
    rays
}
