//! The best split of a node, by the surface area heuristic over bins.

use super::{Item, TreeOptions, grow};
use core_rt::kernel::Bounds;

const BINS: usize = 16;

/// Where to split.
pub(super) struct Split {
    /// The expected cost, in box tests, of visiting the node and what is under it.
    pub(super) cost: f64,
    axis: usize,
    scale: Scale,
    /// Items in bins below this go left.
    bin: usize,
}

/// From centres along an axis to bins: floor(16 (c - low) / length), without a division each.
#[derive(Clone, Copy)]
struct Scale {
    low: i32,
    /// One more than from the least centre to the greatest: below 2^31.
    length: u64,
    /// floor(2^64 / length), or the largest word where there is one centre.
    inverse: u64,
}

impl Scale {
    fn new(low: i32, high: i32) -> Self {
        let length = u64::from(high.abs_diff(low)) + 1;
        let inverse = (1u128 << 64) / u128::from(length);
        Self { low, length, inverse: inverse.min(u64::MAX.into()) as u64 }
    }

    /// The inverse is low by less than one, so the estimate is by less than 2^35 / 2^64, and one at most after the floor.
    #[inline(always)]
    fn bin(&self, centre_2x: i32) -> usize {
        let along = u64::from(centre_2x.abs_diff(self.low)) * BINS as u64;
        let estimate = ((u128::from(along) * u128::from(self.inverse)) >> 64) as u64;
        (estimate + u64::from((estimate + 1) * self.length <= along)) as usize
    }
}

/// Half the surface of a box; the grid is at most 2^29, so it is exact in 64 bits but not in f64's 53.
fn half_area(bounds: &Bounds) -> f64 {
    let [x, y, z] = [0, 1, 2].map(|axis| i64::from(bounds.high[axis]) - i64::from(bounds.low[axis]));
    (x * y + y * z + z * x) as f64
}

/// How many items, and the box of all.
type Bin = (u32, Bounds);

const EMPTY: Bin = (0, Bounds::NOTHING);

#[inline(always)]
fn merge(all: &mut Bin, other: &Bin) {
    all.0 += other.0;
    grow(&mut all.1, &other.1);
}

/// The split with the least cost; `None` where all centres are one.
pub(super) fn best(items: &[Item], bounds: &Bounds, options: TreeOptions) -> Option<Split> {
    let mut centres = Bounds::NOTHING;
    for item in items {
        let centre = [0, 1, 2].map(|axis| item.centre_2x(axis));
        grow(&mut centres, &Bounds { low: centre, high: centre });
    }
    let scales = [0, 1, 2].map(|axis| Scale::new(centres.low[axis], centres.high[axis]));
    let mut bins = [[EMPTY; BINS]; 3];
    for item in items {
        for ((axis, scale), bins) in scales.iter().enumerate().zip(&mut bins) {
            merge(&mut bins[scale.bin(item.centre_2x(axis)) % BINS], &(1, item.bounds));
        }
    }
    let mut best: Option<Split> = None;
    for ((axis, &scale), bins) in scales.iter().enumerate().zip(&bins) {
        if scale.length == 1 {
            continue;
        }
        // What lies to the right of each bin's beginning.
        let mut right = [EMPTY; BINS];
        let mut sum = EMPTY;
        for (slot, bin) in right.iter_mut().zip(bins).rev() {
            if bin.0 > 0 {
                merge(&mut sum, bin);
            }
            *slot = sum;
        }
        let mut left = EMPTY;
        for split in 1..BINS {
            // Behind an empty bin the split is the one before it.
            if bins[split - 1].0 == 0 {
                continue;
            }
            merge(&mut left, &bins[split - 1]);
            let right = right[split];
            if right.0 == 0 {
                break;
            }
            let inside = half_area(&left.1) * f64::from(left.0) + half_area(&right.1) * f64::from(right.0);
            let cost = 2.0 + options.triangle_cost * inside / half_area(bounds).max(1.0);
            if best.as_ref().is_none_or(|b| cost < b.cost) {
                best = Some(Split { cost, axis, scale, bin: split });
            }
        }
    }
    best
}

/// Brings the left items before the right ones, in place, and returns where the right ones begin.
pub(super) fn partition(items: &mut [Item], split: &Split) -> usize {
    let (mut left, mut right) = (0, items.len());
    while left < right {
        if split.scale.bin(items[left].centre_2x(split.axis)) < split.bin {
            left += 1;
        } else {
            right -= 1;
            items.swap(left, right);
        }
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_are_those_of_a_division() {
        for (low, high) in
            [(0, 1), (-5, 9), (7, 1 << 20), (-(1 << 29), (1 << 30) - 1), (i32::MIN / 2, i32::MAX / 2), (3, 18)]
        {
            let scale = Scale::new(low, high);
            let length = i64::from(high) - i64::from(low) + 1;
            let bin = |along: i64| (along * BINS as i64 / length) as usize;
            // Around every place where a bin begins, and the ends.
            for begin in (0..=BINS as i64).map(|bin| bin * length / BINS as i64) {
                for along in (begin - 2..=begin + 2).filter(|along| (0..length).contains(along)) {
                    let centre = (i64::from(low) + along) as i32;
                    assert_eq!(scale.bin(centre), bin(along), "{low}..={high}, {centre}");
                }
            }
        }
        assert_eq!(Scale::new(4, 4).bin(4), 0);
    }
}
