//! Kernels: a space with its records, its box test, its triangle test and its sphere test.
//!
//! Traversal, tracing and shading are written once against [`Kernel`]. A kernel states how wide its numbers are;
//! what the others may rely on is here: a box test that never loses a hit, and an order of hits that does not
//! depend on the order in which they are found.

use core::cmp::Ordering;
use core::fmt::Debug;

use crate::arithmetic::{Arithmetic, Knobs};
use crate::camera::Camera;
use crate::num::{Triple, Word};
use crate::record::Record;
use crate::space::Space;
use crate::sphere::Ball;
use crate::tile::Beam;

/// The corners of a triangle in grid units.
pub type Vertices = [Triple<i32>; 3];

/// An axis-aligned box in grid units, both corners inclusive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// The least coordinates.
    pub low: Triple<i32>,
    /// The greatest coordinates.
    pub high: Triple<i32>,
}

impl Bounds {
    /// The box of no point: [`Bounds::union`] with it changes nothing.
    pub const NOTHING: Self = Self { low: [i32::MAX; 3], high: [i32::MIN; 3] };

    /// Whether `other` lies within.
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        let not_below = self.low.iter().zip(&other.low).all(|(a, b)| a <= b);
        not_below && self.high.iter().zip(&other.high).all(|(a, b)| a >= b)
    }

    /// Whether a point is at most `span` from everything in the box, along each axis.
    #[must_use]
    pub fn spanned_from(&self, point: Triple<i32>, span: i32) -> bool {
        let reaches = |(&point, (&low, &high)): (&i32, (&i32, &i32))| {
            let point = i64::from(point);
            point - i64::from(low) <= i64::from(span) && i64::from(high) - point <= i64::from(span)
        };
        point.iter().zip(self.low.iter().zip(&self.high)).all(reaches)
    }

    /// The box of two boxes.
    #[must_use]
    #[inline(never)]
    pub fn union(&self, other: &Self) -> Self {
        let mut both = *self;
        for (low, other) in both.low.iter_mut().zip(other.low) {
            *low = other.min(*low);
        }
        for (high, other) in both.high.iter_mut().zip(other.high) {
            *high = other.max(*high);
        }
        both
    }

    /// The box of three corners.
    #[must_use]
    pub fn of(vertices: &Vertices) -> Self {
        let [a, b, c] = *vertices;
        let fold = |pick: fn(i32, i32) -> i32| {
            [pick(pick(a[0], b[0]), c[0]), pick(pick(a[1], b[1]), c[1]), pick(pick(a[2], b[2]), c[2])]
        };
        Self { low: fold(i32::min), high: fold(i32::max) }
    }
}

/// No primitive: the value of `skip` for a ray that starts on none, and of an id where nothing was hit.
pub const NONE: u32 = u32::MAX;

/// Every octant: planes are then chosen by comparing the distances to them.
pub const ANY_OCTANT: usize = 8;

/// The octant of a direction; see [`Kernel::octant`].
#[inline(always)]
#[must_use]
pub fn octant<T: Word>(direction: Triple<T>) -> usize {
    let [x, y, z] = direction.map(|c| usize::from(c < T::ZERO));
    z << 2 | y << 1 | x
}

/// What a hit is made of, for shading.
#[derive(Clone, Copy, Debug)]
pub struct Surface<S: Space> {
    /// The hit point.
    pub point: S::Point,
    /// The geometric normal, on the side that the ray came from.
    pub normal: S::Unit,
    /// Whether that is the front, from where the vertices run counter-clockwise; of a sphere the outside.
    pub front: bool,
    /// The weight of the second vertex; 0 on a sphere.
    pub u: S::Fraction,
    /// The weight of the third vertex; 0 on a sphere.
    pub v: S::Fraction,
}

