//! Origins and directions of rays. Each has a picture by such rays, for all machines, and rays of its own.

use glam::DVec3;

use super::{benign, table};
use crate::model::{Model, Projection};
use crate::stress::shapes::{Scene, v};
use crate::stress::{Case, Group, Subject};

const fn case(name: &'static str, expectation: &'static str, subject: fn() -> Subject) -> Case {
    Case::new(Group::Rays, name, expectation, subject)
}

pub(super) fn cases() -> Vec<Case> {
    vec![
        case("grazing", "Ground seen from 10^-6 of its size above it, and rays that meet it at 10^-6 radians", grazing),
        case(
            "axis-parallel",
            "Parallel rays along every axis, both ways, some of them in the faces of a box",
            axis_parallel,
        ),
        case("through-vertices", "Rays through every vertex: closed surfaces show no gap there", through_vertices),
        case("along-edges", "Rays along the edges of a box, in two faces at a time", along_edges),
        case(
            "from-a-surface",
            "Rays that start on surfaces: none meets what it leaves from the side that it leaves to",
            from_a_surface,
        ),
        case("inside-a-box", "From inside a closed box every ray hits", inside_a_box),
        case("from-a-corner", "From a corner of the grid, through all of it", from_a_corner),
        case("from-far-outside", "Rays from 10^6 times the scene's size away, clipped to the grid", from_far_outside),
    ]
}

fn parallel(mut subject: Subject, height: f64) -> Subject {
    subject.model.camera.projection = Projection::Orthographic { height };
    subject
}

/// Corners of all triangles.
fn corners(model: &Model) -> impl Iterator<Item = [DVec3; 3]> {
    model.triangles.iter().map(|triangle| triangle.vertices.map(|v| model.positions[v as usize]))
}

fn grazing() -> Subject {
    let rays = (0..64).flat_map(|i| {
        let along = f64::from(i) / 64.0;
        // They come down to the ground half-way across.
        [1e-2, 1e-4, 1e-6].map(|angle| [v(-1.0, angle, along - 0.5), v(1.0, -angle, 0.0)])
    });
    let scene = Scene::seen(v(0.0, 2e-6, 0.9), v(0.0, 2e-6, 0.0)).sun(v(-0.3, -1.0, -0.4), 0.9);
    scene
        .matt(v(0.6, 0.5, 0.4))
        .ground(v(0.0, 0.0, 0.0), 1.0)
        .matt(v(0.2, 0.3, 0.8))
        .block(v(-0.3, 0.1, -0.6), v(0.3, 0.4, -0.4))
        .with_rays(rays.collect())
}

fn axis_parallel() -> Subject {
    let low = v(-0.5, -0.5, -0.5);
    let scene = Scene::seen(v(0.0, 0.0, 2.0), v(0.0, 0.0, 0.0)).light(v(1.0, 1.5, 2.0), 0.8);
    let scene = scene.matt(v(0.7, 0.5, 0.3)).block(low, -low).globe(v(0.6, 0.6, 0.0), 0.3, 6);
    let rays = [DVec3::X, DVec3::Y, DVec3::Z].into_iter().flat_map(|axis| {
        (0..81).flat_map(move |i| {
            let [a, b] = [i % 9, i / 9].map(|c| f64::from(c) / 8.0 - 0.5);
            // Every eighth lies in a face.
            let across = if axis == DVec3::X {
                v(0.0, a, b)
            } else if axis == DVec3::Y {
                v(a, 0.0, b)
            } else {
                v(a, b, 0.0)
            };
            [[across - axis, axis], [across + axis, -axis]]
        })
    });
    parallel(scene.with_rays(rays.collect()), 1.5)
}

fn through_vertices() -> Subject {
    let subject = benign().done();
    let eyes = [v(1.5, 2.0, 1.9), v(-1.9, 1.0, 0.3), v(0.0, 1.9, 0.0)];
    let rays = subject.model.positions.iter().flat_map(|&p| eyes.map(|eye| [eye, p - eye])).collect();
    Subject { rays, ..subject }
}

