//! What stands in the header and in the records of shading, from f64.

use core_rt::colour::{Albedo, Radiance, Transfer};
use core_rt::format::Format;
use core_rt::profile::{Need, Needs};
use core_rt::record::{Light, Lustre, Material};
use core_rt::samples::MAX_SAMPLES;
use core_rt::scene::MAX_BRANCHES;
use glam::DVec3;

use super::lustre;
use crate::grid::Grid;
use crate::model::{self, LightKind, Model, Projection};

/// Light as the blob has it; the strongest channel decides the exponent, and weaker ones round to nearest.
pub(super) fn radiance(linear: DVec3) -> Radiance {
    let strongest = linear.max_element();
    if strongest <= 0.0 {
        return Radiance::default();
    }
    // The exponent for which the strongest mantissa is in [2^15, 2^16) after rounding.
    let exponent = Radiance::EXPONENTS
        .clone()
        .find(|&e| strongest * f64::from(1u32 << 16) / libm::exp2(f64::from(e)) < 65_535.5)
        .unwrap_or(*Radiance::EXPONENTS.end());
    let scale = f64::from(1u32 << 16) / libm::exp2(f64::from(exponent));
    Radiance { mantissa: linear.to_array().map(|c| (c * scale + 0.5).floor().min(65_535.0) as u16), exponent }
}

/// A material as the blob has it.
pub(super) fn material(material: &model::Material, lustre: u16) -> Material {
    let albedo = lustre::albedo(material.colour * lustre::diffuse_weight(material));
    Material { emission: radiance(material.emission), albedo, lustre }
}

/// A unit vector in Q30.
pub(super) fn unit_q30(direction: DVec3) -> [i32; 3] {
    let unit = direction.normalize_or_zero().to_array();
    unit.map(|c| (c * f64::from(1u32 << 30) + 0.5).floor() as i32)
}

/// A light as the blob has it.
pub(super) fn light(light: &model::Light, grid: &Grid) -> Light {
    let (kind, place) = match light.kind {
        LightKind::Point(position) => (Light::POINT, grid.place(position)),
        LightKind::Directional(direction) => (Light::DIRECTIONAL, unit_q30(-direction)),
    };
    Light { kind, place, radiance: radiance(light.radiance) }
}

/// What the model needs, widths of indices aside.
pub(super) fn needs(model: &Model, materials: &[Material], lustres: &[Lustre]) -> Needs {
    let shines =
        |phong: bool| lustres.iter().any(|l| !l.specular_is_black() && (l.flags & Lustre::PHONG != 0) == phong);
    let goes_on = |colour: fn(&Lustre) -> Albedo| max_depth(model) > 0 && lustres.iter().any(|l| colour(l) != [0; 3]);
    let any_light = |wanted: fn(&LightKind) -> bool| model.lights.iter().any(|light| wanted(&light.kind));
    Needs::NONE
        .with(Need::PointLight, any_light(|kind| matches!(kind, LightKind::Point(_))))
        .with(Need::DirectionalLight, any_light(|kind| matches!(kind, LightKind::Directional(_))))
        .with(Need::Shadows, !model.lights.is_empty())
        .with(Need::Emission, materials.iter().any(|m| !m.emission.is_black()))
        .with(Need::Ambient, !radiance(model.render.ambient).is_black())
        .with(Need::Srgb, model.render.transfer == model::Transfer::Srgb)
        .with(Need::Linear, model.render.transfer == model::Transfer::Linear)
        .with(format(model.render.format).need(), true)
        .with(Need::Supersampling, samples(model) > 1)
        .with(Need::Orthographic, matches!(model.camera.projection, Projection::Orthographic { .. }))
        .with(Need::BlinnPhong, shines(false))
        .with(Need::Phong, shines(true))
        .with(Need::Reflection, goes_on(|l| l.reflected))
        .with(Need::Refraction, goes_on(|l| l.refracted))
}

/// From how many surfaces a ray may go on.
pub(super) fn max_depth(model: &Model) -> u8 {
    model.render.max_depth.min(MAX_BRANCHES as u32) as u8
}

/// Camera rays a pixel.
pub(super) fn samples(model: &Model) -> u16 {
    model.render.samples.clamp(1, MAX_SAMPLES.into()) as u16
}

/// How pixels lie in memory.
pub(super) const fn format(format: model::Format) -> Format {
    match format {
        model::Format::Rgb888 => Format::Rgb888,
        model::Format::Rgb565 => Format::Rgb565,
        model::Format::Gray8 => Format::Gray8,
    }
}

/// How pixels are encoded.
pub(super) const fn transfer(transfer: model::Transfer) -> Transfer {
    match transfer {
        model::Transfer::Srgb => Transfer::Srgb,
        model::Transfer::Linear => Transfer::Linear,
    }
}
