//! Kernels by name: what the command line can ask of each, behind one interface.

use std::collections::BTreeMap;
use std::hint::black_box;
use std::marker::PhantomData;
use std::time::Instant;

use core_rt::blob::{BlobError, Header};
use core_rt::exact::{Exact14, Exact20, Exact29};
use core_rt::hanika::{HanikaC, HanikaCd, HanikaCons};
use core_rt::profile::Full;
use core_rt::scene::Scene;
use exact_simd::{ByEights, Eights, Tree};
use float_rt::{Float32, Float64};

use crate::grid::Grid;
use crate::model::Model;
use crate::needs::{self, Asked};
use crate::planes::engine::Planes12;
use crate::prepare::{self, Options, PrepareError, Prepared};
use crate::render::{self, Progress, Rendered};
use crate::stage::{Stage, Staged};
use crate::trace::{Measure, Trace, Tracer};
use crate::witness::Seen;

/// What can be done with a kernel.
pub trait Engine: Sync + std::fmt::Debug {
    /// The kernel's name.
    fn name(&self) -> &'static str;
    /// The kernel's number in a blob.
    fn id(&self) -> u16;
    /// The bits of its grid.
    fn grid_bits(&self) -> u32;
    /// The least radius of a sphere, grid units.
    fn radius_min(&self) -> i32;
    /// The grid that it has for a model, the finest or one of so many bits.
    ///
    /// # Errors
    /// Where it has none.
    fn grid(&self, model: &Model, bits: Option<u32>) -> Result<Grid, PrepareError>;
    /// A model as a blob.
    ///
    /// # Errors
    /// Where the kernel cannot hold it.
    fn prepare(&self, model: &Model, options: &Options) -> Result<Prepared, PrepareError>;
    /// What a model loses on a grid, a sentence each.
    fn losses(&self, model: &Model, grid: &Grid) -> Vec<String> {
        let losses = prepare::losses(self.name(), self.grid_bits(), self.radius_min(), model, grid);
        losses.iter().map(ToString::to_string).collect()
    }
    /// The header and the sizes of a blob, checked as the device checks it.
    ///
    /// # Errors
    /// Where the blob is not one for this kernel.
    fn inspect(&self, blob: &[u8]) -> Result<(Header, Sizes), BlobError>;
    /// What in a blob asks for each of its needs, and a triangle or a sphere of the file for each material.
    ///
    /// # Errors
    /// Where the blob is not one for this kernel.
    fn asked(&self, blob: &[u8]) -> Result<(Vec<Asked>, BTreeMap<u32, u32>), BlobError>;
    /// The picture of a blob.
    ///
    /// # Errors
    /// Where the blob is not one for this kernel.
    fn render(&self, blob: &[u8], tile: [u16; 2], progress: Progress<'_>) -> Result<Rendered, BlobError>;
    /// The same, by the machine's vector units where the kernel has a way; box and triangle tests are counted as they are made.
    ///
    /// # Errors
    /// Where the blob is not one for this kernel.
    fn render_in_lanes(&self, blob: &[u8], tile: [u16; 2], progress: Progress<'_>) -> Result<Rendered, BlobError> {
        self.render(blob, tile, progress)
    }
    /// The vector units of [`Engine::render_in_lanes`]; `None` where there are none for this kernel.
    fn lanes(&self) -> Option<&'static str> {
        None
    }
    /// The picture, and what the rays of each pixel saw, row by row.
    ///
    /// # Errors
    /// Where the blob is not one for this kernel.
    fn witness(&self, blob: &[u8], tile: [u16; 2], progress: Progress<'_>) -> Result<(Rendered, Vec<Seen>), BlobError>;
    /// Seconds that drawing a blob takes, on the threads of the current rayon pool; checking it beforehand is not counted.
    ///
    /// # Errors
    /// Where the blob is not one for this kernel.
    fn seconds(&self, blob: &[u8], tile: [u16; 2]) -> Result<f64, BlobError>;
    /// What finds the nearest hits in a blob's scene.
    ///
    /// # Errors
    /// Where the blob is not one for this kernel, or its header does not say where its grid is.
    fn tracer<'a>(&self, blob: &'a [u8]) -> Result<Box<dyn Trace + 'a>, BlobError>;
    /// What draws a blob's scene through other cameras than its own.
    ///
    /// # Errors
    /// Where the blob is not one for this kernel, or its header does not say where its grid is.
    fn stage<'a>(&self, blob: &'a [u8]) -> Result<Box<dyn Stage + 'a>, BlobError>;
}

/// Bytes of each section, padding left out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct Sizes {
    /// Tree nodes.
    pub nodes: u64,
    /// Triangles with their vertices.
    pub triangles: u64,
    /// Spheres.
    pub spheres: u64,
    /// File-order ids.
    pub ids: u64,
    /// Normals and their indices.
    pub normals: u64,
    /// Texture coordinates and colours of vertices, with their indices.
    pub paint: u64,
    /// Texels.
    pub texels: u64,
    /// Materials and lights.
    pub shading: u64,
}

/// A kernel with its way to draw by vector units; in place where it has none.
trait Lanes: Measure {
    fn unit() -> Option<&'static str> {
        None
    }

    fn render(blob: &[u8], tile: [u16; 2], progress: Progress<'_>) -> Result<Rendered, BlobError> {
        Ok(render::render(&Scene::<Full<Self>>::new_checked(blob)?, tile, progress))
    }
}

