//! Pictures on all cores: tiles of `core_rt::render`, each thread with a workspace of its own.

use core_rt::kernel::Kernel;
use core_rt::profile::Profile;
use core_rt::render::{Tile, Workspace, render_tile};
use core_rt::scene::{MAX_BRANCHES, MAX_DEPTH, Scene};
use core_rt::stats::Counts;
use rayon::prelude::*;

use crate::picture::Picture;
use crate::pixels::rgb888;

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
    let tiles: Vec<Tile> = Tile::of(scene.frame.size, tile).collect();
    let done: Vec<(Tile, Vec<u8>, Counts)> = tiles
        .par_iter()
        .map(|&tile| {
            let (pixels, counts) = one_tile(scene, tile);
            progress(tile.pixels() as u64);
            (tile, pixels, counts)
        })
        .collect();
    let [width, height] = scene.frame.size;
    let mut picture = Picture::new(width.into(), height.into());
    let mut counts = Counts::default();
    for (tile, pixels, tile_counts) in done {
        counts = counts.plus(tile_counts);
        for (row, source) in rgb888(scene.frame.format, &pixels).chunks_exact(tile.width.into()).enumerate() {
            let start = (usize::from(tile.y) + row) * usize::from(width) + usize::from(tile.x);
            picture.pixels_mut()[start..start + source.len()].copy_from_slice(source);
        }
    }
    Rendered { picture, counts }
}

/// One tile, with storage for it alone.
fn one_tile<P: Profile>(scene: &Scene<'_, P>, tile: Tile) -> (Vec<u8>, Counts) {
    let mut stack = heapless::Vec::<(u32, <P::Kernel as Kernel>::Distance), MAX_DEPTH>::new();
    let mut hits = vec![0; tile.pixels()];
    let mut pixels = vec![0; tile.pixels() * scene.frame.format.bytes()];
    let mut counts = Counts::default();
    let mut branches = heapless::Vec::<_, { MAX_BRANCHES + 1 }>::new();
    let mut workspace = Workspace { stack: &mut stack, branches: &mut branches, hits: &mut hits, pixels: &mut pixels };
    // The workspace is as large as any scene asks for: there is no error left.
    let rendered = render_tile(scene, tile, &mut workspace, &mut counts);
    debug_assert!(rendered.is_ok());
    (pixels, counts)
}
