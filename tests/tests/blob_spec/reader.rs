//! A reader of blobs, made from `docs/BLOB.md` alone: plain arithmetic on bytes, and nothing of core-rt.

use super::cursor::Cursor;

/// The document's table of kernels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Kernel {
    pub(crate) id: u16,
    /// Of a plane and of a triangle's field, bytes.
    pub(crate) short: usize,
    pub(crate) vertices: (i64, i64),
    pub(crate) radius_least: i64,
    pub(crate) span: i64,
    pub(crate) direction_bits: u32,
    pub(crate) fraction_bits_most: u8,
    /// Where rays are parallel.
    pub(crate) fraction_bits_parallel: u8,
    pub(crate) offset_bits: u32,
    pub(crate) normal_bits: u32,
    pub(crate) shift_bits: u32,
    pub(crate) material_most: u32,
    /// Of a unit normal.
    pub(crate) unit_bits: u32,
}

pub(crate) const EXACT14: Kernel = Kernel {
    id: 14,
    short: 2,
    vertices: (4, (1 << 15) - 5),
    radius_least: 2,
    span: (1 << 15) - 4,
    direction_bits: 13,
    fraction_bits_most: 17,
    fraction_bits_parallel: 14,
    offset_bits: 16,
    normal_bits: 15,
    shift_bits: 4,
    material_most: 4095,
    unit_bits: 14,
};

