//! A reader of blobs, made from `docs/BLOB.md` alone: plain arithmetic on bytes, and nothing of core-rt.

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
    pub(crate) needs: u32,
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
    /// Nodes, triangles, spheres, smooth, normals, texture coordinates, colours, bytes of texels, materials, lustres, checkers,
    /// lights.
    pub(crate) counts: [usize; 12],
    pub(crate) file_triangles: u64,
    pub(crate) file_spheres: u64,
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
    pub(crate) reserved: u16,
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

struct Cursor<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Cursor<'_> {
    fn unsigned(&mut self, size: usize) -> u64 {
        let bytes = &self.bytes[self.at..self.at + size];
        self.at += size;
        bytes.iter().rev().fold(0, |value, &byte| value << 8 | u64::from(byte))
    }

    fn signed(&mut self, size: usize) -> i64 {
        let unused = 64 - 8 * size as u32;
        (self.unsigned(size) << unused) as i64 >> unused
    }

    fn varint(&mut self, bits: u32) -> u64 {
        let mut value = 0_u128;
        for group in 0..bits.div_ceil(7) {
            let byte = self.unsigned(1) as u128;
            value |= (byte & 127) << (7 * group);
            if byte < 128 {
                assert!(value >> bits == 0, "a varint beyond its type");
                return value as u64;
            }
        }
        panic!("a varint without end");
    }

    fn zigzag(&mut self, bits: u32) -> i64 {
        let value = self.varint(bits);
        (value >> 1) as i64 ^ -((value & 1) as i64)
    }

    fn three<T>(&mut self, mut read: impl FnMut(&mut Self) -> T) -> [T; 3] {
        [read(self), read(self), read(self)]
    }

    fn pad(&mut self) {
        while !self.at.is_multiple_of(8) {
            assert_eq!(self.unsigned(1), 0, "padding");
        }
    }

    fn section<T>(&mut self, count: usize, mut read: impl FnMut(&mut Self) -> T) -> Vec<T> {
        let records = (0..count).map(|_| read(self)).collect();
        self.pad();
        records
    }

    fn radiance(&mut self) -> Radiance {
        Radiance { mantissa: self.three(|c| c.unsigned(2) as u16), exponent: self.signed(2) }
    }

    fn encoded_radiance(&mut self) -> Radiance {
        Radiance { mantissa: self.three(|c| c.varint(16) as u16), exponent: self.zigzag(16) }
    }

    fn header(&mut self) -> Header {
        Header {
            needs: self.varint(32) as u32,
            size: [self.varint(16), self.varint(16)],
            eye: self.three(|c| c.zigzag(32)),
            along: self.three(|c| c.zigzag(32)),
            first: self.three(|c| c.zigzag(64)),
            right: self.three(|c| c.zigzag(64)),
            down: self.three(|c| c.zigzag(64)),
            fraction_bits: self.unsigned(1) as u8,
            background: [self.encoded_radiance(), self.encoded_radiance()],
            ambient: self.encoded_radiance(),
            transfer: self.varint(32),
            format: self.varint(32),
            samples: self.varint(16),
            max_depth: self.unsigned(1) as u8,
            root: self.varint(32) as u32,
            depth: self.unsigned(1) as u8,
            counts: [(); 12].map(|()| self.varint(32) as usize),
            file_triangles: self.varint(32),
            file_spheres: self.varint(32),
            arithmetic: [(); 4].map(|()| self.unsigned(1) as u8),
            origin: self.three(|c| f64::from_bits(c.varint(64))),
            scale: f64::from_bits(self.varint(64)),
        }
    }

    fn node(&mut self, kernel: Kernel) -> Node {
        let mut bounds = || Bounds {
            low: self.three(|c| c.unsigned(kernel.short) as i64),
            high: self.three(|c| c.unsigned(kernel.short) as i64 - 1),
        };
        Node { boxes: [bounds(), bounds()], children: [self.unsigned(4) as u32, self.unsigned(4) as u32] }
    }

    fn triangle(&mut self, kernel: Kernel) -> Triangle {
        let mut row = || self.three(|c| c.signed(kernel.short));
        let [v0, e1, e2, n] = [row(), row(), row(), row()];
        let meta = self.unsigned(kernel.short) as u32;
        let plus = |edge: [i64; 3]| [v0[0] + edge[0], v0[1] + edge[1], v0[2] + edge[2]];
        Triangle {
            vertices: [v0, plus(e1), plus(e2)],
            edges: [e1, e2],
            n,
            shift: meta & ((1 << kernel.shift_bits) - 1),
            material: meta >> kernel.shift_bits,
        }
    }
}

/// Reads a whole blob. Panics where the document is not kept to: this is a test's reader.
pub(crate) fn read(bytes: &[u8]) -> Blob {
    assert_eq!(bytes[..8], [0x89, 0x69, 0x6e, 0x74, 0x72, 0x61, 0x79, 0x0a], "magic");
    let mut cursor = Cursor { bytes, at: 8 };
    assert_eq!(cursor.unsigned(2), 1, "version");
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

    let [node_count, triangle_count, sphere_count, smooth, normal_count, ..] = header.counts;
    let [.., uv_count, colour_count, texel_count, material_count, lustre_count, checker_count, light_count] =
        header.counts;
    let wide = |bit: u32| if header.needs >> bit & 1 == 1 { 4 } else { 2 };
    let nodes = cursor.section(node_count, |c| c.node(kernel));
    let triangles = cursor.section(triangle_count, |c| c.triangle(kernel));
    let spheres = cursor.section(sphere_count, |c| Sphere {
        centre: c.three(|c| c.signed(kernel.short)),
        radius: c.signed(kernel.short),
        material: c.unsigned(kernel.short) as u32,
    });
    let ids = cursor.section(triangle_count + sphere_count, |c| c.unsigned(wide(8)) as u32);
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
        Lustre { eta, colours, exponent: rest[0], gain: rest[1], flags: rest[2], r0: rest[3], reserved: rest[4] }
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
