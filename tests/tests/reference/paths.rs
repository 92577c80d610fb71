//! Paths and rough mirrors against what they must send: exactly, where no path differs from another, else within four standard
//! deviations of the mean.

use glam::DVec3;
use host_tools::model::{
    Background, Camera, LightKind, Lobe, Material, MaterialKind, Model, Projection, Specular, Sphere,
};
use host_tools::reference::Reference;
use tests::convergence::{self, ALLOWED, rmse};

use crate::{Corners, model, quad};

/// A large square through the origin, upwards y.
fn floor() -> Vec<Corners> {
    let at = |x: f64, z: f64| DVec3::new(x, 0.0, z);
    quad(at(-1e3, -1e3), at(-1e3, 1e3), at(1e3, 1e3), at(1e3, -1e3)).to_vec()
}

/// A floor seen from above in parallel rays at an angle, of one material, by paths.
fn seen(material: Material, background: Background, degrees: f64) -> Model {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let mut scene = model(&floor(), &[]);
    scene.materials[0] = material;
    scene.background = background;
    scene.camera = Camera {
        position: DVec3::new(sin, cos, 0.0) * 50.0,
        look_at: DVec3::ZERO,
        up: DVec3::Z,
        projection: Projection::Orthographic { height: 1.0 },
    };
    scene.render.paths = true;
    scene
}

/// The inside of a sphere of one material.
fn inside(material: Material) -> Model {
    let mut scene = seen(material, DVec3::splat(9.0).into(), 0.0);
    (scene.triangles, scene.positions) = (Vec::new(), Vec::new());
    scene.spheres = vec![Sphere { centre: DVec3::new(0.1, 0.2, 0.3), radius: 4.0, material: 0 }];
    scene.camera.position = DVec3::Y;
    scene.camera.projection = Projection::Perspective { fov_y: 2.0 };
    scene
}

fn mirror(roughness: f64) -> Material {
    Material { kind: MaterialKind::Mirror, colour: DVec3::ONE, roughness, ..Material::default() }
}

fn lambert(colour: DVec3) -> Material {
    Material { colour, ..Material::default() }
}

/// Nothing below, everything above.
const SKY: Background = Background::Sky { bottom: DVec3::ZERO, top: DVec3::ONE };

/// The colours of an 8x6 picture's pixels, each the mean of so many samples.
fn colours(scene: &Model, samples: u32) -> Vec<DVec3> {
    let mut scene = scene.clone();
    scene.render.samples = samples;
    let tracer = Reference::new(&scene);
    (0..6).flat_map(|y| (0..8).map(move |x| [x, y])).map(|[x, y]| tracer.pixel_colour([8, 6], x, y)).collect()
}

/// Checks that every pixel is exactly so, but for rounding.
#[track_caller]
fn exactly(scene: &Model, expected: DVec3) {
    for colour in colours(scene, 16) {
        assert!((colour - expected).abs().max_element() < 1e-12, "{colour} and not {expected}");
    }
}

/// Checks that the mean is so, by how far pixels are from each other.
#[track_caller]
fn in_the_mean(scene: &Model, expected: DVec3) {
    let colours = colours(scene, 1024);
    let count = colours.len() as f64;
    let mean = colours.iter().sum::<DVec3>() / count;
    let variance = colours.iter().map(|colour| (colour - mean) * (colour - mean)).sum::<DVec3>() / (count - 1.0);
    let allowed = 4.0 * (variance / count).map(libm::sqrt) + 1e-12;
    assert!((mean - expected).abs().cmple(allowed).all(), "{mean} and not {expected}, by more than {allowed}");
}

#[test]
fn a_white_furnace_shows_nothing_of_what_is_in_it() {
    let half = DVec3::splat(0.5);
    let white = [
        lambert(DVec3::ONE),
        mirror(0.0),
        mirror(0.3),
        mirror(1.0),
        Material { weights: Some([0.25, 0.0, 0.5, 0.25]), roughness: 0.4, ..lambert(DVec3::ONE) },
    ];
    for material in white {
        for degrees in [0.0, 40.0, 85.0] {
            exactly(&seen(material.clone(), half.into(), degrees), half);
        }
    }
    // Through glass and within it, and between a sphere and the floor.
    let mut scene = seen(lambert(DVec3::ONE), half.into(), 50.0);
    scene.materials.push(Material {
        kind: MaterialKind::Dielectric,
        colour: DVec3::ONE,
        ior: 1.5,
        ..Material::default()
    });
    scene.spheres = vec![Sphere { centre: DVec3::new(0.0, 0.5, 0.0), radius: 0.4, material: 1 }];
    scene.render.max_depth = 64;
    exactly(&scene, half);
}

