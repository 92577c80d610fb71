//! The kernels of the 2009 report: Heinly, Recker, Bensema, Porch & Gribble, "Integer Ray Tracing" (GCC-CS-001-2009),
//! after Hanika & Keller, "Towards Hardware Ray Tracing using Fixed Point Arithmetic" (2007), and Wald's projection
//! method (2004).
//!
//! Everything is in one machine word of 64 bits, so hits and distances are rounded. Boxes are those of the report for
//! [`HanikaC`] and [`HanikaCd`], and these may lose a hit; [`HanikaCons`] has the same triangles behind boxes that do not.
//! Where a part of a listing is lost, what stands here is derived, and says so.
//!
//! | value | format, bound | sums and products, in `i64` |
//! | --- | --- | --- |
//! | vertices, planes of boxes | integers, 0 to 2^29 | |
//! | origins - vertices | integers, to 2^29 + 2^7 (see `ray`) | plane: 3 (2^29 + 2^7) 2^31 < 2^62 |
//! | directions | Q31, [-1, 1), of length 1 | |
//! | t | integers, 1 to 2^30 | t direction: 2^61 |
//! | hit - v0 | integers, to 3 2^29 + 2^7 + 1 | u, v: 2 (2^31 - 1) (3 2^29 + 2^7 + 1) < 2^63 |
//! | edges / N_r | Q(31 + E), (-2^31, 2^31) | u + v < 2^64, unsigned |
//! | reciprocals | Q(C), see `boxes` | 2^62 + 2^55 |

mod boxes;
mod ray;
mod resolve;
mod settings;
mod shading;
mod sphere;
#[cfg(test)]
mod testing;
mod triangle;
mod variant;

pub use boxes::{ConservativeSlab, Slab, TightSlab};
pub use ray::Ray;
pub use triangle::TriangleRecord;
pub use variant::{Conservative, PlainC, RefinedCd, Variant};

use core::cmp::Ordering;
use core::marker::PhantomData;

use fixed::FixedI32;

use crate::arithmetic::{Arithmetic, Knobs};
use crate::camera::Camera;
use crate::exact::{BoxNode, BoxNode29};
use crate::kernel::{Bounds, Kernel, NONE, Surface, Vertices};
use crate::num::Triple;
use crate::space::{GridQ31, Space};
use crate::sphere::{Ball, SphereRecord};
use crate::tile::NoBeam;

/// The report's kernel, in one of its variants.
#[derive(Clone, Copy, Debug, Default)]
pub struct Hanika<V>(PhantomData<V>);

/// Hanika's own box test: C = 12 bits taken from differences and given to reciprocals.
pub type HanikaC = Hanika<PlainC>;

/// The report's refinement: C = 15 and D = 9, with directions of at least 16 units.
pub type HanikaCd = Hanika<RefinedCd>;

/// The triangles of [`HanikaCd`] behind the conservative box test of [`Exact29`](crate::exact::Exact29).
pub type HanikaCons = Hanika<Conservative>;

/// Bits of a coordinate.
const GRID_BITS: u32 = 29;
/// No vertex is closer to the ends of the grid, so that boxes have room to be stored larger.
const MARGIN: i32 = 16;
/// Bits of a unit vector's fraction.
const UNIT_BITS: u32 = 31;

impl<V: Variant> Kernel for Hanika<V> {
    const ID: u16 = V::ID;
    const NAME: &'static str = V::NAME;
    const GRID_BITS: u32 = GRID_BITS;
    const MARGIN: i32 = MARGIN;
    const SPAN: i32 = (1 << GRID_BITS) - MARGIN;
    const DIRECTION_BITS: u32 = 31;
    const MATERIALS_MAX: u32 = triangle::MATERIALS_MAX;
    const RADIUS_MIN: i32 = sphere::RADIUS_MIN;

    type Settings = Arithmetic;
    const KNOBS: &'static str = V::KNOBS;

    type Space = GridQ31;
    type Word = i64;
    type Node = BoxNode29;
    type Triangle = TriangleRecord;
    type Vertex = Triple<i32>;
    type Sphere = SphereRecord<i32>;
    type Ray = Ray<V::Slab>;
    type Path = Ray<V::Slab>;
    type Distance = i32;
    type Depth = i32;
    type Span = i32;
    type Beam = NoBeam;

    fn settle(knobs: &Knobs, triangles: impl Iterator<Item = Vertices>) -> Option<Arithmetic> {
        settings::settle::<V>(knobs, triangles)
    }

    fn settings(arithmetic: &Arithmetic) -> Option<Arithmetic> {
        settings::checked::<V>(*arithmetic)
    }

    fn node(boxes: [Bounds; 2], children: [u32; 2]) -> BoxNode29 {
        BoxNode29::new(boxes.map(boxes::planes::<V::Slab>), children)
    }

    #[inline(always)]
    fn children(node: &BoxNode29) -> [u32; 2] {
        node.children()
    }

