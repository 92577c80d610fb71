//! What a scene may ask for and no kernel has yet: refused, since leaving it out would show another scene.

use thiserror::Error;

use crate::model::Model;

/// Something that no kernel has yet, and without which the picture would be another one.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum Unsupported {
    /// A sphere.
    #[error("spheres are not supported yet by any kernel; use a mesh")]
    Spheres,
}

/// Checks that kernels have all of a model.
///
/// # Errors
/// Where they have not.
pub(super) fn supported(model: &Model) -> Result<(), Unsupported> {
    if model.spheres.is_empty() { Ok(()) } else { Err(Unsupported::Spheres) }
}