#[test]
fn light_between_walls_is_a_geometric_series() {
    let glow = DVec3::new(0.1, 0.05, 0.2);
    for max_depth in [0, 1, 2, 7] {
        for (material, share) in [
            (lambert(DVec3::splat(0.5)), 0.5),
            (Material { weights: Some([0.3, 0.0, 0.4, 0.0]), roughness: 0.5, ..lambert(DVec3::splat(0.5)) }, 0.55),
        ] {
            let mut scene = inside(Material { emission: glow, ..material });
            scene.render.max_depth = max_depth;
            let sum: f64 = (0..=max_depth).map(|bounce| libm::pow(share, bounce.into())).sum();
            exactly(&scene, glow * sum);
        }
    }
}

#[test]
fn a_lambert_surface_gathers_by_the_cosine() {
    // The mean of 1 + y over the hemisphere, weighted by the cosine, is 5/3.
    let colour = DVec3::new(0.9, 0.5, 0.1);
    in_the_mean(&seen(lambert(colour), SKY, 30.0), colour * (5.0 / 6.0));
}

#[test]
fn a_rough_mirror_strews_as_far_as_it_is_rough() {
    // The mean cosine of m + r s to m is 1 - r^2 / 3 for r up to 1.
    for roughness in [0.2, 0.6, 1.0] {
        let expected = DVec3::splat(1.0 - roughness * roughness / 6.0);
        let mut scene = seen(mirror(roughness), SKY, 0.0);
        in_the_mean(&scene, expected);
        // Under Whitted's tracer too.
        scene.render.paths = false;
        in_the_mean(&scene, expected);
    }
    let mut sharp = seen(mirror(0.0), SKY, 0.0);
    exactly(&sharp, DVec3::ONE);
    sharp.render.paths = false;
    exactly(&sharp, DVec3::ONE);
}

#[test]
fn a_rough_mirror_keeps_its_energy_at_any_angle() {
    let light = DVec3::splat(0.75);
    for degrees in [0.0, 60.0, 89.0] {
        let mut scene = seen(Material { colour: DVec3::splat(0.6), ..mirror(0.8) }, light.into(), degrees);
        exactly(&scene, light * 0.6);
        scene.render.paths = false;
        exactly(&scene, light * 0.6);
    }
}

#[test]
fn ways_that_are_chosen_at_random_are_right_in_the_mean() {
    // Each has colours of its own, so that samples differ.
    let specular = Specular { lobe: Lobe::Phong, exponent: 10, colour: DVec3::new(0.0, 0.3, 0.9) };
    let material = lambert(DVec3::new(0.6, 0.2, 0.0));
    let material =
        Material { weights: Some([1.0, 0.0, 0.5, 0.0]), specular: Some(specular), roughness: 0.3, ..material };
    let light = DVec3::splat(0.5);
    in_the_mean(&seen(material, light.into(), 20.0), light * DVec3::new(0.6, 0.35, 0.45));
}

#[test]
fn lights_are_added_at_surfaces_and_ambient_light_is_left_out() {
    let mut scene = model(&floor(), &[LightKind::Directional(DVec3::NEG_Y)]);
    scene.camera = seen(Material::default(), SKY, 0.0).camera;
    scene.background = DVec3::ZERO.into();
    (scene.render.paths, scene.render.ambient) = (true, DVec3::ONE);
    exactly(&scene, DVec3::ONE);
}

#[test]
fn the_error_falls_as_the_square_root_of_the_samples() {
    let scene = seen(lambert(DVec3::ONE), SKY, 0.0);
    let truth = vec![DVec3::splat(5.0 / 6.0); 48];
    let exponent = |picture: &dyn Fn(u32) -> Vec<DVec3>| {
        convergence::exponent(&[1, 4, 16, 64, 256].map(|samples| (samples, rmse(&picture(samples), &truth))))
    };
    let found = exponent(&|samples| colours(&scene, samples));
    assert!(ALLOWED.contains(&found), "{found}");
    // The same sample again and again tells nothing new.
    let same = exponent(&|_| colours(&scene, 1));
    assert!(!ALLOWED.contains(&same), "{same}");
}

#[test]
fn pictures_do_not_depend_on_the_threads() {
    let mut scene = seen(mirror(0.5), SKY, 30.0);
    scene.spheres = vec![Sphere { centre: DVec3::ZERO, radius: 0.3, material: 0 }];
    (scene.render.size, scene.render.samples) = ([24, 18], 3);
    let picture = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Reference::new(&scene).picture(&|_| ()))
    };
    assert_eq!(picture(1), picture(3));
}
