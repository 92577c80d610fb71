//! The float kernel.

use core::cmp::Ordering;
use core::marker::PhantomData;

use core_rt::arithmetic::{Arithmetic, Knobs};
use core_rt::camera::Camera;
use core_rt::kernel::{Bounds, Kernel, NONE, Surface, Vertices};
use core_rt::num::{Triple, Word};
use core_rt::sphere::Ball;
use core_rt::tile::NoBeam;

use crate::boxes;
use crate::format::Format;
use crate::ray::{Path, Ray};
use crate::record::{NodeRecord, SphereRecord, TriangleRecord};
use crate::space::FloatSpace;
use crate::sphere;
use crate::triangle;
use crate::vector::{add, cross, dot, normalise, scale, sub};

/// The kernel of a float type.
#[derive(Clone, Copy, Debug, Default)]
pub struct Float<F>(PhantomData<F>);

/// As `exact29`'s, so that `f64` has its grid.
pub(crate) const MARGIN: i32 = 8;

impl<F: Format> Kernel for Float<F> {
    const ID: u16 = F::ID;
    const NAME: &'static str = F::NAME;
    const GRID_BITS: u32 = F::GRID_BITS;
    const MARGIN: i32 = MARGIN;
    /// So that eyes and lights are exact too, and so are their differences to vertices.
    const SPAN: i32 = (1 << F::GRID_BITS) - MARGIN;
    const DIRECTION_BITS: u32 = F::DIRECTION_BITS;
    const MATERIALS_MAX: u32 = triangle::MATERIALS_MAX;
    const RADIUS_MIN: i32 = F::RADIUS_MIN;

    type Settings = ();
    type Space = FloatSpace<F>;
    type Word = i64;
    type Node = F::Node;
    type Triangle = F::Triangle;
    type Vertex = Triple<i32>;
    type Sphere = F::Sphere;
    type Ray = Ray<F>;
    type Path = Path<F>;
    type Distance = F;
    type Depth = F;
    type Span = F;
    type Beam = NoBeam;

    fn settle(knobs: &Knobs, _triangles: impl Iterator<Item = Vertices>) -> Option<Arithmetic> {
        Arithmetic::fixed(knobs)
    }

    fn settings(arithmetic: &Arithmetic) -> Option<()> {
        arithmetic.none()
    }

    fn node(boxes: [Bounds; 2], children: [u32; 2]) -> F::Node {
        boxes::pack::<F>(boxes, children)
    }

    #[inline(always)]
    fn children(node: &F::Node) -> [u32; 2] {
        node.children()
    }

    fn boxes(node: &F::Node) -> [Bounds; 2] {
        boxes::unpack::<F>(node)
    }

    fn triangle((): (), vertices: &Vertices, material: u32) -> Option<F::Triangle> {
        triangle::pack::<F>(vertices, material)
    }

    fn vertices(triangle: &F::Triangle) -> Vertices {
        triangle::vertices::<F>(triangle)
    }

    fn vertex(place: Triple<i32>) -> Triple<i32> {
        place
    }

    fn place(vertex: &Triple<i32>) -> Triple<i32> {
        *vertex
    }

    #[inline]
    fn material(triangle: &F::Triangle) -> u32 {
        triangle.material()
    }

    fn sphere(ball: &Ball, material: u32) -> Option<F::Sphere> {
        if ball.fits::<Self>() { sphere::pack::<F>(ball, material) } else { None }
    }

    fn ball(sphere: &F::Sphere) -> Ball {
        sphere::ball::<F>(sphere)
    }

    #[inline]
    fn sphere_material(sphere: &F::Sphere) -> u32 {
        sphere.material()
    }

    #[inline]
    fn primary((): (), camera: &Camera<i64>, x: u16, y: u16) -> Option<Ray<F>> {
        // The header has the eye in 32 bits, and a direction has at most 31.
        let [origin, direction] = [camera.eye(), camera.direction(x, y)].map(|v| v.map(|c| F::from_i32(c.low_i32())));
        Ray::new(origin, direction, F::INFINITY, NONE)
    }

