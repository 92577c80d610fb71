//! A scene: a view of a blob, checked once and read in place.

use crate::blob::{BlobError, Header, check, open};
use crate::bvh::{Bvh, Intersect, Walk};
use crate::camera::{Camera, Use};
use crate::colour::{Radiance, Transfer};
use crate::format::Format;
use crate::kernel::{Kernel, NONE};
use crate::mesh::Mesh;
use crate::paint::Paint;
use crate::profile::{Need, Needs, Profile};
use crate::record::{Checker, Light, Lustre, Material};
use crate::samples::MAX_SAMPLES;
use crate::section::{Integers, Reader};
use crate::space::Space;

/// No tree is deeper; the host's builder keeps to it.
pub const MAX_DEPTH: usize = 64;

/// No ray goes on from more surfaces.
pub const MAX_BRANCHES: usize = 64;

/// What shading reads.
#[derive(Clone, Copy, Debug)]
pub struct Shading<'a, K: Kernel> {
    /// Three normals a triangle, in the order of the triangles; empty for a flat scene.
    pub normal_indices: Integers<'a>,
    /// Unit normals.
    pub normals: &'a [<K::Space as Space>::Normal],
    /// Textures and colours of vertices.
    pub paint: Paint<'a>,
    /// Materials.
    pub materials: &'a [Material],
    /// What is more than matt of them.
    pub lustres: &'a [Lustre],
    /// Patterns of cubes.
    pub checkers: &'a [Checker],
    /// Lights.
    pub lights: &'a [Light],
}

impl<K: Kernel> Shading<'_, K> {
    /// Whether a triangle in a smooth scene is flat: its indices are the largest of their width.
    #[inline]
    #[must_use]
    pub fn is_flat(&self, index: u32) -> bool {
        self.normal_indices.is_none(index)
    }

    /// The normals of a triangle's vertices; `None` for a flat one.
    #[inline]
    #[must_use]
    pub fn normals(&self, index: u32) -> Option<[<K::Space as Space>::Unit; 3]> {
        let [a, b, c] = self.normal_indices.triple(index);
        let unit = |i: u32| self.normals.get(i as usize).map(K::Space::unit);
        Some([unit(a)?, unit(b)?, unit(c)?])
    }
}

/// What drawing reads of a header. The rest of it, which is most, takes no memory while a picture is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Frame {
    /// What the scene needs.
    pub needs: Needs,
    /// Width and height of the picture.
    pub size: [u16; 2],
    /// What a ray that hits nothing sees: straight down, and straight up.
    pub background: [Radiance; 2],
    /// Light that reaches everything.
    pub ambient: Radiance,
    /// How light becomes numbers.
    pub transfer: Transfer,
    /// How pixels are stored.
    pub format: Format,
    /// Camera rays a pixel.
    pub samples: u16,
    /// From how many surfaces a ray may go on.
    pub max_depth: u8,
    /// The levels of nodes: the stack that a traversal needs.
    pub depth: u8,
}

impl Frame {
    fn of(header: &Header) -> Self {
        let &Header { needs, size, background, ambient, transfer, format, samples, max_depth, depth, .. } = header;
        Self { needs, size, background, ambient, transfer, format, samples, max_depth, depth }
    }
}

/// A checked scene.
#[derive(Clone, Copy, Debug)]
pub struct Scene<'a, P: Profile> {
    /// What its header says of the picture.
    pub frame: Frame,
    /// What the kernel computes with.
    pub settings: <P::Kernel as Kernel>::Settings,
    /// The view.
    pub camera: Camera<<P::Kernel as Kernel>::Word>,
    /// Geometry.
    pub bvh: Bvh<'a, P>,
    /// How rays find what they hit there.
    pub walk: P::Walk<'a>,
    /// Everything else.
    pub shading: Shading<'a, P::Kernel>,
}

