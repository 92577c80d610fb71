//! Trees of rays: how deep they go, and what falls on the way.

use glam::DVec3;
use host_tools::model::{LightKind, Material, MaterialKind, Model, Sphere};
use host_tools::reference::Reference;

use crate::{BACKGROUND, cuboid, model, quad};

/// Two mirrors of reflectance 1/2 that face each other at z = 1 and z = -1 and glow with `glow`.
fn facing(glow: f64, max_depth: u32) -> Model {
    let square = |z: f64| {
        let at = |x: f64, y: f64| DVec3::new(x, y, z);
        quad(at(-9.0, -9.0), at(9.0, -9.0), at(9.0, 9.0), at(-9.0, 9.0))
    };
    let mut scene = model(&[square(1.0), square(-1.0)].concat(), &[]);
    scene.materials[0] = Material {
        kind: MaterialKind::Mirror,
        colour: DVec3::splat(0.5),
        emission: DVec3::splat(glow),
        ..Material::default()
    };
    scene.render.max_depth = max_depth;
    scene
}

#[test]
fn facing_mirrors_are_a_geometric_series_that_ends_at_the_depth() {
    for depth in [0, 1, 2, 10] {
        // 1 + 1/2 + ... + 1/2^depth of the glow, and the background beyond.
        let rest = libm::ldexp(1.0, -1 - depth as i32);
        let expected = DVec3::splat(2.0 * (1.0 - rest)) + rest * BACKGROUND;
        let scene = facing(1.0, depth);
        let sample = Reference::new(&scene).sample(DVec3::new(0.1, 0.2, 0.3), DVec3::new(0.01, 0.02, 1.0));
        assert!((sample.colour - expected).abs().max_element() < 1e-15, "depth {depth}: {}", sample.colour);
    }
}

#[test]
fn what_cannot_be_seen_is_not_followed() {
    // Each bounce halves the share; the 20th is the last of 2^-20, and what it sees counts.
    let scene = facing(1.0, 64);
    let sample = Reference::new(&scene).sample(DVec3::ZERO, DVec3::Z);
    assert_eq!(sample.colour, DVec3::splat(2.0 - libm::ldexp(1.0, -20)));
}

#[test]
fn no_surface_mirrors_itself_or_its_neighbours_in_one_plane() {
    // The inside of a room of mirrors that glow: after n bounces every ray has seen n walls, whichever it meets.
    let mut room = model(&cuboid([0, 100_000, 0], [1_000_000; 3]), &[]);
    room.materials = facing(1.0, 10).materials;
    room.background = DVec3::splat(100.0).into();
    room.render.max_depth = 9;
    let tracer = Reference::new(&room);
    let centre = DVec3::new(0.01, 0.02, -0.03);
    let expected = 2.0 * (1.0 - libm::ldexp(1.0, -10)) + 100.0 * libm::ldexp(1.0, -10);
    for i in 0..2000 {
        let (a, b) = (f64::from(i) * 0.37, f64::from(i) * 0.11);
        let direction = DVec3::new(libm::sin(a), libm::sin(b), libm::cos(a));
        let colour = tracer.sample(centre, direction).colour;
        assert!((colour - expected).abs().max_element() < 1e-12, "{direction}: {colour}");
    }
}

#[test]
fn spheres_are_hit_from_both_sides_with_outward_normals_after_triangles() {
    let mut scene = model(&cuboid([0; 3], [100_000; 3]), &[]);
    let count = scene.triangles.len() as u32;
    scene.spheres = vec![
        Sphere { centre: DVec3::new(0.0, 0.0, 1.0), radius: 0.5, material: 0 },
        Sphere { centre: DVec3::new(0.0, 0.0, 1.0), radius: 0.5, material: 0 },
    ];
    let tracer = Reference::new(&scene);
    let outside = tracer.sample(DVec3::new(0.3, 0.0, 5.0), -DVec3::Z);
    let hit = outside.hit.unwrap();
    assert_eq!((hit.prim, hit.u, hit.v), (count, 0.0, 0.0), "the first of equal ones");
    assert!((hit.t - 3.6).abs() < 1e-14);
    assert!((outside.normal - DVec3::new(0.6, 0.0, 0.8)).length() < 1e-14);
    assert_eq!(outside.normal, outside.geometric_normal);
    let inside = tracer.sample(DVec3::new(0.3, 0.0, 1.0), DVec3::Z);
    assert!((inside.normal - DVec3::new(-0.6, 0.0, -0.8)).length() < 1e-14, "towards the viewer");
    assert_eq!(tracer.candidates(DVec3::new(0.3, 0.0, 5.0), -DVec3::Z, 1e-9).len(), 2);
}

