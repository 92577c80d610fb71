//! The blob's bytes. `docs/BLOB.md` specifies them; `core_rt::blob` reads them.

use core_rt::arithmetic::Arithmetic;
use core_rt::blob::{Counts, Header, MAGIC, PREFIX_SIZE, Prefix, SourceGrid, TRAILER_SIZE, VERSION, crc32};
use core_rt::kernel::Kernel;
use core_rt::profile::Need;
use core_rt::record::{Checker, Lustre, Material, Record};
use core_rt::section::ALIGN;
use core_rt::space::Space;
use zerocopy::IntoBytes;

use super::paint::Paint;
use super::shared::Shared;
use super::{PrepareError, camera, header};
use crate::compacted::Compacted;
use crate::grid::Grid;
use crate::model::Model;

/// A blob in memory, 8-aligned.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Blob {
    words: Vec<u64>,
    size: usize,
}

impl Blob {
    /// Copies bytes of any alignment, of any length.
    #[must_use]
    pub fn from_bytes(bytes: &[u8]) -> Self {
        let mut words = vec![0; bytes.len().div_ceil(ALIGN)];
        words.as_mut_bytes()[..bytes.len()].copy_from_slice(bytes);
        Self { words, size: bytes.len() }
    }

    /// The bytes.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.words.as_bytes()[..self.size]
    }
}

/// What the tree's builder and the kernel made, in the order of the blob.
pub(super) struct Parts<'a, N, T, S> {
    pub(super) root: u32,
    pub(super) depth: u8,
    pub(super) arithmetic: Arithmetic,
    /// Where ids stand in records: the bits below them, of the material.
    pub(super) material_bits: Option<u8>,
    pub(super) nodes: N,
    pub(super) triangles: T,
    /// The vertices that triangles share and their three each, where they have no records.
    pub(super) shared: Option<Shared>,
    pub(super) spheres: S,
    /// The file's number of each triangle.
    pub(super) ids: &'a [u32],
    /// The file's number of each sphere, behind all triangles.
    pub(super) sphere_ids: &'a [u32],
    pub(super) materials: &'a [Material],
    pub(super) lustres: &'a [Lustre],
    pub(super) checkers: &'a [Checker],
    pub(super) paint: Paint,
}

/// Memory of a blob's size, filled section by section: records go straight to their place.
struct Writer {
    words: Vec<u64>,
    used: usize,
}

impl Writer {
    fn with_capacity(bytes: usize) -> Self {
        Self { words: vec![0; bytes / ALIGN], used: 0 }
    }

    fn bytes(&mut self, bytes: &[u8]) {
        self.words.as_mut_bytes()[self.used..][..bytes.len()].copy_from_slice(bytes);
        self.used += bytes.len();
    }

    /// A section; what pads it to a multiple of 8 is zero already.
    fn records<T: Record>(&mut self, records: impl Iterator<Item = T>) {
        for record in records {
            self.bytes(record.as_bytes());
        }
        self.used = self.used.next_multiple_of(ALIGN);
    }

    fn integers(&mut self, values: impl Iterator<Item = u32>, wide: bool) {
        if wide { self.records(values) } else { self.records(values.map(|value| value as u16)) }
    }

    /// Closes the blob by its checksum, in its last four bytes.
    fn close(mut self) -> Blob {
        let size = size_of_val(self.words.as_slice());
        let checksum = crc32(&self.words.as_bytes()[..size - 4]);
        self.words.as_mut_bytes()[size - 4..].copy_from_slice(&checksum.to_le_bytes());
        Blob { words: self.words, size }
    }
}

