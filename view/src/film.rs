//! Samples of paths that add up from frame to frame.

use std::ops::Range;

use core_rt::path::Sum;
use core_rt::render::Tile;
use core_rt::stats::Counts;
use host_tools::stage::Stage;
use rayon::prelude::*;

use crate::painter::Painted;

/// The samples that each frame adds: one, then as many as there are, so that all frames together take as long as one of all
/// samples.
pub(crate) fn passes(samples: u16) -> impl Iterator<Item = Range<u16>> {
    let mut done: u16 = 0;
    std::iter::from_fn(move || {
        let range = done..done.saturating_mul(2).clamp(1, samples.max(1));
        done = range.end;
        (!range.is_empty()).then_some(range)
    })
}

/// A picture as the sums of its samples.
#[derive(Debug)]
pub(crate) struct Film<'a> {
    stage: &'a dyn Stage,
    /// Each with a sum a pixel.
    tiles: Vec<(Tile, Vec<Sum>)>,
}

impl<'a> Film<'a> {
    /// Without a sample.
    pub(crate) fn new(stage: &'a dyn Stage, tiles: &[Tile]) -> Self {
        let tiles = tiles.iter().map(|&tile| (tile, vec![Sum::default(); tile.pixels()]));
        Self { stage, tiles: tiles.collect() }
    }

    /// Adds samples to the tiles of a range, on the threads of the current rayon pool: what they show with all samples up to the
    /// last of them, and the work that it took.
    pub(crate) fn add(&mut self, tiles: Range<usize>, samples: &Range<u16>) -> (Vec<Painted>, Counts) {
        let stage = self.stage;
        let tiles = self.tiles.get_mut(tiles).unwrap_or_default();
        let added = tiles.par_iter_mut().map(|(tile, sums)| {
            let counts = stage.add_samples(*tile, samples.clone(), sums);
            ((*tile, stage.mean(*tile, sums, samples.end)), counts)
        });
        let (painted, counts): (Vec<Painted>, Vec<Counts>) = added.unzip();
        (painted, counts.into_iter().fold(Counts::default(), Counts::plus))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_double_until_all_samples_are_there() {
        let ends = |samples| passes(samples).map(|range| range.end).collect::<Vec<_>>();
        assert_eq!(ends(1), [1]);
        assert_eq!(ends(10), [1, 2, 4, 8, 10]);
        assert_eq!(ends(u16::MAX).last(), Some(&u16::MAX));
        for samples in [1, 2, 3, 64, 1000] {
            assert!(passes(samples).flatten().eq(0..samples), "each once, in order");
        }
    }
}
