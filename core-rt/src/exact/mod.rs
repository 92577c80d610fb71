//! The exact kernels: one algorithm, instantiated by a [`Width`].
//!
//! Whether a ray hits a triangle or a sphere is decided by the signs of integers that are computed without error, and
//! which of two hits is nearer by comparing fractions. A filter in one machine word decides all but the closest
//! calls. Boxes are conservative, so a hit is never lost. Nearest means: the smallest (t, id).
//!
//! The arithmetic is that of Kensler & Shirley, "Optimizing Ray-Triangle Intersection via Automated Search" (2006),
//! as integers; the filter is of the kind of Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust
//! Geometric Predicates" (1997).

mod boxes;
mod frustum;
mod ray;
mod resolve;
mod slopes;
#[cfg_attr(prefer_size, path = "span/exact.rs")]
mod span;
mod sphere;
mod triangle;
mod width;
mod width14;
mod width20;
mod width29;

pub(crate) use boxes::slab;
pub use boxes::{BoxNode, BoxNode14, BoxNode29};
pub use frustum::Frustum;
pub use ray::Ray;
pub(crate) use slopes::in_order;
pub use slopes::{PerAxis, Slopes, Slopes14, Slopes29};
pub use span::Span;
pub(crate) use sphere::{Crossing, crossing};
pub use triangle::{Depth, TriangleRecord};
pub use width::{Distance, Reciprocal, Wide, Width};
pub use width14::Width14;
pub use width20::{Reciprocal20, Width20};
pub use width29::{Form, Reciprocal29, Width29, Width29In};

use core::cmp::Ordering;
use core::marker::PhantomData;

use crate::arithmetic::{Arithmetic, Knobs};
use crate::camera::Camera;
use crate::kernel::{Bounds, Kernel, NONE, Surface, Vertices};
use crate::num::{Triple, Word};
use crate::space::Space;
use crate::sphere::{Ball, SphereRecord};

/// The exact kernel of a width.
#[derive(Clone, Copy, Debug, Default)]
pub struct Exact<W>(PhantomData<W>);

/// 14-bit grid (15 where the camera is inside the scene), 32-bit hot path: for a Cortex-M0 and small pictures.
pub type Exact14 = Exact<Width14>;

/// 20-bit grid, everything in 64 bits: for 64-bit hosts in a hurry.
pub type Exact20 = Exact<Width20>;

/// 29-bit grid, 64-bit hot path: for hosts, and the best picture.
pub type Exact29 = Exact<Width29>;

impl<W: Width> Kernel for Exact<W> {
    const ID: u16 = W::ID;
    const NAME: &'static str = W::NAME;
    const GRID_BITS: u32 = W::GRID_BITS;
    const MARGIN: i32 = W::MARGIN;
    const SPAN: i32 = W::SPAN;
    const DIRECTION_BITS: u32 = W::DIRECTION_BITS;
    const MATERIALS_MAX: u32 = W::MATERIALS_MAX;
    const RADIUS_MIN: i32 = sphere::RADIUS_MIN;
    const ANY_OCTANT: bool = <W::Slopes as Slopes>::ANY_OCTANT;

    type Settings = ();
    type Space = W::Space;
    type Word = W::Word;
    type Node = W::Node;
    type Triangle = TriangleRecord<W::Short>;
    type Vertex = Triple<W::Short>;
    type Sphere = SphereRecord<W::Short>;
    type Ray = Ray<W>;
    type Path = W::Slopes;
    type Distance = Distance<W>;
    type Depth = Depth<W>;
    type Span = Span<W>;
    type Beam = Frustum<W>;

    fn settle(knobs: &Knobs, _triangles: impl Iterator<Item = Vertices>) -> Option<Arithmetic> {
        Arithmetic::fixed(knobs)
    }

    fn settings(arithmetic: &Arithmetic) -> Option<()> {
        arithmetic.none()
    }

    fn node(boxes: [Bounds; 2], children: [u32; 2]) -> Self::Node {
        boxes::pack(boxes, children)
    }

    #[inline(always)]
    fn children(node: &Self::Node) -> [u32; 2] {
        node.children()
    }

    fn boxes(node: &Self::Node) -> [Bounds; 2] {
        boxes::unpack::<W>(node)
    }

    fn triangle((): (), vertices: &Vertices, material: u32) -> Option<Self::Triangle> {
        triangle::pack::<W>(vertices, material)
    }

    fn vertices(triangle: &Self::Triangle) -> Vertices {
        triangle::vertices::<W>(triangle)
    }

    fn vertex(place: Triple<i32>) -> Self::Vertex {
        triangle::vertex::<W>(place)
    }

    #[inline(always)]
    fn place(vertex: &Self::Vertex) -> Triple<i32> {
        vertex.map(|c| W::coordinate(c).low_i32())
    }

