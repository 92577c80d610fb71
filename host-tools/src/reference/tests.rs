//! The tree against a loop: bit for bit the same crossings.

use super::*;
use crate::model::{Sphere, Triangle};

/// A model of bare triangles and spheres.
fn soup(corners: &[[DVec3; 3]], spheres: &[Sphere]) -> Model {
    Model {
        positions: corners.iter().flatten().copied().collect(),
        triangles: (0..corners.len() as u32)
            .map(|i| Triangle { vertices: [3 * i, 3 * i + 1, 3 * i + 2], normals: None, material: 0 })
            .collect(),
        spheres: spheres.to_vec(),
        ..Model::default()
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
    let shapes: Vec<Shape> = Shape::all(all).collect();
    let loops = |ray: &Ray| {
        let hits = shapes.iter().filter_map(|shape| Some((shape.intersect(ray)?, shape.prim())));
        hits.min_by(|(a, i), (b, j)| a.depth.total_cmp(&b.depth).then(i.cmp(j)))
    };
    let differs = |&&(origin, direction): &&(DVec3, DVec3)| {
        let ray = Ray::new(origin, direction);
        tree.closest(&ray, Shape::intersect) != loops(&ray)
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
        let spheres: Vec<Sphere> = (0..40)
            .map(|i| Sphere { centre: coarse(&mut state), radius: f64::from(i % 5 + 1) / 16.0, material: 0 })
            .collect();
        let model = soup(&corners, &spheres);
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
        for missing in [soup(&corners[1..200], &spheres), soup(&corners, &spheres[1..])] {
            assert_ne!(differences(&Reference::new(&missing), &model, &rays), 0);
        }
    }
}
