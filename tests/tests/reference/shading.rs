//! How bright a point is, and which lights reach it.

use glam::DVec3;
use host_tools::model::{LightKind, Model};
use host_tools::reference::Reference;
use tests::random::SplitMix64;

use crate::{Corners, aim, cuboid, model, quad, sphere, vector};

#[test]
fn a_lit_plane_has_the_cosine_of_its_light() {
    let far = 1e3;
    let [a, b] = [DVec3::new(far, far, 0.0), DVec3::new(-far, far, 0.0)];
    let light = DVec3::new(1.0, -2.0, 3.0);
    let travel = DVec3::new(-2e-9, 1e-9, -3e-9);
    let lights = [LightKind::Point(light), LightKind::Directional(travel)];
    let mut plane = model(&quad(a, b, -a, -b), &lights);
    plane.lights[0].radiance = DVec3::new(1.0, 0.5, 8.0);
    plane.render.ambient = DVec3::new(0.01, 0.02, 0.03);
    plane.materials[0].colour = DVec3::new(0.5, 0.25, 0.125);
    plane.materials[0].emission = DVec3::new(0.0, 2.0, 0.0);
    let tracer = Reference::new(&plane);
    for x in 0..64 {
        for y in 0..48 {
            let sample = tracer.pixel([64, 48], x, y);
            // Half the height is 5 at the plane, by tan 45 degrees at a distance of 5.
            let point = DVec3::new(f64::from(x) - 31.5, 23.5 - f64::from(y), 0.0) * (5.0 / 24.0);
            let point_cosine = 3.0 / (light - point).length();
            let sun_cosine = 3.0 / 14.0_f64.sqrt();
            let irradiance = plane.render.ambient + plane.lights[0].radiance * point_cosine + DVec3::splat(sun_cosine);
            let expected = plane.materials[0].emission + plane.materials[0].colour * irradiance;
            assert!((sample.colour - expected).abs().max_element() < 1e-12);
            assert_eq!((sample.lights, sample.normal), (0b11, DVec3::Z));
        }
    }
}

#[test]
fn a_known_occluder_casts_a_known_shadow() {
    let floor = quad(
        DVec3::new(-9.0, -9.0, 0.0),
        DVec3::new(9.0, -9.0, 0.0),
        DVec3::new(9.0, 9.0, 0.0),
        DVec3::new(-9.0, 9.0, 0.0),
    );
    // A square of half-width 1, out of sight between the lamps, and another behind each of them.
    let square = |x: f64, z: f64| {
        let at = |dx, dy| DVec3::new(x + dx, dy, z);
        quad(at(-1.0, -1.0), at(1.0, -1.0), at(1.0, 1.0), at(-1.0, 1.0))
    };
    let lamp = DVec3::new(0.0, 0.0, 4.0);
    let lights = [LightKind::Point(lamp), LightKind::Directional(DVec3::new(1.0, 0.0, -1.0))];
    let corners = [floor, square(0.0, 2.0), square(0.0, 4.5)].concat();
    let scene = model(&corners, &lights);
    let tracer = Reference::new(&scene);
    let mut random = SplitMix64(3);
    let mut seen = [0; 4];
    for _ in 0..10_000 {
        let point = vector(&mut random) * DVec3::new(8.0, 8.0, 0.0);
        let sample = tracer.sample(point + DVec3::Z, -DVec3::Z);
        let within = |x: f64, y: f64, half: f64| x.abs() < half && y.abs() < half;
        // The lamp enlarges the square at half its height twofold, and does not see the one above
        // itself; the sun moves each by its height.
        let from_lamp = !within(point.x, point.y, 2.0);
        let from_sun = !within(point.x - 2.0, point.y, 1.0) && !within(point.x - 4.5, point.y, 1.0);
        let expected = u64::from(from_lamp) | u64::from(from_sun) << 1;
        assert_eq!(sample.lights, expected, "at {point}");
        seen[expected as usize] += 1;
    }
    assert!(seen.iter().all(|&count| count > 10), "{seen:?}");
}

