//! Fewer triangles for the same shape, so that any mesh can be made to fit a chip.
//!
//! Edges are collapsed one by one, those first whose loss changes the surface least: Garland & Heckbert, "Surface
//! Simplification Using Quadric Error Metrics", 1997. The half-edge mesh, and the check that a collapse leaves it a
//! manifold, are `alum`'s. What is kept beside the shape:
//!
//! - Outlines: open borders, borders between materials and creases between normals stay where they are as well as
//!   the surface does, and no collapse leaves them (`surface`).
//! - Materials: each surviving triangle has its own.
//! - Smooth normals: the normal of a vertex is the mean of those that were collapsed into it, by area. A triangle with
//!   one normal for all corners is flat, before and after.
//! - Closed stays closed, and no collapse turns a triangle over.
//!
//! Texture coordinates and colours of vertices are not carried along: the decimated model has none.

mod quadric;
mod surface;

use alum::{HasTopology, Queue};
use thiserror::Error;

use crate::compacted::Compacted;
use crate::model::{Model, Triangle};
use surface::{Face, Surface};

/// Why a model cannot be decimated as far as was asked.
#[derive(Debug, Error)]
pub enum DecimateError {
    /// Whatever could be collapsed was.
    #[error(
        "decimating {triangles} triangles ends at {reached}, and at most {target} were asked for: what is left are \
         outlines of parts, of materials and of creases, which are kept; ask for --triangles {reached}, or make the \
         model of fewer parts, materials and sharp edges"
    )]
    Unreachable {
        /// How many there were.
        triangles: usize,
        /// How many were asked for.
        target: usize,
        /// How many are left.
        reached: usize,
    },
    /// The half-edge mesh refuses what it has checked.
    #[error("the mesh cannot be decimated: {0:?}")]
    Mesh(alum::Error),
}

impl From<alum::Error> for DecimateError {
    fn from(error: alum::Error) -> Self {
        Self::Mesh(error)
    }
}

/// The model with at most `target` triangles; the same model where it has no more already.
///
/// Surviving triangles are in their old order. Positions that are equal are one vertex afterwards. Where more than two
/// triangles share an edge, the vertices stay as they are.
///
/// # Errors
/// Where what must be kept needs more triangles.
pub fn decimate(model: Model, target: usize) -> Result<Model, DecimateError> {
    let triangles = model.triangles.len();
    if triangles <= target {
        return Ok(model);
    }
    let mut surface = Surface::new(&model)?;
    let mut queue = Queue::new(surface.mesh.num_vertices());
    for vertex in surface.mesh.vertices() {
        if let Some(collapse) = surface.cheapest(vertex) {
            queue.insert(vertex, collapse.error);
        }
    }
    while surface.triangles > target {
        let Some((vertex, error)) = queue.pop() else {
            return Err(DecimateError::Unreachable { triangles, target, reached: surface.triangles });
        };
        // Its surroundings may have changed since it was queued.
        let Some(collapse) = surface.cheapest(vertex) else { continue };
        if collapse.error > error {
            queue.insert(vertex, collapse.error);
            continue;
        }
        for vertex in surface.collapse(&collapse)? {
            match surface.cheapest(vertex) {
                Some(collapse) => queue.insert(vertex, collapse.error),
                None => queue.remove(vertex),
            }
        }
    }
    Ok(rebuilt(model, &surface))
}

/// The model with what is left of its surface.
fn rebuilt(model: Model, surface: &Surface) -> Model {
    let mut positions = Compacted::default();
    let mut normals = Compacted::default();
    let triangle = |face: &Face| Triangle {
        vertices: face.corners.map(|corner| positions.number(corner.vertex)),
        // Flat ones have none.
        normals: (face.corners.iter().all(|corner| surface.normal(corner.wedge).is_some()))
            .then(|| face.corners.map(|corner| normals.number(corner.wedge))),
        material: model.triangles[face.id].material,
    };
    let triangles = surface.faces.iter().filter(|face| face.is_left).map(triangle).collect();
    Model {
        positions: positions.used().map(|vertex| surface.positions[vertex]).collect(),
        normals: normals.used().filter_map(|wedge| surface.normal(wedge)).collect(),
        triangles,
        uvs: Vec::new(),
        colours: Vec::new(),
        ..model
    }
}
