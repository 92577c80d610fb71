//! Triangles that are put into a tile where they are the nearest. See [`tile`](crate::tile).

use super::together::BeamOf;
use super::{Bvh, RayOf};
use crate::kernel::NONE;
use crate::num::{BitLength, Triple};
use crate::profile::Profile;
use crate::render::Tile;
use crate::tile::{Beam, Edges, Linear, ROOM, SIDE};

/// A nearness a pixel, in rows of [`SIDE`].
pub(super) type Nearnesses = [i16; PIXELS];
const _: () = assert!(size_of::<Nearnesses>() < ROOM);

/// The pixels of the largest tile.
const PIXELS: usize = 1 << (2 * SIDE_BITS);
const SIDE_BITS: u32 = SIDE.trailing_zeros();

/// Pixels a side of a block, which is left out at once where a triangle does not reach it.
const BLOCK: i32 = 4;

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
        let rows = hits.chunks_mut(stride.max(1)).zip(nearness.as_chunks_mut::<{ SIDE as usize }>().0);
        for (hits, nearness) in rows.take(tile.height.into()) {
            hits.get_mut(..tile.width.into()).unwrap_or_default().fill(NONE);
            nearness.get_mut(..tile.width.into()).unwrap_or_default().fill(NOWHERE);
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
    bvh: &'a Bvh<'b, P>,
    ray: &'a R,
    index: u32,
    tile: Tile,
    edges: &'a Edges,
    /// By what the triangle's nearness is shifted to the right, in all.
    shift: u32,
    /// By what it may be wrong then; one for each shift, and one for that of the band.
    band: i32,
    /// By what its difference from another may be.
    spread: i32,
    found: &'a mut Found<'h>,
    changed: bool,
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
        let band = (edges.band >> shift) + 2;
        let spread = found.band + band;
        Self { bvh, ray, index, tile, edges, shift, band, spread, found, changed: false }
    }

    /// Goes through the tile by blocks.
    #[inline(never)]
    pub(super) fn draw(mut self) {
        let [a, b, c] = &self.edges.edges;
        let most = |edge: &Linear| edge.first + (BLOCK - 1) * (edge.right.max(0) + edge.down.max(0));
        let right = [a.right * BLOCK, b.right * BLOCK, c.right * BLOCK];
        let down = [a.down * BLOCK, b.down * BLOCK, c.down * BLOCK];
        let mut outside = outside([most(a), most(b), most(c)], right, down);
        let mut block = 0;
        while outside != ALL_OUTSIDE {
            if outside >> 31 == 0 {
                self.block((block & 3) * BLOCK, (block >> 2) * BLOCK);
            }
            outside = outside << 1 | 1;
            block += 1;
        }
        if self.changed {
            self.found.band = self.found.band.max(self.band);
        }
    }

    #[inline(always)]
    fn block(&mut self, x0: i32, y0: i32) {
        let [a, b, c] = &self.edges.edges;
        let (right, down) = ([a.right, b.right, c.right], [a.down, b.down, c.down]);
        let start = |edge: &Linear| edge.first + x0 * edge.right + y0 * edge.down;
        let most = right.map(|step| (BLOCK - 1) * step.max(0));
        // The largest values of a row.
        let mut row = [start(a) + most[0], start(b) + most[1], start(c) + most[2]];
        let [p, q, r] = self.edges.uncertain.map(|c| -c);
        let (x_end, y_end) = (i32::from(self.tile.width).min(x0 + BLOCK), i32::from(self.tile.height).min(y0 + BLOCK));
        let mut y = y0;
        while y < y_end {
            if (row[0] | row[1] | row[2]) >= 0 {
                let [mut a, mut b, mut c] = [row[0] - most[0], row[1] - most[1], row[2] - most[2]];
                let mut x = x0;
                while x < x_end {
                    if (a | b | c) >= 0 {
                        self.pixel(x, y, ((a + p) | (b + q) | (c + r)) >= 0);
                    }
                    (a, b, c) = (a + right[0], b + right[1], c + right[2]);
                    x += 1;
                }
            }
            row = [row[0] + down[0], row[1] + down[1], row[2] + down[2]];
            y += 1;
        }
    }

    #[inline(always)]
    fn pixel(&mut self, x: i32, y: i32, is_certain: bool) {
        // What is too near for the room is as near as there is room for, and so not certainly nearer than another of these. A
        // hit's is positive but for its error.
        let nearness = (self.edges.nearness(x, y) >> (self.shift & 31)).clamp(0, i16::MAX.into());
        let place = [x as usize, y as usize];
        let nearer = nearness - i32::from(self.found.nearness[(place[1] << SIDE_BITS | place[0]) % PIXELS]);
        let is_nearer = nearer > self.spread;
        if nearer >= -self.spread && (is_certain && is_nearer || self.replaces(place, is_nearer)) {
            self.found.set(place, self.index, nearness as i16);
            self.changed = true;
        }
    }

    /// By the pixel's ray: whether the triangle is hit, where that is all there is to know; else also whether it is the nearest.
    #[inline(never)]
    fn replaces(&self, place: [usize; 2], is_nearer: bool) -> bool {
        let [x, y] = place.map(|c| c as u16);
        let Some(ray) = (self.ray)([self.tile.x + x, self.tile.y + y]) else { return false };
        match BeamOf::<P>::meets(&ray, self.edges) {
            Some(false) => false,
            Some(true) if is_nearer => true,
            _ => self.bvh.replaces(&ray, self.index, self.found.hit(place)),
        }
    }
}

/// What [`outside`] says where nothing is inside, and behind the last place.
const ALL_OUTSIDE: u32 = u32::MAX;

/// Whether one of three functions is negative, in four rows of four places, from the highest bit down; the other bits are set.
#[inline(never)]
fn outside([mut a, mut b, mut c]: Triple<i32>, right: Triple<i32>, down: Triple<i32>) -> u32 {
    let back = [down[0] - 4 * right[0], down[1] - 4 * right[1], down[2] - 4 * right[2]];
    let mut outside = 0;
    for _ in 0..4 {
        for _ in 0..4 {
            outside = outside << 1 | (a | b | c).cast_unsigned() >> 31;
            (a, b, c) = (a + right[0], b + right[1], c + right[2]);
        }
        (a, b, c) = (a + back[0], b + back[1], c + back[2]);
    }
    outside << 16 | 0xffff
}
