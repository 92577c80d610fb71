//! How surfaces and lights look: the tables of `docs/SHADING.md` and `docs/BLOB.md` as formulas.

use glam::DVec3;
use host_tools::model::{Background, Falloff, LightKind, Lobe, Material, MaterialKind, Model};

use crate::agree::{Checked, rule};
use crate::reader::{Blob, Checker, Lustre};

const SPECULAR: usize = 0;
const REFLECTED: usize = 1;
const MIRRORED: usize = 2;
const REFRACTED: usize = 3;
const SHADOW: usize = 4;

fn used(model: &Model) -> impl Iterator<Item = &Material> {
    let of_triangles = |number| model.triangles.iter().any(|t| t.material as usize == number);
    let used =
        move |&number: &usize| of_triangles(number) || model.spheres.iter().any(|s| s.material as usize == number);
    (0..model.materials.len()).filter(used).map(|number| &model.materials[number])
}

/// The columns kd, ks, kr, kt of the table of kinds; of glass, what Schlick's F and 1 - F are multiplied by.
fn weights(material: &Material) -> [f64; 4] {
    material.weights.unwrap_or(match material.kind {
        MaterialKind::Lambert => [1.0, 1.0, 0.0, 0.0],
        MaterialKind::Metal | MaterialKind::Mirror => [0.0, 1.0, 1.0, 0.0],
        MaterialKind::Dielectric => [0.0, 1.0, 1.0, 1.0],
    })
}

fn is(kind: MaterialKind, material: &Material) -> bool {
    material.weights.is_none() && material.kind == kind
}

/// The bits of `needs` that follow from looks.
pub(crate) fn needs(blob: &Blob, model: &Model) -> u64 {
    let share = |index: usize| used(model).any(|m| weights(m)[index] > 0.0);
    let lobe = |lobe| {
        used(model)
            .any(|m| m.specular.is_some_and(|s| s.lobe == lobe && s.colour != DVec3::ZERO && weights(m)[1] > 0.0))
    };
    let is_dark = |colour: DVec3| colour == DVec3::ZERO;
    let is_dark = match model.background {
        Background::Colour(colour) => is_dark(colour),
        Background::Sky { bottom, top } => is_dark(bottom) && is_dark(top),
    };
    let goes_on = blob.header.max_depth > 0 || !is_dark;
    let fades =
        |light: &host_tools::model::Light| matches!(light.kind, LightKind::Point(_)) && light.falloff != Falloff::None;
    let schlick = used(model).any(|m| is(MaterialKind::Dielectric, m) || is(MaterialKind::Metal, m));
    let tinted = used(model).any(|m| m.tinted_shadow && weights(m)[3] > 0.0);
    [
        (10, lobe(Lobe::BlinnPhong)),
        (11, lobe(Lobe::Phong)),
        (12, goes_on && share(2)),
        (13, goes_on && share(3)),
        (15, model.lights.iter().any(fades)),
        (16, matches!(model.background, Background::Sky { .. })),
        (17, used(model).any(|m| m.checker.is_some())),
        (18, tinted && !model.lights.is_empty() && model.render.shadows),
        (28, schlick),
        (30, model.lights.len() > 1),
        (32, blob.header.max_depth > 0 && (share(2) || share(3)) && !model.render.paths),
        (35, model.render.paths),
        (36, goes_on && used(model).any(|m| m.roughness > 0.0 && weights(m)[2] + weights(m)[3] > 0.0)),
    ]
    .into_iter()
    .fold(0, |bits, (bit, is_needed)| bits | u64::from(is_needed) << bit)
}

/// Whether a colour of the blob is one of the model, to the nearest.
fn colour(found: [u16; 3], meant: DVec3, gain: u16) -> bool {
    let unit = f64::from(1_u32 << gain) / 65_535.0;
    found.iter().zip(meant.to_array()).all(|(&f, m)| (f64::from(f) * unit - m).abs() <= unit * 0.500_001)
}

