//! Triangles that are put into a tile where they are the nearest. See [`tile`](crate::tile).

use super::rows::{Row, Rows};
use super::together::BeamOf;
use super::{Bvh, RayOf};
use crate::kernel::NONE;
use crate::num::BitLength;
use crate::profile::Profile;
use crate::render::Tile;
use crate::tile::{Beam, Edges, Linear, ROOM, SIDE};

/// A nearness a pixel, in rows of [`SIDE`].
pub(super) type Nearnesses = [i16; PIXELS];
const _: () = assert!(size_of::<Nearnesses>() < ROOM);

/// The pixels of the largest tile.
const PIXELS: usize = 1 << (2 * SIDE_BITS);
const SIDE_BITS: u32 = SIDE.trailing_zeros();

/// The nearness of no hit; others are not negative.
const NOWHERE: i16 = i16::MIN;

/// The bits of a nearness for which there is room to be as near again, twice.
const NEARNESS_BITS: u32 = 13;

/// A band wider than all differences.
pub(super) const UNKNOWN: i32 = 1 << 17;

/// A tile's hits so far.
pub(super) struct Found<'h> {
    /// From the tile's first pixel on.
    hits: &'h mut [u32],
    /// From row to row.
    stride: usize,
    /// The first pixel without a hit, in rows of [`SIDE`].
    open: usize,
    /// How near each hit is; [`i16::MAX`] for what is no pixel of the tile.
    nearness: &'h mut Nearnesses,
    /// By what a nearness is shifted to the right; known from the first triangle on.
    shift: Option<u32>,
    /// By what they may be wrong.
    pub(super) band: i32,
}

impl<'h> Found<'h> {
    /// Nothing yet.
    pub(super) fn new(hits: &'h mut [u32], stride: usize, nearness: &'h mut Nearnesses, tile: Tile) -> Self {
        nearness.fill(i16::MAX);
        // Counted: to know how many chunks there are takes a division.
        let mut start = 0;
        for nearness in nearness.as_chunks_mut::<{ SIDE as usize }>().0.iter_mut().take(tile.height.into()) {
            hits.get_mut(start..start + usize::from(tile.width)).unwrap_or_default().fill(NONE);
            nearness.get_mut(..tile.width.into()).unwrap_or_default().fill(NOWHERE);
            start += stride;
        }
        Self { hits, stride, open: 0, nearness, shift: None, band: 0 }
    }

    /// Whether every pixel has a hit since this was last asked.
    #[inline(always)]
    pub(super) fn closes(&mut self) -> bool {
        let rest = self.nearness.get(self.open..).unwrap_or_default();
        let closed = rest.iter().position(|&nearness| nearness == NOWHERE).unwrap_or(rest.len());
        self.open += closed;
        closed > 0 && self.open == PIXELS
    }

    /// What every pixel's hit is at least as near as.
    #[inline(never)]
    pub(super) fn least(&self) -> i32 {
        let least = self.nearness.iter().copied().fold(i16::MAX, i16::min);
        // Below 2^30 as the nearnesses were before they were shifted.
        (i32::from(least) - self.band).max(0) << self.shift.unwrap_or(0)
    }

    #[inline(always)]
    pub(super) fn hit(&self, [x, y]: [usize; 2]) -> u32 {
        self.hits.get(y * self.stride + x).copied().unwrap_or(NONE)
    }

    #[inline(always)]
    pub(super) fn set(&mut self, [x, y]: [usize; 2], index: u32, nearness: i16) {
        if let Some(hit) = self.hits.get_mut(y * self.stride + x) {
            *hit = index;
        }
        self.nearness[(y << SIDE_BITS | x) % PIXELS] = nearness;
    }
}

/// A triangle that is put where it is the nearest.
///
/// What its nearness and that of another hit are wrong by is at most `spread`; where they differ by more, their order is that of
/// the hits. Elsewhere, and where the triangle's edges do not decide, the pixel's ray is asked.
pub(super) struct Drawing<'a, 'h, 'b, P: Profile, R> {
    candidate: Candidate<'a, 'b, P, R>,
    /// By what the triangle's nearness is shifted to the right, in all.
    shift: u32,
    /// Whether there is room for it in all pixels of the tile.
    fits: bool,
    /// It then, if there is.
    nearness_q16: Linear,
    /// By what it may be wrong then; one for each shift, and one for that of the band.
    band: i32,
    /// By what its difference from another may be.
    spread: i32,
    found: &'a mut Found<'h>,
}

impl<'a, 'h, 'b, P: Profile, R: Fn([u16; 2]) -> Option<RayOf<P>>> Drawing<'a, 'h, 'b, P, R> {
    #[inline(always)]
    pub(super) fn new(
        bvh: &'a Bvh<'b, P>,
        edges: &'a Edges,
        ray: &'a R,
        tile: Tile,
        index: u32,
        found: &'a mut Found<'h>,
    ) -> Self {
        let shift = *found.shift.get_or_insert_with(|| {
            let most = edges.nearness.most([i32::from(tile.width) - 1, i32::from(tile.height) - 1]) >> edges.shift;
            most.max(0).unsigned_abs().bit_length().saturating_sub(NEARNESS_BITS)
        });
        let shift = (edges.shift + shift).min(31);
        let band = (edges.band >> shift) + 3;
        let spread = found.band + band;
        let Linear { first, right, down } = edges.nearness;
        let [first_size, right_size, down_size] = [first, right, down].map(i32::unsigned_abs);
        let fits = (first_size >> 1 | right_size << SIDE_BITS | down_size << SIDE_BITS) >> shift >> 13 == 0;
        let scaled = |value: i32| if shift < 16 { value << (16 - shift) } else { value >> (shift - 16) };
        let nearness_q16 = Linear { first: scaled(first), right: scaled(right), down: scaled(down) };
        let candidate = Candidate { bvh, ray, index, tile, edges };
        Self { candidate, shift, fits, nearness_q16, band, spread, found }
    }

