//! Everything of intray that runs on a PC: importers, the grid, the BVH, the blob, pictures, and the
//! independent f64 reference.

pub mod builtin;
pub mod choose;
pub mod cli;
mod compacted;
pub mod compare;
pub mod decimate;
pub mod emulate;
pub mod engine;
pub mod files;
pub mod flash;
pub mod grid;
pub mod import;
pub mod model;
pub mod needs;
pub mod picture;
pub mod pixel_planes;
pub mod pixels;
pub mod plane;
pub mod planes;
pub mod prepare;
pub mod reference;
pub mod render;
pub mod report;
pub mod stage;
pub mod stress;
pub mod textures;
pub mod trace;
pub mod tree;
pub mod witness;
