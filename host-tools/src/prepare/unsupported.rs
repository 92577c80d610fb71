//! What a scene may ask for and no kernel has yet: refused where leaving it out would show another scene, else said.
//!
//! In one place, so that each goes from here when kernels learn it.

use thiserror::Error;

use crate::model::{Model, Projection};

/// Something that no kernel has yet, and without which the picture would be another one.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum Unsupported {
    /// A sphere.
    #[error("spheres are not supported yet by any kernel; use a mesh")]
    Spheres,
    /// Parallel camera rays.
    #[error("orthographic projection is not supported yet by any kernel; use \"perspective\"")]
    Orthographic,
}

/// What kernels have one form of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plain {
    /// Vertical field of view, radians.
    pub(super) fov_y: f64,
}

/// A model in the form that kernels have.
///
/// # Errors
/// Where it is in another.
pub(super) fn plain(model: &Model) -> Result<Plain, Unsupported> {
    if !model.spheres.is_empty() {
        return Err(Unsupported::Spheres);
    }
    let Projection::Perspective { fov_y } = model.camera.projection else {
        return Err(Unsupported::Orthographic);
    };
    Ok(Plain { fov_y })
}

/// What of a model every kernel leaves out: a line of text each.
#[must_use]
pub fn missing(model: &Model) -> Vec<String> {
    let mut missing = Vec::new();
    if model.render.samples > 1 {
        missing.push("samples: more than one a pixel is not supported yet; drawn with one".into());
    }
    missing
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    use crate::model::{RenderSettings, Sphere};

    #[test]
    fn what_would_be_another_scene_is_refused() {
        let refusal = |change: &dyn Fn(&mut Model)| {
            let mut model = Model::default();
            change(&mut model);
            plain(&model).unwrap_err()
        };
        assert!(plain(&Model::default()).is_ok());
        let sphere = Sphere { centre: DVec3::ZERO, radius: 1.0, material: 0 };
        assert_eq!(refusal(&|m| m.spheres.push(sphere)), Unsupported::Spheres);
        let parallel = Projection::Orthographic { height: 1.0 };
        assert_eq!(refusal(&|m| m.camera.projection = parallel), Unsupported::Orthographic);
    }

    #[test]
    fn what_is_left_out_is_said() {
        assert_eq!(missing(&Model::default()), Vec::<String>::new());
        let model = Model { render: RenderSettings { samples: 4, ..RenderSettings::default() }, ..Model::default() };
        let expected = ["samples: more than one a pixel is not supported yet; drawn with one"];
        assert_eq!(missing(&model), expected);
    }
}
