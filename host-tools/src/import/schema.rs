//! The form of a `scene.toml`: its tables and keys, and nothing of their meaning.
//!
//! Keys that are not here are errors, with the nearest key that is. Values carry their place in the
//! text ([`Spanned`]) wherever their meaning can still be wrong.

use std::collections::BTreeMap;
use std::fmt;

use glam::DVec3;
use serde::Deserialize;
use serde::de::{Deserializer, Error, SeqAccess, Visitor};
use toml::Spanned;

/// A whole file.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SceneToml {
    pub model: Option<Spanned<String>>,
    #[serde(default)]
    pub transfer: TransferToml,
    pub camera: Option<Spanned<CameraToml>>,
    #[serde(default)]
    pub light: Vec<Spanned<LightToml>>,
    #[serde(default)]
    pub sphere: Vec<Spanned<SphereToml>>,
    #[serde(default)]
    pub material: BTreeMap<Spanned<String>, MaterialToml>,
    #[serde(default)]
    pub background: BackgroundToml,
    #[serde(default)]
    pub render: RenderToml,
}

/// `transfer`.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum TransferToml {
    #[default]
    Srgb,
    Linear,
}

/// `[camera]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as [camera]")]
pub(super) struct CameraToml {
    pub projection: Option<ProjectionToml>,
    pub height: Option<Spanned<Number>>,
    pub position: Option<Spanned<Vector>>,
    pub look_at: Option<Spanned<Vector>>,
    pub up: Option<Spanned<Vector>>,
    pub fov_y: Option<Spanned<Number>>,
}

/// `camera.projection`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum ProjectionToml {
    Perspective,
    Orthographic,
}

/// `[[light]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as [[light]]")]
pub(super) struct LightToml {
    #[serde(default)]
    pub kind: LightKindToml,
    pub position: Option<Spanned<Vector>>,
    pub direction: Option<Spanned<Vector>>,
    pub colour: Option<Spanned<Vector>>,
    pub intensity: Option<Spanned<Number>>,
    pub falloff: Option<Spanned<FalloffToml>>,
    pub reach: Option<Spanned<Number>>,
}

/// `light.kind`.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum LightKindToml {
    #[default]
    Point,
    Directional,
}

/// `light.falloff`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum FalloffToml {
    None,
    InverseSquare,
}

/// `[[sphere]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as [[sphere]]")]
pub(super) struct SphereToml {
    pub centre: Spanned<Vector>,
    pub radius: Spanned<Number>,
    pub material: Option<Spanned<String>>,
}

/// `[material.NAME]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as [material.glass]")]
pub(super) struct MaterialToml {
    pub kind: Option<MaterialKindToml>,
    pub ior: Option<Spanned<Number>>,
    pub colour: Option<Spanned<Vector>>,
    pub specular: Option<SpecularToml>,
    pub exponent: Option<Spanned<Number>>,
    pub weights: Option<Spanned<[Number; 4]>>,
    pub checker: Option<Spanned<CheckerToml>>,
    pub tinted_shadow: Option<bool>,
    pub roughness: Option<Spanned<Number>>,
}

/// `material.NAME.kind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum MaterialKindToml {
    Lambert,
    Metal,
    Dielectric,
    Mirror,
}

/// `material.NAME.specular`.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum SpecularToml {
    BlinnPhong,
    Phong,
}

/// `material.NAME.checker`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { size = 2.0, other = [0, 0, 0] }")]
pub(super) struct CheckerToml {
    pub size: Number,
    pub other: Spanned<Vector>,
}

/// `[background]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as [background]")]
pub(super) struct BackgroundToml {
    pub colour: Option<Spanned<Vector>>,
    pub sky: Option<Spanned<[Vector; 2]>>,
}

/// `[render]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as [render]")]
pub(super) struct RenderToml {
    pub size: Option<Spanned<Vec<Number>>>,
    pub samples: Option<Spanned<Number>>,
    pub paths: Option<bool>,
    pub max_depth: Option<Spanned<Number>>,
    pub ambient: Option<Spanned<Vector>>,
    pub shadows: Option<bool>,
    #[serde(default)]
    pub filter: FilterToml,
    #[serde(default)]
    pub format: FormatToml,
}

/// `render.format`.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum FormatToml {
    #[default]
    Rgb888,
    Rgb565,
    Gray8,
}

/// `render.filter`.
#[derive(Clone, Copy, Debug, Default, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(super) enum FilterToml {
    #[default]
    Bilinear,
    Nearest,
}

/// A finite number, whole or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Number(pub f64);

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberVisitor;
        impl Visitor<'_> for NumberVisitor {
            type Value = Number;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number")
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Number, E> {
                Ok(Number(value as f64))
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Number, E> {
                if value.is_finite() {
                    Ok(Number(value))
                } else {
                    Err(E::custom(format_args!("{value} is not a finite number")))
                }
            }
        }
        deserializer.deserialize_any(NumberVisitor)
    }
}

/// Three finite numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vector(pub DVec3);

impl<'de> Deserialize<'de> for Vector {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct VectorVisitor;
        impl<'de> Visitor<'de> for VectorVisitor {
            type Value = Vector;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("three numbers such as [0, 1, 5]")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Vector, A::Error> {
                let mut numbers = Vec::new();
                while let Some(Number(number)) = sequence.next_element()? {
                    numbers.push(number);
                }
                match numbers[..] {
                    [x, y, z] => Ok(Vector(DVec3::new(x, y, z))),
                    _ => Err(A::Error::invalid_length(numbers.len(), &self)),
                }
            }
        }
        deserializer.deserialize_any(VectorVisitor)
    }
}