impl<'a, P: Profile> Scene<'a, P> {
    /// Checks a blob, once and completely, and views it in place. `bytes` must be 8-aligned.
    ///
    /// # Errors
    /// Whatever is wrong with it; see [`BlobError`].
    pub fn new_checked(bytes: &'a [u8]) -> Result<Self, BlobError> {
        // Matched by reference here and below: neither a header nor a scene is small, and the stack would have them twice.
        match &open(bytes, P::Kernel::ID, P::PREFER) {
            Ok((header, sections)) => Self::checked(header, sections),
            Err(error) => Err(*error),
        }
    }

    // Out of line, so that what takes the header apart is not on the stack any more.
    #[inline(never)]
    fn checked(header: &Header, sections: &'a [u8]) -> Result<Self, BlobError> {
        // A need that this version does not know cannot be met, nor named.
        if !header.needs.is_known()
            || usize::from(header.depth) > MAX_DEPTH
            || usize::from(header.max_depth) > MAX_BRANCHES
            || !(1..=MAX_SAMPLES).contains(&header.samples)
        {
            return Err(BlobError::Header);
        }
        if let Some(need) = header.needs.first_missing_in(P::NEEDS) {
            return Err(BlobError::Missing(need));
        }
        let scene = Self::view(header, sections);
        check::all(header, scene.as_ref().map_err(|error| *error)?)?;
        scene
    }

    /// The scene, not checked, if the sections fill the body exactly and agree with each other.
    // Out of line, so that what it takes is not on the stack while the scene is checked.
    #[inline(never)]
    fn view(header: &Header, sections: &'a [u8]) -> Result<Self, BlobError> {
        let settings = P::Kernel::settings(&header.arithmetic).ok_or(BlobError::Header)?;
        let camera = camera::<P::Kernel>(header, header.camera_use(P::NEEDS)).ok_or(BlobError::Header)?;
        let (bvh, shading) = geometry::<P>(header, settings, sections).ok_or(BlobError::Sections)?;
        Ok(Self { frame: Frame::of(header), settings, camera, bvh, walk: P::Walk::default(), shading })
    }

    /// All that the header of a blob for this kernel says; what is not the header is not checked.
    ///
    /// # Errors
    /// As [`Scene::new_checked`].
    pub fn header(bytes: &[u8]) -> Result<Header, BlobError> {
        open(bytes, P::Kernel::ID, P::PREFER).map(|(header, _)| header)
    }
}

impl<P: Profile> Scene<'_, P> {
    /// The rays that may wait while a pixel is drawn.
    #[must_use]
    pub fn branches(&self) -> usize {
        if P::NEEDS.has(Need::Bounces) && self.frame.needs.has(Need::Bounces) {
            usize::from(self.frame.max_depth) + 1
        } else {
            0
        }
    }

    /// Whether camera rays are followed as [paths](crate::path).
    #[inline(always)]
    #[must_use]
    pub fn follows_paths(&self) -> bool {
        (const { P::NEEDS.has(Need::Paths) }) && self.frame.needs.has(Need::Paths)
    }

    /// What finds what rays hit.
    #[inline(always)]
    pub fn hits(&self) -> impl Intersect<P::Kernel> + '_ {
        self.walk.over(&self.bvh)
    }

    /// Whether surfaces are in each other's way of light.
    #[inline(always)]
    pub(crate) fn shadows(&self) -> bool {
        P::NEEDS.has(Need::Shadows) && self.frame.needs.has(Need::Shadows)
    }

    /// The camera, where all its rays start at its eye.
    #[inline]
    #[must_use]
    pub fn shared_origin(&self) -> Option<&Camera<<P::Kernel as Kernel>::Word>> {
        (!P::NEEDS.has(Need::Orthographic) || !self.frame.needs.has(Need::Orthographic)).then_some(&self.camera)
    }

    /// The camera, where its rays had better walk the tree together: a tile draws every triangle in it, so not where there are
    /// fewer pixels than triangles.
    #[inline]
    #[must_use]
    pub(crate) fn drawn_from(&self) -> Option<&Camera<<P::Kernel as Kernel>::Word>> {
        let [width, height] = self.frame.size.map(u32::from);
        self.shared_origin().filter(|_| width * height >= self.bvh.triangles.len())
    }

    /// The ray of a camera, the scene's or one that looks [through](Camera::through) other places, that goes through a pixel;
    /// `None` where the direction is zero.
    #[inline]
    #[must_use]
    pub fn primary(
        &self,
        camera: &Camera<<P::Kernel as Kernel>::Word>,
        x: u16,
        y: u16,
    ) -> Option<<P::Kernel as Kernel>::Ray> {
        if P::NEEDS.has(Need::Orthographic) && self.frame.needs.has(Need::Orthographic) {
            let (origin, direction) = camera.parallel(x, y);
            P::Kernel::ray(self.settings, origin, direction, NONE)
        } else {
            P::Kernel::primary(self.settings, camera, x, y)
        }
    }
}

