//! A bounding volume hierarchy: binned surface-area heuristic, median where that does not help.
//!
//! I. Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", RT 2007. Traversal takes
//! the leaf's work as a closure and knows nothing of hits.

use std::ops::{ControlFlow, Range};

use glam::DVec3;

use super::bounds::{Bounds, SLACK};
use super::ray::Ray;
use super::shape::Shape;

/// Shapes below which a node is not split.
const LEAF: usize = 4;

/// Bins an axis.
const BINS: usize = 16;

/// Levels split by the heuristic. Below, the median halves the at most 2^32 shapes, so that no
/// scene, however uneven, is deeper than [`DEPTH`].
const HEURISTIC_DEPTH: usize = 32;

/// Levels at most, the root's not counted; one entry of the traversal's stack a level suffices.
const DEPTH: usize = HEURISTIC_DEPTH + 32;

/// The tree, with the shapes in the order of its leaves.
#[derive(Clone, Debug)]
pub(super) struct Bvh {
    /// The root first, siblings side by side; empty if there are no shapes.
    nodes: Vec<Node>,
    shapes: Vec<Shape>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    bounds: Bounds,
    /// First shape of a leaf, left child of an inner node.
    first: u32,
    /// Shapes of a leaf, 0 in an inner node.
    count: u32,
}

/// A shape while the tree is built.
#[derive(Clone, Copy)]
struct Item {
    shape: Shape,
    bounds: Bounds,
}

impl Item {
    /// Twice the centre of the bounds.
    fn centre(&self) -> DVec3 {
        self.bounds.low + self.bounds.high
    }
}

impl Bvh {
    /// The tree over `shapes`, at most 2^32 - 1 of them, duplicates welcome.
    pub(super) fn build(shapes: impl IntoIterator<Item = Shape>) -> Self {
        let mut items: Vec<Item> = shapes.into_iter().map(|shape| Item { shape, bounds: shape.bounds() }).collect();
        let mut nodes = Vec::new();
        if !items.is_empty() {
            nodes.push(leaf(&items, 0..items.len()));
            subdivide(&mut nodes, 0, &mut items, 0);
        }
        Self { nodes, shapes: items.iter().map(|item| item.shape).collect() }
    }

    /// The box around everything.
    pub(super) fn bounds(&self) -> Bounds {
        self.nodes.first().map_or(Bounds::EMPTY, |root| root.bounds)
    }

    /// Visits the leaves whose boxes `ray` enters no deeper than `limit`, roughly front to back.
    ///
    /// `visit` gets a leaf's shapes and returns the limit from there on, or breaks off.
    pub(super) fn traverse(&self, ray: &Ray, mut limit: f64, mut visit: impl FnMut(&[Shape]) -> ControlFlow<(), f64>) {
        let entry = |index: u32, limit| self.nodes[index as usize].bounds.entry(ray, limit);
        if self.nodes.is_empty() || entry(0, limit).is_none() {
            return;
        }
        let mut stack = [(0_u32, 0.0_f64); DEPTH];
        let mut waiting = 0;
        let mut current = 0;
        loop {
            let node = &self.nodes[current as usize];
            if node.count > 0 {
                let first = node.first as usize;
                match visit(&self.shapes[first..first + node.count as usize]) {
                    ControlFlow::Continue(new) => limit = new,
                    ControlFlow::Break(()) => return,
                }
            } else {
                let (left, right) = (node.first, node.first + 1);
                let near = match (entry(left, limit), entry(right, limit)) {
                    (Some(l), Some(r)) => {
                        let (near, far) = if r < l { (right, (left, l)) } else { (left, (right, r)) };
                        stack[waiting] = far;
                        waiting += 1;
                        Some(near)
                    }
                    (Some(_), None) => Some(left),
                    (None, Some(_)) => Some(right),
                    (None, None) => None,
                };
                if let Some(near) = near {
                    current = near;
                    continue;
                }
            }
            loop {
                if waiting == 0 {
                    return;
                }
                waiting -= 1;
                let (index, entry) = stack[waiting];
                if entry <= limit * SLACK {
                    current = index;
                    break;
                }
            }
        }
    }
}

/// A leaf over `range` of `items`.
fn leaf(items: &[Item], range: Range<usize>) -> Node {
    Node {
        bounds: items[range.clone()].iter().fold(Bounds::EMPTY, |bounds, item| bounds.union(item.bounds)),
        first: range.start as u32,
        count: range.len() as u32,
    }
}

/// Splits the leaf `index`, which lies `depth` levels below the root, until all leaves are small.
fn subdivide(nodes: &mut Vec<Node>, index: usize, items: &mut [Item], depth: usize) {
    let first = nodes[index].first as usize;
    let end = first + nodes[index].count as usize;
    if end - first <= LEAF {
        return;
    }
    let part = &mut items[first..end];
    let split = if depth < HEURISTIC_DEPTH { binned(part) } else { None };
    let middle = first + split.unwrap_or_else(|| median(part));
    let left = nodes.len();
    nodes.push(leaf(items, first..middle));
    nodes.push(leaf(items, middle..end));
    nodes[index].first = left as u32;
    nodes[index].count = 0;
    subdivide(nodes, left, items, depth + 1);
    subdivide(nodes, left + 1, items, depth + 1);
}

