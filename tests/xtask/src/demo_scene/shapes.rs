//! The shapes of the built-in scene, in scene units, y up, the open front towards +z.

use super::Part;
use glam::DVec3;
use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, TAU};

/// Half the box's width, its height, and half its depth.
const ROOM: DVec3 = DVec3::new(1.35, 2.0, 1.1);

/// Where plinth and knot stand on the floor, and the plinth's top.
const KNOT_PLACE: DVec3 = DVec3::new(-0.28, 0.0, -0.2);
const PLINTH_HEIGHT: f64 = 0.22;

/// The five walls and the lamp, all facing inwards.
pub(super) fn room() -> Vec<Part> {
    // A side of the box of that half width, height and half depth; the bits of a corner's number say
    // whether it is right, up and in front.
    let quad = |name, material, size: DVec3, z: f64, corners: [u8; 4]| Part {
        name,
        material,
        positions: corners
            .map(|corner| {
                let side = |bit: u8| f64::from(corner >> bit & 1);
                let unit = DVec3::new(2.0 * side(0) - 1.0, side(1), 2.0 * side(2) - 1.0);
                size * unit + z * DVec3::Z
            })
            .to_vec(),
        normals: Vec::new(),
        faces: vec![vec![0, 1, 2, 3]],
    };
    // Under the ceiling by a little, not in it: surfaces in one plane would tie for the nearest hit.
    let lamp = DVec3::new(0.36, ROOM.y - 0.004, 0.26);
    vec![
        quad("floor", "white", ROOM, 0.0, [4, 5, 1, 0]),
        quad("ceiling", "white", ROOM, 0.0, [2, 3, 7, 6]),
        quad("back", "white", ROOM, 0.0, [0, 1, 3, 2]),
        quad("left", "red", ROOM, 0.0, [4, 0, 2, 6]),
        quad("right", "green", ROOM, 0.0, [1, 5, 7, 3]),
        quad("lamp", "lamp", lamp, 0.45, [2, 3, 7, 6]),
    ]
}

/// An octagonal prism on the floor, without the underside that nothing sees; its top is one octagon.
pub(super) fn plinth() -> Part {
    const SIDES: usize = 8;
    const RADIUS: f64 = 0.6;
    let ring = |y: f64| {
        (0..SIDES).map(move |i| {
            let (sin, cos) = libm::sincos((i as f64 + 0.5) * TAU / SIDES as f64);
            DVec3::new(RADIUS * sin, y, RADIUS * cos) + KNOT_PLACE
        })
    };
    let mut faces: Vec<_> = (0..SIDES)
        .map(|i| {
            let next = (i + 1) % SIDES;
            vec![i, next, SIDES + next, SIDES + i]
        })
        .collect();
    faces.push((SIDES..2 * SIDES).collect());
    Part {
        name: "plinth",
        material: "stone",
        positions: ring(0.0).chain(ring(PLINTH_HEIGHT)).collect(),
        normals: Vec::new(),
        faces,
    }
}

/// A tube along the trefoil, the (2, 3) torus knot, upright on the plinth on two of its lobes.
pub(super) fn knot() -> Part {
    const ALONG: usize = 52;
    const AROUND: usize = 14;
    const MAJOR: f64 = 0.42;
    const MINOR: f64 = 0.2;
    const TUBE: f64 = 0.108;
    let (turn_sin, turn_cos) = libm::sincos(0.55);
    // The knot is made around the z axis; it is turned about the vertical to show its depth.
    let turned = |v: DVec3| DVec3::new(turn_cos * v.x + turn_sin * v.z, v.y, turn_cos * v.z - turn_sin * v.x);

    let (mut positions, mut normals) = (Vec::new(), Vec::new());
    for step in 0..ALONG {
        let t = TAU * step as f64 / ALONG as f64;
        let (sin2, cos2) = libm::sincos(2.0 * t + FRAC_PI_2);
        let (sin3, cos3) = libm::sincos(3.0 * t);
        let reach = MAJOR + MINOR * cos3;
        let centre = DVec3::new(reach * cos2, reach * sin2, MINOR * sin3);
        let tangent = DVec3::new(
            -3.0 * MINOR * sin3 * cos2 - 2.0 * reach * sin2,
            -3.0 * MINOR * sin3 * sin2 + 2.0 * reach * cos2,
            3.0 * MINOR * cos3,
        )
        .normalize();
        // The torus's own normal is perpendicular to a curve on the torus, and closes with it. It twists about
        // the curve, though; three whole turns back (see `3.0 * t` below) nearly undo that.
        let outward = DVec3::new(cos3 * cos2, cos3 * sin2, sin3);
        let side = outward.cross(tangent);
        for step in 0..AROUND {
            let (sin, cos) = libm::sincos(TAU * step as f64 / AROUND as f64 - 3.0 * t);
            let normal = cos * outward + sin * side;
            positions.push(turned(centre + TUBE * normal));
            normals.push(turned(normal));
        }
    }
    stand(&mut positions, KNOT_PLACE + PLINTH_HEIGHT * DVec3::Y);

    let mut faces = Vec::new();
    for (i, j) in (0..ALONG).flat_map(|i| (0..AROUND).map(move |j| (i, j))) {
        let at = |i: usize, j: usize| (i % ALONG) * AROUND + j % AROUND;
        let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        faces.extend([vec![a, b, c], vec![a, c, d]]);
    }
    Part { name: "knot", material: "knot", positions, normals, faces }
}

