//! A ray as the box and triangle tests want it: measured by its depth along its major axis.

use glam::DVec3;

/// A half-line with what depends on it alone worked out once.
///
/// Its parameter is the *depth*: the distance travelled along the axis in which the direction is
/// longest, so that nothing here depends on the direction's length. `t = depth / scale`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    /// Where it starts.
    pub(super) origin: DVec3,
    /// Direction per unit of depth: every component in [-1, 1], the major one -1 or 1.
    pub(super) step: DVec3,
    /// 1 / `step`, infinite with the sign of the zero for an axis it does not move along.
    pub(super) inverse: DVec3,
    /// The major axis last, the other two before it.
    pub(super) axes: [usize; 3],
    /// Length of the direction's major component.
    pub(super) scale: f64,
}

impl Ray {
    /// The ray from `origin` along `direction`. A direction of zero or with a NaN hits nothing.
    pub(super) fn new(origin: DVec3, direction: DVec3) -> Self {
        let size = direction.abs();
        let axes = if size.x >= size.y && size.x >= size.z {
            [1, 2, 0]
        } else if size.y >= size.z {
            [2, 0, 1]
        } else {
            [0, 1, 2]
        };
        let scale = size[axes[2]];
        let step = direction / scale;
        Self { origin, step, inverse: step.recip(), axes, scale }
    }

    /// The point at `depth`.
    pub(super) fn at(&self, depth: f64) -> DVec3 {
        self.origin + self.step * depth
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_does_not_depend_on_the_length_of_the_direction() {
        let direction = DVec3::new(1.0, -3.0, 2.0);
        let unit = Ray::new(DVec3::ONE, direction);
        assert_eq!(unit.axes, [2, 0, 1]);
        assert_eq!(unit.step.y, -1.0);
        assert_eq!(unit.scale, 3.0);
        for length in [1e-300, 1e300] {
            let ray = Ray::new(DVec3::ONE, direction * length);
            assert!((ray.step - unit.step).abs().max_element() < 1e-15);
            assert_eq!(ray.axes, unit.axes);
        }
    }
}
