//! What each material shows, against answers worked out by hand.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use host_tools::model::{
    Background, Checker, Falloff, Filter, Light, LightKind, Lobe, Material, MaterialKind, Model, Specular, Sphere,
    Texture,
};
use host_tools::reference::Reference;

use crate::{BACKGROUND, model, quad};

/// A large square of `material` in the plane z = 0, its front up, lit by nothing.
fn plane(material: Material) -> Model {
    let [a, b] = [DVec3::new(1e3, 1e3, 0.0), DVec3::new(-1e3, 1e3, 0.0)];
    Model { materials: vec![material], ..model(&quad(a, b, -a, -b), &[]) }
}

/// What is seen of it from (x, 1, z) towards (0, 1, 0).
fn seen(model: &Model, x: f64, z: f64) -> DVec3 {
    Reference::new(model).sample(DVec3::new(x, 1.0, z), DVec3::new(-x, 0.0, -z)).colour
}

#[track_caller]
fn close(found: DVec3, expected: DVec3) {
    assert!((found - expected).abs().max_element() < 1e-12, "{found} is not {expected}");
}

/// Light from above that is reflected to a viewer at (-1, 0, 1): both at 45 degrees.
fn lit(model: Model) -> Model {
    Model { lights: vec![Light::new(LightKind::Directional(DVec3::new(-1.0, 0.0, -1.0)), DVec3::ONE)], ..model }
}

fn shine(lobe: Lobe, exponent: u32) -> Option<Specular> {
    Some(Specular { lobe, exponent, colour: DVec3::new(1.0, 0.5, 0.0) })
}

#[test]
fn a_mirror_shows_what_is_in_its_direction() {
    let tint = DVec3::new(0.5, 0.25, 1.0);
    let mirror = Material { kind: MaterialKind::Mirror, colour: tint, ..Material::default() };
    let mut scene = plane(mirror);
    close(seen(&scene, 1.0, 1.0), tint * BACKGROUND);
    // The direction (-1, 0, -1) becomes (-1, 0, 1): up is y here.
    scene.background = Background::Sky { bottom: DVec3::ZERO, top: DVec3::ONE };
    close(seen(&scene, 1.0, 1.0), tint * 0.5);
    let eye = DVec3::new(0.0, 3.0, 4.0);
    close(Reference::new(&scene).sample(eye, -eye).colour, tint * 0.2);
}

#[test]
fn a_sky_is_linear_from_the_nadir_to_the_zenith() {
    let mut scene = plane(Material::default());
    let [bottom, top] = [DVec3::new(1.0, 2.0, 3.0), DVec3::new(0.0, 4.0, 3.5)];
    scene.background = Background::Sky { bottom, top };
    let tracer = Reference::new(&scene);
    let at = |direction: DVec3| tracer.sample(DVec3::Z, direction).colour;
    close(at(DVec3::Y * 1e-200), top);
    close(at(-DVec3::Y * 1e200), bottom);
    close(at(DVec3::Z), (bottom + top) / 2.0);
    close(at(DVec3::new(0.0, 3.0, 4.0)), bottom + (top - bottom) * 0.8);
}

#[test]
fn lobes_are_powers_of_their_cosines() {
    for (lobe, x, cosine) in [
        // Seen along the mirrored light, and from the normal: the half vector is at 22.5 degrees then, the mirrored at 45.
        (Lobe::BlinnPhong, -1.0, 1.0),
        (Lobe::Phong, -1.0, 1.0),
        (Lobe::BlinnPhong, 0.0, libm::cos(std::f64::consts::FRAC_PI_8)),
        (Lobe::Phong, 0.0, std::f64::consts::FRAC_1_SQRT_2),
        (Lobe::Phong, 1.0, 0.0),
    ] {
        for exponent in [1, 7, 1000] {
            let material = Material { colour: DVec3::ZERO, specular: shine(lobe, exponent), ..Material::default() };
            let expected = libm::pow(cosine, exponent.into()) * DVec3::new(1.0, 0.5, 0.0);
            close(seen(&lit(plane(material)), x, 1.0), expected);
        }
    }
}

#[test]
fn weights_are_the_shares_of_each_kind_of_light() {
    let material = Material {
        colour: DVec3::new(0.5, 0.5, 1.0),
        specular: shine(Lobe::Phong, 3),
        weights: Some([0.25, 8.0, 0.5, 0.0]),
        emission: DVec3::Z,
        ..Material::default()
    };
    let mut scene = lit(plane(material));
    scene.render.ambient = DVec3::ONE;
    let colour = DVec3::new(1.0, 0.5, 0.0);
    let diffuse = 0.25 * DVec3::new(0.5, 0.5, 1.0) * (1.0 + std::f64::consts::FRAC_1_SQRT_2);
    close(seen(&scene, -1.0, 1.0), DVec3::Z + diffuse + 8.0 * colour + 0.5 * colour * BACKGROUND);
}

