//! Triangles as corners among the vertices that they share.

use std::collections::HashMap;

use core_rt::kernel::{Kernel, Vertices};
use core_rt::num::Triple;
use core_rt::section::ALIGN;

/// Triangles without records.
pub(super) struct Shared {
    /// On the grid, each once, in the order in which triangles come upon them.
    pub(super) vertices: Vec<Triple<i32>>,
    /// Three a triangle.
    pub(super) corners: Vec<u32>,
    /// The material of each triangle; none where all are of the first.
    pub(super) materials: Vec<u32>,
}

impl Shared {
    /// Of triangles and their materials.
    pub(super) fn of(triangles: impl Iterator<Item = (Vertices, u32)>) -> Self {
        let (mut numbers, mut vertices) = (HashMap::new(), Vec::new());
        let (mut corners, mut materials) = (Vec::new(), Vec::new());
        for (triangle, material) in triangles {
            corners.extend(triangle.map(|vertex| {
                *numbers.entry(vertex).or_insert_with(|| {
                    vertices.push(vertex);
                    vertices.len() as u32 - 1
                })
            }));
            materials.push(material);
        }
        Self { vertices, corners, materials }
    }

    /// Whether corners have 32 bits.
    pub(super) fn wide_corners(&self) -> bool {
        self.vertices.len() > 1 << 16
    }

    /// The numbers of materials that a blob with so many has: none of one alone.
    pub(super) fn numbers(&self, materials: usize) -> &[u32] {
        if materials > 1 { &self.materials } else { &[] }
    }

    /// How many bytes they take in a blob with so many materials.
    pub(super) fn bytes<K: Kernel>(&self, materials: usize) -> usize {
        let integer = |wide: bool| if wide { 4 } else { 2 };
        let sections = [
            self.corners.len() * integer(self.wide_corners()),
            self.vertices.len() * size_of::<K::Vertex>(),
            self.numbers(materials).len() * integer(materials > 1 << 16),
        ];
        sections.iter().map(|bytes| bytes.next_multiple_of(ALIGN)).sum()
    }
}
