//! The error of a point against the planes that it stands for: a quadratic form.
//!
//! Garland & Heckbert, "Surface Simplification Using Quadric Error Metrics", 1997. The small pull towards the points
//! themselves makes every minimum unique, on a plane too (Trettner & Kobbelt, "Fast and Robust QEM Minimization using
//! Probabilistic Quadrics", 2020).

use glam::{DMat3, DVec3};
use std::ops::{Add, AddAssign};

/// `q(p) = p A p - 2 b p + c`, with A symmetric: a weighted sum of squared distances.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Quadric {
    a: DMat3Upper,
    b: DVec3,
    c: f64,
}

/// xx, yy, zz and yz, zx, xy of a symmetric matrix.
#[derive(Clone, Copy, Debug, Default)]
struct DMat3Upper {
    diagonal: DVec3,
    rest: DVec3,
}

impl Quadric {
    /// The squared distance from the plane through `point`, times `weight`. The normal is of unit length.
    pub(super) fn plane(normal: DVec3, point: DVec3, weight: f64) -> Self {
        let distance = normal.dot(point);
        let turned = DVec3::new(normal.y * normal.z, normal.z * normal.x, normal.x * normal.y);
        Self {
            a: DMat3Upper { diagonal: weight * normal * normal, rest: weight * turned },
            b: weight * distance * normal,
            c: weight * distance * distance,
        }
    }

    /// The squared distance from `point`, times `weight`.
    pub(super) fn point(point: DVec3, weight: f64) -> Self {
        Self {
            a: DMat3Upper { diagonal: DVec3::splat(weight), rest: DVec3::ZERO },
            b: weight * point,
            c: weight * point.length_squared(),
        }
    }

    /// The form's value; rounding may take it a little below zero.
    pub(super) fn error(&self, point: DVec3) -> f64 {
        let squares = self.a.diagonal.dot(point * point);
        let products = self.a.rest.dot(DVec3::new(point.y * point.z, point.z * point.x, point.x * point.y));
        squares + 2.0 * products - 2.0 * self.b.dot(point) + self.c
    }

    /// Where the form is least; not finite where that is no single point.
    pub(super) fn minimum(&self) -> DVec3 {
        let (d, r) = (self.a.diagonal, self.a.rest);
        let columns = [DVec3::new(d.x, r.z, r.y), DVec3::new(r.z, d.y, r.x), DVec3::new(r.y, r.x, d.z)];
        DMat3::from_cols(columns[0], columns[1], columns[2]).inverse() * self.b
    }
}

impl Add for Quadric {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            a: DMat3Upper { diagonal: self.a.diagonal + other.a.diagonal, rest: self.a.rest + other.a.rest },
            b: self.b + other.b,
            c: self.c + other.c,
        }
    }
}

impl AddAssign for Quadric {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_minimum_is_where_three_planes_meet() {
        let corner = DVec3::new(1.0, -2.0, 3.0);
        let oblique = DVec3::new(1.0, 2.0, 2.0) / 3.0;
        let sum = Quadric::plane(DVec3::X, corner, 2.0)
            + Quadric::plane(DVec3::Y, corner, 0.5)
            + Quadric::plane(oblique, corner, 1.0);
        assert!((sum.minimum() - corner).length() < 1e-12);
        assert!(sum.error(corner).abs() < 1e-12);
        let off = corner + DVec3::new(0.1, 0.2, -0.3);
        let expected = 2.0 * 0.01 + 0.5 * 0.04 + (oblique.dot(off - corner)).powi(2);
        assert!((sum.error(off) - expected).abs() < 1e-12);
    }

    #[test]
    fn a_plane_alone_has_no_minimum_and_a_pull_gives_it_one() {
        let plane = Quadric::plane(DVec3::Z, DVec3::Z, 1.0);
        assert!(!plane.minimum().is_finite());
        let pulled = plane + Quadric::point(DVec3::new(4.0, 5.0, 1.0), 1e-6);
        assert!((pulled.minimum() - DVec3::new(4.0, 5.0, 1.0)).length() < 1e-9);
    }
}
