//! The cases.

mod planes;
mod rays;
mod scale;
mod shading;
mod structure;
mod triangles;

use super::Case;
use super::shapes::{Scene, v};

/// The scene that the work of all others is relative to.
pub const BENIGN: &str = "benign";

/// The scene whose tree has the most levels.
pub const DEEPEST: &str = "deepest-tree";

/// All cases, by group, the benign one first.
#[must_use]
pub fn all() -> Vec<Case> {
    [scale::cases(), triangles::cases(), rays::cases(), shading::cases(), structure::cases()].concat()
}

/// Cases of spheres alone, for the tracer of 1994.
#[must_use]
pub fn of_spheres() -> Vec<Case> {
    planes::cases()
}

/// Everyday objects on a table, everything within two orders of magnitude: 4 across.
fn benign() -> Scene {
    table(Scene::seen(v(1.5, 2.0, 4.0), v(0.0, 0.4, 0.0)).light(v(2.0, 4.0, 3.0), 0.8))
}

/// What stands on the table, for another view or other lights.
fn table(scene: Scene) -> Scene {
    objects(scene.matt(v(0.5, 0.5, 0.4)).ground(v(0.0, 0.0, 0.0), 2.0))
}

/// A box, a globe of triangles and a ball, about one across, on y = 0.
fn objects(scene: Scene) -> Scene {
    scene
        .matt(v(0.8, 0.3, 0.2))
        .block(v(-1.2, 0.0, -0.7), v(-0.4, 0.8, 0.1))
        .matt(v(0.2, 0.7, 0.3))
        .globe(v(0.5, 0.45, -0.3), 0.4, 6)
        .matt(v(0.3, 0.4, 0.9))
        .sphere(v(0.1, 0.3, 0.8), 0.25)
}
