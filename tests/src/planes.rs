//! The way of a ray among spheres in real numbers: what the tracer of 1994 would do if its words had no end.

use glam::DVec3;
use planes_rt::scene::Sphere;

/// Where a ray met a sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Met {
    /// The sphere's place in the list.
    pub sphere: usize,
    /// The distance, in lengths of the direction.
    pub t: f64,
    /// The point.
    pub point: DVec3,
    /// The direction in which the ray goes on, as long as it came.
    pub direction: DVec3,
}

/// The spheres that a ray meets from outside, one after the other.
#[must_use]
pub fn way(spheres: &[Sphere], origin: [i16; 3], direction: [i16; 3], generations: u16) -> Vec<Met> {
    let real = |triple: [i16; 3]| DVec3::from_array(triple.map(f64::from));
    let (mut origin, mut direction) = (real(origin), real(direction));
    let mut way: Vec<Met> = Vec::new();
    for _ in 0..generations {
        let from = way.last().map(|met| met.sphere);
        let hits =
            spheres.iter().enumerate().filter(|(number, _)| Some(*number) != from).filter_map(|(number, sphere)| {
                let (unit, towards) = (direction.normalize(), real(sphere.centre) - origin);
                let along = towards.dot(unit);
                let off = towards - unit * along;
                let half_chord = f64::from(sphere.radius) * f64::from(sphere.radius) - off.length_squared();
                let distance = along - half_chord.max(0.0).sqrt();
                (half_chord >= 0.0 && distance >= 0.0).then_some((number, distance))
            });
        let Some((sphere, distance)) = hits.min_by(|a, b| a.1.total_cmp(&b.1)) else { break };
        origin += direction.normalize() * distance;
        let normal = (origin - real(spheres[sphere].centre)).normalize();
        let t = distance / direction.length();
        direction -= normal * (2.0 * normal.dot(direction));
        way.push(Met { sphere, t, point: origin, direction });
    }
    way
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_goes_to_and_fro_between_two_spheres() {
        let sphere = |x: i16| Sphere { centre: [x, 0, 0], radius: 100, ..Sphere::default() };
        let way = way(&[sphere(300), sphere(-300)], [0; 3], [50, 0, 0], 3);
        let seen: Vec<_> = way.iter().map(|met| (met.sphere, met.t, met.point.x, met.direction.x)).collect();
        assert_eq!(seen, [(0, 4.0, 200.0, -50.0), (1, 8.0, -200.0, 50.0), (0, 8.0, 200.0, -50.0)]);
    }
}
