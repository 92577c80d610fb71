//! Camera rays: one integer function of the blob's coefficients, for all kernels and paths.
//!
//! `direction(x, y) = (A + x B + y C + 1/2) >> f`: linear in the pixel, so that a tile can step it by addition, and
//! not normalised, so that it needs no square root. A stands for the middle of pixel (0, 0).

use serde::{Deserialize, Serialize};

use crate::num::{Triple, Word, round_shift};

/// A camera as it stands in the header, for every kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CameraHeader {
    /// The origin of all rays, grid units.
    pub eye: Triple<i32>,
    /// The direction through the middle of pixel (0, 0), with `fraction_bits` below the direction's unit.
    pub first: Triple<i64>,
    /// What a step to the right adds.
    pub right: Triple<i64>,
    /// What a step down adds.
    pub down: Triple<i64>,
    /// Fractional bits of the three.
    pub fraction_bits: u8,
}

/// A camera in a kernel's words.
#[derive(Clone, Copy, Debug)]
pub struct Camera<W> {
    eye: Triple<W>,
    first: Triple<W>,
    right: Triple<W>,
    down: Triple<W>,
    fraction_bits: u32,
}

impl<W: Word> Camera<W> {
    /// The camera, if every direction in a picture of `size` stays below `2^direction_bits` and the word holds all sums.
    ///
    /// A direction is linear in x and y, so the corners of the picture decide. Let all four be below B. The partial sums
    /// x B, y C and x B + y C are differences of directions, so below 2 B, which the word must hold.
    #[must_use]
    pub fn new(header: &CameraHeader, size: [u16; 2], direction_bits: u32) -> Option<Self> {
        let fraction_bits = u32::from(header.fraction_bits);
        let bound = 1i64.checked_shl(direction_bits + fraction_bits).filter(|&b| b > 0)?;
        W::from_i64(bound.checked_mul(2)? - 1)?;
        let half = (1i64 << fraction_bits) >> 1;
        let [right, bottom] = size.map(|s| i64::from(s.saturating_sub(1)));
        for (x, y) in [(0, 0), (right, 0), (0, bottom), (right, bottom)] {
            for ((&a, &b), &c) in header.first.iter().zip(&header.right).zip(&header.down) {
                let direction = a.checked_add(b.checked_mul(x)?.checked_add(c.checked_mul(y)?)?)?;
                if direction.checked_abs()? >= bound - half {
                    return None;
                }
            }
        }
        let words = |v: &Triple<i64>| Some([W::from_i64(v[0])?, W::from_i64(v[1])?, W::from_i64(v[2])?]);
        Some(Self {
            eye: header.eye.map(W::from_i32),
            first: words(&header.first)?,
            right: words(&header.right)?,
            down: words(&header.down)?,
            fraction_bits,
        })
    }

    /// The origin of all rays.
    #[inline]
    #[must_use]
    pub fn eye(&self) -> Triple<W> {
        self.eye
    }

    /// The direction through a pixel of the picture that the camera was made for.
    #[inline]
    #[must_use]
    pub fn direction(&self, x: u16, y: u16) -> Triple<W> {
        let (x, y) = (W::from_i32(x.into()), W::from_i32(y.into()));
        let component = |a: W, b: W, c: W| round_shift(a + (x * b + y * c), self.fraction_bits);
        [
            component(self.first[0], self.right[0], self.down[0]),
            component(self.first[1], self.right[1], self.down[1]),
            component(self.first[2], self.right[2], self.down[2]),
        ]
    }
}
