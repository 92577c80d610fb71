//! Everyday objects on a ground plane that is far larger than they are: few of a grid's steps are left for them.

use glam::DVec3;
use host_tools::model::{Camera, Light, LightKind, Material, Model, Projection, RenderSettings, Triangle};

use crate::meshes;

/// Width, height and depth of a cuboid, the middle of its underside, and by how many radians it is turned about the vertical.
const CUBOIDS: [([f64; 3], [f64; 3], f64); 9] = [
    // A table, and what stands on it.
    ([1.6, 0.04, 0.8], [0.0, 0.71, 0.0], 0.3),
    ([0.06, 0.72, 0.06], [-0.801, -0.01, -0.1], 0.3),
    ([0.06, 0.72, 0.06], [-0.601, -0.01, 0.521], 0.3),
    ([0.06, 0.72, 0.06], [0.801, -0.01, 0.1], 0.3),
    ([0.06, 0.72, 0.06], [0.601, -0.01, -0.521], 0.3),
    ([0.21, 0.03, 0.15], [-0.31, 0.749, 0.12], 0.9),
    // Crates beside it.
    ([0.5, 0.4, 0.4], [1.45, -0.01, 0.35], 1.1),
    ([0.3, 0.25, 0.3], [1.47, 0.389, 0.31], 0.2),
    ([0.7, 0.9, 0.6], [-1.6, -0.01, -0.7], -0.4),
];

/// Radius and centre of a ball.
const BALLS: [(f64, [f64; 3]); 7] = [
    (0.11, [0.27, 0.86, 0.03]),
    (0.038, [0.08, 0.787, 0.17]),
    (0.037, [0.11, 0.786, 0.08]),
    (0.12, [0.71, 0.119, 0.83]),
    (0.3, [-0.83, 0.298, 0.93]),
    (0.02, [0.31, 0.019, 1.2]),
    (0.15, [-1.55, 1.038, -0.65]),
];

/// Each ball has eight times the square of this many triangles.
const BALL_CUTS: i64 = 40;

/// The scene in metres: the ground is a square `factor` metres wide, and the objects, at most 1.6 m, are in the middle of it.
/// Everything rests a few millimetres in what it rests on, so that no two surfaces lie in one plane.
#[must_use]
pub fn vast_ground(factor: f64) -> Model {
    let mut model = Model {
        materials: [("ground", [0.45, 0.42, 0.35]), ("wood", [0.6, 0.35, 0.15]), ("rubber", [0.75, 0.75, 0.8])]
            .map(|(name, colour)| Material { name: name.into(), colour: colour.into(), ..Material::default() })
            .into(),
        lights: vec![Light::new(LightKind::Directional(DVec3::new(-0.5, -1.0, -0.3)), DVec3::new(1.0, 0.95, 0.85))],
        camera: Camera {
            position: DVec3::new(1.3, 2.4, 5.9),
            look_at: DVec3::new(0.0, 0.55, 0.0),
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: 0.7 },
        },
        background: DVec3::new(0.35, 0.5, 0.8).into(),
        render: RenderSettings { size: [96, 64], ambient: DVec3::splat(0.08), ..RenderSettings::default() },
        ..Model::default()
    };
    let half = factor / 2.0;
    let corner = |x: f64, z: f64| DVec3::new(x * half, 0.0, z * half);
    let [a, b, c, d] = [corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)];
    add(&mut model, 0, [[a, b, c], [a, c, d]]);
    for (size, base, turn) in CUBOIDS {
        let (sin, cos) = libm::sincos(turn);
        let place = |v: [i64; 3]| {
            let [x, y, z] = [0, 1, 2].map(|axis| v[axis] as f64 * size[axis] / 2.0);
            DVec3::new(cos * x + sin * z, y, cos * z - sin * x) + DVec3::from(base)
        };
        add(&mut model, 1, meshes::cuboid([-1, 0, -1], [1, 2, 1]).into_iter().map(|t| t.map(place)));
    }
    const BITS: u32 = 20;
    let ball = meshes::sphere(BITS, BALL_CUTS);
    for (radius, centre) in BALLS {
        let middle = f64::from(1 << (BITS - 1));
        let place = |v: [i64; 3]| DVec3::from(v.map(|c| (c as f64 / middle - 1.0) * radius)) + DVec3::from(centre);
        add(&mut model, 2, ball.iter().map(|t| t.map(place)));
    }
    model
}

/// Adds triangles of a material.
fn add(model: &mut Model, material: u32, triangles: impl IntoIterator<Item = [DVec3; 3]>) {
    for corners in triangles {
        let first = model.positions.len() as u32;
        model.positions.extend(corners);
        model.triangles.push(Triangle { vertices: [first, first + 1, first + 2], normals: None, material });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use host_tools::reference::Reference;

    #[test]
    fn the_ground_is_as_large_as_asked_for_and_the_objects_are_not() {
        for factor in [1e4, 1e6] {
            let model = vast_ground(factor);
            let largest =
                |from: usize| model.positions[from..].iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
            assert_eq!(largest(0), factor / 2.0);
            assert!(largest(6) < 2.5, "all but the ground is within reach");
            assert_eq!(
                model.triangles.len(),
                2 + 12 * CUBOIDS.len() + 8 * (BALL_CUTS * BALL_CUTS) as usize * BALLS.len()
            );
        }
    }

    /// Camera and light see ground, wood and rubber; nothing there is a tie.
    #[test]
    fn every_material_is_seen_and_no_two_surfaces_share_a_place() {
        let model = vast_ground(1e4);
        let reference = Reference::new(&model);
        let mut seen = [0; 3];
        for (x, y) in (0..64).flat_map(|y| (0..96).map(move |x| (x, y))) {
            let (origin, direction) = reference.camera_ray([96, 64], f64::from(x) + 0.5, f64::from(y) + 0.5);
            let hits = reference.candidates(origin, direction, 1e-6);
            assert!(hits.len() <= 1, "{hits:?}");
            for hit in hits {
                seen[model.triangles[hit.prim as usize].material as usize] += 1;
            }
        }
        assert!(seen.iter().all(|&pixels| pixels > 100), "{seen:?}");
    }
}
