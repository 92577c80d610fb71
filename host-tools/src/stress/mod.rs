//! The stiff cases, where scales differ by orders of magnitude, and the extreme ones: each a small generator with a written
//! expectation, drawn by every kernel on every machine.
//!
//! What is promised is derived, not fitted: a kernel's [`Promise`](promise::Promise) says by how many units of its grid what
//! it sees may be off, and how many gray levels its shading may be; the grid and the camera make pixels of the units. A
//! pixel that is neither the reference's, nor among what the reference shows within so many pixels, is a
//! [stray](envelope), and none is allowed. Where a kernel cannot hold that, `prep` must have said so: it refuses, or it
//! warns of what is lost. A picture that is wrong without a word is a failure.

pub mod cases;
pub mod chip;
pub mod envelope;
pub mod host;
pub mod promise;
mod rays;
pub mod row;
pub mod shapes;
pub mod suite;
pub mod table;

use glam::DVec3;

use crate::model::Model;

/// What a case strains.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Group {
    /// Sizes and distances that differ by orders of magnitude.
    Scale,
    /// Shapes and places of triangles.
    Triangles,
    /// Origins and directions of rays.
    Rays,
    /// Materials and lights.
    Shading,
    /// Trees.
    Structure,
}

impl Group {
    /// As a heading.
    #[must_use]
    pub const fn title(self) -> &'static str {
        match self {
            Self::Scale => "Relative scale",
            Self::Triangles => "Triangles",
            Self::Rays => "Rays",
            Self::Shading => "Shading",
            Self::Structure => "Structure",
        }
    }
}

/// A case: a scene, how it is drawn, and what is expected of it.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// On the command line.
    pub name: &'static str,
    /// What it strains.
    pub group: Group,
    /// What is expected, one sentence.
    pub expectation: &'static str,
    /// How much farther than a surface's own image what is seen by way of others moves: shadows' edges, mirror images. At
    /// each case stands why.
    pub leverage: f64,
    /// By how many unit vectors, each off by what the kernel's are, the direction to what is seen by way of other surfaces
    /// is off.
    pub bends: f64,
    /// Whether refracted rays come out as flat as can be: there 1 - turn of a sine is an angle of sqrt(2 turn).
    pub grazes: bool,
    /// By how many full ranges of a channel a colour changes where a unit vector turns by a radian: 1 for matt surfaces
    /// under one light.
    pub steepness: f64,
    /// How many rays that go on a pixel may drop because nobody would see them, a quarter of a gray level each.
    pub dropped: f64,
    /// The length of the concave corners between mirrors and other surfaces, and of their images, pixels: a ray that leaves
    /// a mirror closer to the other surface than its start is off may start behind it, and passes it.
    pub corners: f64,
    /// The most triangles of a leaf; `None` where their cost decides.
    pub leaf: Option<u32>,
    /// Whether it is small enough for a chip.
    pub chips: bool,
    /// Whether nothing but grids of their own for its parts would let coarse grids hold it: the seam for such grids.
    pub part_grids: bool,
    /// The scene, and rays of its own.
    pub subject: fn() -> Subject,
}

/// A scene, and rays of its own.
#[derive(Clone, Debug)]
pub struct Subject {
    /// The scene, with the camera and the size of its picture.
    pub model: Model,
    /// Origins and directions, scene units, whose nearest hits are compared beside the picture; on the host alone.
    pub rays: Vec<[DVec3; 2]>,
}

impl From<Model> for Subject {
    fn from(model: Model) -> Self {
        Self { model, rays: Vec::new() }
    }
}

impl Case {
    /// A case of matt surfaces with shadows that fall on what is about as near to what casts them as it is large.
    #[must_use]
    pub const fn new(group: Group, name: &'static str, expectation: &'static str, subject: fn() -> Subject) -> Self {
        Self {
            name,
            group,
            expectation,
            leverage: 4.0,
            bends: 0.0,
            grazes: false,
            steepness: 1.0,
            dropped: 0.0,
            corners: 0.0,
            leaf: None,
            chips: true,
            part_grids: false,
            subject,
        }
    }
}