/// A floor at z = 0 under a lamp at (0, 0, 4), and a ball of the second material between.
fn under_a_ball(material: Material) -> Model {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let floor = quad(at(-9.0, -9.0), at(9.0, -9.0), at(9.0, 9.0), at(-9.0, 9.0));
    let mut scene = model(&floor, &[LightKind::Point(DVec3::Z * 4.0)]);
    scene.materials.push(material);
    scene.spheres = vec![Sphere { centre: DVec3::Z * 2.0, radius: 1.0, material: 1 }];
    scene
}

#[test]
fn a_ball_casts_a_round_shadow_which_glass_may_tint() {
    let glass = Material {
        kind: MaterialKind::Dielectric,
        colour: DVec3::new(0.5, 1.0, 0.25),
        ior: 1.5,
        ..Material::default()
    };
    let tinted = Material { tinted_shadow: true, ..glass.clone() };
    let weighted = Material { weights: Some([0.0, 0.0, 0.25, 0.5]), ..tinted.clone() };
    // The cone of 30 degrees around the ball is 4 / sqrt 3 wide at the floor.
    let edge = 4.0 / 3f64.sqrt();
    for (material, tint) in [
        (Material::default(), DVec3::ZERO),
        (glass, DVec3::ZERO),
        (tinted, DVec3::new(0.25, 1.0, 0.0625)),
        (weighted, DVec3::new(0.0625, 0.25, 0.015625)),
    ] {
        let scene = under_a_ball(material);
        let tracer = Reference::new(&scene);
        for x in [0.0, 1.0, edge - 1e-6, edge + 1e-6, 5.0] {
            // Seen from just above the floor.
            let sample = tracer.sample(DVec3::new(x, 0.0, 0.5), -DVec3::Z);
            let light = 4.0 / libm::sqrt(16.0 + x * x);
            let expected = if x < edge { tint * light } else { DVec3::splat(light) };
            assert!((sample.colour - expected).abs().max_element() < 1e-12, "at {x}: {}", sample.colour);
            assert_eq!(sample.lights, u64::from(expected != DVec3::ZERO));
        }
    }
}

#[test]
fn a_ball_does_not_shade_its_lit_side_and_does_its_own_inside() {
    let scene = under_a_ball(Material::default());
    let tracer = Reference::new(&scene);
    let lights = |origin: DVec3, direction: DVec3| {
        let sample = tracer.sample(origin, direction);
        assert!(sample.hit.is_some_and(|hit| hit.prim == 2));
        sample.lights
    };
    for i in 0..1000 {
        let angle = f64::from(i) * 0.01;
        let round = DVec3::new(libm::cos(angle), libm::sin(angle), 0.0);
        // The lamp sees the ball down to sin = 1/2: what faces it there is lit, whatever the rounding.
        for height in [0.501, 0.7, 0.9999] {
            let normal = round * libm::sqrt(1.0 - height * height) + DVec3::Z * height;
            let point = DVec3::Z * 2.0 + normal;
            assert_eq!(lights(point + normal, -normal), 1, "{normal}");
            assert_eq!(lights(DVec3::Z * 2.0, -normal), 0, "the lamp is outside");
        }
    }
}

#[test]
fn samples_are_averaged_in_linear_light_after_clamping() {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    // The left half of the picture glows far over 1.
    let mut scene = model(&quad(at(-9.0, -9.0), at(0.0, -9.0), at(0.0, 9.0), at(-9.0, 9.0)), &[]);
    scene.materials[0].emission = DVec3::splat(64.0);
    scene.background = DVec3::ZERO.into();
    scene.render.samples = 4;
    let tracer = Reference::new(&scene);
    // An odd width has its middle column half and half.
    assert_eq!(tracer.pixel_colour([3, 3], 0, 1), DVec3::ONE);
    assert_eq!(tracer.pixel_colour([3, 3], 1, 1), DVec3::splat(0.5));
    assert_eq!(tracer.pixel_colour([3, 3], 2, 1), DVec3::ZERO);
    let (bytes, hits) = tracer.render([3, 3], &|_| ());
    assert_eq!((bytes[3], bytes[4], bytes[5]), ([255; 3], [188; 3], [0; 3]));
    assert_eq!(hits.len(), 9);
}
