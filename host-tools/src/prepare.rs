//! From a model to a blob: grid, degenerates, tree, records, header, checksum.
//!
//! Whatever the device will use is made by the device's own integer code; f64 ends at the grid.

mod header;
mod layout;

pub use layout::Blob;

use core_rt::bvh::Child;
use core_rt::kernel::{Kernel, Vertices};
use core_rt::record::Material;
use thiserror::Error;

use crate::grid::{Grid, GridError};
use crate::model::Model;
use crate::tree::{self, TreeOptions};

/// How a scene is prepared.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Options {
    /// The tree.
    pub tree: TreeOptions,
}

/// Why a scene cannot be prepared for a kernel.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum PrepareError {
    /// No grid.
    #[error(transparent)]
    Grid(#[from] GridError),
    /// Nothing is left.
    #[error(
        "all {triangles} triangles are degenerate on the {bits}-bit grid of {kernel}: nothing is left to render; \
         {hint}"
    )]
    AllDegenerate {
        /// How many there were.
        triangles: usize,
        /// The grid's bits.
        bits: u32,
        /// The kernel's name.
        kernel: &'static str,
        /// What would help.
        hint: &'static str,
    },
    /// More triangles than a tree can refer to.
    #[error("the scene has {found} triangles, and a blob holds at most {most}")]
    TooManyTriangles {
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: u32,
    },
    /// More materials than a triangle's record can refer to.
    #[error("the scene uses {found} materials, and {kernel} holds at most {most}; exact29 holds more")]
    TooManyMaterials {
        /// How many there are.
        found: usize,
        /// How many there may be.
        most: u32,
        /// The kernel's name.
        kernel: &'static str,
    },
    /// The blob would not fit its size field.
    #[error("the blob would be {bytes} bytes long, and the format ends at 4 GiB")]
    TooLarge {
        /// How long it would be.
        bytes: u64,
    },
}

/// Triangles that have no area on the grid, by cause (the columns of the 2009 report's Table 2 are their sum).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Degenerates {
    /// Two corners are one.
    pub zero_edge: u32,
    /// Three corners are in one line.
    pub zero_area: u32,
}

impl Degenerates {
    /// All of them.
    #[must_use]
    pub const fn total(self) -> u32 {
        self.zero_edge + self.zero_area
    }
}

/// A scene, ready for a kernel.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The blob.
    pub blob: Blob,
    /// What was left out.
    pub degenerates: Degenerates,
    /// The grid.
    pub grid: Grid,
}

/// Prepares a model for a kernel.
///
/// # Errors
/// Where the kernel cannot hold the scene.
pub fn prepare<K: Kernel>(model: &Model, options: &Options) -> Result<Prepared, PrepareError> {
    if model.triangles.len() >= Child::INDEX_END as usize {
        return Err(PrepareError::TooManyTriangles { found: model.triangles.len(), most: Child::INDEX_END - 1 });
    }
    let (used, materials) = used_materials(model);
    if used.len() > K::MATERIALS_MAX as usize + 1 {
        return Err(PrepareError::TooManyMaterials {
            found: used.len(),
            most: K::MATERIALS_MAX + 1,
            kernel: K::NAME,
        });
    }
    let grid = Grid::fit::<K>(model)?;
    let (corners, ids, degenerates) = without_degenerates(grid.triangles(model));
    if corners.is_empty() {
        return Err(PrepareError::AllDegenerate {
            triangles: model.triangles.len(),
            bits: K::GRID_BITS,
            kernel: K::NAME,
            hint: "check the model's vertices, or bring camera and lights closer to it",
        });
    }
    let flat = tree::build(&corners, options.tree);
    let triangles: Vec<K::Triangle> = flat
        .order
        .iter()
        .filter_map(|&place| {
            let material = materials[model.triangles[ids[place as usize] as usize].material as usize];
            K::triangle(&corners[place as usize], material)
        })
        .collect();
    debug_assert_eq!(triangles.len(), flat.order.len(), "corners are on the grid and have area");
    let nodes: Vec<K::Node> = flat.nodes.iter().map(|node| K::node(node.boxes, node.children)).collect();
    let ids: Vec<u32> = flat.order.iter().map(|&place| ids[place as usize]).collect();
    let used: Vec<Material> = used.iter().map(|&m| header::material(&model.materials[m as usize])).collect();
    let blob = layout::write::<K>(model, &grid, layout::Parts {
        root: flat.root,
        depth: flat.depth,
        nodes: &nodes,
        triangles: &triangles,
        ids: &ids,
        materials: &used,
    })?;
    Ok(Prepared { blob, degenerates, grid })
}

/// The materials that triangles refer to, and the new number of each old one.
fn used_materials(model: &Model) -> (Vec<u32>, Vec<u32>) {
    let mut numbers = vec![u32::MAX; model.materials.len()];
    let mut used = Vec::new();
    for triangle in &model.triangles {
        let number = &mut numbers[triangle.material as usize];
        if *number == u32::MAX {
            *number = used.len() as u32;
            used.push(triangle.material);
        }
    }
    (used, numbers)
}

/// Triangles with area and their ids.
fn without_degenerates(all: Vec<Vertices>) -> (Vec<Vertices>, Vec<u32>, Degenerates) {
    let mut degenerates = Degenerates::default();
    let mut ids = Vec::with_capacity(all.len());
    let mut corners = Vec::with_capacity(all.len());
    for (id, triangle) in (0..).zip(all) {
        let [a, b, c] = triangle;
        let [wide_a, wide_b, wide_c] = triangle.map(|v| v.map(i64::from));
        let normal = core_rt::num::cross(
            core_rt::num::sub(wide_b, wide_a),
            core_rt::num::sub(wide_c, wide_a),
        );
        if a == b || b == c || c == a {
            degenerates.zero_edge += 1;
        } else if normal == [0; 3] {
            degenerates.zero_area += 1;
        } else {
            ids.push(id);
            corners.push(triangle);
        }
    }
    (corners, ids, degenerates)
}