/// Checks the looks of all surfaces.
pub(crate) fn agree(blob: &Blob, model: &Model) -> Checked {
    let reflects = used(model).any(|m| weights(m)[2..].iter().any(|&share| share > 0.0));
    let depth = if reflects || model.render.paths { model.render.max_depth.min(64) } else { 0 };
    rule(u32::from(blob.header.max_depth) == depth, "depth of reflections")?;
    let triangles =
        blob.triangles.iter().zip(&blob.ids).map(|(t, &id)| (t.material, model.triangles[id as usize].material));
    let sphere_ids = blob.ids[blob.triangles.len()..].iter().map(|&id| id as usize - model.triangles.len());
    let spheres = blob.spheres.iter().zip(sphere_ids).map(|(s, id)| (s.material, model.spheres[id].material));
    for (number, source) in triangles.chain(spheres) {
        let (found, meant) = (&blob.materials[number as usize], &model.materials[source as usize]);
        rule(colour(found.albedo, meant.colour * weights(meant)[0], 0), "albedo")?;
        match (usize::from(found.lustre), usize::from(found.checker)) {
            (0, _) => rule(is_matt(meant), "a matt surface")?,
            (number, _) => lustre(blob.lustres.get(number - 1).ok_or("a lustre that is not there")?, meant)?,
        }
        match usize::from(found.checker) {
            0 => rule(meant.checker.is_none(), "a surface of one colour")?,
            number => checker(blob, blob.checkers.get(number - 1).ok_or("a checker that is not there")?, meant)?,
        }
    }
    for (light, meant) in blob.lights.iter().zip(&model.lights) {
        let (mantissa, exponent) = light.reach;
        let square = f64::from(mantissa) * 2_f64.powi(exponent as i32);
        let holds = match (meant.kind, meant.falloff) {
            (LightKind::Point(_), Falloff::InverseSquare { reach }) => {
                let meant = (reach * blob.header.scale).powi(2);
                mantissa >> 15 == 1 && (square / meant - 1.0).abs() < 2_f64.powi(-15)
            }
            _ => (mantissa, exponent) == (0, 0),
        };
        rule(holds, "reach of a light")?;
    }
    Ok(())
}

fn is_matt(material: &Material) -> bool {
    let [_, ks, kr, kt] = weights(material);
    let shines = ks > 0.0 && material.specular.is_some_and(|s| s.colour != DVec3::ZERO);
    !shines && kr == 0.0 && kt == 0.0
}

fn lustre(found: &Lustre, meant: &Material) -> Checked {
    let [_, ks, kr, kt] = weights(meant);
    let of_kind = |kind| meant.kind == kind;
    let tint = match meant.specular {
        _ if of_kind(MaterialKind::Metal) || of_kind(MaterialKind::Mirror) => meant.colour,
        Some(specular) if of_kind(MaterialKind::Lambert) => specular.colour,
        _ => DVec3::ONE,
    };
    let passed = if of_kind(MaterialKind::Dielectric) { meant.colour } else { DVec3::ONE };
    let all = if is(MaterialKind::Dielectric, meant) { 1.0 } else { kr + kt };
    let specular = meant.specular.map_or(DVec3::ZERO, |s| s.colour) * ks;
    rule(found.gain <= 15 && colour(found.colours[SPECULAR], specular, found.gain), "highlights")?;
    rule(colour(found.colours[REFLECTED], tint * kr, 0), "mirror image")?;
    rule(colour(found.colours[MIRRORED], tint * all, 0), "mirror image of all light")?;
    rule(colour(found.colours[REFRACTED], passed * kt, 0), "what passes")?;
    let shadow = if meant.tinted_shadow { passed * kt } else { DVec3::ZERO };
    rule(colour(found.colours[SHADOW], shadow, 0), "shadow")?;
    if let Some(specular) = meant.specular {
        rule(u32::from(found.exponent) == 4 * specular.exponent.min(10_000), "exponent")?;
    }
    let phong = meant.specular.is_some_and(|s| s.lobe == Lobe::Phong);
    let flags = [(1, phong), (2, is(MaterialKind::Dielectric, meant)), (4, is(MaterialKind::Metal, meant))];
    let flags = flags.into_iter().fold(0, |flags, (flag, is_set)| flags | if is_set { flag } else { 0 });
    rule(found.flags == flags, "flags")?;
    let roughness = if kr + kt > 0.0 { meant.roughness } else { 0.0 };
    rule((f64::from(found.roughness) - 65_535.0 * roughness).abs() <= 0.5, "roughness")?;
    let [entering, leaving] = found.eta.map(|eta| f64::from(eta) / 2_f64.powi(28));
    let close = |found: f64, meant: f64| (found - meant).abs() <= 2_f64.powi(-28);
    rule(close(entering, 1.0 / meant.ior) && close(leaving, meant.ior), "index of refraction")?;
    let root = (meant.ior - 1.0) / (meant.ior + 1.0);
    rule((f64::from(found.r0) / 65_535.0 - root * root).abs() < 2_f64.powi(-16), "r0")
}

fn checker(blob: &Blob, found: &Checker, meant: &Material) -> Checked {
    let pattern = meant.checker.ok_or("a checker where there is none")?;
    rule(colour(found.other, pattern.other * weights(meant)[0], 0) && found.reserved == 0, "colour of odd cubes")?;
    let unit = 2_f64.powi(63);
    let step = 1.0 / (256.0 * blob.header.scale * pattern.size);
    rule((found.step as f64 / unit / step - 1.0).abs() < 2_f64.powi(-20), "size of cubes")?;
    for axis in 0..3 {
        let off = found.start[axis] as f64 / unit - blob.header.origin[axis] / pattern.size;
        // A whole number of pairs of cubes apart.
        rule((off / 2.0 - (off / 2.0).round()).abs() < 2_f64.powi(-40), "start of cubes")?;
    }
    Ok(())
}