/// Orders `items` by the cheapest of the binned splits and returns how many lie on its left; `None`
/// if no plane between bins parts them.
fn binned(items: &mut [Item]) -> Option<usize> {
    let centres = Bounds::around(items.iter().map(Item::centre));
    let scale = BINS as f64 / (centres.high - centres.low);
    let bin = |item: &Item, axis: usize| {
        let position = (item.centre()[axis] - centres.low[axis]) * scale[axis];
        (position as usize).min(BINS - 1)
    };
    let mut best: Option<(f64, usize, usize, usize)> = None;
    for axis in 0..3 {
        let mut bins = [(Bounds::EMPTY, 0_usize); BINS];
        for item in items.iter() {
            let (bounds, count) = &mut bins[bin(item, axis)];
            *bounds = bounds.union(item.bounds);
            *count += 1;
        }
        let mut rights = [0.0; BINS];
        let (mut bounds, mut count) = (Bounds::EMPTY, 0);
        for i in (1..BINS).rev() {
            bounds = bounds.union(bins[i].0);
            count += bins[i].1;
            rights[i] = bounds.half_area() * count as f64;
        }
        let (mut bounds, mut count) = (Bounds::EMPTY, 0);
        for i in 1..BINS {
            bounds = bounds.union(bins[i - 1].0);
            count += bins[i - 1].1;
            let cost = bounds.half_area() * count as f64 + rights[i];
            let parts = count > 0 && count < items.len();
            if parts && best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, i, count));
            }
        }
    }
    let (_, axis, split, count) = best?;
    items.sort_unstable_by_key(|item| bin(item, axis) >= split);
    Some(count)
}

/// Orders `items` about the median along the axis of widest spread; returns half their number.
fn median(items: &mut [Item]) -> usize {
    let centres = Bounds::around(items.iter().map(Item::centre));
    let axis = (centres.high - centres.low).max_position();
    let half = items.len() / 2;
    items.select_nth_unstable_by(half, |a, b| a.centre()[axis].total_cmp(&b.centre()[axis]));
    half
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::triangle::Triangle;

    /// Faults of a tree: bounds that do not hold their content, triangles lost, too great a depth.
    fn faults(bvh: &Bvh, shapes: &[Shape]) -> usize {
        fn walk(bvh: &Bvh, index: usize, depth: usize, seen: &mut Vec<u32>) -> usize {
            let node = &bvh.nodes[index];
            let holds = |b: Bounds| node.bounds.union(b) == node.bounds;
            let mut faults = usize::from(depth > DEPTH);
            if node.count > 0 {
                for shape in &bvh.shapes[node.first as usize..][..node.count as usize] {
                    faults += usize::from(!holds(shape.bounds()));
                    seen.push(shape.prim());
                }
            } else {
                for child in [node.first as usize, node.first as usize + 1] {
                    faults += usize::from(!holds(bvh.nodes[child].bounds));
                    faults += walk(bvh, child, depth + 1, seen);
                }
            }
            faults
        }
        let mut seen = Vec::new();
        let faults = walk(bvh, 0, 0, &mut seen);
        seen.sort_unstable();
        faults + usize::from(!seen.iter().copied().eq(0..shapes.len() as u32))
    }

    fn row(count: u32, place: impl Fn(u32) -> f64) -> Vec<Shape> {
        (0..count)
            .map(|prim| {
                let x = place(prim);
                let corners = [[x, 0.0, 0.0], [x, 1.0, 0.0], [x, 0.0, 1.0]].map(DVec3::from);
                Shape::Triangle(Triangle { corners, prim })
            })
            .collect()
    }

    #[test]
    fn trees_are_sound_whatever_the_spacing() {
        let rows = [
            row(1, f64::from),
            row(1000, f64::from),
            row(1000, |_| 7.0),
            // Each step dwarfs all before it, which makes the heuristic cut off one at a time.
            row(1000, |i| libm::ldexp(1.0, i as i32 - 900)),
        ];
        for shapes in rows {
            let mut bvh = Bvh::build(shapes.clone());
            assert_eq!(faults(&bvh, &shapes), 0);
            bvh.shapes[0] = row(1, |_| -1e300)[0];
            assert_ne!(faults(&bvh, &shapes), 0, "the check must see a damaged tree");
        }
    }

    #[test]
    fn nothing_is_visited_in_an_empty_tree() {
        let bvh = Bvh::build([]);
        assert_eq!(bvh.bounds(), Bounds::EMPTY);
        let ray = Ray::new(DVec3::ZERO, DVec3::X);
        bvh.traverse(&ray, f64::INFINITY, |_| panic!("there is no leaf"));
    }

    #[test]
    fn the_limit_and_the_break_end_a_traversal() {
        let bvh = Bvh::build(row(1000, f64::from));
        let ray = Ray::new(DVec3::new(-1.0, 0.25, 0.25), DVec3::X);
        let visited = |limit: f64, break_after: usize| {
            let mut leaves = 0;
            bvh.traverse(&ray, limit, |_| {
                leaves += 1;
                if leaves == break_after { ControlFlow::Break(()) } else { ControlFlow::Continue(limit) }
            });
            leaves
        };
        assert!(visited(f64::INFINITY, 0) >= 250);
        assert_eq!(visited(f64::INFINITY, 3), 3);
        assert!((1..=2).contains(&visited(1.5, 0)));
    }
}
