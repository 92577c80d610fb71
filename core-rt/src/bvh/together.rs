//! The walk of a tile's rays together. See [`tile`](crate::tile).

use core::num::NonZeroU32;

use zerocopy::FromBytes;

use super::drawing::{Drawing, Found, Nearnesses, UNKNOWN};
use super::{Bvh, Child, DistanceOf, Intersect, RayOf, Stack, waiting};
use crate::camera::Camera;
use crate::kernel::{Kernel, NONE};
use crate::profile::{Prefer, Profile};
use crate::render::Tile;
use crate::stats::Stats;
use crate::tile::{Beam, Edges, Footprint, Linear, SIDE};

/// Leaves of spheres that wait until all triangles of a tile are where they are; others are put at once, and rays asked of what is
/// found after them.
const ASIDE: usize = 8;

pub(super) type BeamOf<P> = <<P as Profile>::Kernel as Kernel>::Beam;

impl<P: Profile> Bvh<'_, P> {
    /// Whether tiles walk together, which is more code.
    const HAS_TILES: bool = matches!(P::PREFER, Prefer::Speed);

    /// See [`Intersect::closest_tile`].
    #[expect(clippy::too_many_arguments, reason = "the storage of a tile has three parts")]
    pub(super) fn tile(
        &self,
        camera: Option<&Camera<<P::Kernel as Kernel>::Word>>,
        ray: impl Fn([u16; 2]) -> Option<RayOf<P>>,
        tile: Tile,
        hits: &mut [u32],
        room: &mut [u8],
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
    ) {
        let one = |place, stack: &mut _, stats: &mut _| ray(place).map_or(NONE, |ray| self.closest(&ray, stack, stats));
        if !Self::HAS_TILES {
            for (hit, place) in hits.iter_mut().zip(tile.places()) {
                *hit = one(place, stack, stats);
            }
            return;
        }
        let start = room.as_ptr().align_offset(align_of::<Nearnesses>());
        let room = room.get_mut(start..).and_then(|room| Nearnesses::mut_from_prefix(room).ok());
        let (camera, mut room) = (camera.filter(|_| room.is_some()), room.map(|(room, _)| room));
        let stride = usize::from(tile.width);
        for part in Tile::of([tile.width, tile.height], [SIDE; 2]) {
            let start = usize::from(part.y) * stride + usize::from(part.x);
            let hits = hits.get_mut(start..).unwrap_or_default();
            let part = Tile { x: tile.x + part.x, y: tile.y + part.y, ..part };
            // By reference: it is not small, and the stack would have it twice.
            if let (Some(beam), Some(nearness)) = (&camera.and_then(|c| BeamOf::<P>::new(c, part)), &mut room) {
                self.together(beam, &ray, part, Found::new(hits, stride, nearness, part), stack, stats);
                continue;
            }
            let mut start = 0;
            for y in part.y..part.y + part.height {
                let row = hits.get_mut(start..start + usize::from(part.width)).unwrap_or_default();
                for (x, hit) in (part.x..).zip(row) {
                    *hit = one([x, y], stack, stats);
                }
                start += stride;
            }
        }
    }

    #[inline(never)]
    fn together(
        &self,
        beam: &BeamOf<P>,
        ray: &impl Fn([u16; 2]) -> Option<RayOf<P>>,
        tile: Tile,
        mut found: Found<'_>,
        stack: &mut Stack<P::Kernel>,
        stats: &mut impl Stats,
    ) {
        let mut edges = Edges::default();
        let mut limit = beam.reach();
        let mut next = Some(self.root);
        // Spheres are put last: how near they are is known to rays alone, and triangles are drawn without asking these.
        let mut aside = heapless::Vec::<u32, ASIDE>::new();
        stack.clear();
        while let Some(leaf) = next.and_then(|child| self.entered(beam, child, limit, stack, stats)) {
            let Child::Leaf { first, count } = Child::unpack(leaf.get()) else { return };
            // No vertices are those of a sphere.
            if self.sphere(first).is_some() && aside.push(leaf.get()).is_err() {
                self.put_spheres(beam, ray, tile, leaf.get(), &mut found, stats);
            }
            for index in first..first + count {
                let vertices = self.triangles.vertices(index);
                let Some(vertices) = &vertices else { continue };
                stats.triangle();
                match beam.footprint(vertices, &mut edges) {
                    Footprint::Nothing => {}
                    Footprint::Edges => Drawing::new(self, &edges, ray, tile, index, &mut found).draw(),
                    Footprint::Unknown => self.try_where(&Default::default(), ray, tile, index, &mut found),
                }
            }
            if found.closes() {
                limit = beam.limit(found.least());
            }
            next = waiting::<P::Kernel>(stack, limit);
        }
        for &leaf in &aside {
            self.put_spheres(beam, ray, tile, leaf, &mut found, stats);
        }
    }

    /// Puts a leaf's spheres where they are the nearest, by testing rays that may meet their boxes.
    #[inline(never)]
    fn put_spheres(
        &self,
        beam: &BeamOf<P>,
        ray: &impl Fn([u16; 2]) -> Option<RayOf<P>>,
        tile: Tile,
        leaf: u32,
        found: &mut Found<'_>,
        stats: &mut impl Stats,
    ) {
        let Child::Leaf { first, count } = Child::unpack(leaf) else { return };
        for index in first..first + count {
            let Some(sphere) = self.sphere(index) else { continue };
            stats.sphere();
            // Functions that are 0 leave out nothing.
            let around = beam.around(&P::Kernel::ball(sphere).bounds()).unwrap_or_default();
            self.try_where(&around, ray, tile, index, found);
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

    /// Puts a primitive where it is the nearest, by testing every ray for which no function is negative.
    #[inline(never)]
    fn try_where(
        &self,
        functions: &[Linear; 4],
        ray: &impl Fn([u16; 2]) -> Option<RayOf<P>>,
        tile: Tile,
        index: u32,
        found: &mut Found<'_>,
    ) {
        let last = i32::from(tile.width) - 1;
        for y in 0..tile.height {
            let row = functions.map(|f| Linear { first: f.first + i32::from(y) * f.down, ..f });
            if row.iter().any(|f| f.first + last * f.right.max(0) < 0) {
                continue;
            }
            for x in 0..tile.width {
                if row.iter().any(|f| f.first + i32::from(x) * f.right < 0) {
                    continue;
                }
                let place = [x, y].map(usize::from);
                let hit = found.hit(place);
                if ray([tile.x + x, tile.y + y]).is_some_and(|ray| self.replaces(&ray, index, hit)) {
                    found.set(place, index, 0);
                    found.band = UNKNOWN;
                }
            }
        }
    }
}
