//! The layout: eight boxes a node and eight triangles a packet, in lanes.

use core_rt::bvh::Bvh;
use core_rt::kernel::{Bounds, Vertices};
use core_rt::profile::Profile;

use super::collapse::{Below, WIDTH, collapse};

/// A number a lane.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Row<T>(pub(super) [T; WIDTH]);

/// Eight child boxes.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Node<T> {
    /// Low and high planes, by axis.
    pub(super) planes: [[Row<T>; 2]; 3],
    /// Children, in the order of the lanes of what is found of the boxes.
    pub(super) children: [u32; WIDTH],
    /// How many there are.
    pub(super) count: u32,
}

/// Eight triangles, each with so many numbers.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub(super) struct Packet<T, const ROWS: usize> {
    pub(super) rows: [Row<T>; ROWS],
    /// The first one's place among the records; the others follow.
    pub(super) first: u32,
    /// How many there are.
    pub(super) count: u32,
}

impl<T> Node<T> {
    /// The lanes in which there is a child.
    #[inline(always)]
    pub(super) fn used(&self) -> u32 {
        (1 << self.count) - 1
    }
}

impl<T, const ROWS: usize> Packet<T, ROWS> {
    /// The lanes in which there is a triangle.
    #[inline(always)]
    pub(super) fn used(&self) -> u32 {
        (1 << self.count) - 1
    }
}

/// What numbers a layout is of.
pub(super) trait Layout<const ROWS: usize>: Copy + Default {
    /// In which lane of a box's rows the child stands that comes out in a lane.
    const LANES: [usize; WIDTH];
    /// A coordinate of a box.
    fn plane(coordinate: i32) -> Self;
    /// A triangle's numbers, and in which lane of its row each stands that is tested in a lane.
    fn triangle(vertices: &Vertices) -> [Self; ROWS];
    /// See `triangle`.
    fn lane(row: usize, lane: usize) -> usize;
}

/// A tree of eight children a node.
#[derive(Clone, Debug)]
pub(super) struct Wide<T, const ROWS: usize> {
    pub(super) nodes: Vec<Node<T>>,
    pub(super) packets: Vec<Packet<T, ROWS>>,
    /// Runs of spheres.
    pub(super) spheres: Vec<[u32; 2]>,
}

/// What a child is, packed in a word: bit 31 for a leaf, bit 30 for spheres.
pub(super) enum Word {
    /// A node.
    Node(u32),
    /// Packets.
    Packets { first: u32, count: u32 },
    /// A run of spheres, by its place.
    Spheres(u32),
}

impl Word {
    const LEAF: u32 = 1 << 31;
    const SPHERES: u32 = 1 << 30;
    /// Where the number of packets, 1 to 8, less one is. Below it a number: of nodes, packets and runs of spheres there are no
    /// more than primitives, which are below 2^25.
    const COUNT_SHIFT: u32 = 26;

    fn pack(self) -> u32 {
        match self {
            Self::Node(index) => index,
            Self::Packets { first, count } => Self::LEAF | (count - 1) << Self::COUNT_SHIFT | first,
            Self::Spheres(place) => Self::LEAF | Self::SPHERES | place,
        }
    }

    #[inline(always)]
    pub(super) fn unpack(word: u32) -> Self {
        let rest = word & ((1 << Self::COUNT_SHIFT) - 1);
        if word & Self::LEAF == 0 {
            Self::Node(word)
        } else if word & Self::SPHERES == 0 {
            Self::Packets { first: rest, count: (word >> Self::COUNT_SHIFT & 15) + 1 }
        } else {
            Self::Spheres(rest)
        }
    }
}

impl<T: Layout<ROWS>, const ROWS: usize> Wide<T, ROWS> {
    pub(super) fn new<P: Profile>(bvh: &Bvh<'_, P>) -> Self {
        let sources = collapse(bvh);
        let mut tree = Self { nodes: Vec::new(), packets: Vec::new(), spheres: Vec::new() };
        for source in &sources {
            let mut node =
                Node { planes: [[Row([T::default(); WIDTH]); 2]; 3], children: [0; WIDTH], count: source.len() as u32 };
            for (slot, &(Bounds { low, high }, below)) in source.iter().enumerate() {
                for axis in [0, 1, 2] {
                    node.planes[axis][0].0[T::LANES[slot]] = T::plane(low[axis]);
                    node.planes[axis][1].0[T::LANES[slot]] = T::plane(high[axis]);
                }
                node.children[slot] = tree.word(bvh, below).pack();
            }
            tree.nodes.push(node);
        }
        tree
    }

    fn word<P: Profile>(&mut self, bvh: &Bvh<'_, P>, below: Below) -> Word {
        match below {
            Below::Node(index) => Word::Node(index),
            Below::Spheres { first, count } => {
                self.spheres.push([first, count]);
                Word::Spheres(self.spheres.len() as u32 - 1)
            }
            Below::Triangles { first, count } => {
                let place = self.packets.len() as u32;
                for start in (first..first + count).step_by(WIDTH) {
                    self.packets.push(packet(bvh, start, (first + count - start).min(WIDTH as u32)));
                }
                Word::Packets { first: place, count: count.div_ceil(WIDTH as u32) }
            }
        }
    }
}

fn packet<P: Profile, T: Layout<ROWS>, const ROWS: usize>(bvh: &Bvh<'_, P>, first: u32, count: u32) -> Packet<T, ROWS> {
    let mut packet = Packet { rows: [Row([T::default(); WIDTH]); ROWS], first, count };
    for lane in 0..count {
        // A checked scene has the triangle; one without size is missed by all but what is asked exactly.
        let triangle = T::triangle(&bvh.triangles.vertices(first + lane).unwrap_or_default());
        for (row, value) in triangle.into_iter().enumerate() {
            packet.rows[row].0[T::lane(row, lane as usize)] = value;
        }
    }
    packet
}
