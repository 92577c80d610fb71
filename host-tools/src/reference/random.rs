//! Random numbers of the reference: digests of a pixel, a sample and a count.
//!
//! A sample's numbers depend on nothing else, so that pictures are the same however the work is spread. The integer core has another generator and other points of the sphere.

use glam::DVec3;

use crate::witness::mix;

/// The numbers of one sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Random {
    /// The sample's own.
    key: u64,
    /// How many have been taken.
    number: u64,
}

impl Random {
    /// Those of sample `number` of the pixel in column `x` and row `y`.
    pub(super) fn new([x, y]: [u32; 2], number: u32) -> Self {
        Self { key: mix(mix(u64::from(x) << 32 | u64::from(y)) ^ u64::from(number)), number: 0 }
    }

    /// Evenly in [0, 1).
    pub(super) fn unit(&mut self) -> f64 {
        self.number += 1;
        (mix(self.key ^ mix(self.number)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Evenly on the unit sphere: evenly between its poles and about them, by Archimedes' theorem.
    pub(super) fn on_sphere(&mut self) -> DVec3 {
        let z = 2.0 * self.unit() - 1.0;
        let (sin, cos) = libm::sincos(std::f64::consts::TAU * self.unit());
        // Not negative, since z is in [-1, 1).
        let across = libm::sqrt(1.0 - z * z);
        DVec3::new(across * cos, across * sin, z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_even_on_the_sphere_and_samples_have_nothing_in_common() {
        let count = 20_000;
        let points: Vec<DVec3> = (0..count).map(|i| Random::new([i % 200, i / 200], i % 7).on_sphere()).collect();
        let mean = |of: &dyn Fn(DVec3) -> f64| points.iter().map(|&p| of(p)).sum::<f64>() / f64::from(count);
        // Four standard deviations: those of a coordinate, a square and a product are 1/3, 4/45 and 1/15, squared.
        let is_near = |found: f64, expected: f64, variance: f64| {
            (found - expected).abs() < 4.0 * libm::sqrt(variance / f64::from(count))
        };
        for axis in 0..3 {
            assert!(is_near(mean(&|p| p[axis]), 0.0, 1.0 / 3.0));
            assert!(is_near(mean(&|p| p[axis] * p[axis]), 1.0 / 3.0, 4.0 / 45.0));
            assert!(is_near(mean(&|p| p[axis] * p[(axis + 1) % 3]), 0.0, 1.0 / 15.0));
        }
        assert!(points.iter().all(|p| (p.length() - 1.0).abs() < 1e-15));
        // From one pixel to the next, and from one sample to the next.
        let neighbours = |of: fn(u32) -> Random| {
            let dots = (0..count).map(|i| of(i).on_sphere().dot(of(i + 1).on_sphere()));
            dots.sum::<f64>() / f64::from(count)
        };
        for of in [|i| Random::new([i, 3], 0), |i| Random::new([3, i], 0), |i| Random::new([3, 3], i)]
            as [fn(u32) -> Random; 3]
        {
            assert!(is_near(neighbours(of), 0.0, 1.0 / 3.0));
        }
    }
}
