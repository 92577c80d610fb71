//! Trees that are none, or are not those of their triangles.

use core_rt::blob::BlobError;
use core_rt::bvh::Child;
use core_rt::kernel::Kernel;
use core_rt::profile::Full;
use core_rt::scene::{MAX_DEPTH, Scene};
use tests::blobs::{Draft, corners, sample};

use crate::{for_every_kernel, refused, verdict};

for_every_kernel!(broken_trees, the_deepest_tree);

/// Changes the children of a node.
fn set_children<K: Kernel>(draft: &mut Draft<K>, node: usize, change: impl FnOnce(&mut [u32; 2])) {
    let mut children = K::children(&draft.nodes[node]);
    change(&mut children);
    draft.nodes[node] = K::node(K::boxes(&draft.nodes[node]), children);
}

/// Adds to the high corner of a child's box, along x.
fn grow<K: Kernel>(draft: &mut Draft<K>, node: usize, child: usize, by: i32) {
    let mut boxes = K::boxes(&draft.nodes[node]);
    boxes[child].high[0] += by;
    draft.nodes[node] = K::node(boxes, K::children(&draft.nodes[node]));
}

/// A node under the root, and which child of the root it is.
fn second_node<K: Kernel>(draft: &Draft<K>) -> usize {
    let children = K::children(&draft.nodes[0]).map(Child::unpack);
    children.iter().position(|child| *child == Child::Node(1)).expect("five leaves take two levels")
}

fn broken_trees<K: Kernel>() {
    let past_the_end = Child::Leaf { first: 4, count: 2 };
    assert_eq!(past_the_end.pack() >> 31, 1);
    refused::<K>(
        false,
        &[
            (
                "a box that is larger than the one that holds it",
                |d| {
                    let held = second_node(d);
                    let limit = K::boxes(&d.nodes[0])[held].high[0];
                    let by = limit + 1 - K::boxes(&d.nodes[1])[0].high[0];
                    grow(d, 1, 0, by);
                },
                BlobError::Bounds { node: 0 },
            ),
            (
                "a root's box beyond the grid",
                |d| {
                    let by = (1 << K::GRID_BITS) - K::boxes(&d.nodes[0])[0].high[0];
                    grow(d, 0, 0, by);
                },
                BlobError::Bounds { node: 0 },
            ),
            (
                "a box that leaves out what it holds",
                |d| {
                    let node = d.nodes.len() - 1;
                    grow(d, node, 1, -1);
                },
                BlobError::Bounds { node: 3 },
            ),
            ("a cycle", |d| set_children(d, 0, |c| c[0] = Child::Node(0).pack()), BlobError::Tree { node: 0 }),
            ("a shared child", |d| set_children(d, 0, |c| c[1] = c[0]), BlobError::Tree { node: 0 }),
            ("swapped children", |d| set_children(d, 3, |c| c.swap(0, 1)), BlobError::Tree { node: 3 }),
            (
                "a node that does not exist",
                |d| set_children(d, 0, |c| c[0] = u32::MAX >> 1),
                BlobError::Tree { node: 0 },
            ),
            (
                "a leaf beyond the last triangle",
                |d| set_children(d, 3, |c| c[1] = Child::Leaf { first: 4, count: 2 }.pack()),
                BlobError::Tree { node: 3 },
            ),
            ("the largest word for a leaf", |d| set_children(d, 3, |c| c[1] = u32::MAX), BlobError::Tree { node: 3 }),
            ("the largest word for a root", |d| d.header.root = u32::MAX, BlobError::Tree { node: 0 }),
            (
                "nodes that nothing leads to",
                |d| d.header.root = Child::Leaf { first: 0, count: 5 }.pack(),
                BlobError::Tree { node: 0 },
            ),
            (
                "triangles in no leaf",
                |d| {
                    d.header.root = Child::Leaf { first: 0, count: 4 }.pack();
                    (d.nodes, d.header.counts.nodes) = (Vec::new(), 0);
                },
                BlobError::Tree { node: 0 },
            ),
            ("an understated depth", |d| d.header.depth -= 1, BlobError::Depth { stated: 2 }),
            ("no depth", |d| d.header.depth = 0, BlobError::Depth { stated: 0 }),
            ("a depth beyond all stacks", |d| d.header.depth = MAX_DEPTH as u8 + 1, BlobError::Header),
        ],
    );
}

/// As many levels as there may be: what waits on the stack at the lowest is all that it holds.
fn the_deepest_tree<K: Kernel>() {
    let mut shallow = Draft::<K>::read(sample::<K>(false).bytes()).expect("a good blob");
    let count = MAX_DEPTH + 1;
    // Sixty-four that look another way than the one that is seen, which the last leaf to be visited has.
    let boxes = [K::boxes(&shallow.nodes[0])[0], K::boxes(&shallow.nodes[0])[1]];
    let whole = core_rt::kernel::Bounds {
        low: [0, 1, 2].map(|axis| boxes[0].low[axis].min(boxes[1].low[axis])),
        high: [0, 1, 2].map(|axis| boxes[0].high[axis].max(boxes[1].high[axis])),
    };
    let triangles = shallow.triangles.clone();
    shallow.triangles = (0..count).map(|i| triangles[if i + 1 == count { 0 } else { 1 + i % 4 }]).collect();
    shallow.ids = (0..count as u32).collect();
    shallow.header.counts.triangles = count as u32;
    shallow.header.file_triangles = count as u32;
    shallow.nodes =
        vec![K::node([whole; 2], [0, 1].map(|half| Child::Leaf { first: 64 * half, count: 64 - 63 * half }.pack()))];
    shallow.header.counts.nodes = 1;
    (shallow.header.root, shallow.header.depth) = (Child::Node(0).pack(), 1);

    let mut deep = shallow.clone();
    let chain = |levels: u32| {
        (0..levels).map(move |node| {
            let last = node + 1 == levels;
            let below = if last { Child::Leaf { first: 0, count: 1 } } else { Child::Node(node + 1) };
            K::node([whole; 2], [below.pack(), Child::Leaf { first: levels - node, count: 1 }.pack()])
        })
    };
    deep.nodes = chain(MAX_DEPTH as u32).collect();
    deep.header.counts.nodes = MAX_DEPTH as u32;
    deep.header.depth = MAX_DEPTH as u8;

    let picture =
        |draft: &Draft<K>| corners(&Scene::<Full<K>>::new_checked(draft.write().bytes()).expect("a good blob"));
    assert_eq!(picture(&deep), picture(&shallow));

    deep.nodes = chain(MAX_DEPTH as u32 + 1).collect();
    deep.header.counts.nodes += 1;
    let (triangle, id) = (deep.triangles[0], deep.ids[0]);
    deep.triangles.push(triangle);
    deep.ids.push(id);
    deep.header.counts.triangles += 1;
    assert_eq!(verdict::<K>(deep.write().bytes()), Err(BlobError::Depth { stated: MAX_DEPTH as u8 }));
}
