//! Oracles and helpers that the tests share. Nothing here calls the code that it checks.

pub mod ball_rays;
pub mod balls;
pub mod blobs;
pub mod boards;
pub mod chips;
pub mod convergence;
pub mod documents;
pub mod fuzz;
pub mod growth;
pub mod meshes;
pub mod octants;
pub mod oracle;
pub mod painted;
pub mod planes;
pub mod random;
pub mod rays;
pub mod scenes;
pub mod shared;
pub mod stack;
pub mod symbols;
pub mod ties;
pub mod views;

/// How much more the long run does: 10 with `INTRAY_LONG` set, else 1.
#[must_use]
pub fn effort() -> usize {
    if std::env::var_os("INTRAY_LONG").is_some() { 10 } else { 1 }
}
