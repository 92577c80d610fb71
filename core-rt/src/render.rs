//! Pictures, tile by tile, into whatever takes pixels.
//!
//! All storage is the caller's ([`Workspace`]); a picture is never held whole. Tiles do not know of each other, so any
//! tile size, order and number of threads gives the same picture.

use crate::bvh::{Intersect, Stack};
use crate::colour::{Colour, Transfer};
use crate::kernel::{Kernel, NONE};
use crate::path;
use crate::profile::{Need, Profile};
use crate::random::Sample;
use crate::samples::Places;
use crate::scene::Scene;
use crate::shade::{ColourOf, RayOf};
use crate::stats::{RayKind, Stats};
use crate::whitted::{Branches, radiance};

/// A rectangle of a picture, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// The left column.
    pub x: u16,
    /// The top row.
    pub y: u16,
    /// Columns, at least one.
    pub width: u16,
    /// Rows, at least one.
    pub height: u16,
}

impl Tile {
    /// The number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        usize::from(self.width) * usize::from(self.height)
    }

    /// Column and row in the picture of each pixel, row by row.
    pub fn places(&self) -> impl Iterator<Item = [u16; 2]> + Clone {
        let (left, right) = (self.x, self.x.saturating_add(self.width));
        let bottom = if left < right { self.y.saturating_add(self.height) } else { 0 };
        // Two counters: a nested iterator would keep four, and ask more.
        let (mut x, mut y) = (left, self.y);
        core::iter::from_fn(move || {
            let place = [x, y];
            if y >= bottom {
                return None;
            }
            x += 1;
            if x == right {
                (x, y) = (left, y + 1);
            }
            Some(place)
        })
    }

    /// The tiles of a picture, row by row; those at the right and at the bottom are cut to fit. None where a size is 0.
    pub fn of(picture: [u16; 2], tile: [u16; 2]) -> impl Iterator<Item = Self> {
        // Two counters, and no `step_by`, which divides to know how often it will.
        let ([width, height], [right, down]) = (picture, tile.map(|side| side.max(1)));
        let (mut x, mut y) = (0, if width > 0 { 0 } else { height });
        core::iter::from_fn(move || {
            if y >= height {
                return None;
            }
            let tile = Self { x, y, width: right.min(width - x), height: down.min(height - y) };
            (x, y) =
                if tile.width < right || width - x == right { (0, y.saturating_add(down)) } else { (x + right, y) };
            Some(tile)
        })
    }
}

/// What takes a picture: a file, a display, a wire.
pub trait Sink {
    /// What can go wrong; [`core::convert::Infallible`] where nothing can.
    type Error;

    /// Takes a tile's pixels, row by row, in the format of the scene's header.
    ///
    /// # Errors
    /// Whatever the sink cannot do; rendering stops there.
    fn tile(&mut self, tile: Tile, pixels: &[u8]) -> Result<(), Self::Error>;
}

/// The storage that rendering needs.
#[derive(Debug)]
pub struct Workspace<'a, K: Kernel> {
    /// At least as deep as the scene's tree.
    pub stack: &'a mut Stack<K>,
    /// At least one more than the scene's `max_depth`; none where no ray goes on from a surface.
    pub branches: &'a mut Branches<K>,
    /// At least one entry a pixel of the largest tile.
    pub hits: &'a mut [u32],
    /// At least [`Format::bytes`](crate::format::Format::bytes) a pixel of the largest tile.
    pub pixels: &'a mut [u8],
}

/// Why a picture was not finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RenderError<E> {
    /// The stack is shallower than the scene's tree.
    Stack {
        /// Its capacity.
        capacity: usize,
        /// The levels of the tree.
        needed: usize,
    },
    /// There is room for fewer waiting rays than a pixel may have.
    Branches {
        /// Its capacity.
        capacity: usize,
        /// How many may wait.
        needed: usize,
    },
    /// The buffers hold fewer pixels than a tile.
    Tile {
        /// How many they hold.
        capacity: usize,
        /// How many a tile has.
        needed: usize,
    },
    /// The sink's own.
    Sink(E),
}

impl<E: core::fmt::Display> core::fmt::Display for RenderError<E> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Stack { capacity, needed } => {
                write!(f, "the traversal stack holds {capacity} entries, and this scene needs {needed}")
            }
            Self::Branches { capacity, needed } => {
                write!(f, "{capacity} rays may wait, and this scene needs room for {needed}")
            }
            Self::Tile { capacity, needed } => {
                write!(f, "the tile buffers hold {capacity} pixels, and the tile has {needed}")
            }
            Self::Sink(error) => error.fmt(f),
        }
    }
}