    /// Goes through the tile by rows.
    #[inline(always)]
    pub(super) fn draw(mut self) {
        let Candidate { edges, tile, .. } = self.candidate;
        let (last, height) = (i32::from(tile.width) - 1, i32::from(tile.height));
        if let Some(mut rows) = Rows::new(edges) {
            let mut y = rows.skip(height);
            // A triangle is convex: below a row that it does not reach is none that it does.
            while y < height && rows.is_reached() {
                if let Some(row) = rows.row(last) {
                    self.row(row, y);
                }
                rows.advance();
                y += 1;
            }
        } else {
            for y in 0..height {
                for x in 0..=last {
                    if edges.edges.iter().all(|edge| edge.line.at(x, y) >= 0) {
                        self.pixel(x, y);
                    }
                }
            }
        }
        self.found.band = self.found.band.max(self.band);
    }

    #[inline(always)]
    fn row(&mut self, Row { mut first, mut last, certain }: Row, y: i32) {
        while first < certain[0] && first <= last {
            self.pixel(first, y);
            first += 1;
        }
        while last > certain[1] && first <= last {
            self.pixel(last, y);
            last -= 1;
        }
        while first <= last {
            let left_out = self.fill(first, last, y);
            if left_out <= last {
                self.pixel(left_out, y);
            }
            first = left_out + 1;
        }
    }

    /// Goes through pixels of a row that the triangle certainly covers, up to the first whose ray is to be asked.
    #[inline(never)]
    fn fill(&mut self, first: i32, last: i32, y: i32) -> i32 {
        if !self.fits {
            return first;
        }
        let Linear { first: value, right, down } = self.nearness_q16;
        let mut value = value.wrapping_add(first * right).wrapping_add(y * down);
        let (place, count) = ([first as usize, y as usize], (last + 1 - first) as usize);
        let start = place[1] * self.found.stride + place[0];
        let hits = self.found.hits.get_mut(start..).and_then(|hits| hits.get_mut(..count));
        let start = (place[1] << SIDE_BITS | place[0]) % PIXELS;
        let (Some(hits), Some(olds)) = (hits, self.found.nearness[start..].get_mut(..count)) else { return last + 1 };
        let (spread, index) = (self.spread, self.candidate.index);
        for (done, (hit, old)) in hits.iter_mut().zip(olds).enumerate() {
            let nearness = value >> 16;
            let nearer = nearness - i32::from(*old);
            if nearer > spread {
                (*hit, *old) = (index, nearness as i16);
            } else if nearer >= -spread {
                return first + done as i32;
            }
            value += right;
        }
        last + 1
    }

    /// A pixel that the triangle may cover.
    #[inline(never)]
    fn pixel(&mut self, x: i32, y: i32) {
        let nearness = within(self.candidate.edges.nearness.at(x, y) >> (self.shift & 31));
        let place = [x as usize, y as usize];
        let nearer = nearness - i32::from(self.found.nearness[(place[1] << SIDE_BITS | place[0]) % PIXELS]);
        if nearer >= -self.spread && self.candidate.replaces([x, y], self.found.hit(place), nearer > self.spread) {
            self.found.set(place, self.candidate.index, nearness as i16);
        }
    }
}

/// A triangle, and what its pixels' rays are asked by.
struct Candidate<'a, 'b, P: Profile, R> {
    bvh: &'a Bvh<'b, P>,
    ray: &'a R,
    index: u32,
    tile: Tile,
    edges: &'a Edges,
}

impl<P: Profile, R: Fn([u16; 2]) -> Option<RayOf<P>>> Candidate<'_, '_, P, R> {
    /// By the pixel's ray: whether the triangle is hit, where that is all there is to know; else also whether it is nearer than
    /// what is hit there so far.
    #[inline(never)]
    fn replaces(&self, place: [i32; 2], hit: u32, is_nearer: bool) -> bool {
        let [x, y] = place.map(|c| c as u16);
        let Some(ray) = (self.ray)([self.tile.x + x, self.tile.y + y]) else { return false };
        match BeamOf::<P>::meets(&ray, self.edges) {
            Some(false) => false,
            Some(true) if is_nearer => true,
            _ => self.bvh.replaces(&ray, self.index, hit),
        }
    }
}

/// A nearness that there is room for. What is nearer is as near as there is room for, and so not certainly nearer than another of
/// these. A hit's is positive but for its error.
#[inline(always)]
fn within(nearness: i32) -> i32 {
    // One comparison for most.
    if (0..=i16::MAX.into()).contains(&nearness) { nearness } else { nearness.clamp(0, i16::MAX.into()) }
}
