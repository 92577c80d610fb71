//! Paths: what they gather where one can say what that is, and that sums do not depend on how they are taken.

use core_rt::path::Sum;
use core_rt::render::Tile;
use glam::DVec3;
use host_tools::engine::{ENGINES, Engine};
use host_tools::model::{
    Background, Camera, Light, LightKind, Material, MaterialKind, Model, Projection, RenderSettings, Sphere, Transfer,
    Triangle,
};
use host_tools::prepare::{Blob, Options};
use host_tools::stage::Stage;
use tests::scenes;

fn blob(engine: &dyn Engine, model: &Model) -> Blob {
    engine.prepare(model, &Options::default()).expect("it fits every kernel").blob
}

/// The sums of a whole picture.
fn sums(stage: &dyn Stage, size: [u32; 2], samples: u16) -> Vec<Sum> {
    let [width, height] = size.map(|side| side as u16);
    let tile = Tile { x: 0, y: 0, width, height };
    let mut sums = vec![[0; 3]; tile.pixels()];
    stage.add_samples(tile, 0..samples, &mut sums);
    sums
}

/// A ball before a wall, white but for what its material says, in a furnace: light of 1 from everywhere.
fn furnace(ball: Material) -> Model {
    let white = Material { name: "white".into(), colour: DVec3::ONE, ..Material::default() };
    let corner = |x: f64, y: f64| DVec3::new(x, y, -1.5);
    Model {
        positions: vec![corner(-2.0, -2.0), corner(2.0, -2.0), corner(2.0, 2.0), corner(-2.0, 2.0)],
        triangles: [[0, 1, 2], [0, 2, 3]].map(|vertices| Triangle { vertices, normals: None, material: 0 }).into(),
        spheres: vec![Sphere { centre: DVec3::ZERO, radius: 1.0, material: 1 }],
        materials: vec![white, ball],
        camera: Camera {
            position: DVec3::new(0.5, 0.3, 5.0),
            look_at: DVec3::ZERO,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: 0.7 },
        },
        background: DVec3::ONE.into(),
        render: RenderSettings {
            size: [24, 24],
            samples: 16,
            paths: true,
            max_depth: 64,
            transfer: Transfer::Linear,
            ..RenderSettings::default()
        },
        ..Model::default()
    }
}

fn ball(kind: MaterialKind, roughness: f64, weights: Option<[f64; 4]>) -> Material {
    let ior = if kind == MaterialKind::Dielectric { 1.5 } else { 1.0 };
    Material { name: "ball".into(), kind, colour: DVec3::ONE, roughness, weights, ior, ..Material::default() }
}

/// What is white is not seen in light that is the same everywhere: every sample is 1 but for the rounding of shares, a unit of
/// 65536 a surface: few meet ten, and a pixel is within 2^-10. Of rough glass some paths are still inside when they have
/// gone on from 64 surfaces, so that a sample is lost here and there: there the mean of the picture is so near.
#[test]
fn nothing_is_seen_in_a_white_furnace() {
    let balls = [
        ("lambert", ball(MaterialKind::Lambert, 0.0, None)),
        ("mirror", ball(MaterialKind::Mirror, 0.0, None)),
        ("rough mirror", ball(MaterialKind::Mirror, 0.5, None)),
        ("roughest metal", ball(MaterialKind::Metal, 1.0, None)),
        ("glass", ball(MaterialKind::Dielectric, 0.0, None)),
        ("rough glass", ball(MaterialKind::Dielectric, 0.3, None)),
        ("half a mirror", ball(MaterialKind::Lambert, 0.2, Some([0.5, 0.0, 0.5, 0.0]))),
        ("of all kinds", ball(MaterialKind::Lambert, 0.2, Some([0.25, 0.0, 0.25, 0.5]))),
    ];
    for engine in ENGINES {
        for (name, ball) in &balls {
            let mut model = furnace(ball.clone());
            let own = blob(engine, &model);
            let samples = model.render.samples;
            let stage = engine.stage(own.bytes()).expect("a blob just made");
            let whole = samples << 16;
            let least = whole - (whole >> 10);
            let of = |sums: &[Sum]| {
                let channels = || sums.iter().flatten();
                let mean = channels().map(|&c| u64::from(c)).sum::<u64>() / channels().count() as u64;
                (*channels().min().expect("pixels"), mean, *channels().max().expect("pixels"))
            };
            let (darkest, mean, brightest) = of(&sums(stage.as_ref(), model.render.size, samples as u16));
            let told = format!("{} {name}: {darkest} to {brightest}, {mean} in the mean, of {whole}", engine.name());
            assert!(darkest >= least || ball.roughness > 0.0 && ball.ior > 1.0, "{told}");
            assert!(mean >= u64::from(least) && brightest <= whole, "{told}");
            // A surface that keeps a hundredth is seen.
            model.materials[1].colour *= 0.99;
            model.materials[1].weights = model.materials[1].weights.map(|weights| weights.map(|w| w * 0.99));
            let grey = blob(engine, &model);
            let stage = engine.stage(grey.bytes()).expect("a blob just made");
            assert!(of(&sums(stage.as_ref(), model.render.size, samples as u16)).0 < least, "{} {name}", engine.name());
        }
    }
}