    #[inline(always)]
    fn assemble((): (), vertices: [&Self::Vertex; 3]) -> Option<Self::Triangle> {
        triangle::assemble::<W>(vertices.map(|vertex| vertex.map(W::coordinate)), 0)
    }

    #[inline]
    fn material(triangle: &Self::Triangle) -> u32 {
        W::split_meta(triangle.meta()).1
    }

    fn sphere(ball: &Ball, material: u32) -> Option<Self::Sphere> {
        if !ball.fits::<Self>() || material > W::MATERIALS_MAX {
            return None;
        }
        SphereRecord::new(ball, material)
    }

    fn ball(sphere: &Self::Sphere) -> Ball {
        sphere.ball::<W::Word>()
    }

    #[inline]
    fn sphere_material(sphere: &Self::Sphere) -> u32 {
        sphere.material::<W::Word>()
    }

    #[inline]
    fn primary((): (), camera: &Camera<W::Word>, x: u16, y: u16) -> Option<Ray<W>> {
        Ray::new(camera.eye(), camera.direction(x, y), NONE)
    }

    #[inline]
    fn ray((): (), origin: Triple<W::Word>, direction: Triple<W::Word>, skip: u32) -> Option<Ray<W>> {
        Ray::new(origin, direction, skip)
    }

    #[inline]
    fn segment((): (), from: &Surface<W::Space>, to: Triple<i32>, skip: u32) -> Option<Ray<W>> {
        Ray::segment(W::stand_off(from), to.map(W::Word::from_i32), skip)
    }

    #[inline]
    fn leaving((): (), from: &Surface<W::Space>, direction: <W::Space as Space>::Unit, skip: u32) -> Option<Ray<W>> {
        Ray::new(W::stand_off(from), W::direction(direction), skip)
    }

    #[inline(always)]
    fn skip(ray: &Ray<W>) -> u32 {
        ray.skip
    }

    #[inline(always)]
    fn path(ray: &Ray<W>) -> W::Slopes {
        W::Slopes::new(ray.origin, ray.direction)
    }

    #[inline(always)]
    fn path_of_any(ray: &Ray<W>) -> W::Slopes {
        W::Slopes::of_any(ray.origin, ray.direction)
    }

    #[inline(always)]
    fn octant(slopes: &W::Slopes) -> usize {
        slopes.octant()
    }

    #[inline(always)]
    fn reach(ray: &Ray<W>, slopes: &W::Slopes) -> Distance<W> {
        slopes.limit(ray.reach_limit())
    }

    #[inline(always)]
    fn enter<const OCTANT: usize>(
        slopes: &W::Slopes,
        node: &Self::Node,
        child: usize,
        limit: Distance<W>,
    ) -> Option<Distance<W>> {
        boxes::enter::<W, OCTANT>(slopes, node, child, limit)
    }

    #[inline(always)]
    fn intersect(ray: &Ray<W>, triangle: &Self::Triangle) -> Option<Depth<W>> {
        triangle::intersect(ray, triangle)
    }

    #[inline]
    fn intersect_sphere(ray: &Ray<W>, sphere: &Self::Sphere, leaves: bool) -> Option<Depth<W>> {
        sphere::intersect(ray, sphere, leaves)
    }

    #[inline(always)]
    fn meet(ray: &Ray<W>, triangle: &Self::Triangle) -> Option<Span<W>> {
        span::meet(ray, triangle)
    }

    #[inline(always)]
    fn span(depth: &Depth<W>) -> Span<W> {
        span::of(depth)
    }

    #[inline(always)]
    fn limit(slopes: &W::Slopes, span: &Span<W>) -> Distance<W> {
        slopes.limit(span::depth(span))
    }

    #[inline(always)]
    fn compare(a: &Span<W>, b: &Span<W>) -> Option<Ordering> {
        span::order(a, b)
    }

    #[inline(always)]
    fn order(a: &Depth<W>, b: &Depth<W>) -> Ordering {
        triangle::order(a, b)
    }

    #[inline(always)]
    fn within(entry: Distance<W>, limit: Distance<W>) -> bool {
        entry <= limit
    }

    #[inline]
    fn heading(ray: &Ray<W>) -> <W::Space as Space>::Unit {
        // Its largest component fills the format, so it is not zero.
        W::normalise(ray.direction).unwrap_or_else(|| W::Space::unit_from_q30([0, 0, 1 << 30]))
    }

    fn resolve(ray: &Ray<W>, triangle: &Self::Triangle) -> Surface<W::Space> {
        resolve::resolve(ray, triangle)
    }

    fn resolve_sphere(ray: &Ray<W>, sphere: &Self::Sphere) -> Surface<W::Space> {
        sphere::resolve(ray, sphere)
    }
}
