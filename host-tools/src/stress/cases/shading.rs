//! Materials and lights.

use glam::DVec3;

use super::objects;
use crate::model::{Falloff, Lobe, Material, MaterialKind, Specular};
use crate::stress::shapes::{Scene, v};
use crate::stress::{Case, Group, Subject};

const fn case(name: &'static str, expectation: &'static str, subject: fn() -> Subject) -> Case {
    Case::new(Group::Shading, name, expectation, subject)
}

/// A lobe of exponent n falls the fastest where its slope is sqrt(n / e); half-way vectors turn half as much as what they are
/// between, the mirrored light twice as much. Half the light.
const fn shining(root: f64, case: Case) -> Case {
    Case { steepness: 1.0 + 0.61 * root, ..case }
}

/// Behind glass or a mirror: so many unit vectors turn the image.
const fn bent(bends: f64, dropped: f64, case: Case) -> Case {
    Case { bends, dropped, ..case }
}

pub(super) fn cases() -> Vec<Case> {
    vec![
        shining(1.0, case("exponent-1", "Highlights as wide as can be", || highlights(1))),
        shining(10.0, case("exponent-100", "Highlights of a common width", || highlights(100))),
        shining(
            100.0,
            case("exponent-10000", "Highlights of the largest exponent, a hundredth of a radian wide", || {
                highlights(10_000)
            }),
        ),
        // Entering and leaving, and two reflections of a share that can be seen.
        bent(
            4.0,
            8.0,
            case("ior-1.0001", "Glass that hardly bends: what is behind stays where it is", || glass(1.0001)),
        ),
        // A ray that leaves turns by as much as the index more.
        bent(40.0, 8.0, case("ior-10", "Glass of index 10: most of the light is reflected", || glass(10.0))),
        // Its share goes to 0 there.
        Case {
            grazes: true,
            ..bent(
                8.0,
                8.0,
                case(
                    "critical-angle",
                    "A prism of index sqrt(2) under 45 degrees: total reflection begins in the middle of the picture",
                    critical,
                ),
            )
        },
        // Each of 64 mirrors turns the image, and is left from a little off it. The picture's 64 columns see the ground's edges
        // along the mirrors and their images, each shorter than the one before: 64 (1 + 1/2 + ... + 1/64) pixels.
        bent(
            64.0,
            1.0,
            Case {
                leverage: 64.0,
                corners: 300.0,
                ..case("hall-of-mirrors", "Two mirrors that face each other, 64 reflections deep", hall)
            },
        ),
        case("faint-lights", "Eight lights of 2^-16, each fading, together as bright as 8 gray levels", faint),
        case("strong-light", "A light of 2^14, far outside its reach", || strong(14)),
        case("too-strong-light", "A light of 2^16, twice as strong as a blob holds: it is said", || strong(16)),
        case("light-at-one-unit-of-14", "A light 2^-14 of the scene above the ground", || low_light(-14)),
        case(
            "light-at-one-unit-of-29",
            "A light 2^-29 of the scene above the ground: coarser grids have it in the ground, and it reaches nothing there",
            || low_light(-29),
        ),
        // Each surface turns the ray.
        bent(
            64.0,
            1.0,
            case(
                "nested-glass",
                "150 shells of glass around each other: a ray ends at the 64th surface, on every machine",
                nested,
            ),
        ),
    ]
}

fn highlights(exponent: u32) -> Subject {
    let shiny = |lobe, colour| Material {
        colour,
        specular: Some(Specular { lobe, exponent, colour: DVec3::splat(0.5) }),
        ..Material::default()
    };
    Scene::seen(v(0.0, 1.5, 4.0), v(0.0, 0.3, 0.0))
        .light(v(1.0, 3.0, 2.0), 0.5)
        .of(shiny(Lobe::BlinnPhong, v(0.2, 0.3, 0.5)))
        .ground(v(0.0, 0.0, 0.0), 2.0)
        .sphere(v(-0.7, 0.6, 0.0), 0.6)
        .of(shiny(Lobe::Phong, v(0.5, 0.3, 0.2)))
        .sphere(v(0.7, 0.6, 0.0), 0.6)
        .done()
}

/// Stripes to look at through what is before them.
fn stripes(scene: Scene) -> Scene {
    (0..8).fold(scene, |scene, i| {
        let bright = f64::from(i % 2);
        let x = f64::from(i) * 0.5 - 2.0;
        scene.matt(v(0.2 + 0.6 * bright, 0.4, 0.8 - 0.6 * bright)).quad(
            v(x, -1.5, -1.0),
            v(0.5, 0.0, 0.0),
            v(0.0, 3.0, 0.0),
        )
    })
}

