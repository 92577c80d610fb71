//! Blobs taken apart and put together, so that a test can damage one exactly where it means to.

use core_rt::blob::{Header, MAGIC, PREFIX_SIZE, Prefix, TRAILER_SIZE, VERSION, crc32};
use core_rt::colour::{Albedo, Rgb888};
use core_rt::kernel::{Kernel, Vertices};
use core_rt::profile::{Full, Need, Prefer};
use core_rt::record::{Checker, Light, Lustre, Material, Record};
use core_rt::render::{Tile, Workspace, render_tile};
use core_rt::scene::{MAX_BRANCHES, MAX_DEPTH, Scene};
use core_rt::space::Space;
use core_rt::stats::Counts;
use core_rt::texture::{Texture, Uv};
use host_tools::import::{Embedded, load_from};
use host_tools::pixels::rgb888;
use host_tools::prepare::{Blob, Options, prepare};
use host_tools::tree::TreeOptions;
use zerocopy::{FromBytes, IntoBytes};

/// What a blob holds, section by section. Nothing about it needs to be right.
#[derive(Clone, Debug)]
pub struct Draft<K: Kernel> {
    /// Written as it stands: its counts need not be those of the sections.
    pub header: Header,
    /// Nodes in preorder.
    pub nodes: Vec<K::Node>,
    /// Triangles in the order of the leaves.
    pub triangles: Vec<K::Triangle>,
    /// Three vertices a triangle that has no record.
    pub corners: Vec<u32>,
    /// The vertices that these refer to.
    pub vertices: Vec<K::Vertex>,
    /// The material of each triangle that has no record, where there are several.
    pub numbers: Vec<u32>,
    /// Spheres in the order of the leaves.
    pub spheres: Vec<K::Sphere>,
    /// The file's number of each triangle, then of each sphere.
    pub ids: Vec<u32>,
    /// Three a triangle, or none.
    pub normal_indices: Vec<u32>,
    /// Unit normals.
    pub normals: Vec<<K::Space as Space>::Normal>,
    /// Three a triangle, or none.
    pub uv_indices: Vec<u32>,
    /// Texture coordinates.
    pub uvs: Vec<Uv>,
    /// Three a triangle, or none.
    pub colour_indices: Vec<u32>,
    /// Colours of vertices.
    pub colours: Vec<Albedo>,
    /// One a material, or none.
    pub textures: Vec<Texture>,
    /// The texels of all.
    pub texels: Vec<u8>,
    /// Materials.
    pub materials: Vec<Material>,
    /// What is more than matt of them.
    pub lustres: Vec<Lustre>,
    /// See the document.
    pub checkers: Vec<Checker>,
    /// Lights.
    pub lights: Vec<Light>,
}

impl<K: Kernel> Draft<K> {
    /// The record of a triangle as the draft's kernel makes it; `None` where it makes none.
    #[must_use]
    pub fn triangle(&self, vertices: &Vertices, material: u32) -> Option<K::Triangle> {
        K::triangle(K::settings(&self.header.arithmetic)?, vertices, material)
    }

