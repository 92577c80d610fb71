//! The walk of a tile's rays together. See [`tile`](crate::tile).

use core::num::NonZeroU32;

use super::{Bvh, Child, DistanceOf, Intersect, RayOf, Stack, waiting};
use crate::camera::Camera;
use crate::kernel::{Kernel, NONE};
use crate::num::{BitLength, Triple};
use crate::profile::Profile;
use crate::render::Tile;
use crate::stats::Stats;
use crate::tile::{Beam, Edges, Footprint, Linear, SIDE};

type BeamOf<P> = <<P as Profile>::Kernel as Kernel>::Beam;

/// The pixels of the largest tile.
const PIXELS: usize = 1 << (2 * SIDE_BITS);
const SIDE_BITS: u32 = SIDE.trailing_zeros();

/// Pixels a side of a block, which is left out at once where a triangle does not reach it.
const BLOCK: i32 = 4;

/// The nearness of no hit; others are above it.
const NOWHERE: i16 = i16::MIN;

/// The bits of a nearness for which there is room to be as near again, twice.
const NEARNESS_BITS: u32 = 13;

/// A band wider than all differences.
const UNKNOWN: i32 = 1 << 17;

/// A tile's hits so far.
struct Found<'h> {
    /// From the tile's first pixel on.
    hits: &'h mut [u32],
    /// From row to row.
    stride: usize,
    /// Pixels without a hit.
    left: usize,
    /// How near each hit is, in rows of [`SIDE`].
    nearness: [i16; PIXELS],
    /// By what a nearness is shifted to the right; known from the first triangle on.
    shift: Option<u32>,
    /// By what they may be wrong.
    band: i32,
}

impl<P: Profile> Bvh<'_, P> {
    /// See [`Intersect::closest_tile`].
    pub(super) fn tile(
        &self,
        camera: Option<&Camera<<P::Kernel as Kernel>::Word>>,
        ray: impl Fn([u16; 2]) -> Option<RayOf<P>>,
        tile: Tile,
        hits: &mut [u32],
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
    ) {
        let stride = usize::from(tile.width);
        for part in Tile::of([tile.width, tile.height], [SIDE; 2]) {
            let start = usize::from(part.y) * stride + usize::from(part.x);
            let hits = hits.get_mut(start..).unwrap_or_default();
            let part = Tile { x: tile.x + part.x, y: tile.y + part.y, ..part };
            match camera.and_then(|camera| BeamOf::<P>::new(camera, part)) {
                Some(beam) if self.spheres.is_empty() => self.together(&beam, &ray, part, hits, stride, stack, stats),
                _ => {
                    for (y, row) in (part.y..).zip(hits.chunks_mut(stride).take(part.height.into())) {
                        for (x, hit) in (part.x..).zip(row.iter_mut().take(part.width.into())) {
                            *hit = ray([x, y]).as_ref().map_or(NONE, |ray| self.closest(ray, stack, stats));
                        }
                    }
                }
            }
        }
    }

    #[expect(clippy::too_many_arguments)]
    fn together(
        &self,
        beam: &BeamOf<P>,
        ray: &impl Fn([u16; 2]) -> Option<RayOf<P>>,
        tile: Tile,
        hits: &mut [u32],
        stride: usize,
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
    ) {
        for row in hits.chunks_mut(stride).take(tile.height.into()) {
            row.get_mut(..tile.width.into()).unwrap_or_default().fill(NONE);
        }
        let mut found =
            Found { hits, stride, left: tile.pixels(), nearness: [NOWHERE; PIXELS], shift: None, band: 0 };
        let mut edges = Edges::default();
        let mut limit = beam.reach();
        let mut next = Some(self.root);
        stack.clear();
        while let Some(leaf) = next.and_then(|child| self.entered(beam, child, limit, stack, stats)) {
            let Child::Leaf { first, count } = Child::unpack(leaf.get()) else { return };
            let left = found.left;
            for index in first..first + count {
                let Some(vertices) = self.triangles.vertices(index) else { continue };
                stats.triangle();
                match beam.footprint(&vertices, &mut edges) {
                    Footprint::Nothing => {}
                    Footprint::Edges => Drawing::new(self, &edges, ray, tile, index, &mut found).draw(),
                    Footprint::Unknown => self.try_all(ray, tile, index, &mut found),
                }
            }
            if left != 0 && found.left == 0 {
                limit = found.limit::<P>(beam, tile);
            }
            next = waiting::<P::Kernel>(stack, limit);
        }
    }

    #[inline(always)]
    fn entered(
        &self,
        beam: &BeamOf<P>,
        child: u32,
        limit: DistanceOf<P>,
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
    ) -> Option<NonZeroU32> {
        match beam.axis() {
            0 => self.entered_along::<0>(beam, child, limit, stack, stats),
            1 => self.entered_along::<1>(beam, child, limit, stack, stats),
            _ => self.entered_along::<2>(beam, child, limit, stack, stats),
        }
    }

    #[inline(never)]
    fn entered_along<const AXIS: usize>(
        &self,
        beam: &BeamOf<P>,
        child: u32,
        limit: DistanceOf<P>,
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
    ) -> Option<NonZeroU32> {
        self.descend(child, limit, stack, stats, |node, child| beam.enter::<AXIS>(node, child, limit))
    }

    /// Puts a triangle where it is the nearest, by testing every ray.
    #[inline(never)]
    fn try_all(
        &self,
        ray: &impl Fn([u16; 2]) -> Option<RayOf<P>>,
        tile: Tile,
        index: u32,
        found: &mut Found<'_>,
    ) {
        for [x, y] in tile.places() {
            let place = [x - tile.x, y - tile.y].map(usize::from);
            let hit = found.hit(place);
            if ray([x, y]).is_some_and(|ray| self.replaces(&ray, index, hit)) {
                found.set(place, index, 0);
                found.band = UNKNOWN;
            }
        }
    }

    /// Whether a ray hits a triangle, nearer than another that it hits or that is [`NONE`].
    #[inline(never)]
    fn replaces(&self, ray: &RayOf<P>, index: u32, other: u32) -> bool {
        let depth = |index: u32| self.triangles.get(index).and_then(|triangle| P::Kernel::intersect(ray, &triangle));
        let Some(new) = depth(index) else { return false };
        depth(other).is_none_or(|old| self.nearer((index, &new), (other, &old)))
    }
}

