//! What a scene may ask for and no kernel has yet: refused where leaving it out would show another scene, else said.
//!
//! In one place, so that each goes from here when kernels learn it.

use glam::DVec3;
use thiserror::Error;

use crate::model::{Background, Falloff, Material, MaterialKind, Model, Projection};

/// Something that no kernel has yet, and without which the picture would be another one.
#[derive(Clone, Copy, Debug, Error, PartialEq, Eq)]
pub enum Unsupported {
    /// Parallel camera rays.
    #[error("orthographic projection is not supported yet by any kernel; use \"perspective\"")]
    Orthographic,
    /// A light that fades.
    #[error("inverse-square falloff is not supported yet by any kernel; use \"none\"")]
    Falloff,
    /// A background that is not the same everywhere.
    #[error("sky is not supported yet by any kernel; give a background colour")]
    Sky,
}

/// What kernels have one form of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Plain {
    /// Vertical field of view, radians.
    pub(super) fov_y: f64,
    /// What a ray that hits nothing sees.
    pub(super) background: DVec3,
}

/// A model in the form that kernels have.
///
/// # Errors
/// Where it is in another.
pub(super) fn plain(model: &Model) -> Result<Plain, Unsupported> {
    if model.lights.iter().any(|light| light.falloff != Falloff::None) {
        return Err(Unsupported::Falloff);
    }
    let Projection::Perspective { fov_y } = model.camera.projection else {
        return Err(Unsupported::Orthographic);
    };
    let Background::Colour(background) = model.background else {
        return Err(Unsupported::Sky);
    };
    Ok(Plain { fov_y, background })
}

/// What of a model every kernel leaves out: a line of text each.
#[must_use]
pub fn missing(model: &Model) -> Vec<String> {
    let mut missing = Vec::new();
    if model.render.samples > 1 {
        missing.push("samples: more than one a pixel is not supported yet; drawn with one".into());
    }
    if !model.colours.is_empty() {
        missing.push("colours of vertices are not supported yet, and are left out".into());
    }
    for material in &model.materials {
        let extras = extras(material);
        if !extras.is_empty() {
            let name = material.name.escape_debug();
            missing
                .push(format!("material `{name}` is drawn without what is not supported yet: {}", extras.join(", ")));
        }
    }
    missing
}

/// What a material has that a Lambert surface of one colour has not.
fn extras(material: &Material) -> Vec<&'static str> {
    let extras = [
        (material.kind == MaterialKind::Metal && material.weights.is_none(), "metal towards white at grazing angles"),
        (material.tinted_shadow, "tinted shadow"),
        (material.checker.is_some(), "checker"),
        (material.texture.is_some(), "texture"),
    ];
    extras.into_iter().filter(|&(given, _)| given).map(|(_, name)| name).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{Checker, Light, LightKind, RenderSettings, Specular};

    #[test]
    fn what_would_be_another_scene_is_refused() {
        let refusal = |change: &dyn Fn(&mut Model)| {
            let mut model = Model::default();
            change(&mut model);
            plain(&model).unwrap_err()
        };
        assert_eq!(plain(&Model::default()).map(|plain| plain.background), Ok(DVec3::ZERO));
        let parallel = Projection::Orthographic { height: 1.0 };
        assert_eq!(refusal(&|m| m.camera.projection = parallel), Unsupported::Orthographic);
        let sky = Background::Sky { bottom: DVec3::ZERO, top: DVec3::ONE };
        assert_eq!(refusal(&|m| m.background = sky), Unsupported::Sky);
        let falloff = Falloff::InverseSquare { reach: 1.0 };
        let lamp = Light { falloff, ..Light::new(LightKind::Point(DVec3::Y), DVec3::ONE) };
        assert_eq!(refusal(&|m| m.lights.push(lamp)), Unsupported::Falloff);
    }

    #[test]
    fn what_is_left_out_is_said() {
        assert_eq!(missing(&Model::default()), Vec::<String>::new());
        let specular = Specular { lobe: Default::default(), exponent: 50, colour: DVec3::ONE };
        let rich = Material {
            name: "a\nb".into(),
            kind: MaterialKind::Dielectric,
            specular: Some(specular),
            weights: Some([0.0, 0.5, 0.1, 0.8]),
            checker: Some(Checker { size: 1.0, other: DVec3::ZERO }),
            ..Material::default()
        };
        let plain = Material { weights: Some([1.0, 0.0, 0.0, 0.0]), ..Material::default() };
        let glossy = Material { name: "c".into(), specular: Some(specular), ..Material::default() };
        let model = Model {
            materials: vec![rich, plain, glossy],
            colours: vec![DVec3::ONE],
            render: RenderSettings { samples: 4, ..RenderSettings::default() },
            ..Model::default()
        };
        let expected = [
            "samples: more than one a pixel is not supported yet; drawn with one",
            "colours of vertices are not supported yet, and are left out",
            "material `a\\nb` is drawn without what is not supported yet: dielectric, transparency, weights, checker",
            "material `c` is drawn without what is not supported yet: highlights",
        ];
        assert_eq!(missing(&model), expected);
    }
}