fn glass(ior: f64) -> Subject {
    let scene = stripes(Scene::seen(v(0.0, 0.0, 4.0), v(0.0, 0.0, 0.0)).sun(v(-0.2, -0.3, -1.0), 0.9));
    scene.kind(MaterialKind::Dielectric, ior).sphere(v(0.0, 0.0, 0.5), 0.8).done()
}

fn critical() -> Subject {
    let scene = stripes(Scene::seen(v(0.0, 0.0, 4.0), v(0.0, 0.0, 0.0)).sun(v(-0.2, -0.3, -1.0), 0.9));
    // Its front faces the eye, its back is under 45 degrees.
    let points = [
        v(-0.8, -0.6, 1.0),
        v(0.8, -0.6, 1.0),
        v(0.8, 0.6, 1.0),
        v(-0.8, 0.6, 1.0),
        v(-0.8, -0.6, -0.2),
        v(0.8, -0.6, -0.2),
    ];
    let faces = [[0, 1, 2], [0, 2, 3], [4, 3, 2], [4, 2, 5], [0, 4, 5], [0, 5, 1], [0, 3, 4], [1, 5, 2]];
    scene.kind(MaterialKind::Dielectric, core::f64::consts::SQRT_2).mesh(points, faces).done()
}

fn hall() -> Subject {
    let scene = Scene::seen(v(0.6, 0.9, 0.6), v(-0.2, 0.6, -1.0)).light(v(0.1, 1.6, 0.2), 0.9);
    let mirror = Material { colour: DVec3::splat(0.97), kind: MaterialKind::Mirror, ..Material::default() };
    let scene = scene
        .of(mirror)
        .quad(v(-1.5, 0.0, -1.0), v(3.0, 0.0, 0.0), v(0.0, 2.0, 0.0))
        .quad(v(1.5, 0.0, 1.0), v(-3.0, 0.0, 0.0), v(0.0, 2.0, 0.0))
        .matt(v(0.5, 0.4, 0.3))
        .quad(v(-1.5, 0.0, 1.0), v(3.0, 0.0, 0.0), v(0.0, 0.0, -2.0))
        .matt(v(0.2, 0.6, 0.3))
        .block(v(-0.6, 0.0, -0.5), v(-0.2, 0.6, -0.1));
    let mut subject = scene.done();
    subject.model.render.max_depth = 64;
    subject
}

fn faint() -> Subject {
    let scene = (0..8).fold(Scene::seen(v(1.5, 2.0, 4.0), v(0.0, 0.4, 0.0)), |scene, i| {
        scene.light(v(0.5 * f64::from(i) - 2.0, 3.0, 2.0), 1.0 / 65_536.0)
    });
    let mut subject = objects(scene.matt(v(1.0, 1.0, 1.0)).ground(v(0.0, 0.0, 0.0), 2.0)).done();
    // Within a sixteenth of the reach they are 256 times as bright.
    subject.model.lights.iter_mut().for_each(|light| light.falloff = Falloff::InverseSquare { reach: 128.0 });
    subject
}

fn strong(exponent: i32) -> Subject {
    let mut subject = super::benign().done();
    let strength = libm::ldexp(1.0, exponent);
    for light in &mut subject.model.lights {
        light.radiance = DVec3::splat(strength);
        // About as bright at distance 5 as a light of 0.8.
        light.falloff = Falloff::InverseSquare { reach: 4.5 / strength.sqrt() };
    }
    subject
}

fn low_light(exponent: i32) -> Subject {
    let scene = Scene::seen(v(0.0, 1.5, 3.0), v(0.0, 0.0, 0.0)).light(v(0.1, libm::ldexp(4.0, exponent), 0.3), 0.8);
    scene
        .matt(v(0.7, 0.6, 0.5))
        .ground(v(0.0, 0.0, 0.0), 2.0)
        .matt(v(0.3, 0.5, 0.8))
        .block(v(-1.0, 0.0, -0.8), v(-0.4, 0.6, -0.2))
        .done()
}

fn nested() -> Subject {
    let scene = stripes(Scene::seen(v(0.0, 0.0, 4.0), v(0.0, 0.0, 0.0)).sun(v(-0.2, -0.3, -1.0), 0.9));
    let shell = Material {
        colour: DVec3::splat(0.99),
        kind: MaterialKind::Dielectric,
        ior: 1.001,
        weights: Some([0.0, 0.0, 0.0, 1.0]),
        ..Material::default()
    };
    let scene = (0..150).fold(scene.of(shell), |scene, i| scene.sphere(v(0.0, 0.0, 0.3), 1.0 - f64::from(i) / 160.0));
    let mut subject = scene.done();
    subject.model.render.max_depth = 64;
    subject
}
