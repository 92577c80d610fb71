//! The best split of a node, by the surface area heuristic over bins.

use super::{Item, TreeOptions, union};
use core_rt::kernel::Bounds;

const BINS: usize = 16;

/// Where to split.
pub(super) struct Split {
    /// The expected cost, in box tests, of visiting the node and what is under it.
    pub(super) cost: f64,
    axis: usize,
    low: i32,
    extent: i64,
    /// Items in bins below this go left.
    bin: usize,
}

impl Split {
    fn bin_of(&self, item: &Item) -> usize {
        bin(item.centre_2x(self.axis), self.low, self.extent)
    }
}

/// The bin of a centre, for centres in `low ..= low + extent`.
fn bin(centre_2x: i32, low: i32, extent: i64) -> usize {
    ((i64::from(centre_2x) - i64::from(low)) * BINS as i64 / (extent + 1)) as usize
}

/// Half the surface of a box; the grid is at most 2^29, so it is exact in 64 bits but not in f64's 53.
fn half_area(bounds: &Bounds) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|axis| i64::from(bounds.high[axis]) - i64::from(bounds.low[axis]));
    (x * y + y * z + z * x) as f64
}

/// The split with the least cost; `None` where all centres are one.
pub(super) fn best(items: &[Item], bounds: &Bounds, options: TreeOptions) -> Option<Split> {
    let mut best: Option<Split> = None;
    for axis in 0..3 {
        let centres = || items.iter().map(|item| item.centre_2x(axis));
        let (Some(low), Some(high)) = (centres().min(), centres().max()) else { continue };
        if low == high {
            continue;
        }
        let extent = i64::from(high) - i64::from(low);
        let empty = (0u32, union(std::iter::empty()));
        let mut bins = [empty; BINS];
        for item in items {
            let (count, bounds) = &mut bins[bin(item.centre_2x(axis), low, extent)];
            *count += 1;
            *bounds = bounds.union(&item.bounds);
        }
        let merge = |a: (u32, Bounds), b: &(u32, Bounds)| (a.0 + b.0, a.1.union(&b.1));
        // What lies to the right of each bin's beginning.
        let mut right = [empty; BINS];
        let mut sum = empty;
        for (slot, bin) in right.iter_mut().zip(&bins).rev() {
            sum = merge(sum, bin);
            *slot = sum;
        }
        let mut left = empty;
        for split in 1..BINS {
            left = merge(left, &bins[split - 1]);
            let right = right[split];
            if left.0 == 0 || right.0 == 0 {
                continue;
            }
            let inside = half_area(&left.1) * f64::from(left.0) + half_area(&right.1) * f64::from(right.0);
            let cost = 2.0 + options.triangle_cost * inside / half_area(bounds).max(1.0);
            if best.as_ref().is_none_or(|b| cost < b.cost) {
                best = Some(Split { cost, axis, low, extent, bin: split });
            }
        }
    }
    best
}

/// Brings the left items before the right ones, in place, and returns where the right ones begin.
pub(super) fn partition(items: &mut [Item], split: &Split) -> usize {
    let (mut left, mut right) = (0, items.len());
    while left < right {
        if split.bin_of(&items[left]) < split.bin {
            left += 1;
        } else {
            right -= 1;
            items.swap(left, right);
        }
    }
    left
}