#[test]
fn a_metal_is_tinted_head_on_and_white_at_grazing_angles() {
    let gold = DVec3::new(0.75, 0.5, 0.25);
    let metal = Material { kind: MaterialKind::Metal, colour: gold, ..Material::default() };
    close(seen(&plane(metal.clone()), 0.0, 1.0), gold * BACKGROUND);
    let grazing = seen(&plane(metal.clone()), 1e9, 1.0);
    assert!((grazing - BACKGROUND).abs().max_element() < 1e-7);
    // cos 60 degrees: by Schlick 1/32 of the way to white.
    let way = gold + (DVec3::ONE - gold) / 32.0;
    close(seen(&plane(metal.clone()), 3f64.sqrt(), 1.0), way * BACKGROUND);
    let given = Material { weights: Some([0.0, 0.0, 1.0, 0.0]), ..metal };
    close(seen(&plane(given), 3f64.sqrt(), 1.0), gold * BACKGROUND);
}

/// Glass below z = 0 and a light grey floor, self-luminous, far below it.
fn glass(weights: Option<[f64; 4]>, ior: f64) -> Model {
    let material = Material { kind: MaterialKind::Dielectric, colour: DVec3::ONE, ior, weights, ..Material::default() };
    let [a, b] = [DVec3::new(1e3, 1e3, 0.0), DVec3::new(-1e3, 1e3, 0.0)];
    let down = DVec3::Z * 10.0;
    let mut scene = model(&[quad(a, b, -a, -b), quad(a - down, b - down, -a - down, -b - down)].concat(), &[]);
    let floor = Material {
        colour: DVec3::ZERO,
        checker: Some(Checker { size: 10.0, other: DVec3::ONE }),
        ..Material::default()
    };
    scene.materials = vec![material, floor];
    scene.triangles[2].material = 1;
    scene.triangles[3].material = 1;
    scene.render.ambient = DVec3::ONE;
    scene
}

#[test]
fn glass_reflects_by_schlick_and_bends_by_snell() {
    let scene = glass(None, 1.5);
    // Head on 4 % is reflected; the floor is in the layer -1 of cubes, so that around x = 0.1 it is odd.
    let share = 0.04;
    close(
        Reference::new(&scene).sample(DVec3::new(0.1, 1.0, 1.0), -DVec3::Z).colour,
        share * BACKGROUND + (1.0 - share) * DVec3::ONE,
    );
    // From 60 degrees: sin 60 / 1.5 = 1 / sqrt 3, whose tangent is 1 / sqrt 2: the floor at x = -7.07, an even cube.
    let share = 0.04 + 0.96 / 32.0;
    close(seen(&scene, 3f64.sqrt(), 1.0), share * BACKGROUND);
    // Straight on it would be x = -17.3, two cubes farther, and odd like the first.
    close(seen(&glass(Some([0.0, 0.0, 0.1, 0.9]), 1.0), 3f64.sqrt(), 1.0), 0.1 * BACKGROUND + 0.9 * DVec3::ONE);
}

#[test]
fn from_within_glass_all_is_reflected_beyond_the_critical_angle() {
    // The eye is between floor and glass: it sees the sky through the surface, or the floor in it.
    let critical = libm::tan(libm::asin(1.0 / 1.5));
    for weights in [None, Some([0.0, 0.0, 0.25, 0.75])] {
        let scene = glass(weights, 1.5);
        let floor = |x: f64| if (x / 10.0).floor().rem_euclid(2.0) == 0.0 { DVec3::ONE } else { DVec3::ZERO };
        let beyond = critical * 1.001;
        close(seen(&scene, beyond, -1.0), floor(-10.0 * beyond));
        let within = seen(&scene, critical * 0.5, -1.0);
        let share = match weights {
            Some(_) => 0.25,
            None => {
                let sine = 1.5 * libm::sin(libm::atan(critical * 0.5));
                let k = 1.0 - libm::sqrt(1.0 - sine * sine);
                0.04 + 0.96 * libm::pow(k, 5.0)
            }
        };
        close(within, share * floor(-5.0 * critical) + (1.0 - share) * BACKGROUND);
    }
}