    /// Takes a blob apart by its header's counts, without a look at what the records say. `None` where the header cannot
    /// be decoded or the blob is too short for its counts.
    #[must_use]
    pub fn read(bytes: &[u8]) -> Option<Self> {
        let (prefix, _) = Prefix::read_from_prefix(bytes).ok()?;
        let mut rest = bytes.get(PREFIX_SIZE..bytes.len().checked_sub(TRAILER_SIZE)?)?;
        let (header, _) = postcard::take_from_bytes(&take::<u8>(&mut rest, prefix.header_size)?).ok()?;
        let Header { needs, counts, .. } = header;
        let if_needed = |need: Need, count: u32| if needs.has(need) { count } else { 0 };
        let corners = |need: Need| if_needed(need, counts.triangles).checked_mul(3);
        let wide_uvs = needs.has(Need::WideUvs);
        Some(Self {
            header,
            nodes: take(&mut rest, counts.nodes)?,
            triangles: take(&mut rest, if_needed(Need::WholeTriangles, counts.triangles))?,
            corners: take_integers(&mut rest, corners(Need::SharedVertices)?, counts.vertices > 1 << 16)?,
            vertices: take(&mut rest, counts.vertices)?,
            numbers: take_integers(
                &mut rest,
                if counts.materials > 1 { if_needed(Need::SharedVertices, counts.triangles) } else { 0 },
                counts.materials > 1 << 16,
            )?,
            spheres: take(&mut rest, counts.spheres)?,
            ids: take_integers(
                &mut rest,
                if_needed(Need::Ids, counts.triangles.checked_add(counts.spheres)?),
                needs.has(Need::WideIds),
            )?,
            normal_indices: take_integers(&mut rest, counts.smooth.checked_mul(3)?, needs.has(Need::WideNormals))?,
            normals: take(&mut rest, counts.normals)?,
            uv_indices: take_integers(&mut rest, corners(Need::Texture)?, wide_uvs)?,
            uvs: take(&mut rest, counts.paint.uvs)?,
            colour_indices: take_integers(&mut rest, corners(Need::VertexColours)?, wide_uvs)?,
            colours: take(&mut rest, counts.paint.colours)?,
            textures: take(&mut rest, if_needed(Need::Texture, counts.materials))?,
            texels: take(&mut rest, counts.paint.texels)?,
            materials: take(&mut rest, counts.materials)?,
            lustres: take(&mut rest, counts.lustres)?,
            checkers: take(&mut rest, counts.checkers)?,
            lights: take(&mut rest, counts.lights)?,
        })
    }

    /// Gives ids that stand in records of triangles a section of their own.
    ///
    /// # Panics
    /// Where there is a record that no kernel makes.
    pub fn take_ids_apart(&mut self) {
        let bits = self.header.material_bits;
        let number = |record: &K::Triangle| K::material(record);
        self.ids = self.triangles.iter().map(|record| number(record) >> bits).collect();
        let apart = |record: &K::Triangle| {
            let material = number(record) & ((1 << bits) - 1);
            self.triangle(&K::vertices(record), material).expect("a smaller number is held too")
        };
        self.triangles = self.triangles.iter().map(apart).collect();
        self.header.needs = self.header.needs.without(Need::IdsInRecords).with(Need::Ids, true);
    }

    /// The blob of what is here, with the prefix and the checksum that it should have.
    #[must_use]
    pub fn write(&self) -> Blob {
        let header = postcard::to_stdvec(&self.header).expect("memory is all it takes");
        let mut bytes = vec![0; PREFIX_SIZE];
        bytes[12..16].copy_from_slice(&(header.len() as u32).to_le_bytes());
        put(&mut bytes, &header);
        put(&mut bytes, &self.nodes);
        put(&mut bytes, &self.triangles);
        put_integers(&mut bytes, &self.corners, self.header.counts.vertices > 1 << 16);
        put(&mut bytes, &self.vertices);
        put_integers(&mut bytes, &self.numbers, self.header.counts.materials > 1 << 16);
        put(&mut bytes, &self.spheres);
        put_integers(&mut bytes, &self.ids, self.header.needs.has(Need::WideIds));
        put_integers(&mut bytes, &self.normal_indices, self.header.needs.has(Need::WideNormals));
        put(&mut bytes, &self.normals);
        put_integers(&mut bytes, &self.uv_indices, self.header.needs.has(Need::WideUvs));
        put(&mut bytes, &self.uvs);
        put_integers(&mut bytes, &self.colour_indices, self.header.needs.has(Need::WideUvs));
        put(&mut bytes, &self.colours);
        put(&mut bytes, &self.textures);
        put(&mut bytes, &self.texels);
        put(&mut bytes, &self.materials);
        put(&mut bytes, &self.lustres);
        put(&mut bytes, &self.checkers);
        put(&mut bytes, &self.lights);
        bytes.extend([0; TRAILER_SIZE]);
        repaired(&bytes, K::ID)
    }
}

