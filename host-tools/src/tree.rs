//! Building the BVH: binned SAH on the grid's integers.
//!
//! Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies" (2007): the centroids of a node fall into 16 bins
//! an axis, and the split between bins with the least expected cost is taken. The tree never depends on the number of
//! threads; its depth is bounded by splitting in the middle where the SAH would go on too long.

mod split;

use core_rt::bvh::Child;
use core_rt::kernel::Bounds;
use core_rt::scene::MAX_DEPTH;

/// How a tree is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TreeOptions {
    /// A leaf has at most so many primitives, 1 to [`Child::COUNT_MAX`].
    pub leaf_max: u32,
    /// Nodes of at most `leaf_max` primitives of one kind become leaves without asking the SAH: the 2009 report's "leaf threshold".
    pub leaf_always: bool,
    /// What a triangle test costs, in box tests.
    pub triangle_cost: f64,
    /// Larger boxes of leaves, for the study of box tests that lose hits.
    pub leaf_growth: Option<Growth>,
}

/// By how much boxes of leaves are larger than what they hold; the boxes above hold them still.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Growth {
    /// On every side, grid units, not negative.
    pub by: i32,
    /// How far they grow at most: where a kernel takes boxes.
    pub within: Bounds,
}

impl Growth {
    fn of(self, bounds: Bounds) -> Bounds {
        let Self { by, within } = self;
        let grown = Bounds {
            low: [0, 1, 2].map(|axis| bounds.low[axis].saturating_sub(by).max(within.low[axis])),
            high: [0, 1, 2].map(|axis| bounds.high[axis].saturating_add(by).min(within.high[axis])),
        };
        grown.union(&bounds)
    }
}

impl Default for TreeOptions {
    fn default() -> Self {
        Self { leaf_max: 8, leaf_always: false, triangle_cost: 1.2, leaf_growth: None }
    }
}

/// A node before a kernel packs it.
#[derive(Clone, Copy, Debug)]
pub struct Node {
    /// The boxes of its children.
    pub boxes: [Bounds; 2],
    /// Its children, packed.
    pub children: [u32; 2],
}

/// A tree as the blob has it.
#[derive(Clone, Debug)]
pub struct Tree {
    /// The root, packed.
    pub root: u32,
    /// Nodes in preorder.
    pub nodes: Vec<Node>,
    /// Which primitive stands at each place, triangles first.
    pub order: Vec<u32>,
    /// Levels of nodes.
    pub depth: u8,
}

/// A triangle or a sphere while the tree is built.
#[derive(Clone, Copy, Debug)]
struct Item {
    bounds: Bounds,
    /// Its number, and [`Item::SPHERE`] for a sphere: there are fewer than [`Child::INDEX_END`].
    number: u32,
}

impl Item {
    const SPHERE: u32 = 1 << 31;

    fn is_sphere(&self) -> bool {
        self.number & Self::SPHERE != 0
    }

    /// Twice the centre of its box along an axis.
    #[inline(always)]
    fn centre_2x(&self, axis: usize) -> i32 {
        self.bounds.low[axis] + self.bounds.high[axis]
    }
}

/// Builds a tree over the boxes of triangles, at least one and fewer than [`Child::INDEX_END`].
#[must_use]
pub fn build(boxes: impl Iterator<Item = Bounds>, options: TreeOptions) -> Tree {
    build_mixed(boxes, std::iter::empty(), options)
}

/// Builds a tree over the boxes of triangles and of spheres, at least one and fewer than [`Child::INDEX_END`] in all. A
/// leaf holds one kind; spheres are numbered, and placed, after all triangles.
#[must_use]
pub fn build_mixed(
    triangles: impl Iterator<Item = Bounds>,
    spheres: impl Iterator<Item = Bounds>,
    options: TreeOptions,
) -> Tree {
    let kinds = triangles.map(|bounds| (bounds, 0)).chain(spheres.map(|bounds| (bounds, Item::SPHERE)));
    let item = |(number, (bounds, kind)): (u32, _)| Item { bounds, number: number | kind };
    let mut items: Vec<Item> = (0..).zip(kinds).map(item).collect();
    let mut nodes = Vec::new();
    let triangles = items.len() as u32 - self::spheres(&items);
    let root = subtree(&mut items, [0, triangles], 0, options, &mut nodes);
    nodes.shrink_to_fit();
    let mut order = Vec::with_capacity(items.len());
    for is_sphere in [false, true] {
        let kind = items.iter().filter(|item| item.is_sphere() == is_sphere);
        order.extend(kind.map(|item| item.number & !Item::SPHERE));
    }
    Tree { root: root.packed, nodes, order, depth: root.levels }
}