impl Lanes for Exact29 {
    fn unit() -> Option<&'static str> {
        exact_simd::unit()
    }

    fn render(blob: &[u8], tile: [u16; 2], progress: Progress<'_>) -> Result<Rendered, BlobError> {
        let mut scene = Scene::<ByEights>::new_checked(blob)?;
        let tree = Tree::new(&scene.bvh);
        scene.walk = Eights::new(tree.as_ref(), &scene);
        Ok(render::render(&scene, tile, progress))
    }
}

impl Lanes for Exact20 {}
impl Lanes for Exact14 {}
impl Lanes for HanikaC {}
impl Lanes for HanikaCd {}
impl Lanes for HanikaCons {}
impl Lanes for Float32 {}
impl Lanes for Float64 {}

#[derive(Debug)]
struct Of<K>(PhantomData<K>);

impl<K: Lanes + std::fmt::Debug> Engine for Of<K> {
    fn name(&self) -> &'static str {
        K::NAME
    }

    fn id(&self) -> u16 {
        K::ID
    }

    fn grid_bits(&self) -> u32 {
        K::GRID_BITS
    }

    fn radius_min(&self) -> i32 {
        K::RADIUS_MIN
    }

    fn grid(&self, model: &Model, bits: Option<u32>) -> Result<Grid, PrepareError> {
        prepare::grid::<K>(model, bits)
    }

    fn prepare(&self, model: &Model, options: &Options) -> Result<Prepared, PrepareError> {
        prepare::prepare::<K>(model, options)
    }

    fn inspect(&self, blob: &[u8]) -> Result<(Header, Sizes), BlobError> {
        let scene = Scene::<Full<K>>::new_checked(blob)?;
        let sizes = Sizes {
            nodes: size_of_val(scene.bvh.nodes) as u64,
            triangles: scene.bvh.triangles.bytes() as u64,
            spheres: size_of_val(scene.bvh.spheres) as u64,
            ids: scene.bvh.ids.size() as u64,
            normals: (size_of_val(scene.shading.normals) + scene.shading.normal_indices.size()) as u64,
            paint: (scene.shading.paint.uv_indices.size()
                + size_of_val(scene.shading.paint.uvs)
                + scene.shading.paint.colour_indices.size()
                + size_of_val(scene.shading.paint.colours)) as u64,
            texels: scene.shading.paint.texels.len() as u64,
            shading: (size_of_val(scene.shading.materials) + size_of_val(scene.shading.lights)) as u64,
        };
        Ok((Scene::<Full<K>>::header(blob)?, sizes))
    }

    fn asked(&self, blob: &[u8]) -> Result<(Vec<Asked>, BTreeMap<u32, u32>), BlobError> {
        let scene = Scene::<Full<K>>::new_checked(blob)?;
        Ok((needs::asked(&scene, &Scene::<Full<K>>::header(blob)?), needs::bearers(&scene)))
    }

    fn render(&self, blob: &[u8], tile: [u16; 2], progress: Progress<'_>) -> Result<Rendered, BlobError> {
        Ok(render::render(&Scene::<Full<K>>::new_checked(blob)?, tile, progress))
    }

    fn render_in_lanes(&self, blob: &[u8], tile: [u16; 2], progress: Progress<'_>) -> Result<Rendered, BlobError> {
        <K as Lanes>::render(blob, tile, progress)
    }

    fn lanes(&self) -> Option<&'static str> {
        K::unit()
    }

    fn witness(&self, blob: &[u8], tile: [u16; 2], progress: Progress<'_>) -> Result<(Rendered, Vec<Seen>), BlobError> {
        Ok(render::witness(&Scene::<Full<K>>::new_checked(blob)?, tile, progress))
    }

    fn seconds(&self, blob: &[u8], tile: [u16; 2]) -> Result<f64, BlobError> {
        let scene = Scene::<Full<K>>::new_checked(blob)?;
        let begin = Instant::now();
        black_box(render::render(&scene, tile, &|_| ()));
        Ok(begin.elapsed().as_secs_f64())
    }

    fn tracer<'a>(&self, blob: &'a [u8]) -> Result<Box<dyn Trace + 'a>, BlobError> {
        let source = Scene::<Full<K>>::header(blob)?.source;
        let tracer = Tracer::<K>::new(Scene::new_checked(blob)?, &source).ok_or(BlobError::Header)?;
        Ok(Box::new(tracer))
    }

    fn stage<'a>(&self, blob: &'a [u8]) -> Result<Box<dyn Stage + 'a>, BlobError> {
        let header = Scene::<Full<K>>::header(blob)?;
        let staged = Staged::<K>::new(Scene::new_checked(blob)?, &header).ok_or(BlobError::Header)?;
        Ok(Box::new(staged))
    }
}

/// All kernels, the default of `render` first.
pub const ENGINES: [&dyn Engine; 8] = [
    &Of::<Exact29>(PhantomData),
    &Of::<Exact20>(PhantomData),
    &Of::<Exact14>(PhantomData),
    &Of::<HanikaC>(PhantomData),
    &Of::<HanikaCd>(PhantomData),
    &Of::<HanikaCons>(PhantomData),
    &Of::<Float32>(PhantomData),
    &Of::<Float64>(PhantomData),
];

/// The tracer of 1994, apart from those that take any scene: it has spheres alone.
pub const PLANES12: &dyn Engine = &Planes12;

/// The kernel of a name.
#[must_use]
pub fn by_name(name: &str) -> Option<&'static dyn Engine> {
    ENGINES.into_iter().chain([PLANES12]).find(|engine| engine.name() == name)
}

/// The kernel of a number, as a blob has it.
#[must_use]
pub fn by_id(id: u16) -> Option<&'static dyn Engine> {
    ENGINES.into_iter().find(|engine| engine.id() == id)
}