fn along_edges() -> Subject {
    let scene = Scene::seen(v(0.5, 0.5, 3.0), v(0.5, 0.5, 0.5)).light(v(2.0, 2.0, 3.0), 0.8);
    let subject = scene.matt(v(0.7, 0.5, 0.3)).block(v(-0.5, -0.5, -0.5), v(0.5, 0.5, 0.5)).done();
    let edges = corners(&subject.model).flat_map(|[a, b, c]| [[a, b], [b, c], [c, a]]);
    let rays = edges.flat_map(|[a, b]| [[a - (b - a) * 0.5, b - a], [b + (b - a) * 0.25, a - b]]).collect();
    Subject { rays, ..parallel(subject, 2.0) }
}

fn from_a_surface() -> Subject {
    let subject = Scene::seen(v(0.0, 0.35, 0.99), v(0.0, 0.3, 0.0));
    let subject =
        subject.light(v(0.0, 0.9, 0.0), 0.9).matt(v(0.7, 0.6, 0.5)).block(v(-1.0, 0.0, -1.0), v(1.0, 1.0, 1.0));
    let subject = subject.matt(v(0.3, 0.6, 0.8)).globe(v(0.2, 0.3, -0.2), 0.3, 6).done();
    let rays = corners(&subject.model).flat_map(|[a, b, c]| {
        let normal = (b - a).cross(c - a).normalize();
        let along = (b - a).normalize();
        [0.25, 0.5].into_iter().flat_map(move |u| {
            let start = a + (b - a) * u + (c - a) * 0.25;
            [[start, normal], [start, -normal], [start, normal + along * 8.0], [start, along - normal * 0.1]]
        })
    });
    let rays = rays.collect();
    Subject { rays, ..subject }
}

fn inside_a_box() -> Subject {
    let scene = Scene::seen(v(0.1, 0.1, 0.1), v(1.0, 0.7, -0.8)).light(v(-0.3, 0.4, 0.2), 0.9);
    let scene = scene.matt(v(0.7, 0.6, 0.5)).block(v(-1.0, -1.0, -1.0), v(1.0, 1.0, 1.0));
    // Fibonacci's sphere: even in all directions.
    let rays = (0..2000).map(|i| {
        let z = (2.0 * f64::from(i) + 1.0) / 2000.0 - 1.0;
        let around = f64::from(i) * 2.399_963_229_728_653;
        let out = (1.0 - z * z).sqrt();
        [v(0.1, 0.1, 0.1), v(out * libm::cos(around), out * libm::sin(around), z)]
    });
    scene.with_rays(rays.collect())
}

fn from_a_corner() -> Subject {
    let scene = Scene::seen(v(2.0, 2.0, 2.0), v(0.0, 0.0, 0.0)).light(v(-2.0, 2.0, 2.0), 0.8);
    let scene = scene.matt(v(0.7, 0.5, 0.3)).block(v(-0.5, -0.5, -0.5), v(0.5, 0.5, 0.5));
    // What makes the grid as wide as it is, out of the way.
    let subject = scene.triangle(v(-2.0, -2.0, -2.0), v(-1.9, -2.0, -2.0), v(-2.0, -1.9, -2.0)).done();
    let ends =
        (0..8).map(|i: u32| v(f64::from(i & 1), f64::from(i >> 1 & 1), f64::from(i >> 2)) * 4.0 - DVec3::splat(2.0));
    let rays = ends.flat_map(|end| subject.model.positions.iter().map(move |&p| [end, p - end]));
    let rays = rays.filter(|[_, direction]| *direction != DVec3::ZERO).collect();
    Subject { rays, ..subject }
}

fn from_far_outside() -> Subject {
    let subject = table(Scene::seen(v(1.5, 2.0, 4.0), v(0.0, 0.4, 0.0)).sun(v(-0.5, -1.3, -0.6), 0.8)).done();
    let middles = corners(&subject.model).map(|[a, b, c]| (a + b + c) / 3.0);
    let ways = [v(1.0, 2.0, 1.5), v(-1.0, 0.5, 0.25), v(0.0, 1.0, 0.0)];
    let rays = middles.flat_map(|middle| ways.map(|way| [middle + way * 1e6, -way])).collect();
    Subject { rays, ..subject }
}