/// An icosahedron with each face divided in four, on the floor on one of its 80 flat faces.
pub(super) fn gem() -> Part {
    let golden = 0.5 * (1.0 + 5f64.sqrt());
    let mut positions: Vec<DVec3> = [(1, 2), (2, 0), (0, 1)]
        .into_iter()
        .flat_map(|axes| [(-1., -1.), (1., -1.), (-1., 1.), (1., 1.)].map(|signs| (axes, signs)))
        .map(|((short, long), (p, q))| {
            let mut v = DVec3::ZERO;
            (v[short], v[long]) = (p, q * golden);
            v.normalize()
        })
        .collect();
    // The faces are the triples of mutual neighbours: the edge is 2, against a radius of |(0, 1, golden)|.
    let near = |a: DVec3, b: DVec3| a.dot(b) > 0.4;
    let mut coarse = Vec::new();
    for (a, b, c) in (0..12).flat_map(|a| (a + 1..12).flat_map(move |b| (b + 1..12).map(move |c| (a, b, c)))) {
        let [p, q, r] = [a, b, c].map(|i| positions[i]);
        if near(p, q) && near(q, r) && near(r, p) {
            let outward = (q - p).cross(r - p).dot(p) > 0.0;
            coarse.push(if outward { [a, b, c] } else { [a, c, b] });
        }
    }
    // The middle of a divided face is square to the old face's direction; that of the first goes down.
    let down = coarse[0].iter().map(|&i| positions[i]).sum::<DVec3>().normalize();

    let mut middles = HashMap::new();
    let mut faces = Vec::new();
    for [a, b, c] in coarse {
        let [ab, bc, ca] = [(a, b), (b, c), (c, a)].map(|(a, b)| {
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                positions.push((positions[a] + positions[b]).normalize());
                positions.len() - 1
            })
        });
        faces.extend([vec![a, ab, ca], vec![ab, b, bc], vec![ca, bc, c], vec![ab, bc, ca]]);
    }

    const RADIUS: f64 = 0.27;
    let side = down.cross(DVec3::Z).normalize();
    let (sin, cos) = libm::sincos(0.5);
    for position in &mut positions {
        let v = RADIUS * DVec3::new(position.dot(side), -position.dot(down), position.dot(down.cross(side)));
        *position = DVec3::new(cos * v.x + sin * v.z, v.y, cos * v.z - sin * v.x);
    }
    stand(&mut positions, DVec3::new(0.72, 0.0, 0.34));
    Part { name: "gem", material: "gem", positions, normals: Vec::new(), faces }
}

/// Moves `positions`, made around the origin, to `place`, the lowest of them to its height.
fn stand(positions: &mut [DVec3], place: DVec3) {
    let lowest = positions.iter().fold(f64::INFINITY, |lowest, position| lowest.min(position.y));
    positions.iter_mut().for_each(|position| *position += place - lowest * DVec3::Y);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solids_are_closed_and_face_outwards() {
        for part in [knot(), gem()] {
            assert!(part.is_closed(), "{}", part.name);
            assert!(part.volume() > 0.0, "{}", part.name);
        }
        let mut open = gem();
        open.faces.pop();
        assert!(!open.is_closed());
        let mut inside_out = knot();
        inside_out.faces.iter_mut().for_each(|face| face.reverse());
        assert!(inside_out.is_closed() && inside_out.volume() < 0.0);
    }

    #[test]
    fn smooth_normals_are_unit_and_near_their_faces() {
        let knot = knot();
        assert_eq!(knot.normals.len(), knot.positions.len());
        assert!(knot.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-12));
        for [a, b, c] in knot.triangles() {
            let p = |i: usize| knot.positions[i];
            let face = (p(b) - p(a)).cross(p(c) - p(a)).normalize();
            assert!([a, b, c].iter().all(|&i| knot.normals[i].dot(face) > 0.95));
        }
    }

    #[test]
    fn the_room_faces_inwards_and_holds_everything() {
        let middle = DVec3::new(0.0, 1.0, 0.0);
        for wall in room() {
            for [a, b, c] in wall.triangles().map(|face| face.map(|i| wall.positions[i])) {
                assert!((b - a).cross(c - a).dot(middle - a) > 0.0, "{}", wall.name);
            }
        }
        let inside = |v: &DVec3| v.x.abs() <= ROOM.x && v.z.abs() <= ROOM.z && (-1e-9..=ROOM.y).contains(&v.y);
        let parts = room().into_iter().chain([plinth(), knot(), gem()]);
        assert!(parts.flat_map(|part| part.positions).all(|position| inside(&position)));
    }

    #[test]
    fn counts_are_as_meant() {
        let count = |part: &Part| part.triangles().count();
        let walls: usize = room().iter().map(count).sum();
        assert_eq!([walls, count(&plinth()), count(&knot()), count(&gem())], [12, 22, 1456, 80]);
    }
}
