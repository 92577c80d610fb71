//! Surfaces that a grid does not keep apart: which of two is nearer is then decided by rounding.

use core_rt::bvh::Child;
use core_rt::kernel::Bounds;
use glam::DVec3;
use rayon::prelude::*;

use super::survey::{few, normal};
use crate::grid::Grid;
use crate::model::Model;
use crate::tree::{self, Tree, TreeOptions};

/// Corners move by up to sqrt(3)/2 units each on a grid, and so do points between them: what is closer than the sum, grid
/// units, may change sides.
pub(super) const APART: f64 = 1.732_050_807_568_877_2;

/// As many triangles around one are looked at: more are copies, or a scene in one place, and the answer is known.
const LOOKED_AT: usize = 64;

/// Of the largest coordinate: closer than that, surfaces are in one place in the file too.
const TOGETHER: f64 = 1.0 / (1u64 << 40) as f64;

/// The triangles of a model that a kernel's grid may put on the other side of a surface.
pub(super) struct Layers {
    /// Triangles that have an area in the model.
    triangles: u32,
    /// Those that may change sides.
    pub(super) merged: u32,
    /// Whether all of a material may.
    is_material: bool,
}

impl Layers {
    pub(super) fn of(model: &Model, grid: &Grid) -> Self {
        let mut counts = vec![[0u32; 2]; model.materials.len()];
        for (triangle, merged) in model.triangles.iter().zip(merged(model, grid)) {
            if normal(triangle.vertices.map(|v| model.positions[v as usize])) != DVec3::ZERO {
                let [all, lost] = &mut counts[triangle.material as usize];
                *all += 1;
                *lost += u32::from(merged);
            }
        }
        Self {
            triangles: counts.iter().map(|[all, _]| all).sum(),
            merged: counts.iter().map(|[_, lost]| lost).sum(),
            is_material: counts.iter().any(|[all, lost]| *all > 0 && all == lost),
        }
    }

    /// Whether they are more than what is said nothing of.
    pub(super) fn are_merged(&self) -> bool {
        self.is_material || !few(self.merged, self.triangles)
    }
}

/// Whether the middle of each triangle lies so close before or behind another, whose corners are none of its own, that a
/// grid may put it on the other side.
fn merged(model: &Model, grid: &Grid) -> Vec<bool> {
    let count = model.triangles.len() as u32;
    // More than a tree refers to are in no blob.
    if !(1..Child::INDEX_END).contains(&count) {
        return vec![false; model.triangles.len()];
    }
    let corners = |id: u32| model.triangles[id as usize].vertices.map(|v| model.positions[v as usize]);
    let largest = model.positions.iter().fold(0.0, |largest: f64, p| largest.max(p.abs().max_element()));
    let (together, apart) = (largest * TOGETHER, APART / grid.scale);
    let tree = tree::build(grid.snap(model).iter().map(|corners| Bounds::of(&corners)), TreeOptions::default());
    let is_merged = |waiting: &mut Vec<u32>, id: u32| {
        let own = corners(id);
        let middle = own.iter().sum::<DVec3>() / 3.0;
        let mut left = LOOKED_AT;
        around(&tree, waiting, grid.place(middle), &mut |other| {
            let theirs = corners(other);
            let touches = other == id || own.iter().any(|corner| theirs.contains(corner));
            left -= 1;
            let is_over = !touches && height(middle, theirs).is_some_and(|h| h > together && h < apart);
            (is_over, left == 0)
        })
    };
    (0..count).into_par_iter().map_init(Vec::new, is_merged).collect()
}

/// Whether one of the triangles around a grid point is looked for; `look` says whether it is, and whether to give up. What
/// waits meanwhile is in `waiting`.
fn around(tree: &Tree, waiting: &mut Vec<u32>, point: [i32; 3], look: &mut impl FnMut(u32) -> (bool, bool)) -> bool {
    waiting.clear();
    waiting.push(tree.root);
    while let Some(packed) = waiting.pop() {
        match Child::unpack(packed) {
            Child::Leaf { first, count } => {
                for &id in &tree.order[first as usize..(first + count) as usize] {
                    let (found, enough) = look(id);
                    if found || enough {
                        return found;
                    }
                }
            }
            Child::Node(index) => {
                let node = &tree.nodes[index as usize];
                // Two units are more than what is looked for.
                let is_near = |bounds: &Bounds| {
                    (0..3).all(|axis| bounds.low[axis] - 2 <= point[axis] && point[axis] <= bounds.high[axis] + 2)
                };
                waiting
                    .extend(node.boxes.iter().zip(node.children).filter(|(bounds, _)| is_near(bounds)).map(|(_, c)| c));
            }
        }
    }
    false
}

/// How far a point is from a triangle's plane, where it is above or below the triangle itself.
fn height(point: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let normal = (b - a).cross(c - a);
    let is_inside = |from: DVec3, to: DVec3| (to - from).cross(point - from).dot(normal) >= 0.0;
    let is_over = normal != DVec3::ZERO && is_inside(a, b) && is_inside(b, c) && is_inside(c, a);
    is_over.then(|| (point - a).dot(normal.normalize()).abs())
}

/// The distance between a point and a triangle.
///
/// After C. Ericson, "Real-Time Collision Detection", 2005, 5.1.5: above the triangle that to its plane, else that to the
/// nearest of its edges.
pub(super) fn distance(point: DVec3, corners: [DVec3; 3]) -> f64 {
    let [a, b, c] = corners;
    let to_edge = |from: DVec3, to: DVec3| {
        let along = to - from;
        let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        // A point for an edge has no share.
        (point - from - if share.is_nan() { DVec3::ZERO } else { along * share }).length()
    };
    height(point, corners).unwrap_or_else(|| to_edge(a, b).min(to_edge(b, c)).min(to_edge(c, a)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_to_faces_edges_and_corners() {
        let corners = [DVec3::ZERO, DVec3::X * 4.0, DVec3::Y * 4.0];
        for (point, expected) in [
            ([1.0, 1.0, -0.5], 0.5),
            ([1.0, 1.0, 0.0], 0.0),
            ([1.0, -3.0, 4.0], 5.0),
            ([-3.0, -4.0, 12.0], 13.0),
            ([7.0, -4.0, 0.0], 5.0),
        ] {
            assert_eq!(distance(DVec3::from_array(point), corners), expected, "{point:?}");
        }
        assert_eq!(distance(DVec3::Z, [DVec3::ZERO; 3]), 1.0);
    }
}