/// Dark points of a convex body, or of what else `corners` has, lit by `lamp` and seen from `eye` inside;
/// two thirds of the rays go to vertices and edges.
fn dark(corners: &[Corners], eye: DVec3, lamp: DVec3, shift: DVec3) -> usize {
    let shifted: Vec<_> = corners.iter().map(|triangle| triangle.map(|corner| corner + shift)).collect();
    let body = model(&shifted, &[LightKind::Point(lamp + shift)]);
    let tracer = Reference::new(&body);
    let mut random = SplitMix64(4);
    let is_dark = |&i: &usize| {
        let direction = aim(&mut random, corners, i, eye);
        let sample = tracer.sample(eye + shift, direction);
        sample.hit.is_some() && sample.lights == 0
    };
    (0..9_999).filter(is_dark).count()
}

#[test]
fn no_wall_shadows_its_neighbours() {
    let (eye, lamp) = (DVec3::new(-0.6, -0.15, 0.1), DVec3::new(-0.7, -0.15, 0.2));
    let room = cuboid([0, 100_000, 0], [1_000_000; 3]);
    // Walls that meet at 13 degrees.
    let [a, b] = [-1.0, 1.0].map(|z| DVec3::new(-1.0, -0.3, z));
    let [c, d] = [DVec3::new(0.6, -0.3, 0.1), DVec3::new(-1.0, 0.07, 0.1)];
    let wedge = vec![[a, b, c], [a, c, d], [c, b, d], [a, b, d]];
    // A panel with the lamp in the middle of its plane, which the eye sees edge-on.
    let panel = |drop: f64| {
        let corner = |x, z| lamp + DVec3::new(x, -drop, z);
        vec![[corner(-0.1, -0.1), corner(0.1, -0.1), corner(0.0, 0.1)]]
    };
    let panelled = [room.clone(), panel(0.0)].concat();
    let darkened = [room.clone(), panel(1e-3)].concat();
    for shift in [DVec3::ZERO, DVec3::new(1e6, -1e6, 3e5)] {
        for (i, body) in [&room, &wedge, &sphere(12), &panelled].into_iter().enumerate() {
            assert_eq!(dark(body, eye, lamp, shift), 0, "body {i} at {shift}");
        }
        assert!(dark(&darkened, eye, lamp, shift) > 1000, "below the lamp it is dark");
    }
}

#[test]
fn smooth_normals_are_interpolated_and_face_the_viewer() {
    let corners = [DVec3::new(-3.0, -3.0, 0.0), DVec3::new(3.0, -3.0, 0.0), DVec3::new(0.0, 3.0, 0.0)];
    let mut scene = model(&[corners], &[LightKind::Point(DVec3::new(0.0, 0.0, 5.0))]);
    let tilted = DVec3::new(0.6, 0.0, 0.8);
    scene.triangles[0].normals = Some([0, 1, 2]);
    let seen = |scene: &mut Model, normals: [DVec3; 3], z: f64| {
        scene.normals = normals.to_vec();
        let sample = Reference::new(scene).sample(DVec3::new(0.0, 0.0, z), -DVec3::Z * z);
        let hit = sample.hit.expect("the middle of the triangle is hit");
        assert_eq!((hit.t, hit.u, hit.v), (1.0, 0.25, 0.5));
        (sample.geometric_normal, sample.normal, sample.lights)
    };
    let close = |a: DVec3, b: DVec3| assert!((a - b).length() < 1e-15, "{a} {b}");

    let (geometric, normal, lights) = seen(&mut scene, [DVec3::Z, DVec3::Z, tilted], 5.0);
    close(normal, (DVec3::Z + tilted).normalize());
    assert_eq!((geometric, lights), (DVec3::Z, 1));
    let (geometric, normal, lights) = seen(&mut scene, [DVec3::Z, DVec3::Z, tilted], -5.0);
    close(normal, -(DVec3::Z + tilted).normalize());
    assert_eq!((geometric, lights), (-DVec3::Z, 0));
    let (geometric, normal, _) = seen(&mut scene, [tilted, tilted, -tilted], 5.0);
    assert_eq!((geometric, normal), (DVec3::Z, DVec3::Z), "normals that cancel");
}