/// How many spheres there are.
fn spheres(items: &[Item]) -> u32 {
    items.iter().filter(|item| item.is_sphere()).count() as u32
}

/// Below this, threads cost more than they bring.
const PARALLEL: usize = 4096;

/// What a parent needs to know of a child.
struct Subtree {
    packed: u32,
    bounds: Bounds,
    /// Levels of nodes.
    levels: u8,
}

/// Appends the nodes of a subtree over items whose triangles and spheres stand from the places `first` on. Recursion is at most [`MAX_DEPTH`] deep.
fn subtree(items: &mut [Item], first: [u32; 2], level: u32, options: TreeOptions, nodes: &mut Vec<Node>) -> Subtree {
    let mut bounds = Bounds::NOTHING;
    items.iter().for_each(|item| grow(&mut bounds, &item.bounds));
    let Some(middle) = split(items, &bounds, level, options) else {
        let kind = usize::from(items.iter().any(Item::is_sphere));
        let leaf = Child::Leaf { first: first[kind], count: items.len() as u32 };
        let bounds = options.leaf_growth.map_or(bounds, |growth| growth.of(bounds));
        return Subtree { packed: leaf.pack(), bounds, levels: 0 };
    };
    let index = nodes.len();
    nodes.push(Node { boxes: [bounds; 2], children: [0; 2] });
    let (left, right) = items.split_at_mut(middle);
    let left_spheres = spheres(left);
    let right_first = [first[0] + middle as u32 - left_spheres, first[1] + left_spheres];
    let [a, b] = if left.len().min(right.len()) > PARALLEL {
        let mut right_nodes = Vec::new();
        let (a, b) = rayon::join(
            || subtree(left, first, level + 1, options, nodes),
            || subtree(right, right_first, level + 1, options, &mut right_nodes),
        );
        [a, append(b, right_nodes, nodes)]
    } else {
        let a = subtree(left, first, level + 1, options, nodes);
        [a, subtree(right, right_first, level + 1, options, nodes)]
    };
    nodes[index] = Node { boxes: [a.bounds, b.bounds], children: [a.packed, b.packed] };
    let bounds = a.bounds.union(&b.bounds);
    Subtree { packed: Child::Node(index as u32).pack(), bounds, levels: a.levels.max(b.levels) + 1 }
}

/// Moves a subtree that was numbered from 0 behind other nodes.
fn append(subtree: Subtree, own: Vec<Node>, nodes: &mut Vec<Node>) -> Subtree {
    let offset = nodes.len() as u32;
    let moved = |packed: u32| match Child::unpack(packed) {
        Child::Node(index) => Child::Node(index + offset).pack(),
        leaf @ Child::Leaf { .. } => leaf.pack(),
    };
    nodes.extend(own.into_iter().map(|node| Node { children: node.children.map(moved), ..node }));
    Subtree { packed: moved(subtree.packed), ..subtree }
}

/// Brings a node's left items before its right ones and returns where these begin, or `None` for a leaf.
fn split(items: &mut [Item], bounds: &Bounds, level: u32, options: TreeOptions) -> Option<usize> {
    let count = items.len() as u32;
    let leaf_max = options.leaf_max.clamp(1, Child::COUNT_MAX);
    let spheres = spheres(items);
    let is_mixed = spheres > 0 && spheres < count;
    let fits_leaf = count <= leaf_max && !is_mixed;
    if count == 1 || (fits_leaf && options.leaf_always) {
        return None;
    }
    // What would be a leaf but for its kinds is split by them.
    let by_kind = is_mixed && count <= leaf_max;
    // Splitting in the middle from here on ends within the levels that are left, one of which may go to kinds.
    let levels = count.div_ceil(leaf_max).next_power_of_two().ilog2() + 1 + u32::from(is_mixed);
    let must_halve = levels >= MAX_DEPTH as u32 - level;
    let best = if must_halve || (by_kind && options.leaf_always) { None } else { split::best(items, bounds, options) };
    match best {
        Some(best) if !(fits_leaf || by_kind) || best.cost < f64::from(count) * options.triangle_cost => {
            Some(split::partition(items, &best))
        }
        _ if fits_leaf => None,
        _ if by_kind => {
            items.sort_by_key(Item::is_sphere);
            Some((count - spheres) as usize)
        }
        // No split separates them, or there is no time left for one.
        _ => Some(items.len() / 2),
    }
}

/// Makes a box hold another. [`Bounds::union`] is a call, which these loops would spend their time on.
#[inline(always)]
fn grow(all: &mut Bounds, other: &Bounds) {
    for axis in 0..3 {
        all.low[axis] = all.low[axis].min(other.low[axis]);
        all.high[axis] = all.high[axis].max(other.high[axis]);
    }
}
