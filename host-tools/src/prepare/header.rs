//! What stands in the header and in the records of shading, from f64.

use core_rt::colour::{Albedo, Radiance, Transfer};
use core_rt::format::Format;
use core_rt::profile::{Need, Needs};
use core_rt::record::{Checker, Light, Lustre, Material, Reach};
use core_rt::samples::MAX_SAMPLES;
use core_rt::scene::MAX_BRANCHES;
use glam::DVec3;

use super::lustre;
use crate::grid::Grid;
use crate::model::{self, Background, Falloff, LightKind, Model, Projection};

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
pub(super) fn material(material: &model::Material, lustre: u16, checker: u16) -> Material {
    let albedo = lustre::albedo(material.colour * lustre::diffuse_weight(material));
    Material { emission: radiance(material.emission), albedo, lustre, checker }
}

/// A pattern of cubes as the blob has it. What is finer than a 256th of a grid unit is drawn as fine as that.
pub(super) fn checker(material: &model::Material, grid: &Grid) -> Option<Checker> {
    let model::Checker { size, other } = material.checker?;
    let q63 = libm::exp2(63.0);
    let step = 1.0 / (size * grid.scale * 256.0);
    let start = grid.origin / size;
    Some(Checker {
        step_q63: (step * q63).min(q63) as u64,
        // Modulo 2, in which a u64 wraps.
        start_q63: start.to_array().map(|c| ((c - 2.0 * (c / 2.0).floor()) * q63) as u64),
        other: lustre::albedo(other * lustre::diffuse_weight(material)),
        reserved: 0,
    })
}

/// A unit vector in Q30.
pub(super) fn unit_q30(direction: DVec3) -> [i32; 3] {
    let unit = direction.normalize_or_zero().to_array();
    unit.map(|c| (c * f64::from(1u32 << 30) + 0.5).floor() as i32)
}

/// A light as the blob has it.
pub(crate) fn light(light: &model::Light, grid: &Grid) -> Light {
    let (kind, place) = match light.kind {
        LightKind::Point(position) => (Light::POINT, grid.place(position)),
        LightKind::Directional(direction) => (Light::DIRECTIONAL, unit_q30(-direction)),
    };
    let reach = match (light.kind, light.falloff) {
        (LightKind::Point(_), Falloff::InverseSquare { reach }) => square(reach * grid.scale),
        _ => Reach::default(),
    };
    Light { kind, place, radiance: radiance(light.radiance), reach }
}

/// The square of a distance in grid units, above 0.
fn square(distance: f64) -> Reach {
    let (fraction, exponent) = libm::frexp(distance);
    // In [1/4, 1).
    let (fraction, exponent) = match fraction * fraction {
        square if square < 0.5 => (square * 2.0, 2 * exponent - 1),
        square => (square, 2 * exponent),
    };
    let (least, most) = (i32::from(*Reach::EXPONENTS.start()), i32::from(*Reach::EXPONENTS.end()));
    let mantissa = (fraction * f64::from(1u32 << 16) + 0.5).min(65_535.0) as u16;
    Reach { mantissa, exponent: (exponent - 16).clamp(least, most) as i16 }
}

/// What a ray that hits nothing sees: straight down, and straight up.
pub(super) fn background(model: &Model) -> [Radiance; 2] {
    match model.background {
        Background::Colour(colour) => [radiance(colour); 2],
        Background::Sky { bottom, top } => [bottom, top].map(radiance),
    }
}

/// Light that reaches everything; none where paths gather what it stands for.
pub(super) fn ambient(model: &Model) -> Radiance {
    if model.render.paths { Radiance::default() } else { radiance(model.render.ambient) }
}

/// What the model needs, widths of indices aside.
pub(super) fn needs(model: &Model, materials: &[Material], lustres: &[Lustre]) -> Needs {
    let shines =
        |phong: bool| lustres.iter().any(|l| !l.specular_is_black() && (l.flags & Lustre::PHONG != 0) == phong);
    let [bottom, top] = background(model);
    // Where rays may not go on, the background is seen instead of what they would see.
    let is_seen = max_depth(model) > 0 || !bottom.is_black() || !top.is_black();
    let goes_on = |colour: fn(&Lustre) -> Albedo| is_seen && lustres.iter().any(|l| colour(l) != [0; 3]);
    let (reflects, refracts) = (goes_on(|l| l.reflected), goes_on(|l| l.refracted));
    let shadows = model.render.shadows && !model.lights.is_empty();
    let fades = |light: &model::Light| {
        matches!((light.kind, light.falloff), (LightKind::Point(_), Falloff::InverseSquare { .. }))
    };
    let any_light = |wanted: fn(&LightKind) -> bool| model.lights.iter().any(|light| wanted(&light.kind));
    Needs::NONE
        .with(Need::PointLight, any_light(|kind| matches!(kind, LightKind::Point(_))))
        .with(Need::DirectionalLight, any_light(|kind| matches!(kind, LightKind::Directional(_))))
        .with(Need::Shadows, shadows)
        .with(Need::SeveralLights, model.lights.len() > 1)
        .with(Need::Emission, materials.iter().any(|m| !m.emission.is_black()))
        .with(Need::Ambient, !ambient(model).is_black())
        .with(Need::Srgb, model.render.transfer == model::Transfer::Srgb)
        .with(Need::Linear, model.render.transfer == model::Transfer::Linear)
        .with(format(model.render.format).need(), true)
        .with(Need::Supersampling, samples(model) > 1 && !model.render.paths)
        .with(Need::Orthographic, matches!(model.camera.projection, Projection::Orthographic { .. }))
        .with(Need::BlinnPhong, shines(false))
        .with(Need::Phong, shines(true))
        // What would pass a surface, and cannot, is mirrored.
        .with(Need::Reflection, reflects || refracts)
        .with(Need::Refraction, refracts)
        .with(Need::Bounces, (reflects || refracts) && max_depth(model) > 0 && !model.render.paths)
        .with(Need::Paths, model.render.paths)
        .with(Need::Roughness, (reflects || refracts) && lustres.iter().any(|l| l.roughness != 0))
        .with(Need::Schlick, lustres.iter().any(|l| l.flags & (Lustre::FRESNEL | Lustre::METAL) != 0))
        .with(Need::TintedShadow, shadows && lustres.iter().any(|l| l.shadow != [0; 3]))
        .with(Need::Checker, materials.iter().any(|m| m.checker != 0))
        .with(Need::Falloff, model.lights.iter().any(fades))
        .with(Need::Sky, bottom != top)
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
pub(crate) const fn transfer(transfer: model::Transfer) -> Transfer {
    match transfer {
        model::Transfer::Srgb => Transfer::Srgb,
        model::Transfer::Linear => Transfer::Linear,
    }
}
