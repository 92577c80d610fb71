//! The picture as far as it is drawn: the last draft, at two pixels by two, under the tiles of the full one.

use core_rt::render::Tile;
use host_tools::picture::Picture;

/// The side of a tile, pixels.
pub const TILE: u16 = 32;

/// The tiles of a picture in the order in which they are drawn: from the middle outwards.
#[must_use]
pub fn order(size: [u16; 2]) -> Vec<Tile> {
    let mut tiles: Vec<Tile> = Tile::of(size, [TILE; 2]).collect();
    // Twice the distances from the middle.
    let off_2x = |start: u16, length: u16, size: u16| 2 * i64::from(start) + i64::from(length) - i64::from(size);
    let distance = |tile: &Tile| {
        let [x, y] = [off_2x(tile.x, tile.width, size[0]), off_2x(tile.y, tile.height, size[1])];
        x * x + y * y
    };
    tiles.sort_by_key(|tile| (distance(tile), tile.y, tile.x));
    tiles
}

/// The size of a draft: half of each side.
#[must_use]
pub fn draft_size(size: [u32; 2]) -> [u32; 2] {
    size.map(|side| side.div_ceil(2))
}

/// A picture, as far as it is drawn.
#[derive(Clone, Debug)]
pub struct Canvas {
    picture: Picture,
    /// Pixels that are still missing of the full picture.
    missing: u64,
}

impl Canvas {
    /// A black one, of which all is missing.
    #[must_use]
    pub fn new(size: [u32; 2]) -> Self {
        Self { picture: Picture::new(size[0], size[1]), missing: u64::from(size[0]) * u64::from(size[1]) }
    }

    /// Width and height, pixels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        [self.picture.width(), self.picture.height()]
    }

    /// What there is to see.
    #[must_use]
    pub fn picture(&self) -> &Picture {
        &self.picture
    }

    /// The full picture, once nothing of it is missing.
    #[must_use]
    pub fn full(&self) -> Option<&Picture> {
        (self.missing == 0 && !self.picture.pixels().is_empty()).then_some(&self.picture)
    }

    /// What is seen is no longer the picture that is asked for.
    pub fn outdate(&mut self) {
        self.missing = self.picture.pixels().len() as u64;
    }

    /// Begins a picture anew, over what is seen where the size is the same.
    pub fn begin(&mut self, size: [u32; 2]) {
        if size == self.size() {
            self.outdate();
        } else {
            *self = Self::new(size);
        }
    }

    /// Shows a draft of [`draft_size`], or of the whole size, as a picture of a size.
    pub fn draft(&mut self, draft: &Picture, size: [u32; 2]) {
        self.begin(size);
        let is_half = [draft.width(), draft.height()] != size;
        let (across, width) = (draft.width() as usize, size[0] as usize);
        if width == 0 {
            return;
        }
        for (y, row) in self.picture.pixels_mut().chunks_exact_mut(width).enumerate() {
            let source = if is_half { y / 2 } else { y } * across;
            let Some(source) = draft.pixels().get(source..source + across) else { return };
            if is_half {
                for (pair, &pixel) in row.chunks_mut(2).zip(source) {
                    pair.fill(pixel);
                }
            } else {
                row.copy_from_slice(source);
            }
        }
    }

    /// Puts a tile of the full picture to its place. One that lies outside is left out.
    pub fn tile(&mut self, tile: Tile, pixels: &[[u8; 3]]) {
        if self.show(tile, pixels) {
            self.missing = self.missing.saturating_sub(pixels.len() as u64);
        }
    }

    /// Puts a tile to its place that is not yet as it is to be; false where it lies outside.
    pub fn show(&mut self, tile: Tile, pixels: &[[u8; 3]]) -> bool {
        let [width, height] = self.size();
        let [right, bottom] = [u32::from(tile.x) + u32::from(tile.width), u32::from(tile.y) + u32::from(tile.height)];
        if right > width || bottom > height || tile.width == 0 {
            return false;
        }
        for (row, source) in pixels.chunks_exact(tile.width.into()).enumerate() {
            let start = (usize::from(tile.y) + row) * width as usize + usize::from(tile.x);
            self.picture.pixels_mut()[start..start + source.len()].copy_from_slice(source);
        }
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_come_from_the_middle_and_cover_each_pixel_once() {
        for size in [[1, 1], [33, 31], [160, 128], [641, 5]] {
            let tiles = order(size);
            let mut seen = vec![0; usize::from(size[0]) * usize::from(size[1])];
            for [x, y] in tiles.iter().flat_map(Tile::places) {
                seen[usize::from(y) * usize::from(size[0]) + usize::from(x)] += 1;
            }
            assert!(seen.iter().all(|&times| times == 1), "{size:?}");
        }
        let tiles = order([160, 96]);
        assert_eq!((tiles[0].x, tiles[0].y), (64, 32));
        assert_eq!((tiles[14].x, tiles[14].y), (128, 64));
        assert_eq!(order([0, 9]), []);
    }

    #[test]
    fn a_draft_is_doubled_and_tiles_replace_it() {
        for size in [[5, 3], [64, 40]] {
            let [width, height] = draft_size(size);
            let draft = Picture::from_fn(width, height, |x, y| [x as u8, y as u8, 0]);
            let mut canvas = Canvas::new([1, 1]);
            canvas.draft(&draft, size);
            let expected = Picture::from_fn(size[0], size[1], |x, y| [x as u8 / 2, y as u8 / 2, 0]);
            assert_eq!((canvas.picture(), canvas.full()), (&expected, None));

            let full = |x: u16, y: u16| [x as u8, y as u8, 9];
            let tiles = order(size.map(|side| side as u16));
            for (number, tile) in tiles.iter().enumerate() {
                assert!(canvas.full().is_none(), "after {number}");
                let pixels: Vec<[u8; 3]> = tile.places().map(|[x, y]| full(x, y)).collect();
                canvas.tile(*tile, &pixels);
            }
            let expected = Picture::from_fn(size[0], size[1], |x, y| full(x as u16, y as u16));
            assert_eq!(canvas.full(), Some(&expected));
            canvas.outdate();
            assert_eq!((canvas.picture(), canvas.full()), (&expected, None));
            // What is begun anew is seen until it is replaced.
            canvas.begin(size);
            assert_eq!((canvas.picture(), canvas.full()), (&expected, None));
        }
    }

    #[test]
    fn what_does_not_fit_is_left_out() {
        let mut canvas = Canvas::new([8, 8]);
        let outside = Tile { x: 4, y: 4, width: 8, height: 2 };
        canvas.tile(outside, &[[1; 3]; 16]);
        assert_eq!(canvas.picture(), &Picture::new(8, 8));
        canvas.draft(&Picture::new(2, 2), [8, 8]);
        canvas.draft(&Picture::new(0, 0), [0, 0]);
        assert_eq!(canvas.size(), [0, 0]);
    }

    #[test]
    fn a_draft_of_the_whole_size_is_not_doubled() {
        let draft = Picture::from_fn(6, 4, |x, y| [x as u8, y as u8, 1]);
        let mut canvas = Canvas::new([6, 4]);
        canvas.draft(&draft, [6, 4]);
        assert_eq!((canvas.picture(), canvas.full()), (&draft, None));
    }
}