/// The camera, where the kernel can hold it and the picture has pixels.
fn camera<K: Kernel>(header: &Header, used: Use) -> Option<Camera<K::Word>> {
    if header.size.contains(&0) {
        return None;
    }
    Camera::new::<K>(&header.camera, used)
}

/// Geometry, and everything else.
type Geometry<'a, P> = (Bvh<'a, P>, Shading<'a, <P as Profile>::Kernel>);

/// The sections, if they fill the body exactly and agree with each other.
#[inline(always)]
fn geometry<'a, P: Profile>(
    header: &Header,
    settings: <P::Kernel as Kernel>::Settings,
    sections: &'a [u8],
) -> Option<Geometry<'a, P>> {
    let counts = &header.counts;
    let smooth = header.needs.has(Need::SmoothNormals);
    let (whole, shared) = (header.needs.has(Need::WholeTriangles), header.needs.has(Need::SharedVertices));
    let primitives = counts.triangles.checked_add(counts.spheres)?;
    let apart = header.needs.has(Need::Ids);
    let consistent = primitives > 0
        && !(whole && shared)
        && (whole || shared) == (counts.triangles > 0)
        && shared == (counts.vertices > 0)
        // Only records have ids in them.
        && apart != header.needs.has(Need::IdsInRecords)
        && (apart || (whole && counts.spheres == 0 && header.material_bits < Mesh::<P>::NO_IDS))
        && header.needs.has(Need::Spheres) == (counts.spheres > 0)
        && counts.smooth == if smooth { counts.triangles } else { 0 }
        && smooth == (counts.normals > 0);
    if !consistent {
        return None;
    }
    let mut reader = Reader { bytes: sections };
    let nodes = reader.records(counts.nodes)?;
    let [with_record, with_corners] = [whole, shared].map(|is_so| if is_so { counts.triangles } else { 0 });
    let bvh = Bvh {
        root: header.root,
        nodes,
        triangles: Mesh {
            settings,
            records: reader.records(with_record)?,
            material_bits: if apart { Mesh::<P>::NO_IDS } else { header.material_bits },
            corners: reader.integers(with_corners.checked_mul(3)?, counts.vertices > 1 << 16)?,
            vertices: reader.records(counts.vertices)?,
            materials: reader
                .integers(if counts.materials > 1 { with_corners } else { 0 }, counts.materials > 1 << 16)?,
        },
        // What the profile lacks the scene was found not to need, and then there are none.
        spheres: if P::NEEDS.has(Need::Spheres) { reader.records(counts.spheres)? } else { &[] },
        ids: reader.integers(
            if apart { primitives } else { 0 },
            P::NEEDS.has(Need::WideIds) && header.needs.has(Need::WideIds),
        )?,
    };
    let shading = Shading {
        normal_indices: if P::NEEDS.has(Need::SmoothNormals) {
            reader.integers(counts.smooth.checked_mul(3)?, header.needs.has(Need::WideNormals))?
        } else {
            Integers::Narrow(&[])
        },
        normals: if P::NEEDS.has(Need::SmoothNormals) { reader.records(counts.normals)? } else { &[] },
        paint: Paint::read::<P>(&mut reader, header)?,
        materials: reader.records(counts.materials)?,
        lustres: reader.records(counts.lustres)?,
        checkers: reader.records(counts.checkers)?,
        lights: reader.records(counts.lights)?,
    };
    reader.bytes.is_empty().then_some((bvh, shading))
}
