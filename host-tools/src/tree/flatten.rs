//! From a tree of boxes to nodes in preorder.

use core_rt::bvh::Child;
use core_rt::kernel::Bounds;

use super::Tree;

/// A node before a kernel packs it.
#[derive(Clone, Copy, Debug)]
pub struct FlatNode {
    /// The boxes of its children.
    pub boxes: [Bounds; 2],
    /// Its children, packed.
    pub children: [u32; 2],
}

/// A tree as the blob has it.
#[derive(Clone, Debug)]
pub struct Flat {
    /// The root, packed.
    pub root: u32,
    /// Nodes in preorder.
    pub nodes: Vec<FlatNode>,
    /// Which triangle stands at each place.
    pub order: Vec<u32>,
    /// Levels of nodes.
    pub depth: u8,
}

pub(super) fn flatten(tree: &Tree, order: Vec<u32>) -> Flat {
    let mut flat = Flat { root: 0, nodes: Vec::new(), order, depth: 0 };
    flat.root = visit(tree, 0, &mut flat.nodes, &mut flat.depth);
    flat
}

/// Appends a subtree and returns its packed reference. Recursion is as deep as the tree, so at most 64.
fn visit(tree: &Tree, level: u8, nodes: &mut Vec<FlatNode>, depth: &mut u8) -> u32 {
    match tree {
        Tree::Leaf { first, count, .. } => Child::Leaf { first: *first, count: *count }.pack(),
        Tree::Node { children, .. } => {
            *depth = (*depth).max(level + 1);
            let index = nodes.len();
            let [a, b] = &**children;
            nodes.push(FlatNode { boxes: [a.bounds(), b.bounds()], children: [0; 2] });
            let packed = [visit(a, level + 1, nodes, depth), visit(b, level + 1, nodes, depth)];
            nodes[index].children = packed;
            Child::Node(index as u32).pack()
        }
    }
}
