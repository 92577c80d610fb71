//! What a scene is painted with: textures with their coordinates, and colours of vertices.

use serde::{Deserialize, Serialize};

use crate::blob::{BlobError, Header};
use crate::colour::Albedo;
use crate::profile::{Need, Profile};
use crate::section::{Integers, Reader};
use crate::texture::{Texture, UV_END, Uv};

/// The number of records in each section of paint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct PaintCounts {
    /// Texture coordinates.
    pub uvs: u32,
    /// Colours of vertices.
    pub colours: u32,
    /// Bytes of texels.
    pub texels: u32,
}

/// The sections of paint; all empty for a scene without any.
#[derive(Clone, Copy, Debug)]
pub struct Paint<'a> {
    /// Three texture coordinates a triangle, in the order of the triangles.
    pub uv_indices: Integers<'a>,
    /// Texture coordinates.
    pub uvs: &'a [Uv],
    /// Three colours a triangle, in the order of the triangles.
    pub colour_indices: Integers<'a>,
    /// Colours of vertices.
    pub colours: &'a [Albedo],
    /// The texture of each material.
    pub textures: &'a [Texture],
    /// The texels of all.
    pub texels: &'a [u8],
}

impl<'a> Paint<'a> {
    /// No paint.
    const NONE: Self = Self {
        uv_indices: Integers::Narrow(&[]),
        uvs: &[],
        colour_indices: Integers::Narrow(&[]),
        colours: &[],
        textures: &[],
        texels: &[],
    };

    /// The sections of a scene; `None` where they are not there, or are there in vain.
    pub(crate) fn read<P: Profile>(reader: &mut Reader<'a>, header: &Header) -> Option<Self> {
        let (needs, counts) = (header.needs, &header.counts);
        let (textured, coloured) = (needs.has(Need::Texture), needs.has(Need::VertexColours));
        let PaintCounts { uvs, colours, texels } = counts.paint;
        let consistent = textured == (uvs > 0)
            && textured == (texels > 0)
            && coloured == (colours > 0)
            && (textured || !needs.has(Need::Bilinear));
        if !consistent {
            return None;
        }
        // What the profile lacks the scene was found not to need.
        if !P::NEEDS.paint() {
            return Some(Self::NONE);
        }
        let wide = needs.has(Need::WideUvs);
        let indices = |has: bool| if has { counts.triangles.checked_mul(3) } else { Some(0) };
        Some(Self {
            uv_indices: reader.integers(indices(textured)?, wide)?,
            uvs: reader.records(uvs)?,
            colour_indices: reader.integers(indices(coloured)?, wide)?,
            colours: reader.records(colours)?,
            textures: reader.records(if textured { counts.materials } else { 0 })?,
            texels: reader.records(texels)?,
        })
    }

    /// Checks what the sections of a scene of so many triangles say.
    pub(crate) fn check<P: Profile>(&self, triangles: u32) -> Result<(), BlobError> {
        if let Some(index) = (0..triangles).find(|&index| !self.exists::<P>(index)) {
            return Err(BlobError::Triangle { index });
        }
        if self.in_range() { Ok(()) } else { Err(BlobError::Shading) }
    }

    /// The texture coordinates of a triangle's vertices; `None` where it has none.
    #[inline]
    #[must_use]
    pub fn uvs_of(&self, triangle: u32) -> Option<[Uv; 3]> {
        three(&self.uv_indices, self.uvs, triangle)
    }

    /// The colours of a triangle's vertices; `None` where it has none.
    #[inline]
    #[must_use]
    pub fn colours_of(&self, triangle: u32) -> Option<[Albedo; 3]> {
        three(&self.colour_indices, self.colours, triangle)
    }

    /// Whether the coordinates and the colours of a triangle exist, as far as there are any.
    fn exists<P: Profile>(&self, triangle: u32) -> bool {
        let uvs = || self.uv_indices.is_none(triangle) || self.uvs_of(triangle).is_some();
        (!P::NEEDS.has(Need::Texture) || self.uv_indices.is_empty() || uvs())
            && (!P::NEEDS.has(Need::VertexColours)
                || self.colour_indices.is_empty()
                || self.colours_of(triangle).is_some())
    }

    /// Whether every coordinate is in range and every texture is among the texels.
    fn in_range(&self) -> bool {
        self.uvs.as_flattened().iter().all(|c| (0..UV_END).contains(c))
            && self.textures.iter().all(|texture| texture.is_within(self.texels.len()))
    }
}

/// The records of a triangle's corners.
#[inline]
fn three<T: Copy>(indices: &Integers<'_>, records: &[T], triangle: u32) -> Option<[T; 3]> {
    let [a, b, c] = indices.triple(triangle);
    let record = |i: u32| records.get(i as usize).copied();
    Some([record(a)?, record(b)?, record(c)?])
}
