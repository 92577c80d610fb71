//! Pictures on all cores: tiles of `core_rt::render`, each thread with a workspace of its own.

use core_rt::kernel::Kernel;
use core_rt::profile::Profile;
use core_rt::render::{Tile, Workspace, render_tile};
use core_rt::scene::{MAX_BRANCHES, MAX_DEPTH, Scene};
use core_rt::stats::{Counts, Stats};
use rayon::prelude::*;

use crate::picture::Picture;
use crate::pixels::rgb888;
use crate::witness::{Seen, Witness};

/// Tiles that threads take turns at. Small enough to share the work, large enough to be worth it.
pub const TILE: [u16; 2] = [32, 32];

/// A picture and the work that it took.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The picture.
    pub picture: Picture,
    /// Rays and tests.
    pub counts: Counts,
}

/// Told the number of pixels of every tile that is done, from any thread.
pub type Progress<'a> = &'a (dyn Fn(u64) + Sync);

/// Renders a scene on the threads of the current rayon pool. The picture depends on neither threads nor tiles.
pub fn render<P: Profile>(scene: &Scene<'_, P>, tile: [u16; 2], progress: Progress<'_>) -> Rendered {
    let done = tiles(scene, tile, progress, Counts::default);
    let counts = done.iter().fold(Counts::default(), |sum, (.., counts)| sum.plus(*counts));
    Rendered { picture: picture(scene, &done), counts }
}

/// The same, and what the rays of each pixel saw, row by row.
pub(crate) fn witness<P: Profile>(
    scene: &Scene<'_, P>,
    tile: [u16; 2],
    progress: Progress<'_>,
) -> (Rendered, Vec<Seen>) {
    let done = tiles(scene, tile, progress, || Witness::new(scene.frame.samples.into()));
    let counts = done.iter().fold(Counts::default(), |sum, (.., witness)| sum.plus(witness.counts));
    let mut seen = vec![Seen::default(); scene.frame.size.map(usize::from).iter().product()];
    for (tile, _, witness) in &done {
        place(scene.frame.size, *tile, &witness.pixels, &mut seen);
    }
    (Rendered { picture: picture(scene, &done), counts }, seen)
}

/// The picture of all tiles.
fn picture<P: Profile, S>(scene: &Scene<'_, P>, tiles: &[(Tile, Vec<u8>, S)]) -> Picture {
    let [width, height] = scene.frame.size;
    let mut picture = Picture::new(width.into(), height.into());
    for (tile, pixels, _) in tiles {
        place(scene.frame.size, *tile, &rgb888(scene.frame.format, pixels), picture.pixels_mut());
    }
    picture
}

/// Puts what a tile has, row by row, to its place in the whole.
fn place<T: Copy>(size: [u16; 2], tile: Tile, part: &[T], whole: &mut [T]) {
    for (row, source) in part.chunks_exact(tile.width.into()).enumerate() {
        let start = (usize::from(tile.y) + row) * usize::from(size[0]) + usize::from(tile.x);
        whole[start..start + source.len()].copy_from_slice(source);
    }
}

/// All tiles, each with what was told of it.
fn tiles<P: Profile, S: Stats + Send>(
    scene: &Scene<'_, P>,
    tile: [u16; 2],
    progress: Progress<'_>,
    stats: impl Fn() -> S + Sync,
) -> Vec<(Tile, Vec<u8>, S)> {
    let tiles: Vec<Tile> = Tile::of(scene.frame.size, tile).collect();
    let one = |&tile: &Tile| {
        let mut stats = stats();
        let pixels = one_tile(scene, tile, &mut stats);
        progress(tile.pixels() as u64);
        (tile, pixels, stats)
    };
    tiles.par_iter().map(one).collect()
}

/// One tile, with storage for it alone.
pub(crate) fn one_tile<P: Profile>(scene: &Scene<'_, P>, tile: Tile, stats: &mut impl Stats) -> Vec<u8> {
    let mut stack = heapless::Vec::<(u32, <P::Kernel as Kernel>::Distance), MAX_DEPTH>::new();
    let mut hits = vec![0; tile.pixels()];
    let mut pixels = vec![0; tile.pixels() * scene.frame.format.bytes()];
    let mut branches = heapless::Vec::<_, { MAX_BRANCHES + 1 }>::new();
    let mut workspace = Workspace { stack: &mut stack, branches: &mut branches, hits: &mut hits, pixels: &mut pixels };
    // The workspace is as large as any scene asks for: there is no error left.
    let rendered = render_tile(scene, tile, &mut workspace, stats);
    debug_assert!(rendered.is_ok());
    pixels
}
