//! From the blob's binary tree to one of eight children a node (Wald, Benthin & Boulos, "Getting Rid of Packets", 2008).
//!
//! A node opens the widest of its children until there are eight, and small subtrees become leaves. The primitives stay in
//! their order: whatever is below a node of the blob is a run of them.

use core_rt::bvh::{Bvh, Child};
use core_rt::kernel::{Bounds, Kernel};
use core_rt::profile::Profile;

/// Children of a node, and triangles that are tested at a time.
pub(super) const WIDTH: usize = 8;

/// What a child is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Below {
    /// Another node, by its place.
    Node(u32),
    /// A run of triangles.
    Triangles { first: u32, count: u32 },
    /// A run of spheres.
    Spheres { first: u32, count: u32 },
}

/// A node: up to [`WIDTH`] children with their boxes.
pub(super) type Node = Vec<(Bounds, Below)>;

/// The nodes, the root first.
pub(super) fn collapse<P: Profile>(bvh: &Bvh<'_, P>) -> Vec<Node> {
    let source = Source::new(bvh);
    // What nodes are made of that are still to be.
    let mut open = vec![match Child::unpack(bvh.root) {
        Child::Node(index) => source.children(index).to_vec(),
        Child::Leaf { .. } => vec![(bvh.bounds().fold(Bounds::NOTHING, |a, b| a.union(&b)), bvh.root)],
    }];
    let mut nodes = Vec::new();
    while let Some(children) = open.get_mut(nodes.len()).map(std::mem::take) {
        let node = source.widened(children).into_iter().map(|(bounds, child)| {
            let below = source.leaf(child).unwrap_or_else(|| {
                open.push(source.children_of(child));
                Below::Node(open.len() as u32 - 1)
            });
            (bounds, below)
        });
        nodes.push(node.collect());
    }
    nodes
}

/// The tree that is collapsed.
struct Source<'a, P: Profile> {
    bvh: &'a Bvh<'a, P>,
    /// Below each node, the primitives; `None` where there are triangles and spheres.
    runs: Vec<Option<(u32, u32)>>,
}

impl<'a, P: Profile> Source<'a, P> {
    fn new(bvh: &'a Bvh<'a, P>) -> Self {
        let mut source = Self { bvh, runs: vec![None; bvh.nodes.len()] };
        // In preorder children come after their parents.
        for (index, node) in bvh.nodes.iter().enumerate().rev() {
            let [a, b] = P::Kernel::children(node).map(|child| source.run(child));
            source.runs[index] = a.zip(b).and_then(|(a, b)| source.joined(a, b));
        }
        source
    }

    /// The primitives below a child.
    fn run(&self, child: u32) -> Option<(u32, u32)> {
        match Child::unpack(child) {
            Child::Node(index) => self.runs.get(index as usize).copied().flatten(),
            Child::Leaf { first, count } => Some((first, count)),
        }
    }

    /// Two runs as one, where they are next to each other and of one kind.
    fn joined(&self, a: (u32, u32), b: (u32, u32)) -> Option<(u32, u32)> {
        let is_sphere = |(first, _)| first >= self.bvh.triangles.len();
        (a.0 + a.1 == b.0 && is_sphere(a) == is_sphere(b)).then_some((a.0, a.1 + b.1))
    }

    /// The leaf that a child becomes.
    fn leaf(&self, child: u32) -> Option<Below> {
        let is_leaf = matches!(Child::unpack(child), Child::Leaf { .. });
        let (first, count) = self.run(child).filter(|&(_, count)| is_leaf || count <= WIDTH as u32)?;
        let is_sphere = first >= self.bvh.triangles.len();
        // Spheres are tested one by one, as the blob has them.
        (is_leaf || !is_sphere).then_some(if is_sphere {
            Below::Spheres { first, count }
        } else {
            Below::Triangles { first, count }
        })
    }

    fn children(&self, index: u32) -> [(Bounds, u32); 2] {
        let node = &self.bvh.nodes[index as usize];
        let ([a, b], [first, second]) = (P::Kernel::boxes(node), P::Kernel::children(node));
        [(a, first), (b, second)]
    }

    /// The children of a child that is a node.
    fn children_of(&self, child: u32) -> Vec<(Bounds, u32)> {
        match Child::unpack(child) {
            Child::Node(index) => self.children(index).to_vec(),
            Child::Leaf { .. } => Vec::new(),
        }
    }

    /// Opens the widest child that is no leaf, until there are [`WIDTH`] of them.
    fn widened(&self, mut children: Vec<(Bounds, u32)>) -> Vec<(Bounds, u32)> {
        while children.len() < WIDTH {
            let inner = (0..children.len()).filter(|&place| self.leaf(children[place].1).is_none());
            let Some(widest) = inner.max_by_key(|&place| area(&children[place].0)) else { break };
            let (_, child) = children.swap_remove(widest);
            children.extend(self.children_of(child));
        }
        children
    }
}

/// Half the surface of a box: its sides are below 2^30.
fn area(bounds: &Bounds) -> u64 {
    let [x, y, z] = [0, 1, 2].map(|axis| u64::from(bounds.high[axis].abs_diff(bounds.low[axis])));
    x * y + y * z + z * x
}
