//! What a material is beyond matt, as the blob has it: the table of `docs/SHADING.md` as numbers.

use core_rt::colour::Albedo;
use core_rt::record::Lustre;
use glam::DVec3;

use crate::model::{Lobe, Material, MaterialKind, Specular};

/// The diffuse share of a material.
pub(super) fn diffuse_weight(material: &Material) -> f64 {
    match (material.weights, material.kind) {
        (Some([diffuse, ..]), _) => diffuse,
        (None, MaterialKind::Lambert) => 1.0,
        (None, MaterialKind::Metal | MaterialKind::Dielectric | MaterialKind::Mirror) => 0.0,
    }
}

/// The lustre of a material; `None` for a matt one.
pub(super) fn lustre(material: &Material) -> Option<Lustre> {
    let Material { kind, colour, ior, .. } = *material;
    // Shares of specular, reflected and refracted light, and where Schlick's law has a say.
    let ([ks, kr, kt], schlick) = match (material.weights, kind) {
        (Some([_, ks, kr, kt]), _) => ([ks, kr, kt], 0),
        (None, MaterialKind::Lambert) => ([1.0, 0.0, 0.0], 0),
        (None, MaterialKind::Metal) => ([1.0, 1.0, 0.0], Lustre::METAL),
        (None, MaterialKind::Mirror) => ([1.0, 1.0, 0.0], 0),
        (None, MaterialKind::Dielectric) => ([1.0, 1.0, 1.0], Lustre::FRESNEL),
    };
    let highlight = material.specular.unwrap_or(Specular { lobe: Lobe::BlinnPhong, exponent: 1, colour: DVec3::ZERO });
    let mirrored = match kind {
        MaterialKind::Metal | MaterialKind::Mirror => colour,
        MaterialKind::Lambert if material.specular.is_some() => highlight.colour,
        MaterialKind::Lambert | MaterialKind::Dielectric => DVec3::ONE,
    };
    let passed = if kind == MaterialKind::Dielectric { colour } else { DVec3::ONE };
    let (tint, gain) = scaled(highlight.colour * ks);
    let whole = if schlick == Lustre::FRESNEL { 1.0 } else { kr + kt };
    let lustre = Lustre {
        eta_q28: [eta(1.0 / ior), eta(ior)],
        specular: tint,
        reflected: albedo(mirrored * kr),
        mirrored: albedo(mirrored * whole),
        refracted: albedo(passed * kt),
        shadow: if material.tinted_shadow { albedo(passed * kt) } else { [0; 3] },
        exponent_q2: (highlight.exponent.min(10_000) * 4) as u16,
        gain,
        flags: if highlight.lobe == Lobe::Phong { Lustre::PHONG } else { 0 } | schlick,
        r0: unit(((ior - 1.0) / (ior + 1.0)).powi(2)),
        roughness: if kr + kt > 0.0 { unit(material.roughness) } else { 0 },
    };
    let is_matt = lustre.specular_is_black() && lustre.reflected == [0; 3] && lustre.refracted == [0; 3];
    (!is_matt).then_some(lustre)
}

/// An index of refraction in Q28: those from 1/10 to 10 fit.
fn eta(ratio: f64) -> u32 {
    (ratio * f64::from(1u32 << 28) + 0.5) as u32
}

/// 65535 for 1.
fn unit(value: f64) -> u16 {
    (value.clamp(0.0, 1.0) * 65_535.0 + 0.5).floor() as u16
}

/// A colour up to 1.
pub(super) fn albedo(colour: DVec3) -> Albedo {
    colour.to_array().map(unit)
}

/// A colour of any strength up to 2^15, and how often it was halved to fit.
fn scaled(colour: DVec3) -> (Albedo, u16) {
    let halvings = (0..15).find(|&n| colour.max_element() <= f64::from(1u32 << n)).unwrap_or(15);
    (albedo(colour / f64::from(1u32 << halvings)), halvings as u16)
}
