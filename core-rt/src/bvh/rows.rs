//! Between which columns a triangle lies in each row of a tile.
//!
//! An edge function is linear, so the column where it is 0 moves by the same step from row to row: one reciprocal an edge, and
//! an addition a row. Of a triangle's edges one has the others opposite. Columns are counted towards that one, to the right or to
//! the left, and the least of the two widths up to it is that of the row. Beside each edge is a margin, for what its column may be
//! off and for where its function is not certain: pixels in that are asked by themselves.
//!
//! **Margins.** Let r be an edge function's step to the right, d that down, and c(y) = -(first + y d) / r. Where |r| is less than
//! 2^15 it is taken larger, by g / 15, and g is added: the function grows, in no column of the tile by more than 2 g, and columns are
//! let in by that. The reciprocal is low by 2^-14 or high by 2^-15 of it, for first columns, steps and margins alike: in the tile
//! a column is off by less than 16 / 2^14, which is 4 of its unit. The first one is cut to a unit and rounded, and so is each of 15
//! steps, by less than 3/2 each. That is less than [`OFF`].

use crate::num::{byte_length, mantissa};
use crate::tile::{Edge, Edges, Linear, SIDE};

/// Fractional bits of a column: a value below 2^31, times 2^12, by a step of at least 2^15 is below 2^28. Functions have steps down
/// below 2^25, and 15 of theirs are less.
const COLUMN_BITS: u32 = 12;

/// The least step of an edge function from column to column is 2 to this.
const SLOPE_BITS: u32 = 15;

/// By what a column in the tile may be off.
const OFF: i32 = 32;

/// By how much farther inwards than its margin a triangle certainly is: what a column was moved out by, what it may be off, and
/// what the margin was cut by.
const INWARDS: i32 = 2 * OFF + 6;

/// The pixels of a row that a triangle may cover, and between which ones it certainly does.
#[derive(Clone, Copy, Debug)]
pub(super) struct Row {
    pub(super) first: i32,
    pub(super) last: i32,
    pub(super) certain: [i32; 2],
}

/// An edge's place in a row: the column up to which a triangle may be, for an edge to the left as its negative.
#[derive(Clone, Copy, Debug)]
struct Crossing {
    column: i32,
    /// What is added from row to row.
    step: i32,
    /// Farther inwards by this, and [`INWARDS`], it certainly is.
    margin: i32,
}

impl Crossing {
    #[inline(always)]
    fn new(edge: &Edge) -> Self {
        const LAST: i32 = SIDE as i32 - 1;
        let Linear { first, right, down } = edge.line;
        let slope = right.unsigned_abs();
        let taken = slope.max(1 << SLOPE_BITS);
        let grown = LAST * (taken - slope) as i32;
        // Below 2^10, and not 0.
        let high = taken >> SLOPE_BITS;
        let over = if high >> 8 == 0 { byte_length(high) } else { byte_length(high >> 8) + 8 } - 1;
        let m = mantissa(taken >> over);
        let shift = over + SLOPE_BITS - COLUMN_BITS;
        // A value times the mantissa is below 2^47; a quotient is rounded to nearest.
        let half = (1 << shift) >> 1;
        let columns = |value: i32| {
            let product = (value >> 16) * m as i32 + (((value & 0xffff) as u32 * m) >> 16) as i32;
            (product + half) >> shift
        };
        // Both are below 2^20, so a product is below 2^32; cut by less than 2^5 2^12 / 2^15 + 2 = 6 units.
        let margin = ((((edge.uncertain + 2 * grown) >> 5) as u32 * m) >> 11 >> shift) as i32;
        Self { column: columns(first + grown) + OFF, step: columns(down), margin }
    }
}

/// The rows of a triangle, from above.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rows {
    /// Whether the edge that has the others opposite is the left one.
    is_left: bool,
    /// Up to where the triangle may be, towards that edge, and what is added from row to row.
    end: i32,
    step: i32,
    /// From there back to the other two, and what is added.
    widths: [i32; 2],
    widenings: [i32; 2],
    /// The margins of the one and of the others.
    margin: i32,
    margins: [i32; 2],
}

impl Rows {
    /// `None` where no edge has the others opposite.
    #[inline(always)]
    pub(super) fn new(edges: &Edges) -> Option<Self> {
        let [a, b, c] = &edges.edges;
        let is_left = |edge: &Edge| edge.line.right >= 0;
        let (alone, b, c) = match (is_left(a) == is_left(b), is_left(a) == is_left(c)) {
            (true, true) => return None,
            (false, false) => (a, b, c),
            (true, false) => (c, a, b),
            (false, true) => (b, a, c),
        };
        let is_left = is_left(alone);
        let [alone, b, c] = [Crossing::new(alone), Crossing::new(b), Crossing::new(c)];
        Some(Self {
            is_left,
            end: alone.column,
            step: alone.step,
            widths: [alone.column + b.column, alone.column + c.column],
            widenings: [alone.step + b.step, alone.step + c.step],
            margin: alone.margin,
            margins: [b.margin, c.margin],
        })
    }

    /// Whether the triangle may be in this row.
    #[inline(always)]
    pub(super) fn is_reached(&self) -> bool {
        self.widths[0] | self.widths[1] >= 0
    }

    /// Goes on to the first row that the triangle may be in, of so many; how many are left out.
    #[inline(always)]
    pub(super) fn skip(&mut self, height: i32) -> i32 {
        let mut skipped = 0;
        while !self.is_reached() && skipped < height {
            self.widths = [self.widths[0] + self.widenings[0], self.widths[1] + self.widenings[1]];
            skipped += 1;
        }
        self.end += skipped * self.step;
        skipped
    }

    /// Goes on to the next row.
    #[inline(always)]
    pub(super) fn advance(&mut self) {
        self.end += self.step;
        self.widths = [self.widths[0] + self.widenings[0], self.widths[1] + self.widenings[1]];
    }

    /// The pixels of this row, of a tile with a last column, that the triangle may cover; `None` where there are none.
    #[inline(always)]
    pub(super) fn row(&self, last: i32) -> Option<Row> {
        let (end, [b, c]) = (self.end, self.widths);
        let up = |column: i32| (column + (1 << COLUMN_BITS) - 1) >> COLUMN_BITS;
        let down = |column: i32| column >> COLUMN_BITS;
        let turned = |[start, end]: [i32; 2]| if self.is_left { [-end, -start] } else { [start, end] };
        let [first, end_here] = turned([up(end - b.min(c)), down(end)]);
        let (first, last) = (first.max(0), end_here.min(last));
        if first > last {
            return None;
        }
        let width = (b - self.margins[0]).min(c - self.margins[1]);
        Some(Row { first, last, certain: turned([up(end - width + INWARDS), down(end - self.margin - INWARDS)]) })
    }
}
