//! Reflection and refraction of directions, and how much of each.

use glam::DVec3;

/// The direction of unit length `d` reflected by a plane of unit normal `n`.
pub(super) fn reflect(d: DVec3, n: DVec3) -> DVec3 {
    d - n * (2.0 * d.dot(n))
}

/// The direction of unit length `d` refracted at a plane of unit normal `n`, which faces it, with `eta` the index of
/// refraction before the plane over that behind it (Snell's law); `None` where all is reflected.
pub(super) fn refract(d: DVec3, n: DVec3, eta: f64) -> Option<DVec3> {
    let cosine = -d.dot(n);
    let squared = 1.0 - eta * eta * (1.0 - cosine * cosine);
    (squared >= 0.0).then(|| d * eta + n * (eta * cosine - libm::sqrt(squared)))
}

/// What a boundary reflects of what meets it at `cosine` to its normal, if it reflects `r0` of what meets it head on.
///
/// C. Schlick, "An Inexpensive BRDF Model for Physically-based Rendering", Computer Graphics Forum 13(3), 1994.
pub(super) fn schlick(r0: f64, cosine: f64) -> f64 {
    let k = (1.0 - cosine).clamp(0.0, 1.0);
    r0 + (1.0 - r0) * (k * k) * (k * k) * k
}

/// The share reflected between a medium of index `ior` and vacuum, of a ray at `cosine` to the normal on the side of the
/// lower index, where angles are wider.
pub(super) fn fresnel(ior: f64, cosine: f64) -> f64 {
    let root = (ior - 1.0) / (ior + 1.0);
    schlick(root * root, cosine)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(degrees: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        DVec3::new(sin, -cos, 0.0)
    }

    fn close(a: DVec3, b: DVec3) {
        assert!((a - b).length() < 1e-15, "{a} {b}");
    }

    #[test]
    fn a_mirror_at_45_degrees_turns_by_90() {
        close(reflect(DVec3::X, DVec3::new(-1.0, 1.0, 0.0).normalize()), DVec3::Y);
        close(reflect(at(30.0), DVec3::Y), DVec3::new(0.5, 0.75f64.sqrt(), 0.0));
    }

    #[test]
    fn snells_law_both_ways() {
        // sin 30 degrees / 1.5 = 1/3.
        let inside = refract(at(30.0), DVec3::Y, 1.0 / 1.5).unwrap();
        close(inside, DVec3::new(1.0 / 3.0, -(8f64.sqrt()) / 3.0, 0.0));
        close(refract(inside, DVec3::Y, 1.5).unwrap(), at(30.0));
        close(refract(at(70.0), DVec3::Y, 1.0).unwrap(), at(70.0));
    }

    #[test]
    fn beyond_the_critical_angle_nothing_gets_through() {
        let critical = libm::asin(1.0 / 1.5).to_degrees();
        let just = refract(at(critical - 1e-6), DVec3::Y, 1.5).unwrap();
        assert!(just.y < 0.0 && just.y > -1e-3, "it runs along the surface");
        assert_eq!(refract(at(critical + 1e-6), DVec3::Y, 1.5), None);
        assert!(refract(at(89.999), DVec3::Y, 1.0 / 1.5).is_some(), "there is no such angle on the way in");
    }

    #[test]
    fn what_glass_reflects() {
        assert!((fresnel(1.5, 1.0) - 0.04).abs() < 1e-16);
        assert!((fresnel(1.0 / 1.5, 1.0) - 0.04).abs() < 1e-16, "the same from within");
        assert_eq!(fresnel(1.5, 0.0), 1.0);
        assert!((fresnel(1.5, 0.5) - (0.04 + 0.96 / 32.0)).abs() < 1e-16);
        assert_eq!(fresnel(1.0, 0.5), 1.0 / 32.0);
    }
}