/// The next `count` records of a section and its padding.
fn take<T: Record>(bytes: &mut &[u8], count: u32) -> Option<Vec<T>> {
    let size = (count as usize).checked_mul(size_of::<T>())?;
    let records = bytes.get(..size)?.chunks_exact(size_of::<T>());
    let records = records.map(|record| T::read_from_bytes(record).ok()).collect::<Option<_>>()?;
    *bytes = bytes.get(size.checked_next_multiple_of(8)?..)?;
    Some(records)
}

fn take_integers(bytes: &mut &[u8], count: u32, wide: bool) -> Option<Vec<u32>> {
    if wide {
        return take(bytes, count);
    }
    Some(take::<u16>(bytes, count)?.into_iter().map(u32::from).collect())
}

fn put<T: Record>(bytes: &mut Vec<u8>, records: &[T]) {
    bytes.extend_from_slice(records.as_bytes());
    bytes.resize(bytes.len().next_multiple_of(8), 0);
}

fn put_integers(bytes: &mut Vec<u8>, values: &[u32], wide: bool) {
    if wide {
        put(bytes, values);
    } else {
        put(bytes, &values.iter().map(|&value| value as u16).collect::<Vec<_>>());
    }
}

/// The bytes with the magic, the version, the size and the checksum of a blob for a kernel, so that a check gets to what
/// stands behind these. Bytes that are too few for a prefix and a trailer are filled up with zeros.
#[must_use]
pub fn repaired(bytes: &[u8], kernel: u16) -> Blob {
    let mut bytes = bytes.to_vec();
    bytes.resize(bytes.len().max(PREFIX_SIZE + TRAILER_SIZE), 0);
    let size = bytes.len();
    bytes[..8].copy_from_slice(&MAGIC);
    bytes[8..10].copy_from_slice(&VERSION.to_le_bytes());
    bytes[10..12].copy_from_slice(&kernel.to_le_bytes());
    bytes[16..20].copy_from_slice(&(size as u32).to_le_bytes());
    let sum = crc32(&bytes[..size - 4]);
    bytes[size - 4..].copy_from_slice(&sum.to_le_bytes());
    Blob::from_bytes(&bytes)
}

/// Five triangles, a leaf for each, of two materials one of which emits; a light of each kind; ambient light. Smooth, or
/// flat: of the smooth one's triangles the last is flat.
///
/// # Panics
/// Where it cannot be prepared.
#[must_use]
pub fn sample<K: Kernel>(smooth: bool) -> Blob {
    let mut draft = Draft::<K>::read(sample_with_ids_in_records::<K>(smooth).bytes()).expect("a good blob");
    draft.take_ids_apart();
    draft.write()
}

/// [`sample`] as it is prepared: its records have room for ids.
///
/// # Panics
/// Where it cannot be prepared.
#[must_use]
pub fn sample_with_ids_in_records<K: Kernel>(smooth: bool) -> Blob {
    prepared_sample::<K>(smooth, "", Prefer::Speed)
}

/// [`sample`] with triangles that share vertices.
///
/// # Panics
/// Where it cannot be prepared.
#[must_use]
pub fn sample_with_shared_vertices<K: Kernel>(smooth: bool) -> Blob {
    prepared_sample::<K>(smooth, "", Prefer::Size)
}

/// [`sample`], smooth, with three spheres among its triangles, one of which reaches all ends of the scene.
///
/// # Panics
/// Where it cannot be prepared.
#[must_use]
pub fn sample_with_spheres<K: Kernel>() -> Blob {
    const SPHERES: &str = "[[sphere]]\ncentre = [2, 2, 2]\nradius = 2\nmaterial = 'floor'\n\
                           [[sphere]]\ncentre = [1, 1, 3]\nradius = 0.5\nmaterial = 'lamp'\n\
                           [[sphere]]\ncentre = [3, 1, 3]\nradius = 0.5\nmaterial = 'floor'\n";
    prepared_sample::<K>(true, SPHERES, Prefer::Speed)
}

