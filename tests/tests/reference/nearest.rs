//! Which triangle a ray hits, and where.

use glam::DVec3;
use host_tools::reference::{Hit, Reference};
use tests::random::SplitMix64;

use crate::{Corners, aim, cuboid, model, sphere, vector};

/// Möller and Trumbore 1997: t, u, v of the plane's crossing, wherever in the plane it is.
fn moller_trumbore([v0, v1, v2]: Corners, origin: DVec3, direction: DVec3) -> Option<[f64; 3]> {
    let (e1, e2) = (v1 - v0, v2 - v0);
    let p = direction.cross(e2);
    let det = e1.dot(p);
    let s = origin - v0;
    let q = s.cross(e1);
    let well_conditioned = det.abs() > 1e-4 * e1.cross(e2).length() * direction.length();
    well_conditioned.then(|| [e2.dot(q) / det, s.dot(p) / det, direction.dot(q) / det])
}

/// Rays whose nearest hit contradicts the loop over `corners`, and the number of hits.
///
/// What lies within 1e-9 of an edge or of another hit, or is seen edge-on, may go either way.
fn contradictions(tracer: &Reference, corners: &[Corners], rays: &[(DVec3, DVec3)]) -> (usize, usize) {
    const E: f64 = 1e-9;
    let contradicts = |hit: Option<Hit>, origin, direction| {
        let crossing = |prim: u32| moller_trumbore(corners[prim as usize], origin, direction);
        let missed_or_hidden = (0..corners.len() as u32).any(|prim| {
            crossing(prim).is_some_and(|[t, u, v]| {
                let certain = u > E && v > E && u + v < 1.0 - E && t > E;
                certain && hit.is_none_or(|hit| t < hit.t * (1.0 - E))
            })
        });
        let wrong = hit.is_some_and(|hit| {
            crossing(hit.prim)
                .is_some_and(|[t, u, v]| (t - hit.t).abs() > E * t || (u - hit.u).abs() > E || (v - hit.v).abs() > E)
        });
        missed_or_hidden || wrong
    };
    let (mut bad, mut hits) = (0, 0);
    for &(origin, direction) in rays {
        let hit = tracer.nearest(origin, direction);
        hits += usize::from(hit.is_some());
        bad += usize::from(contradicts(hit, origin, direction));
    }
    (bad, hits)
}

#[test]
fn nearest_hits_agree_with_a_loop_of_moller_trumbore() {
    let mut random = SplitMix64(1);
    let mut corners: Vec<Corners> = (0..300)
        .map(|_| {
            let centre = vector(&mut random);
            [(); 3].map(|()| centre + vector(&mut random) * 0.2)
        })
        .collect();
    corners.extend(cuboid([300_000; 3], [700_000; 3]));
    corners.push([DVec3::ONE; 3]);
    corners.push([DVec3::ZERO, DVec3::ONE, DVec3::splat(2.0)]);
    let rays: Vec<_> = (0..4000)
        .map(|i| {
            let (origin, direction) = (vector(&mut random) * 2.0, vector(&mut random));
            if i % 4 == 0 { (origin, DVec3::AXES[i / 4 % 3]) } else { (origin, (direction - origin) * 1e-3) }
        })
        .collect();
    let whole = model(&corners, &[]);
    let (bad, hits) = contradictions(&Reference::new(&whole), &corners, &rays);
    assert_eq!(bad, 0);
    assert!(hits > 1000, "only {hits} hits to compare");

    let mut moved = whole.clone();
    moved.positions[7] += DVec3::splat(1e-3);
    let (bad, _) = contradictions(&Reference::new(&moved), &corners, &rays);
    assert!(bad > 0, "the comparison must see a vertex that moved");
}

/// How many of 100,000 rays from within the closed surface, two thirds of them at vertices and edges,
/// leave it; `lost` is a triangle to leave out.
fn holes(corners: &[Corners], lost: Option<usize>) -> usize {
    let mut kept = corners.to_vec();
    if let Some(lost) = lost {
        kept.remove(lost);
    }
    let closed = model(&kept, &[]);
    let tracer = Reference::new(&closed);
    let mut random = SplitMix64(2);
    let escapes = |&i: &usize| {
        let origin = vector(&mut random) * 0.5;
        let direction = aim(&mut random, corners, i, origin);
        tracer.nearest(origin, direction).is_none()
    };
    (0..100_000).filter(escapes).count()
}

#[test]
fn a_closed_mesh_has_no_hole() {
    let corners = sphere(23);
    assert_eq!(holes(&corners, None), 0);
    assert!(holes(&corners, Some(1000)) > 0, "a missing triangle is a hole");
}

#[test]
fn the_lower_of_equal_triangles_wins_and_the_tie_shows() {
    let large = [DVec3::new(-3.0, -3.0, 0.0), DVec3::new(3.0, -3.0, 0.0), DVec3::new(0.0, 4.0, 0.0)];
    let behind = large.map(|corner| corner - DVec3::Z * 1e-3);
    let scene = model(&[behind, large, large], &[]);
    let tracer = Reference::new(&scene);
    let (origin, direction) = tracer.camera_ray([8, 8], 4.2, 3.9);
    let prims = |tolerance| -> Vec<u32> {
        let hits = tracer.candidates(origin, direction, tolerance);
        assert_eq!(Some(hits[0]), tracer.nearest(origin, direction));
        hits.iter().map(|hit| hit.prim).collect()
    };
    assert_eq!(prims(1e-12), [1, 2]);
    assert_eq!(prims(1e-3), [1, 2, 0]);
    assert!(tracer.candidates(origin, -direction, 1.0).is_empty());
}
