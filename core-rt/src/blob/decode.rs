//! The header from its bytes, in the encoding of `postcard`: integers in groups of 7 bits, the lowest first, those with a
//! sign folded so that small ones are short.
//!
//! The host encodes by `postcard` itself. What its decoder makes of a type by `serde` is right for any format and any type,
//! and on a chip it would be more code than all of a small scene's rendering; a header is integers alone. A test
//! decodes whatever it can think of by both.

use super::{Counts, Header, SourceGrid};
use crate::arithmetic::Arithmetic;
use crate::camera::CameraHeader;
use crate::colour::{Radiance, Transfer};
use crate::format::Format;
use crate::num::Triple;
use crate::paint::PaintCounts;
use crate::profile::Needs;

/// The header, if the bytes are one and nothing else.
#[must_use]
pub fn decode(bytes: &[u8]) -> Option<Header> {
    let mut fields = Fields { bytes, is_good: true };
    let header = fields.header();
    (fields.is_good && fields.bytes.is_empty()).then_some(header)
}

/// Takes integers off the bytes, one after the other. What cannot be one is 0, and is remembered: that costs a caller no
/// branch.
struct Fields<'a> {
    bytes: &'a [u8],
    is_good: bool,
}

impl Fields<'_> {
    /// The next byte.
    #[inline(never)]
    fn byte(&mut self) -> u8 {
        let [byte, rest @ ..] = self.bytes else {
            self.is_good = false;
            return 0;
        };
        self.bytes = rest;
        *byte
    }

    /// The next integer of at most so many bits. Groups beyond them are no integer, and neither are bits.
    #[inline(never)]
    fn unsigned(&mut self, bits: u32) -> u64 {
        let (mut value, mut shift) = (0, 0);
        while shift < bits {
            let byte = self.byte();
            let group = u64::from(byte & 0x7f);
            // Of 64 bits the last group has one.
            if group >> (bits - shift).min(7) != 0 {
                break;
            }
            value |= group << shift;
            if byte < 0x80 {
                return value;
            }
            shift += 7;
        }
        self.is_good = false;
        0
    }

    /// The next integer with a sign: 0, -1, 1, -2 are 0, 1, 2, 3.
    #[inline(never)]
    fn signed(&mut self, bits: u32) -> i64 {
        let folded = self.unsigned(bits);
        (folded >> 1).cast_signed() ^ -(folded & 1).cast_signed()
    }

    #[inline(never)]
    fn u32(&mut self) -> u32 {
        self.unsigned(32) as u32
    }

    fn u16(&mut self) -> u16 {
        self.unsigned(16) as u16
    }

    /// Three in a row; each fits, by the bits that were asked for.
    #[inline(never)]
    fn triple_i32(&mut self) -> Triple<i32> {
        core::array::from_fn(|_| self.signed(32) as i32)
    }

    #[inline(never)]
    fn triple_i64(&mut self) -> Triple<i64> {
        core::array::from_fn(|_| self.signed(64))
    }

    #[inline(never)]
    fn radiance(&mut self) -> Radiance {
        Radiance { mantissa: core::array::from_fn(|_| self.u16()), exponent: self.signed(16) as i16 }
    }

    /// One of a few, by its number.
    fn one_of<T: Copy>(&mut self, all: &[T], otherwise: T) -> T {
        let number = self.u32();
        all.get(number as usize).copied().unwrap_or_else(|| {
            self.is_good = false;
            otherwise
        })
    }

    /// In the order in which the fields stand in the types.
    #[inline(always)]
    fn header(&mut self) -> Header {
        Header {
            needs: Needs::from_bits(self.unsigned(64)),
            size: [self.u16(), self.u16()],
            camera: CameraHeader {
                eye: self.triple_i32(),
                along: self.triple_i32(),
                first: self.triple_i64(),
                right: self.triple_i64(),
                down: self.triple_i64(),
                fraction_bits: self.byte(),
            },
            background: [self.radiance(), self.radiance()],
            ambient: self.radiance(),
            transfer: self.one_of(&[Transfer::Srgb, Transfer::Linear], Transfer::Linear),
            format: self.one_of(&Format::ALL, Format::Gray8),
            samples: self.u16(),
            max_depth: self.byte(),
            root: self.u32(),
            depth: self.byte(),
            counts: Counts {
                nodes: self.u32(),
                triangles: self.u32(),
                vertices: self.u32(),
                spheres: self.u32(),
                smooth: self.u32(),
                normals: self.u32(),
                paint: PaintCounts { uvs: self.u32(), colours: self.u32(), texels: self.u32() },
                materials: self.u32(),
                lustres: self.u32(),
                checkers: self.u32(),
                lights: self.u32(),
            },
            file_triangles: self.u32(),
            file_spheres: self.u32(),
            material_bits: self.byte(),
            arithmetic: Arithmetic {
                c_bits: self.byte(),
                d_bits: self.byte(),
                edge_shift: self.byte(),
                epsilon: self.byte(),
            },
            source: SourceGrid {
                origin_bits: core::array::from_fn(|_| self.unsigned(64)),
                scale_bits: self.unsigned(64),
            },
        }
    }
}