pub(crate) const EXACT29: Kernel = Kernel {
    id: 29,
    short: 4,
    vertices: (8, (1 << 29) - 9),
    radius_least: 2,
    span: (1 << 29) - 8,
    direction_bits: 31,
    fraction_bits_most: 30,
    fraction_bits_parallel: 31,
    offset_bits: 30,
    normal_bits: 30,
    shift_bits: 5,
    material_most: 67_108_863,
    unit_bits: 30,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Radiance {
    pub(crate) mantissa: [u16; 3],
    pub(crate) exponent: i64,
}

#[derive(Clone, Debug)]
pub(crate) struct Header {
    pub(crate) needs: u64,
    pub(crate) size: [u64; 2],
    pub(crate) eye: [i64; 3],
    pub(crate) along: [i64; 3],
    pub(crate) first: [i64; 3],
    pub(crate) right: [i64; 3],
    pub(crate) down: [i64; 3],
    pub(crate) fraction_bits: u8,
    /// Straight down, straight up.
    pub(crate) background: [Radiance; 2],
    pub(crate) ambient: Radiance,
    pub(crate) transfer: u64,
    pub(crate) format: u64,
    pub(crate) samples: u64,
    pub(crate) root: u32,
    pub(crate) depth: u8,
    pub(crate) max_depth: u8,
    /// Nodes, triangles, shared vertices, spheres, smooth, normals, texture coordinates, colours, bytes of texels, materials, lustres, checkers,
    /// lights.
    pub(crate) counts: [usize; 13],
    pub(crate) file_triangles: u64,
    pub(crate) file_spheres: u64,
    /// Of a record's material number, where ids are above them.
    pub(crate) material_bits: u32,
    /// C, D, E, epsilon.
    pub(crate) arithmetic: [u8; 4],
    pub(crate) origin: [f64; 3],
    pub(crate) scale: f64,
}

/// Least and greatest coordinates, both inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bounds {
    pub(crate) low: [i64; 3],
    pub(crate) high: [i64; 3],
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Node {
    pub(crate) boxes: [Bounds; 2],
    pub(crate) children: [u32; 2],
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Triangle {
    pub(crate) vertices: [[i64; 3]; 3],
    pub(crate) edges: [[i64; 3]; 2],
    pub(crate) n: [i64; 3],
    pub(crate) shift: u32,
    pub(crate) material: u32,
}

impl Triangle {
    /// What a record would say of vertices and a material.
    fn of(kernel: Kernel, vertices: [[i64; 3]; 3], material: u32) -> Self {
        let less = |a: [i64; 3], b: [i64; 3]| [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
        let [v0, v1, v2] = vertices;
        let [e1, e2, e3] = [less(v1, v0), less(v2, v0), less(v2, v1)];
        let longest = [e1, e2, e3].as_flattened().iter().map(|c| c.unsigned_abs()).max().unwrap_or(0);
        let shift = 64 - longest.leading_zeros();
        let cross = |i: usize, j: usize| e1[i] * e2[j] - e1[j] * e2[i];
        let k = (2 * shift).saturating_sub(kernel.normal_bits);
        let n = [cross(1, 2), cross(2, 0), cross(0, 1)].map(|c| c >> k);
        Self { vertices, edges: [e1, e2], n, shift, material }
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Sphere {
    pub(crate) centre: [i64; 3],
    pub(crate) radius: i64,
    pub(crate) material: u32,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Material {
    pub(crate) emission: Radiance,
    pub(crate) albedo: [u16; 3],
    pub(crate) lustre: u16,
    pub(crate) checker: u16,
}

/// The texture of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Texture {
    pub(crate) first: u64,
    pub(crate) size: [u64; 2],
    pub(crate) format: u64,
    pub(crate) reserved: u64,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Lustre {
    /// For entering and for leaving, Q28.
    pub(crate) eta: [u32; 2],
    /// Specular, reflected, mirrored, refracted, shadow.
    pub(crate) colours: [[u16; 3]; 5],
    /// Q2.
    pub(crate) exponent: u16,
    pub(crate) gain: u16,
    pub(crate) flags: u16,
    pub(crate) r0: u16,
    pub(crate) roughness: u16,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Checker {
    /// Q63.
    pub(crate) step: u64,
    /// Q63.
    pub(crate) start: [u64; 3],
    pub(crate) other: [u16; 3],
    pub(crate) reserved: u16,
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Light {
    pub(crate) kind: u32,
    pub(crate) place: [i64; 3],
    pub(crate) radiance: Radiance,
    /// Mantissa and exponent.
    pub(crate) reach: (u16, i64),
}

/// Everything that a blob says.
#[derive(Clone, Debug)]
pub(crate) struct Blob {
    pub(crate) kernel: Kernel,
    pub(crate) header: Header,
    pub(crate) nodes: Vec<Node>,
    pub(crate) triangles: Vec<Triangle>,
    pub(crate) spheres: Vec<Sphere>,
    pub(crate) ids: Vec<u32>,
    /// `None` for a flat triangle; empty for a flat scene.
    pub(crate) corners: Vec<Option<[u32; 3]>>,
    pub(crate) normals: Vec<[i64; 3]>,
    /// Texture coordinates, Q20. `None` for a triangle without; empty for a scene without.
    pub(crate) uvs: Vec<Option<[[i64; 2]; 3]>>,
    /// Of vertices; empty for a scene without.
    pub(crate) colours: Vec<[[u16; 3]; 3]>,
    pub(crate) textures: Vec<Texture>,
    pub(crate) texels: Vec<u8>,
    pub(crate) materials: Vec<Material>,
    pub(crate) lustres: Vec<Lustre>,
    pub(crate) checkers: Vec<Checker>,
    pub(crate) lights: Vec<Light>,
}

/// The document's CRC-32, bit by bit.
pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    let mut crc = u32::MAX;
    for &byte in bytes {
        crc ^= u32::from(byte);
        for _ in 0..8 {
            crc = if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
        }
    }
    !crc
}

/// Reads a whole blob. Panics where the document is not kept to: this is a test's reader.
pub(crate) fn read(bytes: &[u8]) -> Blob {
    assert_eq!(bytes[..8], [0x89, 0x69, 0x6e, 0x74, 0x72, 0x61, 0x79, 0x0a], "magic");
    let mut cursor = Cursor { bytes, at: 8 };
    assert_eq!(cursor.unsigned(2), 2, "version");
    let kernel = match cursor.unsigned(2) {
        14 => EXACT14,
        29 => EXACT29,
        other => panic!("kernel {other}"),
    };
    let header_size = cursor.unsigned(4) as usize;
    assert_eq!(cursor.unsigned(4) as usize, bytes.len(), "total size");
    assert_eq!(cursor.unsigned(4), 0, "reserved");
    let header = cursor.header();
    assert_eq!(cursor.at, 24 + header_size, "header size");
    cursor.pad();

    let [node_count, triangle_count, vertex_count, sphere_count, smooth, normal_count, ..] = header.counts;
    let [.., uv_count, colour_count, texel_count, material_count, lustre_count, checker_count, light_count] =
        header.counts;
    let wide = |bit: u32| if header.needs >> bit & 1 == 1 { 4 } else { 2 };
    let nodes = cursor.section(node_count, |c| c.node(kernel));
    let mut triangles: Vec<Triangle> = if header.needs >> 31 & 1 == 1 {
        let wide = |count: usize| if count > 1 << 16 { 4 } else { 2 };
        let corners = cursor.section(triangle_count, |c| c.three(|c| c.unsigned(wide(vertex_count)) as usize));
        let vertices = cursor.section(vertex_count, |c| c.three(|c| c.signed(kernel.short)));
        let numbered = if material_count > 1 { triangle_count } else { 0 };
        let numbers = cursor.section(numbered, |c| c.unsigned(wide(material_count)) as u32);
        let material = |index: usize| numbers.get(index).copied().unwrap_or(0);
        let whole = |(index, corners): (usize, [usize; 3])| {
            Triangle::of(kernel, corners.map(|corner| vertices[corner]), material(index))
        };
        corners.into_iter().enumerate().map(whole).collect()
    } else {
        cursor.section(triangle_count, |c| c.triangle(kernel))
    };
    let spheres = cursor.section(sphere_count, |c| Sphere {
        centre: c.three(|c| c.signed(kernel.short)),
        radius: c.signed(kernel.short),
        material: c.unsigned(kernel.short) as u32,
    });
    let apart = header.needs >> 33 & 1 == 1;
    let with_id = if apart { triangle_count + sphere_count } else { 0 };
    let mut ids = cursor.section(with_id, |c| c.unsigned(wide(8)) as u32);
    if !apart {
        for triangle in &mut triangles {
            ids.push(triangle.material >> header.material_bits);
            triangle.material &= (1 << header.material_bits) - 1;
        }
    }
    let flat = if wide(9) == 4 { u32::MAX } else { u16::MAX.into() };
    let corners = cursor.section(smooth, |c| {
        let indices = c.three(|c| c.unsigned(wide(9)) as u32);
        (indices != [flat; 3]).then_some(indices)
    });
    let normals = cursor.section(normal_count, |c| c.three(|c| c.signed(kernel.short)));
    let (coloured, textured) = (header.needs >> 21 & 1 == 1, header.needs >> 22 & 1 == 1);
    let corner_count = |has: bool| if has { triangle_count } else { 0 };
    let none = if wide(24) == 4 { u32::MAX } else { u16::MAX.into() };
    let corner_indices =
        |c: &mut Cursor<'_>, has: bool| c.section(corner_count(has), |c| c.three(|c| c.unsigned(wide(24)) as u32));
    let uv_indices = corner_indices(&mut cursor, textured);
    let uvs = cursor.section(uv_count, |c| [c.signed(4), c.signed(4)]);
    let colour_indices = corner_indices(&mut cursor, coloured);
    let colours = cursor.section(colour_count, |c| c.three(|c| c.unsigned(2) as u16));
    let textures = cursor.section(if textured { material_count } else { 0 }, |c| Texture {
        first: c.unsigned(4),
        size: [c.unsigned(2), c.unsigned(2)],
        format: c.unsigned(2),
        reserved: c.unsigned(2),
    });
    let texels = cursor.section(texel_count, |c| c.unsigned(1) as u8);
    let uvs = uv_indices.into_iter().map(|i| (i != [none; 3]).then(|| i.map(|i| uvs[i as usize]))).collect();
    let colours = colour_indices.into_iter().map(|i| i.map(|i| colours[i as usize])).collect();
    let materials = cursor.section(material_count, |c| Material {
        emission: c.radiance(),
        albedo: c.three(|c| c.unsigned(2) as u16),
        lustre: c.unsigned(2) as u16,
        checker: c.unsigned(2) as u16,
    });
    let lustres = cursor.section(lustre_count, |c| {
        let mut words = |count: usize| (0..count).map(|_| c.unsigned(2) as u16).collect::<Vec<_>>();
        let eta = words(4);
        let colours = words(15);
        let rest = words(5);
        let eta = [0, 2].map(|i| u32::from(eta[i]) | u32::from(eta[i + 1]) << 16);
        let colours = [0, 3, 6, 9, 12].map(|i| [colours[i], colours[i + 1], colours[i + 2]]);
        Lustre { eta, colours, exponent: rest[0], gain: rest[1], flags: rest[2], r0: rest[3], roughness: rest[4] }
    });
    let checkers = cursor.section(checker_count, |c| Checker {
        step: c.unsigned(8),
        start: c.three(|c| c.unsigned(8)),
        other: c.three(|c| c.unsigned(2) as u16),
        reserved: c.unsigned(2) as u16,
    });
    let lights = cursor.section(light_count, |c| Light {
        kind: c.unsigned(4) as u32,
        place: c.three(|c| c.signed(4)),
        radiance: c.radiance(),
        reach: (c.unsigned(2) as u16, c.signed(2)),
    });
    assert_eq!(cursor.unsigned(4), 0, "before the checksum");
    let computed = crc32(&bytes[..cursor.at]);
    assert_eq!(cursor.unsigned(4), u64::from(computed), "checksum");
    assert_eq!(cursor.at, bytes.len(), "nothing follows");
    Blob {
        kernel,
        header,
        nodes,
        triangles,
        spheres,
        ids,
        corners,
        normals,
        uvs,
        colours,
        textures,
        texels,
        materials,
        lustres,
        checkers,
        lights,
    }
}
