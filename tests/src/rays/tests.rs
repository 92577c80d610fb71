use super::*;
use crate::meshes;

/// The bounds of a 29-bit and a 14-bit kernel, and the widest that the oracle takes.
const BOUNDS: [Bounds; 3] = [
    Bounds { grid_bits: 29, origin: [0, (1 << 29) - 1], direction: (1 << 31) - 1 },
    Bounds { grid_bits: 14, origin: [-(1 << 13), (1 << 14) + (1 << 13)], direction: (1 << 13) - 1 },
    Bounds { grid_bits: 30, origin: [-(1 << 30), 1 << 30], direction: 1 << 31 },
];

fn cross(a: [i64; 3], b: [i64; 3]) -> [i128; 3] {
    let [a, b] = [a, b].map(|v| v.map(i128::from));
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Whether the ray passes through a vertex exactly, or starts on one.
fn meets_vertex(ray: &Ray, mesh: &[Triangle]) -> bool {
    mesh.iter().flatten().any(|&v| cross(difference(v, ray.origin), ray.direction) == [0; 3])
}

/// Whether the line of the ray meets the line of an edge: the volume that they span is zero.
fn meets_edge(ray: &Ray, mesh: &[Triangle]) -> bool {
    mesh.iter().any(|&[a, b, c]| {
        [(a, b), (b, c), (c, a)].iter().any(|&(a, b)| {
            let side = cross(difference(a, ray.origin), difference(b, ray.origin));
            (0..3).map(|i| side[i] * i128::from(ray.direction[i])).sum::<i128>() == 0
        })
    })
}

/// Whether the ray lies in the plane of a triangle.
fn in_a_plane(ray: &Ray, mesh: &[Triangle]) -> bool {
    mesh.iter().any(|&[a, b, c]| {
        let normal = cross(difference(b, a), difference(c, a));
        [ray.direction, difference(ray.origin, a)]
            .iter()
            .all(|v| (0..3).map(|i| normal[i] * i128::from(v[i])).sum::<i128>() == 0)
    })
}

/// How many in a thousand rays of a kind on a soup have a property, for each of the bounds.
fn share(kind: Kind, property: fn(&Ray, &[Triangle]) -> bool) -> [usize; 3] {
    BOUNDS.map(|bounds| {
        let mesh = meshes::soup(bounds.grid_bits, 20, 9);
        let mut rays = Rays::new(&mesh, bounds, 10);
        (0..1000).filter(|_| property(&rays.ray(kind), &mesh)).count()
    })
}

#[test]
fn every_ray_is_within_the_bounds() {
    for bounds in BOUNDS {
        for (name, mesh) in meshes::all(bounds.grid_bits) {
            for (kind, ray) in Rays::new(&mesh, bounds, 1).take(5000) {
                let [low, high] = bounds.origin;
                let inside = ray.origin.iter().all(|c| (low..=high).contains(c));
                let short = ray.direction.iter().all(|c| c.abs() <= bounds.direction);
                assert!(inside && short && ray.direction != [0; 3], "{name} {kind:?} {ray:?}");
            }
        }
    }
}

#[test]
fn aimed_rays_meet_their_aim_exactly() {
    assert_eq!(share(Kind::ThroughVertex, meets_vertex), [1000; 3]);
    assert_eq!(share(Kind::Corner, meets_vertex), [1000; 3]);
    assert_eq!(share(Kind::AlongEdge, meets_edge), [1000; 3]);
    // Wide directions only: 13 bits do not hold most edges of a 14-bit grid.
    let [wide, _, widest] = share(Kind::InPlane, in_a_plane);
    assert_eq!([wide, widest], [1000; 2]);
}

#[test]
fn other_rays_do_not_meet_it_by_chance() {
    for property in [meets_vertex, meets_edge, in_a_plane] {
        for kind in [Kind::Random, Kind::Grazing] {
            let found = share(kind, property);
            assert!(found.iter().all(|&n| n < 100), "{kind:?} {found:?}");
        }
    }
    // Half of the edge points are no grid points: they are not all met at a vertex.
    assert!(share(Kind::AlongEdge, meets_vertex).iter().all(|&n| n < 990));
}

#[test]
fn segments_end_on_a_surface_and_only_surface_rays_skip() {
    let bounds = BOUNDS[0];
    let mesh = meshes::cuboid([3; 3], [1 << 28; 3]);
    let on_box = |p: [i64; 3]| p.iter().any(|c| [3, 1 << 28].contains(c));
    for (kind, ray) in Rays::new(&mesh, bounds, 2).take(10_000) {
        let end = [0, 1, 2].map(|i| ray.origin[i] + ray.direction[i]);
        let segment = kind == Kind::Segment;
        assert_eq!(ray.limit, segment.then_some(0));
        assert!(!segment || on_box(ray.origin) && on_box(end), "{ray:?}");
        assert!(ray.skip.is_none() || segment || kind == Kind::FromSurface, "{kind:?}");
    }
}

#[test]
fn the_rays_are_the_same_on_every_machine() {
    let mesh = meshes::sphere(14, 4);
    let sum = Rays::new(&mesh, BOUNDS[1], 7).take(10_000).fold(0u64, |sum, (_, ray)| {
        let parts = ray.origin.into_iter().chain(ray.direction).chain(ray.skip.map(i64::from));
        parts.fold(sum, |sum, part| sum.wrapping_mul(0x0100_0000_01b3) ^ part as u64)
    });
    assert_eq!(sum, 14_944_510_230_401_905_773);
}
