//! Camera rays: one integer function of the blob's coefficients, for all kernels and paths.
//!
//! `step(x, y) = (A + x B + y C + 1/2) >> f`: linear in the pixel, so that a tile can step it by addition. A stands for the
//! middle of pixel (0, 0). In perspective it is the direction of a ray from the eye, not normalised, so that it needs no
//! square root. Parallel rays have one direction, and it is where their origin is from the eye.
//!
//! Of several samples in a pixel each moves A by its part of B and C.

use serde::{Deserialize, Serialize};

use crate::kernel::{Bounds, Kernel};
use crate::num::{Triple, Word};
use crate::samples::{PLACE_BITS, Place};

/// A camera as it stands in the header, for every kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct CameraHeader {
    /// The origin of all rays, grid units; of parallel rays, the point that their origins are counted from.
    pub eye: Triple<i32>,
    /// The direction of parallel rays; zero in perspective.
    pub along: Triple<i32>,
    /// The direction through the middle of pixel (0, 0), with `fraction_bits` below the direction's unit; of parallel rays,
    /// the origin less the eye, below the grid's.
    pub first: Triple<i64>,
    /// What a step to the right adds.
    pub right: Triple<i64>,
    /// What a step down adds.
    pub down: Triple<i64>,
    /// Fractional bits of the three.
    pub fraction_bits: u8,
}

/// What a scene does with its camera.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Use {
    /// Width and height of the picture.
    pub size: [u16; 2],
    /// Whether rays are parallel.
    pub parallel: bool,
    /// Whether samples are at any place in a pixel.
    pub sampled: bool,
}

impl Use {
    /// By how much a sample's step may be low, units of a coefficient: two products, each rounded down.
    const SAMPLE_ERROR: i64 = 2;

    fn error(self) -> i64 {
        if self.sampled { Self::SAMPLE_ERROR } else { 0 }
    }
}

impl CameraHeader {
    /// For each axis, twice the coefficients' sums at the outermost places that rays go through: the middles of the pixels
    /// in the corners, or the corners of the picture where pixels are sampled. `None` where one does not fit.
    ///
    /// The sums are linear in the place, so that all others are between these.
    fn ends_2x(&self, used: Use) -> impl Iterator<Item = [Option<i64>; 4]> {
        let out = i64::from(used.sampled);
        let [right, bottom] = used.size.map(|side| 2 * i64::from(side.saturating_sub(1)) + out);
        let axes = self.first.iter().zip(&self.right).zip(&self.down);
        axes.map(move |((&a, &b), &c)| {
            core::array::from_fn(|corner| {
                let place = |bit: usize, end: i64| if corner & bit == 0 { -out } else { end };
                sum_2x(a, b, c, (place(1, right), place(2, bottom)))
            })
        })
    }

    /// Whether every ray starts at most `span` from everything in the box, along each axis. The header is one that
    /// [`Camera::new`] takes.
    #[inline(always)]
    #[must_use]
    pub fn starts_within(&self, used: Use, bounds: &Bounds, span: i32) -> bool {
        if !used.parallel {
            return bounds.spanned_from(self.eye, span);
        }
        let half = (1i64 << self.fraction_bits) >> 1;
        let (mut low, mut high) = ([i32::MAX; 3], [i32::MIN; 3]);
        let starts = self.eye.iter().zip(low.iter_mut().zip(&mut high));
        for (ends_2x, (&eye, (low, high))) in self.ends_2x(used).zip(starts) {
            for end_2x in ends_2x {
                let Some(end_2x) = end_2x else { return false };
                // Rounding keeps order, so the ends decide.
                for sum in [(end_2x >> 1) - used.error(), (end_2x + 1) >> 1] {
                    let start = i64::from(eye) + ((sum + half) >> self.fraction_bits);
                    let Ok(start) = i32::try_from(start) else { return false };
                    (*low, *high) = (start.min(*low), start.max(*high));
                }
            }
        }
        bounds.spanned_from(low, span) && bounds.spanned_from(high, span)
    }
}

/// `2 a + x b + y c`; `None` where it does not fit. Out of line: twelve of them are asked for, once a scene.
#[inline(never)]
fn sum_2x(a: i64, b: i64, c: i64, (x, y): (i64, i64)) -> Option<i64> {
    a.checked_add(a)?.checked_add(times(b, x)?.checked_add(times(c, y)?)?)
}

/// Out of line, since a product that may not fit is much code on a machine of 32 bits.
#[inline(never)]
fn times(a: i64, b: i64) -> Option<i64> {
    a.checked_mul(b)
}