    fn boxes(node: &BoxNode29) -> [Bounds; 2] {
        node.planes().map(boxes::bounds::<V::Slab>)
    }

    fn triangle(settings: Arithmetic, vertices: &Vertices, material: u32) -> Option<TriangleRecord> {
        triangle::pack(settings.edge_shift, vertices, material)
    }

    fn vertices(triangle: &TriangleRecord) -> Vertices {
        triangle.vertices()
    }

    fn vertex(place: Triple<i32>) -> Triple<i32> {
        place
    }

    fn place(vertex: &Triple<i32>) -> Triple<i32> {
        *vertex
    }

    #[inline]
    fn material(triangle: &TriangleRecord) -> u32 {
        triangle.material()
    }

    fn sphere(ball: &Ball, material: u32) -> Option<SphereRecord<i32>> {
        if !ball.fits::<Self>() || material > triangle::MATERIALS_MAX {
            return None;
        }
        SphereRecord::new(ball, material)
    }

    fn ball(sphere: &SphereRecord<i32>) -> Ball {
        sphere.ball::<i64>()
    }

    #[inline]
    fn sphere_material(sphere: &SphereRecord<i32>) -> u32 {
        sphere.material::<i64>()
    }

    #[inline]
    fn primary(settings: Arithmetic, camera: &Camera<i64>, x: u16, y: u16) -> Option<Self::Ray> {
        Ray::new(settings, camera.eye(), camera.direction(x, y), NONE)
    }

    #[inline]
    fn ray(settings: Arithmetic, origin: Triple<i64>, direction: Triple<i64>, skip: u32) -> Option<Self::Ray> {
        Ray::new(settings, origin, direction, skip)
    }

    #[inline]
    fn segment(settings: Arithmetic, from: &Surface<GridQ31>, to: Triple<i32>, skip: u32) -> Option<Self::Ray> {
        Ray::segment(settings, ray::stand_off(settings, from), to.map(i64::from), skip)
    }

    #[inline]
    fn leaving(
        settings: Arithmetic,
        from: &Surface<GridQ31>,
        direction: <GridQ31 as Space>::Unit,
        skip: u32,
    ) -> Option<Self::Ray> {
        let unit = direction.map(|c| FixedI32::to_bits(c).into());
        Some(Ray::of_unit(settings, ray::stand_off(settings, from), unit, skip))
    }

    #[inline(always)]
    fn skip(ray: &Self::Ray) -> u32 {
        ray.skip
    }

    #[inline(always)]
    fn path(ray: &Self::Ray) -> Self::Path {
        *ray
    }

    #[inline(always)]
    fn octant(ray: &Self::Path) -> usize {
        crate::kernel::octant(ray.direction)
    }

    #[inline(always)]
    fn reach(ray: &Self::Ray, _: &Self::Path) -> i32 {
        ray.reach
    }

    #[inline(always)]
    fn enter<const OCTANT: usize>(ray: &Self::Path, node: &BoxNode29, child: usize, limit: i32) -> Option<i32> {
        ray.slab.enter::<OCTANT>(ray.origin, &node.planes()[child], limit)
    }

    #[inline(always)]
    fn intersect(ray: &Self::Ray, triangle: &TriangleRecord) -> Option<i32> {
        triangle::intersect(ray, triangle)
    }

    #[inline]
    fn intersect_sphere(ray: &Self::Ray, sphere: &SphereRecord<i32>, leaves: bool) -> Option<i32> {
        sphere::intersect(ray, sphere, leaves)
    }

    #[inline(always)]
    fn meet(ray: &Self::Ray, triangle: &TriangleRecord) -> Option<i32> {
        triangle::intersect(ray, triangle)
    }

    #[inline(always)]
    fn span(depth: &i32) -> i32 {
        *depth
    }

    #[inline(always)]
    fn limit(_: &Self::Path, depth: &i32) -> i32 {
        *depth
    }

    #[inline(always)]
    fn compare(a: &i32, b: &i32) -> Option<Ordering> {
        Some(a.cmp(b))
    }

    #[inline(always)]
    fn order(a: &i32, b: &i32) -> Ordering {
        a.cmp(b)
    }

    #[inline(always)]
    fn within(entry: i32, limit: i32) -> bool {
        entry <= limit + V::Slab::SLACK // both at most about 2^30
    }

    #[inline]
    fn heading(ray: &Self::Ray) -> <GridQ31 as Space>::Unit {
        // It has length 1 in Q31, and saturates there.
        ray.direction.map(|c| FixedI32::from_bits(c.clamp(i32::MIN.into(), i32::MAX.into()) as i32))
    }

    fn resolve(ray: &Self::Ray, triangle: &TriangleRecord) -> Surface<GridQ31> {
        resolve::resolve(ray, triangle)
    }

    fn resolve_sphere(ray: &Self::Ray, sphere: &SphereRecord<i32>) -> Surface<GridQ31> {
        sphere::resolve(ray, sphere)
    }
}
