//! The f64 reference against what it does not share a line with: Möller and Trumbore's test in a loop
//! over all triangles, closed surfaces, and answers worked out by hand.

mod materials;
mod nearest;
mod paths;
mod picture;
mod recursion;
mod scenes;
mod shading;

use std::f64::consts::FRAC_PI_2;

use glam::DVec3;
use host_tools::model::{Camera, Light, LightKind, Material, Model, Projection, RenderSettings, Triangle};
use tests::{meshes, oracle, random::SplitMix64};

/// A triangle's vertices.
type Corners = [DVec3; 3];

/// Evenly in [-1, 1).
fn scalar(random: &mut SplitMix64) -> f64 {
    (random.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
}

/// Evenly in [-1, 1)^3.
fn vector(random: &mut SplitMix64) -> DVec3 {
    DVec3::from_array([(); 3].map(|()| scalar(random)))
}

/// From `eye` to corner `i % n`, to a point of its edge, or anywhere, in turn.
fn aim(random: &mut SplitMix64, corners: &[Corners], i: usize, eye: DVec3) -> DVec3 {
    let [a, b, _] = corners[i % corners.len()];
    match i % 3 {
        0 => vector(random),
        1 => a - eye,
        _ => a + (b - a) * (scalar(random) * 0.5 + 0.5) - eye,
    }
}

/// A mesh on the grid of 20 bits, moved to [-1, 1]^3 exactly.
fn centred(mesh: &[oracle::Triangle]) -> Vec<Corners> {
    let place = |vertex: [i64; 3]| DVec3::from_array(vertex.map(|c| c as f64 / 524_288.0 - 1.0));
    mesh.iter().map(|triangle| triangle.map(place)).collect()
}

/// A closed, convex sphere of radius 1 in 8 n^2 triangles.
fn sphere(n: i64) -> Vec<Corners> {
    centred(&meshes::sphere(20, n))
}

/// An axis-parallel box within [-1, 1]^3.
fn cuboid(low: [i64; 3], high: [i64; 3]) -> Vec<Corners> {
    centred(&meshes::cuboid(low, high))
}

/// What is seen where there is nothing.
const BACKGROUND: DVec3 = DVec3::new(0.1, 0.2, 0.3);

/// White flat triangles, lit by `lights`, seen from (0, 0, 5).
fn model(corners: &[Corners], lights: &[LightKind]) -> Model {
    Model {
        positions: corners.iter().flatten().copied().collect(),
        triangles: (0..corners.len() as u32)
            .map(|i| Triangle { vertices: [3 * i, 3 * i + 1, 3 * i + 2], normals: None, material: 0 })
            .collect(),
        materials: vec![Material { name: "white".into(), colour: DVec3::ONE, ..Material::default() }],
        lights: lights.iter().map(|&kind| Light::new(kind, DVec3::ONE)).collect(),
        camera: Camera {
            position: DVec3::new(0.0, 0.0, 5.0),
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: FRAC_PI_2 },
        },
        background: BACKGROUND.into(),
        render: RenderSettings { size: [64, 48], ..RenderSettings::default() },
        ..Model::default()
    }
}

/// The quadrilateral a, b, c, d.
fn quad(a: DVec3, b: DVec3, c: DVec3, d: DVec3) -> [Corners; 2] {
    [[a, b, c], [a, c, d]]
}