/// A way to intersect rays with boxes, triangles and spheres, and the records for it.
pub trait Kernel: Copy + Debug + Default + Send + Sync + 'static {
    /// Its number in a blob.
    const ID: u16;
    /// Its name on the command line.
    const NAME: &'static str;
    /// Vertices lie in `[MARGIN, 2^GRID_BITS - MARGIN)`.
    const GRID_BITS: u32;
    /// See `GRID_BITS`.
    const MARGIN: i32;
    /// Origins of rays (cameras, point lights) and vertices differ by at most this along each axis.
    const SPAN: i32;
    /// The largest magnitude of a direction's component, as a power of two.
    const DIRECTION_BITS: u32;
    /// The largest material index that a triangle's or a sphere's record holds.
    const MATERIALS_MAX: u32;
    /// The least radius of a sphere, grid units: rays that leave its surface inwards must start inside, whatever they are
    /// moved off it and rounded by.
    const RADIUS_MIN: i32;

    /// What it leaves to the scene, read from the blob's header: `()` where nothing.
    type Settings: Copy + Debug + Send + Sync;
    /// What of [`Knobs`] it has, and in which ranges, in words.
    const KNOBS: &'static str = "it has no knobs";

    /// What it shades in.
    type Space: Space;
    /// The word of camera coefficients.
    type Word: Word;
    /// Two child boxes and what they hold.
    type Node: Record;
    /// A triangle.
    type Triangle: Record;
    /// A vertex that triangles share.
    type Vertex: Record;
    /// A sphere.
    type Sphere: Record;
    /// A ray.
    type Ray: Copy + Debug;
    /// What the box test needs of a ray, worked out once a traversal.
    type Path: Copy + Debug;
    /// A lower bound of the distance at which a ray enters a box.
    type Distance: Copy + Debug + PartialOrd + Send;
    /// Where a ray hits a triangle or a sphere, exactly (as exactly as the kernel knows).
    type Depth: Copy + Debug;
    /// Between which depths a hit is: enough to tell most hits apart, for less.
    type Span: Copy + Debug;
    /// The camera rays of a tile, where they walk the tree together; [`NoBeam`](crate::tile::NoBeam) where they do not.
    type Beam: Beam<Self>;

    /// The settings for a scene of these triangles, where a user may ask for some; `None` where the kernel lacks what is
    /// asked for, or cannot hold it. Of the host, in the integers of the device.
    fn settle(knobs: &Knobs, triangles: impl Iterator<Item = Vertices>) -> Option<Arithmetic>;
    /// The settings of a blob; `None` where it could not be of [`Kernel::settle`].
    fn settings(arithmetic: &Arithmetic) -> Option<Self::Settings>;

    /// The record of a node, from the boxes of its children and their packed references.
    fn node(boxes: [Bounds; 2], children: [u32; 2]) -> Self::Node;
    /// The packed references of a node's children.
    fn children(node: &Self::Node) -> [u32; 2];
    /// The boxes of a node's children.
    fn boxes(node: &Self::Node) -> [Bounds; 2];
    /// The record of a triangle with vertices on the grid; `None` where it has no area or the material is too high.
    fn triangle(settings: Self::Settings, vertices: &Vertices, material: u32) -> Option<Self::Triangle>;
    /// The corners of a triangle; of a record that [`Kernel::triangle`] did not make, whatever it says.
    fn vertices(triangle: &Self::Triangle) -> Vertices;
    /// The record of a vertex on the grid.
    fn vertex(place: Triple<i32>) -> Self::Vertex;
    /// The place of a vertex.
    fn place(vertex: &Self::Vertex) -> Triple<i32>;
    /// The record of a triangle of which [`Kernel::triangle`] makes one, with material 0; of another `None`, or whatever.
    #[inline]
    fn assemble(settings: Self::Settings, vertices: [&Self::Vertex; 3]) -> Option<Self::Triangle> {
        Self::triangle(settings, &vertices.map(Self::place), 0)
    }
    /// The material of a triangle.
    fn material(triangle: &Self::Triangle) -> u32;
    /// The record of a sphere; `None` where it does not fit ([`Ball::fits`]) or the material is too high.
    fn sphere(ball: &Ball, material: u32) -> Option<Self::Sphere>;
    /// The sphere of a record; of one that [`Kernel::sphere`] did not make, whatever it says.
    fn ball(sphere: &Self::Sphere) -> Ball;
    /// The material of a sphere.
    fn sphere_material(sphere: &Self::Sphere) -> u32;

    /// The ray through a pixel; `None` where the direction is zero.
    fn primary(settings: Self::Settings, camera: &Camera<Self::Word>, x: u16, y: u16) -> Option<Self::Ray>;
    /// The ray from an origin on or near the grid in a direction; `None` where that is zero.
    fn ray(
        settings: Self::Settings,
        origin: Triple<Self::Word>,
        direction: Triple<Self::Word>,
        skip: u32,
    ) -> Option<Self::Ray>;
    /// The open segment from a surface (moved off it, on the normal's side) to a grid point.
    fn segment(settings: Self::Settings, from: &Surface<Self::Space>, to: Triple<i32>, skip: u32) -> Option<Self::Ray>;
    /// The ray from a surface (moved off it, on the normal's side) in a direction.
    fn leaving(
        settings: Self::Settings,
        from: &Surface<Self::Space>,
        direction: <Self::Space as Space>::Unit,
        skip: u32,
    ) -> Option<Self::Ray>;

    /// The primitive that a ray starts on, or [`NONE`].
    fn skip(ray: &Self::Ray) -> u32;
    /// The ray, prepared for boxes.
    fn path(ray: &Self::Ray) -> Self::Path;
    /// The ray, prepared for boxes that are tested in the way that serves all octants.
    #[inline(always)]
    fn path_of_any(ray: &Self::Ray) -> Self::Path {
        Self::path(ray)
    }
    /// Whether [`Kernel::octant`] may be [`ANY_OCTANT`], so that the descent is compiled for it too.
    const ANY_OCTANT: bool = false;
    /// Which way a ray goes: bit a is set where it moves down along axis a. [`ANY_OCTANT`] for a ray whose boxes are tested
    /// in the way that serves all.
    fn octant(path: &Self::Path) -> usize;
    /// The limit beyond which nothing counts.
    fn reach(ray: &Self::Ray, path: &Self::Path) -> Self::Distance;
    /// Where a ray of its [octant](Kernel::octant) (or, of a kernel that has no rays without one, [`ANY_OCTANT`]) enters a child of a node, 0 or 1, if it does before `limit`. Conservative: a child that holds a
    /// triangle whose hit is not beyond `limit` is never left out, but for `hanika-c` and `hanika-cd`, which reproduce a
    /// test that does. The octant is a constant, so that near and far planes are chosen when the code is compiled.
    fn enter<const OCTANT: usize>(
        path: &Self::Path,
        node: &Self::Node,
        child: usize,
        limit: Self::Distance,
    ) -> Option<Self::Distance>;
    /// Where a ray hits a triangle, if it does within its reach. Edges belong to both neighbours.
    fn intersect(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<Self::Depth>;
    /// Where a ray hits a sphere, if it does within its reach; a tangent does. `leaves` says that the ray starts on it, off it
    /// on one side: then it hits it at most once more, and only from inside.
    fn intersect_sphere(ray: &Self::Ray, sphere: &Self::Sphere, leaves: bool) -> Option<Self::Depth>;
    /// Between which depths the hit is that [`Kernel::intersect`] finds.
    fn meet(ray: &Self::Ray, triangle: &Self::Triangle) -> Option<Self::Span>;
    /// That of a hit whose depth is known.
    fn span(depth: &Self::Depth) -> Self::Span;
    /// A limit for [`Kernel::enter`] that leaves out nothing at or before a hit of the ray.
    fn limit(path: &Self::Path, span: &Self::Span) -> Self::Distance;
    /// The order of two hits of one ray, where it can be told by these.
    fn compare(a: &Self::Span, b: &Self::Span) -> Option<Ordering>;
    /// The order of two hits of one ray.
    fn order(a: &Self::Depth, b: &Self::Depth) -> Ordering;
    /// Whether a box that is entered at `entry` may hold something not beyond `limit`.
    fn within(entry: Self::Distance, limit: Self::Distance) -> bool;
    /// The direction of a ray, with length 1.
    fn heading(ray: &Self::Ray) -> <Self::Space as Space>::Unit;
    /// The point, the normal and the barycentrics of a hit. The triangle must be hit by the ray.
    fn resolve(ray: &Self::Ray, triangle: &Self::Triangle) -> Surface<Self::Space>;
    /// The point and the normal of a hit. The sphere must be hit by the ray.
    fn resolve_sphere(ray: &Self::Ray, sphere: &Self::Sphere) -> Surface<Self::Space>;
}