#[test]
fn a_ball_of_glass_turns_the_picture_over_and_one_of_air_is_not_there() {
    let ball = |ior: f64, weights| Model {
        spheres: vec![Sphere { centre: DVec3::ZERO, radius: 1.0, material: 0 }],
        materials: vec![Material {
            kind: MaterialKind::Dielectric,
            colour: DVec3::ONE,
            ior,
            weights,
            ..Material::default()
        }],
        background: Background::Sky { bottom: DVec3::ZERO, top: DVec3::ONE },
        ..Model::default()
    };
    let through = Some([0.0, 0.0, 0.0, 1.0]);
    let eye = DVec3::new(0.0, 0.3, 5.0);
    let nothing = ball(1.0, through);
    close(Reference::new(&nothing).sample(eye, -DVec3::Z).colour, DVec3::splat(0.5));
    // A ray at height h is turned by 2 (asin h - asin h/n) towards the axis.
    let turn = 2.0 * (libm::asin(0.3) - libm::asin(0.2));
    let glass = ball(1.5, through);
    close(Reference::new(&glass).sample(eye, -DVec3::Z).colour, DVec3::splat((1.0 - libm::sin(turn)) / 2.0));
    // An eye inside sees out: along a radius nothing is bent.
    close(Reference::new(&glass).sample(DVec3::ZERO, DVec3::Y).colour, DVec3::ONE);
}

#[test]
fn a_checker_is_of_cubes() {
    let checker = Checker { size: 2.0, other: DVec3::ZERO };
    let mut scene = plane(Material { colour: DVec3::ONE, checker: Some(checker), ..Material::default() });
    scene.render.ambient = DVec3::ONE;
    let tracer = Reference::new(&scene);
    for (x, y) in [(0.5, 0.5), (2.5, 0.5), (2.5, 2.5), (-0.5, 0.5), (-0.5, -0.5), (1.9, 4.1), (-11.0, 6.5)] {
        let odd = ((x / 2.0_f64).floor() + (y / 2.0_f64).floor()).rem_euclid(2.0);
        for side in [1.0, -1.0] {
            let sample = tracer.sample(DVec3::new(x, y, side), -DVec3::Z * side);
            close(sample.colour, DVec3::splat(1.0 - odd));
        }
    }
}

#[test]
fn textures_and_colours_of_vertices_tint_the_albedo() {
    let texture = Texture { size: [2, 1], texels: vec![[255, 0, 0], [0, 255, 0]] };
    let mut scene = plane(Material { colour: DVec3::ONE, texture: Some(Arc::new(texture)), ..Material::default() });
    scene.render.ambient = DVec3::ONE;
    scene.render.filter = Filter::Nearest;
    // Each triangle of the square: u is 0 to 1 from left to right.
    let u = |v: DVec3| DVec2::new((v.x + 1e3) / 2e3, 0.5);
    let corners = |t: usize| scene.triangles[t].vertices.map(|v| u(scene.positions[v as usize]));
    scene.uvs = vec![Some(corners(0)), Some(corners(1))];
    let colour = |scene: &Model, x: f64| Reference::new(scene).sample(DVec3::new(x, 1.0, 1.0), -DVec3::Z).colour;
    close(colour(&scene, -300.0), DVec3::X);
    close(colour(&scene, 300.0), DVec3::Y);
    scene.colours = scene.positions.iter().map(|p| DVec3::new(1.0, (p.x + 1e3) / 2e3, 1.0)).collect();
    close(colour(&scene, -300.0), DVec3::X);
    close(colour(&scene, 300.0), DVec3::Y * 0.65);
    scene.uvs = Vec::new();
    close(colour(&scene, 300.0), DVec3::new(1.0, 0.65, 1.0));
}

#[test]
fn light_fades_by_the_square_and_is_never_infinite() {
    let mut scene = plane(Material { colour: DVec3::ONE, ..Material::default() });
    let mut lamp = |z: f64| {
        let falloff = Falloff::InverseSquare { reach: 2.0 };
        scene.lights = vec![Light { falloff, ..Light::new(LightKind::Point(DVec3::Z * z), DVec3::ONE) }];
        Reference::new(&scene).sample(DVec3::new(1e3, 0.0, 1e3), DVec3::new(-1e3, 0.0, -1e3)).colour.x
    };
    assert_eq!([2.0, 4.0, 1.0, 0.125, 0.001].map(&mut lamp), [1.0, 0.25, 4.0, 256.0, 256.0]);
    assert_eq!(lamp(0.0), 0.0, "a light in the plane lights nothing of it");
}
