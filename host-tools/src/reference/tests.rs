//! The tree against a loop: bit for bit the same crossings.

use super::*;
use crate::model::{Camera, RenderSettings, Transfer};

/// A model of bare triangles.
fn soup(corners: &[[DVec3; 3]]) -> Model {
    Model {
        positions: corners.iter().flatten().copied().collect(),
        normals: Vec::new(),
        triangles: (0..corners.len() as u32)
            .map(|i| crate::model::Triangle { vertices: [3 * i, 3 * i + 1, 3 * i + 2], normals: None, material: 0 })
            .collect(),
        materials: Vec::new(),
        lights: Vec::new(),
        camera: Camera { position: DVec3::ZERO, look_at: DVec3::X, up: DVec3::Z, fov_y: 1.0 },
        background: DVec3::ZERO,
        render: RenderSettings { size: [1, 1], ambient: DVec3::ZERO, transfer: Transfer::Linear },
    }
}

/// Multiples of 1/8 in [-1, 1], so that coincidences abound.
fn coarse(state: &mut u64) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| {
        *state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((*state >> 33) % 17) as f64 / 8.0 - 1.0
    }))
}

/// Rays for which the tree and a loop over all triangles differ in any bit.
fn differences(tree: &Reference, all: &Model, rays: &[(DVec3, DVec3)]) -> usize {
    let triangles: Vec<_> = (0..all.triangles.len() as u32).map(|i| lookup(all, i)).collect();
    let loops = |ray: &Ray| {
        let hits = triangles.iter().filter(|triangle| triangle.has_area());
        hits.filter_map(|triangle| Some((triangle.intersect(ray)?, triangle.prim)))
            .min_by(|(a, i), (b, j)| a.depth.total_cmp(&b.depth).then(i.cmp(j)))
    };
    let differs = |&&(origin, direction): &&(DVec3, DVec3)| {
        let ray = Ray::new(origin, direction);
        tree.closest(&ray) != loops(&ray)
    };
    rays.iter().filter(differs).count()
}

#[test]
fn the_tree_loses_nothing_that_a_loop_finds() {
    let mut state = 1;
    for _ in 0..20 {
        let mut corners: Vec<_> = (0..200).map(|_| std::array::from_fn(|_| coarse(&mut state))).collect();
        // An axis-aligned wall, a duplicate, and triangles that are lines and points.
        corners.push([[-1.0, -1.0, 0.5], [1.0, -1.0, 0.5], [1.0, 1.0, 0.5]].map(DVec3::from));
        corners.push(corners[0]);
        corners.push([corners[1][0], corners[1][1], corners[1][0]]);
        corners.push([corners[2][0]; 3]);
        let model = soup(&corners);
        let mut rays = Vec::new();
        for from in corners.iter().flatten().take(100) {
            let (origin, along) = (coarse(&mut state) * 3.0, coarse(&mut state));
            rays.extend([
                (origin, along),                                 // often parallel to an axis or plane
                (origin, *from - origin),                        // at a vertex
                (origin * 1e-3, (*from - origin * 1e-3) * 1e-9), // the same, inexact and short
                (*from, along),                                  // from a vertex
                (*from - along * 2.0, along),                    // in the plane of many
                ((*from + origin) * 0.3, along * 0.7),           // from anywhere
            ]);
        }
        let tree = Reference::new(&model);
        assert_eq!(differences(&tree, &model, &rays), 0);
        let missing = soup(&corners[1..200]);
        assert_ne!(differences(&Reference::new(&missing), &model, &rays), 0);
    }
}