impl Found<'_> {
    /// Nothing counts beyond what is nearest in every pixel, where every pixel has something.
    #[inline(never)]
    fn limit<P: Profile>(&self, beam: &BeamOf<P>, tile: Tile) -> DistanceOf<P> {
        let rows = self.nearness.chunks(SIDE.into()).take(tile.height.into());
        let least = rows.flat_map(|row| row.iter().take(tile.width.into())).min().copied();
        let least = i32::from(least.unwrap_or(NOWHERE)) - self.band;
        beam.limit(least << self.shift.unwrap_or(0))
    }

    #[inline(always)]
    fn hit(&self, [x, y]: [usize; 2]) -> u32 {
        self.hits.get(y * self.stride + x).copied().unwrap_or(NONE)
    }

    #[inline(always)]
    fn set(&mut self, [x, y]: [usize; 2], index: u32, nearness: i16) {
        if let Some(hit) = self.hits.get_mut(y * self.stride + x) {
            self.left -= usize::from(*hit == NONE);
            *hit = index;
        }
        self.nearness[(y << SIDE_BITS | x) % PIXELS] = nearness;
    }
}

/// A triangle that is put where it is the nearest.
struct Drawing<'a, 'h, 'b, P: Profile, R> {
    bvh: &'a Bvh<'b, P>,
    ray: &'a R,
    index: u32,
    tile: Tile,
    edges: &'a Edges,
    /// By what the nearness of the triangle is shifted, and what a difference to another may be off.
    shift: u32,
    band: i32,
    spread: i32,
    found: &'a mut Found<'h>,
    changed: bool,
}

impl<'a, 'h, 'b, P: Profile, R: Fn([u16; 2]) -> Option<RayOf<P>>> Drawing<'a, 'h, 'b, P, R> {
    #[inline(always)]
    fn new(
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
    fn draw(mut self) {
        let [a, b, c] = &self.edges.edges;
        let most = |edge: &Linear| edge.first + (BLOCK - 1) * (edge.right.max(0) + edge.down.max(0));
        let right = [a.right * BLOCK, b.right * BLOCK, c.right * BLOCK];
        let down = [a.down * BLOCK, b.down * BLOCK, c.down * BLOCK];
        let mut outside = outside([most(a), most(b), most(c)], right, down);
        let mut block = 0;
        while outside != ALL_OUTSIDE {
            if outside >> 31 == 0 {
                self.block(block & 3, block >> 2);
            }
            outside = outside << 1 | 1;
            block += 1;
        }
        if self.changed {
            self.found.band = self.found.band.max(self.band);
        }
    }

    #[inline(always)]
    fn block(&mut self, x: i32, y: i32) {
        let [a, b, c] = &self.edges.edges;
        let (right, down) = ([a.right, b.right, c.right], [a.down, b.down, c.down]);
        let (x0, y0) = (x * BLOCK, y * BLOCK);
        let start = |edge: &Linear| edge.first + x0 * edge.right + y0 * edge.down;
        let mut row = [start(a), start(b), start(c)];
        let most = right.map(|step| (BLOCK - 1) * step.max(0));
        let [p, q, r] = self.edges.uncertain.map(|c| -c);
        let (x_end, y_end) = (i32::from(self.tile.width).min(x0 + BLOCK), i32::from(self.tile.height).min(y0 + BLOCK));
        let mut y = y0;
        while y < y_end {
            let [mut a, mut b, mut c] = row;
            if ((a + most[0]) | (b + most[1]) | (c + most[2])) >= 0 {
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
        // What is too near for the room is as near as there is room for, and so not certainly nearer than another of these.
        let nearness = (self.edges.nearness(x, y) >> (self.shift & 31)).min(i16::MAX.into());
        let place = [x as usize, y as usize];
        let nearer = nearness - i32::from(self.found.nearness[(place[1] << SIDE_BITS | place[0]) % PIXELS]);
        let is_nearer = nearer > self.spread;
        if nearer < -self.spread || (!(is_certain && is_nearer) && !self.replaces(place, is_nearer)) {
            return;
        }
        self.found.set(place, self.index, nearness as i16);
        self.changed = true;
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