/// A lambertian ball of albedo a in a furnace sends a, exactly, whatever it is that its paths meet: nothing else is there.
#[test]
fn a_grey_ball_alone_is_as_grey_as_it_says() {
    for engine in ENGINES {
        let mut model = furnace(ball(MaterialKind::Lambert, 0.0, None));
        model.triangles.clear();
        model.materials[1].colour = DVec3::new(0.75, 0.5, 0.25);
        model.camera.projection = Projection::Orthographic { height: 0.5 };
        let own = blob(engine, &model);
        let stage = engine.stage(own.bytes()).expect("a blob just made");
        for sum in sums(stage.as_ref(), model.render.size, 16) {
            for (found, meant) in sum.into_iter().zip([0.75, 0.5, 0.25]) {
                let off = f64::from(found) / 16.0 - meant * 65_536.0;
                assert!(off.abs() <= 1.5, "{}: {found}", engine.name());
            }
        }
    }
}

/// The floor of an open box of emissive walls, the radiance that it gathers known from the form factors of the hemisphere: above
/// a plane, one half of the sky is bright, and a surface turned by an angle sees (1 + cos) / 2 of it.
#[test]
fn a_tilted_plane_sees_its_part_of_the_sky() {
    let (samples, size) = (64u16, [32u32, 32]);
    for engine in ENGINES {
        for degrees in [0.0_f64, 40.0, 90.0] {
            let (sine, cosine) = libm::sincos(degrees.to_radians());
            let (across, along) = (DVec3::Z, DVec3::new(cosine, sine, 0.0));
            let normal = DVec3::new(-sine, cosine, 0.0);
            let mut model = furnace(ball(MaterialKind::Lambert, 0.0, None));
            model.spheres.clear();
            model.positions = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
                .map(|[a, b]| along * (4.0 * a) + across * (4.0 * b))
                .into();
            model.camera.position = normal * 3.0;
            model.camera.up = across;
            model.camera.projection = Projection::Orthographic { height: 2.0 };
            model.background = Background::Sky { bottom: DVec3::ZERO, top: DVec3::ONE };
            model.render.size = size;
            let own = blob(engine, &model);
            let stage = engine.stage(own.bytes()).expect("a blob just made");
            let total: f64 = sums(stage.as_ref(), size, samples).iter().map(|sum| f64::from(sum[1]) / 65_536.0).sum();
            let count = f64::from(size[0] * size[1]) * f64::from(samples);
            // A sky of (1 + y) / 2 over a hemisphere with the cosine's weight: (1 + 2/3 ny) / 2, of variance at most 1/4 (1/18 + 1/4).
            let (found, meant) = (total / count, (1.0 + 2.0 / 3.0 * cosine) / 2.0);
            let deviation = (0.25 * (1.0 / 18.0 + 0.25) / count).sqrt();
            // Hundreds of thousands of directions, within 2^-12 on a grid of 14 bits.
            let bound = 6.0 * deviation + 2f64.powi(-12);
            assert!((found - meant).abs() < bound, "{} {degrees}: {found} for {meant}", engine.name());
        }
    }
}

