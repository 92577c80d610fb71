//! The walk of a tile's rays together. See [`tile`](crate::tile).

use core::num::NonZeroU32;

use super::{Bvh, Child, DistanceOf, Intersect, Primitive, RayOf, Stack, waiting};
use crate::camera::Camera;
use crate::kernel::{Kernel, NONE};
use crate::profile::{Need, Profile};
use crate::render::Tile;
use crate::stats::Stats;
use crate::tile::{Beam, Footprint, NOWHERE, SIDE};

type BeamOf<P> = <<P as Profile>::Kernel as Kernel>::Beam;

/// The entries of a tile of [`SIDE`] pixels.
const PIXELS: usize = SIDE as usize * SIDE as usize;

/// What a band is where nothing is known: twice it is still below 2^31 less a nearness.
const UNKNOWN: i32 = 1 << 29;

/// A tile's hits so far.
struct Found<'h> {
    /// From the tile's first pixel on.
    hits: &'h mut [u32],
    /// From row to row.
    stride: usize,
    /// How near each hit is, within the band; [`NOWHERE`] where there is none.
    nearness: [i32; PIXELS],
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
                Some(beam) => {
                    for row in hits.chunks_mut(stride).take(part.height.into()) {
                        row.get_mut(..part.width.into()).unwrap_or_default().fill(NONE);
                    }
                    let mut found = Found { hits, stride, nearness: [NOWHERE; PIXELS], band: 0 };
                    self.together(&beam, &ray, part, &mut found, stack, stats);
                }
                None => {
                    for (y, row) in (part.y..).zip(hits.chunks_mut(stride).take(part.height.into())) {
                        for (x, hit) in (part.x..).zip(row.iter_mut().take(part.width.into())) {
                            *hit = ray([x, y]).as_ref().map_or(NONE, |ray| self.closest(ray, stack, stats));
                        }
                    }
                }
            }
        }
    }

    fn together(
        &self,
        beam: &BeamOf<P>,
        ray: &impl Fn([u16; 2]) -> Option<RayOf<P>>,
        tile: Tile,
        found: &mut Found<'_>,
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
    ) {
        let mut limit = beam.reach();
        let mut next = Some(self.root);
        stack.clear();
        while let Some(leaf) = next.and_then(|child| self.entered(beam, child, limit, stack, stats)) {
            let Child::Leaf { first, count } = Child::unpack(leaf.get()) else { return };
            let mut changed = false;
            for index in first..first + count {
                changed |= self.cover(beam, ray, tile, index, found, stats);
            }
            if changed {
                limit = found.limit::<P>(beam, tile);
            }
            next = waiting::<P::Kernel>(stack, limit);
        }
    }

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

    /// Puts a primitive where it is the nearest; whether it is anywhere.
    #[inline(never)]
    fn cover(
        &self,
        beam: &BeamOf<P>,
        ray: &impl Fn([u16; 2]) -> Option<RayOf<P>>,
        tile: Tile,
        index: u32,
        found: &mut Found<'_>,
        stats: &mut impl Stats,
    ) -> bool {
        let footprint = match self.triangles.get(index as usize) {
            Some(triangle) => beam.footprint(&P::Kernel::vertices(triangle)),
            None => Footprint::Unknown,
        };
        stats.triangle();
        let last = [i32::from(tile.width) - 1, i32::from(tile.height) - 1];
        let mut changed = false;
        match footprint {
            Footprint::Nothing => {}
            Footprint::Edges(edges) => {
                let spread = found.band + edges.band;
                let Found { hits, stride, nearness, .. } = found;
                edges.visit(last, |x, y, certain| {
                    let near = edges.nearness(x, y);
                    let nearest = &mut nearness[(y as usize * usize::from(SIDE) + x as usize) % PIXELS];
                    let nearer = near - *nearest;
                    if nearer < -spread {
                        return;
                    }
                    let Some(hit) = hits.get_mut(y as usize * *stride + x as usize) else { return };
                    if !(certain && nearer > spread) {
                        let [x, y] = [tile.x + x as u16, tile.y + y as u16];
                        if !ray([x, y]).is_some_and(|ray| self.replaces(&ray, index, *hit)) {
                            return;
                        }
                    }
                    (*hit, *nearest, changed) = (index, near, true);
                });
                if changed {
                    found.band = found.band.max(edges.band);
                }
            }
            Footprint::Unknown => {
                for (place, [x, y]) in tile.places().enumerate() {
                    let row = place / usize::from(tile.width);
                    let column = place % usize::from(tile.width);
                    let Some(hit) = found.hits.get_mut(row * found.stride + column) else { continue };
                    if ray([x, y]).is_some_and(|ray| self.replaces(&ray, index, *hit)) {
                        *hit = index;
                        found.nearness[(row * usize::from(SIDE) + column) % PIXELS] = 0;
                        found.band = UNKNOWN;
                        changed = true;
                    }
                }
            }
        }
        changed
    }

    /// Whether a ray hits a primitive, nearer than another that it hits or that is [`NONE`].
    #[inline(never)]
    fn replaces(&self, ray: &RayOf<P>, index: u32, other: u32) -> bool {
        let depth = |index| self.primitive(index).and_then(|primitive| primitive.intersect(ray));
        let Some(new) = depth(index) else { return false };
        depth(other).is_none_or(|old| self.nearer((index, &new), (other, &old)))
    }

    fn primitive(&self, index: u32) -> Option<Primitive<'_, P::Kernel>> {
        match self.triangles.get(index as usize) {
            Some(triangle) => Some(Primitive::Triangle(triangle)),
            None if P::NEEDS.has(Need::Spheres) => self.sphere(index).map(|sphere| Primitive::Sphere(sphere, false)),
            None => None,
        }
    }
}

impl Found<'_> {
    /// Nothing counts beyond what is nearest in every pixel.
    #[inline(never)]
    fn limit<P: Profile>(&self, beam: &BeamOf<P>, tile: Tile) -> DistanceOf<P> {
        let rows = self.nearness.chunks(SIDE.into()).take(tile.height.into());
        let least = rows.flat_map(|row| row.iter().take(tile.width.into())).min().copied();
        beam.limit(least.unwrap_or(NOWHERE) - self.band)
    }
}
