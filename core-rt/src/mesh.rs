//! Triangles: a record each, or three corners among vertices that neighbours share.
//!
//! A record has all that its test wants, worked out beforehand. Corners are a third of that, since a closed mesh has half as many
//! vertices as triangles, and the record is made anew whenever the triangle is tested: by the same function, from the same
//! vertices, so that both layouts are hit alike, bit for bit. A scene has one of them, and a profile that has one has no code
//! for the other.

use crate::kernel::{Bounds, Kernel, Vertices};
use crate::profile::{Need, Profile};
use crate::section::Integers;

/// The triangles of a scene, in the order of the tree's leaves.
#[derive(Clone, Copy, Debug)]
pub struct Mesh<'a, P: Profile> {
    /// What the kernel computes with.
    pub settings: <P::Kernel as Kernel>::Settings,
    /// A record a triangle; none where vertices are shared.
    pub records: &'a [<P::Kernel as Kernel>::Triangle],
    /// How many bits of a record's material number are that: [`Mesh::NO_IDS`], or those above are the triangle's id.
    pub material_bits: u8,
    /// Three vertices a triangle; none where triangles have records.
    pub corners: Integers<'a>,
    /// The vertices that corners refer to.
    pub vertices: &'a [<P::Kernel as Kernel>::Vertex],
    /// With shared vertices, the material of each triangle; none where all are of the first.
    pub materials: Integers<'a>,
}

impl<'a, P: Profile> Mesh<'a, P> {
    /// In place of `material_bits`: all of them. No kernel has more.
    pub const NO_IDS: u8 = 31;

    /// Triangles with a record each.
    #[must_use]
    pub const fn whole(
        settings: <P::Kernel as Kernel>::Settings,
        records: &'a [<P::Kernel as Kernel>::Triangle],
    ) -> Self {
        Self {
            settings,
            records,
            material_bits: Self::NO_IDS,
            corners: Integers::NONE,
            vertices: &[],
            materials: Integers::NONE,
        }
    }

    /// Whether triangles share vertices; known when the code is compiled, but to a profile that has both layouts.
    #[inline(always)]
    #[must_use]
    pub fn is_shared(&self) -> bool {
        match (P::NEEDS.has(Need::WholeTriangles), P::NEEDS.has(Need::SharedVertices)) {
            (_, false) => false,
            (false, true) => true,
            (true, true) => !self.corners.is_empty(),
        }
    }

    /// How many there are.
    #[inline(always)]
    #[must_use]
    pub fn len(&self) -> u32 {
        // A blob's header counts them in 32 bits.
        (if self.is_shared() { self.corners.len() / 3 } else { self.records.len() }) as u32
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The records from `first` on of triangles that have some; `None` where there are fewer.
    #[inline(always)]
    #[must_use]
    pub fn run(&self, first: u32, count: u32) -> Option<&'a [<P::Kernel as Kernel>::Triangle]> {
        self.records.get(first as usize..(first + count) as usize)
    }

    /// The record of a triangle that shares its vertices, its material left out; `None` where there is none.
    #[inline(always)]
    #[must_use]
    pub fn assemble(&self, index: u32) -> Option<<P::Kernel as Kernel>::Triangle> {
        let [a, b, c] = self.corners.triple(index);
        let vertex = |number: u32| self.vertices.get(number as usize);
        P::Kernel::assemble(self.settings, [vertex(a)?, vertex(b)?, vertex(c)?])
    }

    /// What is made of the record of a triangle, its material left out where vertices are shared; `None` where there is none.
    #[inline(always)]
    pub fn of<T>(&self, index: u32, made: impl FnOnce(&<P::Kernel as Kernel>::Triangle) -> T) -> Option<T> {
        if self.is_shared() {
            self.assemble(index).as_ref().map(made)
        } else {
            self.records.get(index as usize).map(made)
        }
    }

    /// The material of a triangle; `None` where there is none.
    #[inline(always)]
    #[must_use]
    pub fn material(&self, index: u32) -> Option<u32> {
        if !self.is_shared() {
            let number = P::Kernel::material(self.records.get(index as usize)?);
            let has_id = P::NEEDS.has(Need::IdsInRecords);
            return Some(if has_id { number & ((1 << self.material_bits) - 1) } else { number });
        }
        match self.materials.is_empty() {
            true => (index < self.len()).then_some(0),
            false => Some(self.materials.get(index)),
        }
    }

    /// The id of a triangle that has it in its record; past the end the largest.
    #[inline]
    #[must_use]
    pub fn id(&self, index: u32) -> u32 {
        self.records.get(index as usize).map_or(u32::MAX, |record| P::Kernel::material(record) >> self.material_bits)
    }

    /// The corners of a triangle; `None` where there is none.
    #[inline]
    #[must_use]
    pub fn vertices(&self, index: u32) -> Option<Vertices> {
        if !self.is_shared() {
            return self.records.get(index as usize).map(P::Kernel::vertices);
        }
        let [a, b, c] = self.corners.triple(index);
        let place = |number: u32| self.vertices.get(number as usize).map(P::Kernel::place);
        Some([place(a)?, place(b)?, place(c)?])
    }

    /// How many bytes they take, vertices and materials included.
    #[must_use]
    pub fn bytes(&self) -> usize {
        size_of_val(self.records) + self.corners.size() + size_of_val(self.vertices) + self.materials.size()
    }

    /// The boxes of all triangles.
    pub fn bounds(&self) -> impl Iterator<Item = Bounds> {
        (0..self.len()).filter_map(move |index| self.vertices(index)).map(|vertices| Bounds::of(&vertices))
    }

    /// Whether a triangle is what the kernel makes of its vertices.
    pub(crate) fn is_valid(&self, index: u32) -> bool {
        let Some(vertices) = self.vertices(index) else { return false };
        let made = |number| P::Kernel::triangle(self.settings, &vertices, number);
        if self.is_shared() {
            return made(0).is_some();
        }
        // Whatever the vertices of a record wrap to, only one made from vertices on the grid is equal to what is made of them.
        let own = self.records.get(index as usize);
        own.is_some_and(|own| made(P::Kernel::material(own)).is_some_and(|made| made == *own))
    }
}
