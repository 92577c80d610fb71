//! Textures, texture coordinates and colours of vertices as the blob has them.

use std::collections::HashMap;
use std::hash::Hash;
use std::sync::Arc;

use core_rt::colour::Albedo;
use core_rt::paint::PaintCounts;
use core_rt::profile::{Need, Needs};
use core_rt::texture::{self, UV_BITS, UV_END, Uv};
use glam::DVec2;

use super::lustre;
use crate::model::{Filter, Model, Texture};
use crate::textures::Texels;

/// Repeats of a texture across one triangle that a blob holds; one less than its coordinates do, for what is beyond a whole
/// number.
const MOST_REPEATS: i32 = (UV_END >> UV_BITS) - 2;

/// The sections of paint.
#[derive(Debug, Default)]
pub(super) struct Paint {
    pub(super) uv_indices: Vec<u32>,
    pub(super) uvs: Vec<Uv>,
    pub(super) colour_indices: Vec<u32>,
    pub(super) colours: Vec<Albedo>,
    pub(super) textures: Vec<texture::Texture>,
    pub(super) texels: Vec<u8>,
}

impl Paint {
    /// The number of records in each section.
    pub(super) fn counts(&self) -> PaintCounts {
        // A blob of more bytes than 32 bits count is refused.
        PaintCounts { uvs: self.uvs.len() as u32, colours: self.colours.len() as u32, texels: self.texels.len() as u32 }
    }

    /// What it needs, beside what else is needed.
    pub(super) fn needs(&self, others: Needs, filter: Filter) -> Needs {
        let textured = !self.uvs.is_empty();
        // The largest index is kept for triangles without.
        let most = self.uvs.len().max(self.colours.len());
        others
            .with(Need::Texture, textured)
            .with(Need::Bilinear, textured && filter == Filter::Bilinear)
            .with(Need::VertexColours, !self.colours.is_empty())
            .with(Need::WideUvs, most >= 1 << 16)
    }
}

/// The paint of the triangles `ids`, with the model's numbers of the `materials` that the blob has.
pub(super) fn paint(model: &Model, ids: &[u32], materials: &[u32], texels: Texels) -> Paint {
    let (uvs, uv_indices) = coordinates(model, ids);
    let (colours, colour_indices) = colours(model, ids);
    let mut paint = Paint { uv_indices, uvs, colour_indices, colours, ..Paint::default() };
    if paint.uvs.is_empty() {
        return paint;
    }
    let mut known: Vec<(&Arc<Texture>, texture::Texture)> = Vec::new();
    for &material in materials {
        let record = model.materials[material as usize].texture.as_ref().map_or_else(Default::default, |texture| {
            // Materials often share one, and a scene has few.
            if let Some((_, record)) = known.iter().find(|(known, _)| Arc::ptr_eq(known, texture) || known == &texture)
            {
                return *record;
            }
            let record = paint.add(texture, texels);
            known.push((texture, record));
            record
        });
        paint.textures.push(record);
    }
    paint
}

impl Paint {
    /// Adds the texels of a texture.
    fn add(&mut self, texture: &Texture, texels: Texels) -> texture::Texture {
        let first = self.texels.len() as u32;
        let (format, bytes) = texels.encode(texture);
        self.texels.extend(bytes);
        // The importer's bound is core-rt's.
        texture::Texture { first, size: texture.size.map(|side| side as u16), format, reserved: 0 }
    }
}

/// What of a model is drawn without its texture because a blob does not hold so many repeats: a line of text.
#[must_use]
pub fn unplaced(model: &Model) -> Option<String> {
    let count = model.uvs.iter().flatten().filter(|corners| placed(corners).is_none()).count();
    (count > 0)
        .then(|| format!("triangles with over {MOST_REPEATS} repeats of their texture, drawn without it: {count}"))
}

/// Texture coordinates in Q20, each rounded to nearest, less the whole repeats that all three have; `None` where they are too
/// far apart.
fn placed(corners: &[DVec2; 3]) -> Option<[Uv; 3]> {
    let [a, b, c] = *corners;
    let low = a.min(b).min(c).floor();
    let span = a.max(b).max(c) - low;
    if span.max_element() > f64::from(MOST_REPEATS) {
        return None;
    }
    let fixed = |uv: DVec2| (uv - low).to_array().map(|c| (c * f64::from(1 << UV_BITS) + 0.5).floor() as i32);
    Some([fixed(a), fixed(b), fixed(c)])
}

/// The texture coordinates that are used, and three indices a triangle; both empty where no triangle has some.
fn coordinates(model: &Model, ids: &[u32]) -> (Vec<Uv>, Vec<u32>) {
    let mut numbered = Numbered::default();
    let of = |&id: &u32| model.uvs.get(id as usize)?.as_ref().and_then(placed);
    let indices = ids.iter().map(of).flat_map(|uvs| uvs.map_or([u32::MAX; 3], |uvs| uvs.map(|uv| numbered.number(uv))));
    let indices = indices.collect();
    if numbered.records.is_empty() { Default::default() } else { (numbered.records, indices) }
}

/// The colours that are used, and three indices a triangle; both empty where all are white, which changes nothing.
fn colours(model: &Model, ids: &[u32]) -> (Vec<Albedo>, Vec<u32>) {
    if model.colours.is_empty() {
        return Default::default();
    }
    let mut numbered = Numbered::default();
    let corners = ids.iter().flat_map(|&id| model.triangles[id as usize].vertices);
    let indices = corners.map(|vertex| numbered.number(lustre::albedo(model.colours[vertex as usize]))).collect();
    if numbered.records == [[u16::MAX; 3]] { Default::default() } else { (numbered.records, indices) }
}

/// Records without doubles, in the order of their first use.
struct Numbered<T> {
    records: Vec<T>,
    numbers: HashMap<T, u32>,
}

impl<T> Default for Numbered<T> {
    fn default() -> Self {
        Self { records: Vec::new(), numbers: HashMap::new() }
    }
}

impl<T: Copy + Eq + Hash> Numbered<T> {
    fn number(&mut self, record: T) -> u32 {
        *self.numbers.entry(record).or_insert_with(|| {
            self.records.push(record);
            self.records.len() as u32 - 1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_repeats_are_left_out_and_too_many_are_seen() {
        let one = 1 << UV_BITS;
        let at = |corners: [[f64; 2]; 3]| placed(&corners.map(DVec2::from_array));
        assert_eq!(at([[3.5, -2.0], [4.0, -1.0], [3.25, -1.75]]), Some([[one / 2, 0], [one, one], [one / 4, one / 4]]));
        let wide = f64::from(MOST_REPEATS);
        assert_eq!(at([[0.0; 2], [wide, 0.0], [0.0; 2]]).unwrap()[1], [MOST_REPEATS << UV_BITS, 0]);
        assert_eq!(at([[0.5, 0.0], [wide + 0.6, 0.0], [0.5, 0.0]]), None);
        assert_eq!(at([[-1e300, 0.0], [1e300, 0.0], [0.0; 2]]), None);
        assert_eq!(at([[1e300, 0.0]; 3]), Some([[0; 2]; 3]));
        assert!(at([[0.0; 2], [0.0, wide], [0.999_999_9, 0.0]]).unwrap().as_flattened().iter().all(|c| *c < UV_END));
    }
}