/// Writes the blob.
pub(super) fn write<K: Kernel>(
    model: &Model,
    grid: &Grid,
    parts: Parts<
        '_,
        impl ExactSizeIterator<Item = K::Node>,
        impl ExactSizeIterator<Item = K::Triangle>,
        impl ExactSizeIterator<Item = K::Sphere>,
    >,
) -> Result<Blob, PrepareError> {
    let normals = Normals::of(model, parts.ids);
    let smooth = if normals.count() > 0 { parts.ids } else { &[] };
    let (vertices, shared_corners, numbers): (&[_], &[_], &[_]) = match &parts.shared {
        Some(shared) => (&shared.vertices, &shared.corners, shared.numbers(parts.materials.len())),
        None => (&[], &[], &[]),
    };
    let lights: Vec<_> = model.lights.iter().map(|light| header::light(light, grid)).collect();
    let wide_ids = model.triangles.len() + model.spheres.len() > 1 << 16;
    let [ids, sphere_ids] =
        if parts.material_bits.is_some() { [[].as_slice(); 2] } else { [parts.ids, parts.sphere_ids] };
    // The largest index is kept for flat triangles.
    let wide_normals = normals.count() >= 1 << 16;
    let needs = header::needs(model, parts.materials, parts.lustres)
        .with(Need::WholeTriangles, parts.triangles.len() > 0)
        .with(Need::SharedVertices, parts.shared.is_some())
        .with(Need::SmoothNormals, !smooth.is_empty())
        .with(Need::Spheres, !parts.sphere_ids.is_empty())
        .with(Need::Ids, parts.material_bits.is_none())
        .with(Need::IdsInRecords, parts.material_bits.is_some())
        .with(Need::WideIds, wide_ids && parts.material_bits.is_none())
        .with(Need::WideNormals, wide_normals);
    let needs = parts.paint.needs(needs, model.render.filter);
    let wide_uvs = needs.has(Need::WideUvs);
    let header = Header {
        needs,
        // Pictures are at most 2^14 a side: the importer's bound.
        size: model.render.size.map(|s| s.min(u16::MAX.into()) as u16),
        camera: camera::camera::<K>(model, grid),
        background: header::background(model),
        ambient: header::ambient(model),
        transfer: header::transfer(model.render.transfer),
        format: header::format(model.render.format),
        samples: header::samples(model),
        max_depth: if needs.branches() || model.render.paths { header::max_depth(model) } else { 0 },
        root: parts.root,
        depth: parts.depth,
        counts: Counts {
            nodes: parts.nodes.len() as u32,
            triangles: parts.ids.len() as u32,
            vertices: vertices.len() as u32,
            spheres: parts.spheres.len() as u32,
            smooth: smooth.len() as u32,
            normals: normals.count() as u32,
            paint: parts.paint.counts(),
            materials: parts.materials.len() as u32,
            lustres: parts.lustres.len() as u32,
            checkers: parts.checkers.len() as u32,
            lights: lights.len() as u32,
        },
        file_triangles: model.triangles.len() as u32,
        file_spheres: model.spheres.len() as u32,
        material_bits: parts.material_bits.unwrap_or(0),
        arithmetic: parts.arithmetic,
        source: SourceGrid { origin_bits: grid.origin.to_array().map(f64::to_bits), scale_bits: grid.scale.to_bits() },
    };
    let wide_corners = parts.shared.as_ref().is_some_and(Shared::wide_corners);
    let wide_numbers = parts.materials.len() > 1 << 16;
    let encoded = postcard::to_stdvec(&header).unwrap_or_default();
    let integer = |wide: bool| if wide { 4 } else { 2 };
    let total: usize = [
        PREFIX_SIZE,
        encoded.len(),
        parts.nodes.len() * size_of::<K::Node>(),
        parts.triangles.len() * size_of::<K::Triangle>(),
        shared_corners.len() * integer(wide_corners),
        vertices.len() * size_of::<K::Vertex>(),
        numbers.len() * integer(wide_numbers),
        parts.spheres.len() * size_of::<K::Sphere>(),
        (ids.len() + sphere_ids.len()) * integer(wide_ids),
        3 * smooth.len() * integer(wide_normals),
        normals.count() * size_of::<<K::Space as Space>::Normal>(),
        parts.paint.uv_indices.len() * integer(wide_uvs),
        size_of_val(parts.paint.uvs.as_slice()),
        parts.paint.colour_indices.len() * integer(wide_uvs),
        size_of_val(parts.paint.colours.as_slice()),
        size_of_val(parts.paint.textures.as_slice()),
        parts.paint.texels.len(),
        size_of_val(parts.materials),
        size_of_val(parts.lustres),
        size_of_val(parts.checkers),
        size_of_val(lights.as_slice()),
        TRAILER_SIZE,
    ]
    .into_iter()
    .map(|size| size.next_multiple_of(ALIGN))
    .sum();
    let total_size = u32::try_from(total).map_err(|_| PrepareError::TooLarge { bytes: total as u64 })?;
    let prefix = Prefix {
        magic: MAGIC,
        version: VERSION,
        kernel: K::ID,
        header_size: encoded.len() as u32,
        total_size,
        reserved: 0,
    };
    let mut writer = Writer::with_capacity(total);
    writer.bytes(prefix.as_bytes());
    writer.records(encoded.into_iter());
    writer.records(parts.nodes);
    writer.records(parts.triangles);
    writer.integers(shared_corners.iter().copied(), wide_corners);
    writer.records(vertices.iter().map(|&vertex| K::vertex(vertex)));
    writer.integers(numbers.iter().copied(), wide_numbers);
    writer.records(parts.spheres);
    writer.integers(ids.iter().chain(sphere_ids).copied(), wide_ids);
    writer.integers(normals.corners(smooth), wide_normals);
    writer.records(normals.records::<K>());
    writer.integers(parts.paint.uv_indices.into_iter(), wide_uvs);
    writer.records(parts.paint.uvs.into_iter());
    writer.integers(parts.paint.colour_indices.into_iter(), wide_uvs);
    writer.records(parts.paint.colours.into_iter());
    writer.records(parts.paint.textures.into_iter());
    writer.records(parts.paint.texels.into_iter());
    writer.records(parts.materials.iter().copied());
    writer.records(parts.lustres.iter().copied());
    writer.records(parts.checkers.iter().copied());
    writer.records(lights.into_iter());
    Ok(writer.close())
}

/// The normals of triangles, each numbered once; records and indices are made as they are written.
struct Normals<'m> {
    model: &'m Model,
    used: Compacted,
}

impl<'m> Normals<'m> {
    /// Those of some triangles.
    fn of(model: &'m Model, ids: &[u32]) -> Self {
        let mut used = Compacted::default();
        for normal in ids.iter().filter_map(|&id| model.triangles[id as usize].normals).flatten() {
            used.number(normal as usize);
        }
        Self { model, used }
    }

    /// How many there are.
    fn count(&self) -> usize {
        self.used.used().len()
    }

    /// Three indices for each of the triangles.
    fn corners(&self, ids: &[u32]) -> impl Iterator<Item = u32> {
        let corners = |&id: &u32| self.model.triangles[id as usize].normals;
        let number = |normal: u32| self.used.get(normal as usize);
        ids.iter().flat_map(move |id| corners(id).map_or([u32::MAX; 3], |normals| normals.map(number)))
    }

    fn records<K: Kernel>(&self) -> impl Iterator<Item = <K::Space as Space>::Normal> {
        self.used.used().map(|normal| K::Space::normal(header::unit_q30(self.model.normals[normal])))
    }
}