    #[inline]
    fn ray((): (), origin: Triple<i64>, direction: Triple<i64>, skip: u32) -> Option<Ray<F>> {
        Ray::new(origin.map(F::from_i64), direction.map(F::from_i64), F::INFINITY, skip)
    }

    #[inline]
    fn segment((): (), from: &Surface<FloatSpace<F>>, to: Triple<i32>, skip: u32) -> Option<Ray<F>> {
        let origin = stand_off(from);
        Ray::new(origin, sub(to.map(F::from_i32), origin), F::SEGMENT_END, skip)
    }

    #[inline]
    fn leaving((): (), from: &Surface<FloatSpace<F>>, direction: Triple<F>, skip: u32) -> Option<Ray<F>> {
        Ray::new(stand_off(from), direction, F::INFINITY, skip)
    }

    #[inline(always)]
    fn skip(ray: &Ray<F>) -> u32 {
        ray.skip
    }

    #[inline(always)]
    fn path(ray: &Ray<F>) -> Path<F> {
        ray.path()
    }

    #[inline(always)]
    fn octant(path: &Path<F>) -> usize {
        let [x, y, z] = path.negative.map(usize::from);
        z << 2 | y << 1 | x
    }

    #[inline(always)]
    fn reach(ray: &Ray<F>, _: &Path<F>) -> F {
        boxes::limit(ray.reach)
    }

    #[inline(always)]
    fn enter<const OCTANT: usize>(path: &Path<F>, node: &F::Node, child: usize, limit: F) -> Option<F> {
        boxes::enter::<_, OCTANT>(path, node, child, limit)
    }

    #[inline(always)]
    fn intersect(ray: &Ray<F>, triangle: &F::Triangle) -> Option<F> {
        triangle::intersect(ray, triangle)
    }

    #[inline]
    fn intersect_sphere(ray: &Ray<F>, sphere: &F::Sphere, leaves: bool) -> Option<F> {
        sphere::intersect::<F>(ray, sphere, leaves)
    }

    #[inline(always)]
    fn meet(ray: &Ray<F>, triangle: &F::Triangle) -> Option<F> {
        triangle::intersect(ray, triangle)
    }

    #[inline(always)]
    fn span(depth: &F) -> F {
        *depth
    }

    #[inline(always)]
    fn compare(a: &F, b: &F) -> Option<Ordering> {
        Some(a.order(*b))
    }

    #[inline(always)]
    fn limit(_: &Path<F>, depth: &F) -> F {
        boxes::limit(*depth)
    }

    #[inline(always)]
    fn order(a: &F, b: &F) -> Ordering {
        a.order(*b)
    }

    #[inline(always)]
    fn within(entry: F, limit: F) -> bool {
        entry <= limit
    }

    #[inline]
    fn heading(ray: &Ray<F>) -> Triple<F> {
        normalise(ray.direction).unwrap_or([F::ZERO, F::ZERO, F::ONE])
    }

    fn resolve(ray: &Ray<F>, triangle: &F::Triangle) -> Surface<FloatSpace<F>> {
        let [v0, e1, e2] = *triangle.rows();
        // The traversal found the hit by the same operations, so it is there.
        let hit = triangle::hit(ray, triangle).unwrap_or_default();
        let (normal, front) = match normalise(cross(e1, e2)) {
            Some(normal) if dot(normal, ray.direction) > F::ZERO => (normal.map(|c| -c), false),
            Some(normal) => (normal, true),
            // Of a sliver whose area is lost by rounding nothing is known but that it is seen.
            None => (Self::heading(ray).map(|c| -c), true),
        };
        Surface { point: add(v0, add(scale(e1, hit.u), scale(e2, hit.v))), normal, front, u: hit.u, v: hit.v }
    }

    fn resolve_sphere(ray: &Ray<F>, sphere: &F::Sphere) -> Surface<FloatSpace<F>> {
        sphere::resolve::<F>(ray, sphere)
    }
}

/// Where rays leave a surface.
#[inline]
fn stand_off<F: Format>(surface: &Surface<FloatSpace<F>>) -> Triple<F> {
    add(surface.point, scale(surface.normal, F::STAND_OFF))
}