/// Coefficients as words, with something added; `None` where one does not fit.
#[inline(never)]
fn words<W: Word>(coefficients: &Triple<i64>, added: i64) -> Option<Triple<W>> {
    let mut words = [W::ZERO; 3];
    for (word, &c) in words.iter_mut().zip(coefficients) {
        *word = W::from_i64(c + added)?;
    }
    Some(words)
}

/// A camera in a kernel's words.
#[derive(Clone, Copy, Debug)]
pub struct Camera<W> {
    eye: Triple<W>,
    along: Triple<W>,
    /// With the half unit that rounds.
    first: Triple<W>,
    right: Triple<W>,
    down: Triple<W>,
    fraction_bits: u32,
}

impl<W: Word> Camera<W> {
    /// The camera, if the kernel holds every direction in the picture, and the word all sums.
    ///
    /// A step is linear in x and y, so the outermost ones decide. Let all four be below B. The partial sums x B, y C and
    /// x B + y C are differences of steps, so below 2 B, which the word must hold.
    ///
    /// B has the bits of a direction, or for the origins of parallel rays one more than the grid: by
    /// [`CameraHeader::starts_within`] they are in (-2^bits, 2^(bits + 1)) then.
    #[must_use]
    pub fn new<K: Kernel<Word = W>>(header: &CameraHeader, used: Use) -> Option<Self> {
        let bits = if used.parallel { K::GRID_BITS + 1 } else { K::DIRECTION_BITS };
        let fraction_bits = u32::from(header.fraction_bits);
        // 2 B is below 2^62, and less one it is a word.
        if bits + fraction_bits + 1 > (8 * size_of::<W>() as u32 - 1).min(62) {
            return None;
        }
        let bound = 1i64 << (bits + fraction_bits);
        let half = (1i64 << fraction_bits) >> 1;
        for ends_2x in header.ends_2x(used) {
            for end_2x in ends_2x {
                if end_2x?.checked_abs()? >= 2 * (bound - half - used.error()) {
                    return None;
                }
            }
        }
        let largest = if used.parallel { (1u32 << K::DIRECTION_BITS) - 1 } else { 0 };
        if header.along.iter().any(|c| c.unsigned_abs() > largest) {
            return None;
        }
        Some(Self {
            eye: header.eye.map(W::from_i32),
            along: header.along.map(W::from_i32),
            first: words(&header.first, half)?, // of the sums' bound
            right: words(&header.right, 0)?,
            down: words(&header.down, 0)?,
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
        let component = |a: W, b: W, c: W| (a + (x * b + y * c)) >> self.fraction_bits;
        [
            component(self.first[0], self.right[0], self.down[0]),
            component(self.first[1], self.right[1], self.down[1]),
            component(self.first[2], self.right[2], self.down[2]),
        ]
    }

    /// What [`Camera::direction`] rounds to nearest: fractional bits, and with so many the value in a pixel and what a step to
    /// the right and one down adds.
    #[inline]
    #[must_use]
    pub fn linear(&self, x: u16, y: u16) -> (u32, [Triple<W>; 3]) {
        let (x, y) = (W::from_i32(x.into()), W::from_i32(y.into()));
        let half = (W::ONE << self.fraction_bits) >> 1;
        let component = |axis: usize| self.first[axis] + (x * self.right[axis] + y * self.down[axis]) - half;
        (self.fraction_bits, [[component(0), component(1), component(2)], self.right, self.down])
    }

    /// The origin and the direction of the parallel ray through a pixel.
    #[inline]
    #[must_use]
    pub fn parallel(&self, x: u16, y: u16) -> (Triple<W>, Triple<W>) {
        let (eye, step) = (self.eye, self.direction(x, y));
        ([eye[0] + step[0], eye[1] + step[1], eye[2] + step[2]], self.along)
    }

    /// The camera whose rays go through another place of each pixel than the middle.
    #[inline]
    #[must_use]
    pub fn through(&self, place: Place) -> Self {
        let [right, down] = place.off_middle().map(W::from_i32);
        let moved = |a: W, b: W, c: W| a + part(b, right) + part(c, down);
        let first = [
            moved(self.first[0], self.right[0], self.down[0]),
            moved(self.first[1], self.right[1], self.down[1]),
            moved(self.first[2], self.right[2], self.down[2]),
        ];
        Self { first, ..*self }
    }
}

/// `step * part / 2^16`, rounded down, for a part in [-2^15, 2^15].
///
/// By halves, so that nothing is wider than the word: the upper one times the part is at most half of the step, and the
/// lower one, below 2^16, at most 2^31 - 2^15.
#[inline]
fn part<W: Word>(step: W, part: W) -> W {
    let high = step >> PLACE_BITS;
    let low = step - (high << PLACE_BITS);
    high * part + ((low * part) >> PLACE_BITS)
}
