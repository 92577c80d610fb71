//! Building the BVH: binned SAH on the grid's integers.
//!
//! Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies" (2007): the centroids of a node fall into 16 bins
//! an axis, and the split between bins with the least expected cost is taken. The tree never depends on the number of
//! threads; its depth is bounded by splitting in the middle where the SAH would go on too long.

mod flatten;
mod split;

pub use flatten::{Flat, FlatNode};

use core_rt::bvh::Child;
use core_rt::kernel::Bounds;
use core_rt::scene::MAX_DEPTH;

/// How a tree is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeOptions {
    /// A leaf has at most so many triangles, 1 to [`Child::COUNT_MAX`].
    pub leaf_max: u32,
    /// Nodes of at most `leaf_max` triangles become leaves without asking the SAH: the 2009 report's "leaf threshold".
    pub leaf_always: bool,
    /// What a triangle test costs, in box tests.
    pub triangle_cost: f64,
}

impl Default for TreeOptions {
    fn default() -> Self {
        Self { leaf_max: 8, leaf_always: false, triangle_cost: 1.2 }
    }
}

/// A subtree.
#[derive(Debug)]
enum Tree {
    Leaf { first: u32, count: u32, bounds: Bounds },
    Node { children: Box<[Tree; 2]>, bounds: Bounds },
}

impl Tree {
    const fn bounds(&self) -> Bounds {
        match self {
            Self::Leaf { bounds, .. } | Self::Node { bounds, .. } => *bounds,
        }
    }
}

/// A triangle while the tree is built.
#[derive(Clone, Copy, Debug)]
struct Item {
    bounds: Bounds,
    index: u32,
}

impl Item {
    /// Twice the centre of its box along an axis.
    fn centre_2x(&self, axis: usize) -> i32 {
        self.bounds.low[axis] + self.bounds.high[axis]
    }
}

/// Builds a tree over boxes, at least one and fewer than [`Child::INDEX_END`].
#[must_use]
pub fn build(boxes: impl Iterator<Item = Bounds>, options: TreeOptions) -> Flat {
    let mut items: Vec<Item> = (0..).zip(boxes).map(|(index, bounds)| Item { bounds, index }).collect();
    let tree = subtree(&mut items, 0, 0, options);
    let order = items.into_iter().map(|item| item.index).collect();
    flatten::flatten(&tree, order)
}

/// Below this, threads cost more than they bring.
const PARALLEL: usize = 4096;

fn subtree(items: &mut [Item], first: u32, level: u32, options: TreeOptions) -> Tree {
    let bounds = union(items.iter().map(|item| item.bounds));
    let count = items.len() as u32;
    let leaf = Tree::Leaf { first, count, bounds };
    let leaf_max = options.leaf_max.clamp(1, Child::COUNT_MAX);
    if count == 1 || (options.leaf_always && count <= leaf_max) {
        return leaf;
    }
    // Splitting in the middle from here on ends within the levels that are left.
    let levels_left = MAX_DEPTH as u32 - level;
    let must_halve = count.div_ceil(leaf_max).next_power_of_two().ilog2() + 1 >= levels_left;
    let split = if must_halve { None } else { split::best(items, &bounds, options) };
    let middle = match split {
        Some(split) if count > leaf_max || split.cost < f64::from(count) * options.triangle_cost => {
            split::partition(items, &split)
        }
        _ if count <= leaf_max => return leaf,
        // No split separates them, or there is no time left for one.
        _ => items.len() / 2,
    };
    let (left, right) = items.split_at_mut(middle);
    let right_first = first + middle as u32;
    let (left_tree, right_tree) = if left.len().min(right.len()) > PARALLEL {
        rayon::join(
            || subtree(left, first, level + 1, options),
            || subtree(right, right_first, level + 1, options),
        )
    } else {
        (subtree(left, first, level + 1, options), subtree(right, right_first, level + 1, options))
    };
    Tree::Node { children: Box::new([left_tree, right_tree]), bounds }
}

/// The box of boxes; empty for none.
fn union(boxes: impl Iterator<Item = Bounds>) -> Bounds {
    let empty = Bounds { low: [i32::MAX; 3], high: [i32::MIN; 3] };
    boxes.fold(empty, |a, b| a.union(&b))
}