/// Renders one tile into the workspace and returns its pixels, row by row, in the format of the scene's header. The tile must lie in the picture.
///
/// # Errors
/// Where the workspace is too small.
pub fn render_tile<'w, P: Profile>(
    scene: &Scene<'_, P>,
    tile: Tile,
    workspace: &'w mut Workspace<'_, P::Kernel>,
    stats: &mut impl Stats,
) -> Result<&'w [u8], RenderError<core::convert::Infallible>> {
    let needed = usize::from(scene.frame.depth);
    let (stack, branches) = (&mut *workspace.stack, &mut *workspace.branches);
    if stack.capacity() < needed {
        return Err(RenderError::Stack { capacity: stack.capacity(), needed });
    }
    let needed = scene.branches();
    if branches.capacity() < needed {
        return Err(RenderError::Branches { capacity: branches.capacity(), needed });
    }
    // The profile says which transfers and formats there are; with one, there is no choice left at run time.
    let transfer = match (P::NEEDS.has(Need::Srgb), P::NEEDS.has(Need::Linear)) {
        (true, false) => Transfer::Srgb,
        (false, true) => Transfer::Linear,
        _ => scene.frame.transfer,
    };
    let format = P::NEEDS.format().unwrap_or(scene.frame.format);
    let count = tile.pixels();
    let lengths = [workspace.hits.len(), workspace.pixels.len()];
    let room = &mut *workspace.pixels;
    let (Some(hits), true) = (workspace.hits.get_mut(..count), lengths[1] >= count * format.bytes()) else {
        // Counted: a division would be a routine for this alone.
        let fits = |&pixels: &usize| pixels * format.bytes() <= lengths[1];
        let capacity = (1..=lengths[0]).take_while(fits).count();
        return Err(RenderError::Tile { capacity, needed: count });
    };
    let places = tile.places();
    if !P::NEEDS.has(Need::Supersampling) && !scene.follows_paths() {
        // What pixels are written to is room for depths before.
        let ray = |[x, y]: [u16; 2]| scene.primary(&scene.camera, x, y);
        scene.hits().closest_tile(scene.drawn_from(), ray, tile, hits, room, stack, stats);
    }
    let pixels = room.get_mut(..count * format.bytes()).unwrap_or_default();
    if scene.follows_paths() {
        let samples = scene.frame.samples;
        let mut left = &mut *pixels;
        for place in places {
            let mut sum = path::Sum::default();
            path::add(scene, place, 0..samples, stack, &mut sum, stats);
            if let Some(pixel) = left.split_off_mut(..format.bytes()) {
                format.put(path::mean::<P>(sum, samples), transfer, place, pixel);
            }
        }
    } else if P::NEEDS.has(Need::Supersampling) {
        // One sample goes the same way: it is in the middle, and the mean of itself.
        let samples = scene.frame.samples;
        // All samples of a pixel, then those of the next: as many rays at a time as there is room for hits, which are as
        // close together as those of a tile.
        let mut rays = places
            .clone()
            .flat_map(|[x, y]| Places::of(samples).map(move |place| scene.primary(&scene.camera.through(place), x, y)));
        let (mut sum, mut taken) = (ColourOf::<P>::default(), 0);
        let (mut unwritten, mut shown) = (&mut *pixels, places);
        let mut left = count * usize::from(samples);
        while left > 0 {
            let room = hits.len().min(left);
            left -= room;
            let hits = hits.get_mut(..room).unwrap_or_default();
            let again = rays.clone();
            for (hit, ray) in hits.iter_mut().zip(rays.by_ref()) {
                *hit = ray.as_ref().map_or(NONE, |ray| scene.hits().closest(ray, stack, stats));
            }
            for (&hit, ray) in hits.iter().zip(again) {
                let pixel = if P::NEEDS.has(Need::Roughness) { shown.clone().next() } else { None };
                let sample = Sample { pixel: pixel.unwrap_or_default(), number: taken };
                sum = sum.plus(seen(scene, ray.as_ref(), hit, sample, stack, branches, stats).clamped());
                taken += 1;
                if taken == samples {
                    if let Some((pixel, place)) = unwritten.split_off_mut(..format.bytes()).zip(shown.next()) {
                        format.put(sum.mean(samples), transfer, place, pixel);
                    }
                    (sum, taken) = (ColourOf::<P>::default(), 0);
                }
            }
        }
    } else {
        let ray = |[x, y]: [u16; 2]| scene.primary(&scene.camera, x, y);
        // Taken off one by one: to know how many chunks there are takes a division.
        let mut left = &mut *pixels;
        for (&hit, place) in hits.iter().zip(places) {
            let sample = Sample { pixel: place, number: 0 };
            let seen = seen(scene, ray(place).as_ref(), hit, sample, stack, branches, stats);
            let (pixel, rest) = core::mem::take(&mut left).split_at_mut_checked(format.bytes()).unwrap_or_default();
            format.put(seen, transfer, place, pixel);
            left = rest;
        }
    }
    Ok(pixels)
}

/// The light that a camera ray sees whose nearest hit is known.
#[inline]
fn seen<P: Profile>(
    scene: &Scene<'_, P>,
    ray: Option<&RayOf<P>>,
    hit: u32,
    sample: Sample,
    stack: &mut Stack<P::Kernel>,
    branches: &mut Branches<P::Kernel>,
    stats: &mut impl Stats,
) -> ColourOf<P> {
    stats.ray(RayKind::Primary);
    match ray {
        Some(ray) => radiance(scene, ray, hit, sample, stack, branches, stats),
        None => Colour::constant(&scene.frame.background[0]),
    }
}

/// Renders a picture, tile by tile.
///
/// # Errors
/// Where the workspace is too small, or the sink fails.
pub fn render<P: Profile, S: Sink>(
    scene: &Scene<'_, P>,
    tile: [u16; 2],
    workspace: &mut Workspace<'_, P::Kernel>,
    sink: &mut S,
    stats: &mut impl Stats,
) -> Result<(), RenderError<S::Error>> {
    for tile in Tile::of(scene.frame.size, tile) {
        let pixels = render_tile(scene, tile, workspace, stats).map_err(|error| match error {
            RenderError::Stack { capacity, needed } => RenderError::Stack { capacity, needed },
            RenderError::Branches { capacity, needed } => RenderError::Branches { capacity, needed },
            RenderError::Tile { capacity, needed } => RenderError::Tile { capacity, needed },
            RenderError::Sink(never) => match never {},
        })?;
        sink.tile(tile, pixels).map_err(RenderError::Sink)?;
    }
    Ok(())
}
