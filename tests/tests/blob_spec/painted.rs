//! Whether a blob is painted as the model is: textures, their coordinates, colours of vertices.

use glam::DVec3;
use host_tools::model::{Filter, Model};

use crate::reader::{Blob, Texture};

/// The bits of needs that paint asks for.
pub(crate) fn needs(blob: &Blob, model: &Model) -> u64 {
    let is_placed = |id: &u32| model.uvs.get(*id as usize).is_some_and(Option::is_some);
    let textured = blob.ids.iter().any(is_placed);
    let bilinear = textured && model.render.filter == Filter::Bilinear;
    let coloured = model.colours.iter().any(|&colour| colour != DVec3::ONE);
    let [.., uv_count, colour_count, _, _, _, _] = blob.header.counts;
    let wide = uv_count.max(colour_count) >= 65_536;
    u64::from(coloured) << 21 | u64::from(textured) << 22 | u64::from(bilinear) << 23 | u64::from(wide) << 24
}

/// Checks the paint of a blob whose triangles agree.
///
/// # Errors
/// What does not agree.
pub(crate) fn is_painted(blob: &Blob, model: &Model) -> Result<(), String> {
    let rule = |holds: bool, what: &str| if holds { Ok(()) } else { Err(String::from(what)) };
    rule(blob.uvs.is_empty() == (blob.header.needs >> 22 & 1 == 0), "textured")?;
    rule(blob.colours.is_empty() == (blob.header.needs >> 21 & 1 == 0), "coloured")?;
    for ((triangle, &id), corners) in blob.triangles.iter().zip(&blob.ids).zip(&blob.uvs) {
        let source = &model.triangles[id as usize];
        let (found, meant) = (corners, model.uvs[id as usize]);
        rule(found.is_some() == meant.is_some(), "which triangles have coordinates")?;
        if let (Some(found), Some(meant)) = (found, meant) {
            rule(found.as_flattened().iter().all(|c| (0..1 << 30).contains(c)), "range of coordinates")?;
            // Whole repeats may be left out, the same of all corners.
            let repeat = f64::from(1 << 20);
            let left_out = |axis: usize| (meant[0][axis] - found[0][axis] as f64 / repeat).round();
            for (found, meant) in found.iter().zip(meant) {
                let close =
                    |axis: usize| ((meant[axis] - left_out(axis)) * repeat - found[axis] as f64).abs() <= 0.5 + 1e-6;
                rule(close(0) && close(1), "coordinates")?;
            }
        }
        let texture = blob.textures[triangle.material as usize];
        let meant = model.materials[source.material as usize].texture.as_ref();
        rule((texture.size != [0; 2]) == meant.is_some(), "which materials have textures")?;
        if let Some(meant) = meant {
            let texels = texels(blob, &texture).ok_or("a format or a place that is none")?;
            rule(texture.size == meant.size.map(u64::from) && texels == meant.texels, "texels")?;
        } else {
            rule(texture == Texture { first: 0, size: [0; 2], format: 0, reserved: 0 }, "a texture that is none")?;
        }
    }
    for (corners, &id) in blob.colours.iter().zip(&blob.ids) {
        for (found, vertex) in corners.iter().zip(model.triangles[id as usize].vertices) {
            let meant = model.colours[vertex as usize].to_array().map(|c| (c * 65_535.0 + 0.5).floor() as u16);
            rule(*found == meant, "colours")?;
        }
    }
    Ok(())
}

/// The texels from the top, as a picture has them.
fn texels(blob: &Blob, texture: &Texture) -> Option<Vec<[u8; 3]>> {
    let [width, height] = texture.size;
    let number = |x: u64, y: u64| (height - 1 - y) * width + x;
    let at = |size: u64, x: u64, y: u64, i: u64| {
        blob.texels.get((texture.first + size * number(x, y) + i) as usize).copied()
    };
    let texel = |x: u64, y: u64| match texture.format {
        0 => Some([at(3, x, y, 0)?, at(3, x, y, 1)?, at(3, x, y, 2)?]),
        2 => at(1, x, y, 0).map(|gray| [gray; 3]),
        _ => None,
    };
    (texture.reserved == 0).then_some(())?;
    (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| texel(x, y)).collect()
}
