//! Scenes that ask for something of the camera or of pixels.

use glam::DVec3;
use host_tools::builtin;
use host_tools::import::{self, Embedded};
use host_tools::model::{Background, Format, Material, MaterialKind, Model, Projection, Sphere};

use super::{flat, several_lights, sun};
use crate::meshes;

/// Name and scene, at golden size.
///
/// # Panics
/// If the built-in scene does not import.
#[must_use]
pub fn pixels() -> Vec<(&'static str, Model)> {
    vec![
        ("parallel", parallel()),
        ("parallel-inside", parallel_inside()),
        ("samples", samples()),
        ("dithered", dithered()),
        ("gray", gray()),
        ("paths", paths()),
        ("rough", rough()),
    ]
}

fn demo() -> Model {
    let mut model = import::load_from(&Embedded(builtin::FILES), "scene.toml").expect("the built-in scene").model;
    model.render.size = [160, 120];
    model
}

/// From far off, so that the plane is brought nearer.
fn parallel() -> Model {
    let mut model = demo();
    let camera = &mut model.camera;
    let ahead = camera.position - camera.look_at;
    let away = ahead + DVec3::new(0.3, 0.35, 0.0) * ahead.length();
    camera.projection = Projection::Orthographic { height: 0.7 * away.length() };
    camera.position += 1000.0 * away;
    model
}

/// From a plane in the midst of a field of hills, of which those behind it are not seen; several samples.
fn parallel_inside() -> Model {
    let mut model = super::of(&meshes::heightfield(10, 12, 3), [96, 64]);
    model.camera.position = DVec3::splat(0.5);
    model.camera.look_at = DVec3::new(0.1, 0.1, 0.2);
    model.camera.projection = Projection::Orthographic { height: 0.8 };
    model.render.samples = 3;
    model
}

fn samples() -> Model {
    let mut model = flat();
    model.render.samples = 5;
    model
}

fn dithered() -> Model {
    let mut model = demo();
    model.render.format = Format::Rgb565;
    model
}

/// More samples a pixel than hits fit on a chip at a time.
fn gray() -> Model {
    let mut model = sun();
    model.render.size = [32, 24];
    model.render.format = Format::Gray8;
    model.render.samples = 300;
    model
}

/// A cuboid that glows in parts, a rough metal ball and a glass one, under a sky: a path has all the ways to go.
fn paths() -> Model {
    let mut model = several_lights();
    let ball = |name: &str, kind, colour, roughness| Material {
        name: name.into(),
        kind,
        colour,
        roughness,
        ior: 1.5,
        ..Material::default()
    };
    model.spheres = [DVec3::new(0.95, 0.6, 1.1), DVec3::new(0.4, 0.9, 1.05)]
        .into_iter()
        .zip(3..)
        .map(|(centre, material)| Sphere { centre, radius: 0.25, material })
        .collect();
    model.materials.push(ball("metal", MaterialKind::Metal, DVec3::new(0.9, 0.7, 0.4), 0.3));
    model.materials.push(ball("glass", MaterialKind::Dielectric, DVec3::new(0.7, 1.0, 0.9), 0.1));
    model.background = Background::Sky { bottom: DVec3::splat(0.1), top: DVec3::new(0.5, 0.7, 1.0) };
    (model.render.size, model.render.samples, model.render.max_depth) = ([48, 32], 5, 4);
    (model.render.paths, model.render.ambient) = (true, DVec3::splat(0.2));
    model
}

/// The same by Whitted's tree, in ambient light, whose branches are of rough mirrors and of glass.
fn rough() -> Model {
    let mut model = paths();
    (model.render.paths, model.render.samples) = (false, 3);
    model
}