fn prepared_sample<K: Kernel>(smooth: bool, spheres: &str, prefer: Prefer) -> Blob {
    const VERTICES: &str = "mtllib s.mtl\nv 0 0 0\nv 4 0 0\nv 4 0 4\nv 0 0 4\nv 1 1 1\nv 3 1 2\nv 2 3 2\nv 2 1 3\n\
                            vn 0 1 0\nvn 1 1 0\nvn 0 1 1\n";
    const SCENE: &str = "model = 's.obj'\n[camera]\nposition = [1, 3, 8]\nlook_at = [2, 1, 2]\n[[light]]\nposition = [3, 5, 3]\n\
         [[light]]\nkind = 'directional'\ndirection = [-1, -3, -1]\ncolour = [0.3, 0.3, 0.2]\n\
         [background]\ncolour = [0.1, 0.2, 0.4]\n[render]\nsize = [12, 9]\nambient = [0.1, 0.1, 0.1]\n";
    const FLAT: &str = "usemtl floor\nf 1 4 3 2\nusemtl lamp\nf 5 7 6\nf 6 7 8\nf 8 7 5\n";
    const SMOOTH: &str =
        "usemtl floor\nf 1//1 4//1 3//1 2//1\nusemtl lamp\nf 5//2 7//1 6//3\nf 6//3 7//1 8//2\nf 8 7 5\n";
    let obj = [VERTICES, if smooth { SMOOTH } else { FLAT }].concat();
    let scene = [SCENE, spheres].concat();
    let files: [(&str, &[u8]); 3] = [
        ("s.obj", obj.as_bytes()),
        ("s.mtl", b"newmtl floor\nKd 0.5 0.6 0.7\nnewmtl lamp\nKd 0.9 0.2 0.1\nKe 0.25 0 0\n"),
        ("s.toml", scene.as_bytes()),
    ];
    let model = load_from(&Embedded(&files), "s.toml").expect("a good scene").model;
    let tree = TreeOptions { leaf_max: 1, leaf_always: true, ..TreeOptions::default() };
    prepare::<K>(&model, &Options { tree, prefer, ..Options::default() }).expect("it fits every kernel").blob
}

/// Renders the first tile of an accepted scene and the last, of at most 8x8 pixels, and returns the pixels of both.
///
/// # Panics
/// Where the renderer does; where a ray looks at a node or a primitive twice.
pub fn corners<K: Kernel>(scene: &Scene<'_, Full<K>>) -> Vec<Rgb888> {
    let [width, height] = scene.frame.size;
    let side = |picture: u16| picture.min(8);
    let first = Tile { x: 0, y: 0, width: side(width), height: side(height) };
    let last = Tile { x: width - first.width, y: height - first.height, ..first };
    let mut seen = Vec::new();
    for tile in [first, last] {
        let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
        let (mut hits, mut pixels) = ([0; 64], [0; 3 * 64]);
        let mut branches = heapless::Vec::<_, { MAX_BRANCHES + 1 }>::new();
        let mut workspace =
            Workspace { stack: &mut stack, branches: &mut branches, hits: &mut hits, pixels: &mut pixels };
        let mut counts = Counts::default();
        let pixels =
            render_tile(scene, tile, &mut workspace, &mut counts).expect("the workspace is the largest there is");
        seen.extend(rgb888(scene.frame.format, pixels));
        let nodes = scene.bvh.nodes.len() as u64;
        let primitives = u64::from(scene.bvh.triangles.len()) + scene.bvh.spheres.len() as u64;
        assert!(counts.box_tests <= 2 * nodes * counts.rays(), "{counts:?} of {nodes} nodes");
        assert!(counts.triangle_tests <= primitives * counts.rays(), "{counts:?} of {primitives} primitives");
    }
    seen
}
