//! Numbers of a blob, one after the other, as the document writes them.

use super::reader::*;

/// Where the reader is.
pub(crate) struct Cursor<'a> {
    pub(crate) bytes: &'a [u8],
    pub(crate) at: usize,
}

impl Cursor<'_> {
    pub(crate) fn unsigned(&mut self, size: usize) -> u64 {
        let bytes = &self.bytes[self.at..self.at + size];
        self.at += size;
        bytes.iter().rev().fold(0, |value, &byte| value << 8 | u64::from(byte))
    }

    pub(crate) fn signed(&mut self, size: usize) -> i64 {
        let unused = 64 - 8 * size as u32;
        (self.unsigned(size) << unused) as i64 >> unused
    }

    pub(crate) fn varint(&mut self, bits: u32) -> u64 {
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

    pub(crate) fn zigzag(&mut self, bits: u32) -> i64 {
        let value = self.varint(bits);
        (value >> 1) as i64 ^ -((value & 1) as i64)
    }

    pub(crate) fn three<T>(&mut self, mut read: impl FnMut(&mut Self) -> T) -> [T; 3] {
        [read(self), read(self), read(self)]
    }

    pub(crate) fn pad(&mut self) {
        while !self.at.is_multiple_of(8) {
            assert_eq!(self.unsigned(1), 0, "padding");
        }
    }

    pub(crate) fn section<T>(&mut self, count: usize, mut read: impl FnMut(&mut Self) -> T) -> Vec<T> {
        let records = (0..count).map(|_| read(self)).collect();
        self.pad();
        records
    }

    pub(crate) fn radiance(&mut self) -> Radiance {
        Radiance { mantissa: self.three(|c| c.unsigned(2) as u16), exponent: self.signed(2) }
    }

    pub(crate) fn encoded_radiance(&mut self) -> Radiance {
        Radiance { mantissa: self.three(|c| c.varint(16) as u16), exponent: self.zigzag(16) }
    }

    pub(crate) fn header(&mut self) -> Header {
        Header {
            needs: self.varint(64),
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
            counts: [(); 13].map(|()| self.varint(32) as usize),
            file_triangles: self.varint(32),
            file_spheres: self.varint(32),
            material_bits: self.unsigned(1) as u32,
            arithmetic: [(); 4].map(|()| self.unsigned(1) as u8),
            origin: self.three(|c| f64::from_bits(c.varint(64))),
            scale: f64::from_bits(self.varint(64)),
        }
    }

    pub(crate) fn node(&mut self, kernel: Kernel) -> Node {
        let mut bounds = || Bounds {
            low: self.three(|c| c.unsigned(kernel.short) as i64),
            high: self.three(|c| c.unsigned(kernel.short) as i64 - 1),
        };
        Node { boxes: [bounds(), bounds()], children: [self.unsigned(4) as u32, self.unsigned(4) as u32] }
    }

    pub(crate) fn triangle(&mut self, kernel: Kernel) -> Triangle {
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
