//! Scenes that ask for something of the camera or of pixels.

use glam::DVec3;
use host_tools::builtin;
use host_tools::import::{self, Embedded};
use host_tools::model::{Format, Model, Projection};

use super::{flat, sun};
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
