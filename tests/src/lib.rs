//! Oracles and helpers that the tests share. Nothing here calls the code that it checks.

pub mod fuzz;
pub mod meshes;
pub mod oracle;
pub mod random;
pub mod rays;