/// Light that a lamp sends is added at the surfaces that a path meets, without ambient light.
#[test]
fn lamps_are_added_and_ambient_light_is_not() {
    for engine in ENGINES {
        let mut model = furnace(ball(MaterialKind::Lambert, 0.0, None));
        model.spheres.clear();
        model.background = DVec3::ZERO.into();
        model.render.ambient = DVec3::splat(0.5);
        model.camera.projection = Projection::Orthographic { height: 2.0 };
        model.camera.position = DVec3::new(0.0, 0.0, 5.0);
        model.materials[0].colour = DVec3::splat(0.5);
        model.materials[0].emission = DVec3::splat(0.125);
        model.lights = vec![Light::new(LightKind::Directional(DVec3::NEG_Z), DVec3::splat(0.5))];
        let own = blob(engine, &model);
        let stage = engine.stage(own.bytes()).expect("a blob just made");
        for sum in sums(stage.as_ref(), model.render.size, 4) {
            assert!(sum.iter().all(|&c| c.abs_diff(4 * 24_576) <= 16), "{}: {sum:?}", engine.name());
        }
    }
}

/// Whatever frames samples come in, and however tiles are cut, the picture is that of one go; and other samples are another.
#[test]
fn any_split_of_samples_and_tiles_gives_the_same_picture() {
    let (_, model) = scenes::pixels().into_iter().find(|(name, _)| *name == "paths").expect("a scene of this name");
    let samples = model.render.samples as u16;
    let [width, height] = model.render.size.map(|side| side as u16);
    for engine in ENGINES {
        let own = blob(engine, &model);
        let stage = engine.stage(own.bytes()).expect("a blob just made");
        let expected = engine.render(own.bytes(), [16, 16], &|_| ()).expect("a blob just made").picture;
        for (cuts, side) in [(vec![0, samples], [48, 32]), (vec![0, 1, 2, 3, 4, 5], [7, 5]), (vec![0, 4, 5], [1, 32])] {
            for tile in Tile::of([width, height], side) {
                let mut sums = vec![[0; 3]; tile.pixels()];
                // The later frames first: an order is none.
                for frame in cuts.windows(2).rev() {
                    stage.add_samples(tile, frame[0]..frame[1], &mut sums);
                }
                let pixels = stage.mean(tile, &sums, samples);
                for (pixel, [x, y]) in pixels.into_iter().zip(tile.places()) {
                    let place = usize::from(y) * usize::from(width) + usize::from(x);
                    assert_eq!(pixel, expected.pixels()[place], "{} at {x}, {y}", engine.name());
                }
            }
        }
        let whole = Tile { x: 0, y: 0, width, height };
        let [mut first, mut later] = [(); 2].map(|()| vec![[0; 3]; whole.pixels()]);
        stage.add_samples(whole, 0..samples, &mut first);
        stage.add_samples(whole, samples..2 * samples, &mut later);
        assert_ne!(first, later, "{}", engine.name());
    }
}

/// A scene without paths has no sums.
#[test]
fn a_tree_is_not_summed() {
    let (_, model) = scenes::pixels().into_iter().find(|(name, _)| *name == "rough").expect("a scene of this name");
    for engine in ENGINES {
        let own = blob(engine, &model);
        let stage = engine.stage(own.bytes()).expect("a blob just made");
        assert!(!stage.follows_paths());
        assert!(sums(stage.as_ref(), model.render.size, 3).iter().all(|sum| *sum == [0; 3]), "{}", engine.name());
    }
}
