//! Small scenes for goldens: each asks for something that the others do not. And larger ones to measure errors on.

mod pixels;
mod vast_ground;

pub use pixels::pixels;
pub use vast_ground::vast_ground;

use glam::DVec3;
use host_tools::builtin;
use host_tools::import::{self, Embedded};
use host_tools::model::{Camera, Light, LightKind, Material, Model, Projection, RenderSettings, Transfer, Triangle};

use crate::{meshes, shared};

/// Name and scene, at golden size.
///
/// # Panics
/// If the built-in scene does not import.
#[must_use]
pub fn all() -> Vec<(&'static str, Model)> {
    let mut demo = import::load_from(&Embedded(builtin::FILES), "scene.toml").expect("the built-in scene").model;
    demo.render.size = [160, 120];
    vec![
        ("demo", demo),
        ("flat", flat()),
        ("sun", sun()),
        ("several-lights", several_lights()),
        ("linear", linear()),
        ("one-triangle", one_triangle()),
        ("inside", inside(32)),
    ]
}

/// A scene of triangles alone, with Lambert's law alone, before black.
#[must_use]
pub fn matt(mut model: Model) -> Model {
    model.spheres.clear();
    model.background = DVec3::ZERO.into();
    for material in &mut model.materials {
        *material = Material {
            name: std::mem::take(&mut material.name),
            colour: material.colour,
            emission: material.emission,
            texture: material.texture.take(),
            ..Material::default()
        };
    }
    model
}

fn white() -> Material {
    Material { name: "white".into(), colour: DVec3::ONE, ..Material::default() }
}

/// A mesh of the oracle's kind, seen and lit from outside.
fn of(mesh: &[[[i64; 3]; 3]], size: [u32; 2]) -> Model {
    let positions: Vec<DVec3> =
        mesh.iter().flatten().map(|v| DVec3::from_array(v.map(|c| c as f64)) / 1024.0).collect();
    let triangles = (0..mesh.len() as u32)
        .map(|i| Triangle { vertices: [3 * i, 3 * i + 1, 3 * i + 2], normals: None, material: 0 })
        .collect();
    let centre = DVec3::splat(0.5);
    let eye = DVec3::new(1.4, 1.2, 2.3);
    Model {
        positions,
        triangles,
        materials: vec![white()],
        lights: vec![Light::new(LightKind::Point(DVec3::new(0.2, 2.0, 1.8)), DVec3::ONE)],
        camera: Camera {
            position: eye,
            look_at: centre,
            up: DVec3::Y,
            projection: Projection::Perspective { fov_y: 0.6 },
        },
        background: DVec3::new(0.05, 0.1, 0.2).into(),
        render: RenderSettings { size, ..RenderSettings::default() },
        ..Model::default()
    }
}

fn flat() -> Model {
    of(&meshes::heightfield(10, 12, 3), [96, 64])
}

/// Directional light and ambient light; a sphere that shades itself.
fn sun() -> Model {
    let mut model = of(&meshes::sphere(10, 6), [96, 64]);
    model.lights = vec![Light::new(LightKind::Directional(DVec3::new(-1.0, -2.0, -0.5)), DVec3::new(1.0, 0.9, 0.7))];
    model.render.ambient = DVec3::splat(0.05);
    model
}

/// Both kinds of light, intensities over one, emission, three materials.
fn several_lights() -> Model {
    let mut model = of(&meshes::cuboid([100, 100, 100], [900, 700, 800]), [96, 64]);
    model.materials = vec![
        white(),
        Material { name: "red".into(), colour: DVec3::new(0.8, 0.1, 0.05), ..Material::default() },
        Material {
            name: "glow".into(),
            colour: DVec3::ZERO,
            emission: DVec3::new(0.0, 0.3, 0.6),
            ..Material::default()
        },
    ];
    for (i, triangle) in (0..).zip(&mut model.triangles) {
        triangle.material = i % 3;
    }
    model.lights.push(Light::new(LightKind::Point(DVec3::new(2.0, 0.5, 0.5)), DVec3::splat(0.25)));
    model.lights.push(Light::new(LightKind::Directional(DVec3::new(0.0, 0.0, -1.0)), DVec3::new(0.0, 3.0, 0.0)));
    model
}

fn linear() -> Model {
    let mut model = of(&meshes::staircase(10, 9), [96, 64]);
    model.render.transfer = Transfer::Linear;
    model
}

/// A tree that is one leaf.
fn one_triangle() -> Model {
    of(&[[[0, 0, 0], [1023, 0, 300], [200, 1023, 500]]], [64, 48])
}

/// The inside of a closed sphere of about `2 n^2` triangles: wherever the background is seen is a hole.
#[must_use]
pub fn inside(n: i64) -> Model {
    let mut model = of(&meshes::sphere(10, n), [96, 64]);
    model.camera.position = DVec3::splat(0.5);
    model.camera.look_at = DVec3::new(0.9, 0.6, 0.2);
    model.camera.projection = Projection::Perspective { fov_y: 1.9 };
    model.background = DVec3::new(1.0, 0.0, 1.0).into();
    model.lights[0].kind = LightKind::Point(DVec3::splat(0.45));
    model
}

/// Closed meshes: the background is seen through a hole and beside them, but not where a ray meets them.
#[must_use]
pub fn closed() -> Vec<(&'static str, Model)> {
    let size = [96, 64];
    vec![
        ("sphere of 72, inside", inside(3)),
        ("sphere of 32768, inside", inside(64)),
        ("sphere of 72, outside", of(&meshes::sphere(10, 3), size)),
        ("sphere of 32768, outside", of(&meshes::sphere(10, 64), size)),
        ("cuboid, outside", of(&meshes::cuboid([100, 100, 100], [900, 700, 800]), size)),
        ("plate, outside", of(&meshes::cuboid([100, 500, 100], [900, 501, 800]), size)),
    ]
}

const SHARED: [&str; 6] = [
    "bunny/bunny_smooth.obj",
    "sponza-dabrovic/scene.toml",
    "coffee/coffee.obj",
    "teapot/teapot.obj",
    "suzanne/suzanne.obj",
    "cornell-box/scene.toml",
];

/// One of [`with_shared`], without a look at the others; `None` where there is none of this name.
///
/// # Panics
/// If it is a shared model and does not import.
#[must_use]
pub fn named(name: &str, size: [u32; 2]) -> Option<Model> {
    let mut model = if name.contains('/') {
        import::load(&shared::scene(name)?).expect("a real model").model
    } else {
        all().into_iter().find(|&(known, _)| known == name)?.1
    };
    model.render.size = size;
    Some(model)
}

/// The shared models that are present, and the golden scenes, all at one size.
///
/// # Panics
/// If a shared model does not import.
#[must_use]
pub fn with_shared(size: [u32; 2]) -> Vec<(&'static str, Model)> {
    let shared = SHARED.into_iter().filter_map(|name| {
        let path = shared::scene(name)?;
        Some((name, import::load(&path).expect("a real model").model))
    });
    let mut models: Vec<_> = shared.chain(all()).collect();
    for (_, model) in &mut models {
        model.render.size = size;
    }
    models
}
