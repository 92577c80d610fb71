//! Spheres alone, for the tracer of 1994: what its words strain at.

use glam::DVec3;

use super::super::shapes::{Scene, v};
use super::super::{Case, Group, Subject};
use crate::model::{MaterialKind, Projection};

pub(super) fn cases() -> Vec<Case> {
    vec![
        Case::new(
            Group::Scale,
            "spheres-near-and-far",
            "Spheres whose radii differ by a hundred, the small ones a few units in words of 12 bits",
            near_and_far,
        ),
        Case::new(
            Group::Rays,
            "spheres-along-an-axis",
            "Parallel rays along an axis: two components of every direction are zero",
            along_an_axis,
        ),
        Case::new(
            Group::Shading,
            "spheres-mirrored",
            "Mirrors that face each other, to ten reflections: a normal is as long as its radius and no longer exact",
            mirrored,
        ),
        Case::new(Group::Structure, "spheres-many", "More spheres than a mask of 32 has bits, and no tree", many),
    ]
}

fn scene() -> Scene {
    Scene::seen(v(0.0, 1.0, 6.0), DVec3::ZERO).sun(v(-1.0, -2.0, -1.5), 0.8)
}

fn near_and_far() -> Subject {
    let spheres = (0..9).fold(scene().matt(v(0.7, 0.3, 0.2)).sphere(v(-1.5, 0.0, -1.0), 2.0), |scene, number| {
        scene.sphere(v(0.4 + 0.2 * f64::from(number), 0.5 - 0.1 * f64::from(number), 1.0), 0.02)
    });
    spheres.done()
}

fn along_an_axis() -> Subject {
    let mut scene = scene().matt(v(0.2, 0.6, 0.3)).sphere(v(-0.6, 0.2, 0.0), 0.7).sphere(v(0.5, -0.1, 0.6), 0.5);
    (scene.model.camera.position, scene.model.camera.look_at) = (v(0.0, 0.0, 6.0), DVec3::ZERO);
    scene.model.camera.projection = Projection::Orthographic { height: 3.0 };
    scene.done()
}

fn mirrored() -> Subject {
    let mirrors = scene().kind(MaterialKind::Mirror, 1.0).sphere(v(-1.1, 0.0, 0.0), 1.0).sphere(v(1.1, 0.0, 0.0), 1.0);
    mirrors.matt(v(0.8, 0.7, 0.2)).sphere(v(0.0, 0.4, 0.8), 0.3).done()
}

fn many() -> Subject {
    let spheres = (0..70).fold(scene().matt(v(0.4, 0.4, 0.8)), |scene, number| {
        let [x, y] = [number % 10, number / 10].map(f64::from);
        scene.sphere(v(0.4 * x - 1.8, 0.4 * y - 1.2, 0.3 * (x - y) / 10.0), 0.17)
    });
    spheres.done()
}
