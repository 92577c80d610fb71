//! Shapes and places of triangles.

use glam::DVec3;

use crate::stress::shapes::{Scene, v};
use crate::stress::{Case, Group, Subject};

const fn case(name: &'static str, expectation: &'static str, subject: fn() -> Subject) -> Case {
    Case::new(Group::Triangles, name, expectation, subject)
}

pub(super) fn cases() -> Vec<Case> {
    vec![
        case("slivers-1e3", "A wall of slivers of aspect 1,000 shows no gap", || slivers(1e3)),
        case("slivers-1e5", "A wall with slivers of aspect 100,000 shows no gap", || slivers(1e5)),
        case("slivers-1e7", "A wall with slivers of aspect 10,000,000 shows no gap", || slivers(1e7)),
        case("needle-fan", "A disc of 2,048 needles that meet in one point shows no gap", needle_fan),
        case(
            "edge-lengths",
            "Edges from 1 to 2^-28 of the scene, each triangle half as large as the one before",
            edge_lengths,
        ),
        case("coplanar-overlap", "Of faces in one plane, the first in the file is seen, on every machine", coplanar),
        case(
            "nearly-coplanar",
            "Faces 2^-12 to 2^-26 of the scene apart: the nearer is seen where the grid tells them apart",
            nearly_coplanar,
        ),
        case(
            "t-junctions",
            "Edges that end in the middle of others: a crack is no wider than the grid's rounding",
            t_junctions,
        ),
        case("duplicates", "A thousand copies of every triangle: the first is seen", duplicates),
        Case {
            chips: false,
            ..case("million-in-one-place", "A million triangles in a thousandth of the scene", million)
        },
        case(
            "vanishing-mesh",
            "Closed globes of 288 triangles, from a tenth of the scene down to a hundred-thousandth",
            vanishing,
        ),
    ]
}

/// Seen straight from before, the light beside the eye.
fn front() -> Scene {
    Scene::seen(v(0.0, 0.0, 3.0), v(0.0, 0.0, 0.0)).light(v(1.0, 1.0, 3.0), 0.9).matt(v(0.7, 0.6, 0.5))
}

/// A wall cut along lines that run from side to side: every other strip is thinner than wide by the aspect.
fn slivers(aspect: f64) -> Subject {
    let mut scene = front();
    let thin = 2.0 / aspect;
    let strips = 16;
    let mut y = -0.8;
    let step = 1.6 / f64::from(strips);
    for _ in 0..strips {
        scene = scene.quad(v(-1.0, y, 0.0), v(2.0, 0.1, 0.0), v(0.0, thin, 0.0));
        scene = scene.quad(v(-1.0, y + thin, 0.0), v(2.0, 0.1, 0.0), v(0.0, step - thin, 0.0));
        y += step;
    }
    scene.done()
}

fn needle_fan() -> Subject {
    let count = 2048u32;
    let rim = |i: u32| {
        let angle = core::f64::consts::TAU * f64::from(i) / f64::from(count);
        v(libm::cos(angle), libm::sin(angle), 0.0)
    };
    let points = [DVec3::ZERO].into_iter().chain((0..count).map(rim));
    front().mesh(points, (0..count).map(|i| [0, 1 + i, 1 + (i + 1) % count])).done()
}

/// Steps down towards a corner: each is a quarter of the one before, in a plane a little nearer.
fn edge_lengths() -> Subject {
    let mut scene = front();
    for halvings in 0..29 {
        let side = libm::ldexp(2.0, -halvings);
        scene = scene.triangle(v(-1.0, -1.0, 0.0), v(side - 1.0, -1.0, 0.0), v(-1.0, side - 1.0, 0.0));
    }
    scene.matt(v(0.2, 0.3, 0.8)).triangle(v(1.0, 1.0, 0.0), v(-1.0, 1.0, 0.0), v(1.0, -1.0, 0.0)).done()
}

fn coplanar() -> Subject {
    let colours = [v(0.9, 0.2, 0.2), v(0.2, 0.9, 0.2), v(0.2, 0.2, 0.9)];
    (0..3u8)
        .fold(front(), |scene, i| {
            let shift = f64::from(i) * 0.4 - 0.9;
            scene.matt(colours[usize::from(i)]).quad(v(shift, shift, 0.0), v(1.0, 0.0, 0.0), v(0.0, 1.0, 0.0))
        })
        .done()
}

fn nearly_coplanar() -> Subject {
    let mut scene = front();
    for (i, halvings) in [12, 16, 20, 23, 26].into_iter().enumerate() {
        let x = i as f64 * 0.4 - 1.0;
        let nearer = libm::ldexp(2.0, -halvings);
        scene = scene
            .matt(v(0.9, 0.1, 0.1))
            .quad(v(x, -0.5, 0.0), v(0.35, 0.0, 0.0), v(0.0, 1.0, 0.0))
            .matt(v(0.1, 0.8, 0.2))
            .quad(v(x, -0.5, nearer), v(0.35, 0.0, 0.0), v(0.0, 1.0, 0.0));
    }
    scene.done()
}

/// Below one edge, above many: none of the many ends where the one does, and it is level on no grid.
fn t_junctions() -> Subject {
    let (left, right) = (v(-1.0, -0.137, 0.0), v(1.0, 0.211, 0.0));
    let down = v(0.0, -0.6, 0.0);
    let many = 37u32;
    let on_edge = |i: u32| left + (right - left) * (f64::from(i) / f64::from(many));
    let points = (0..=many).flat_map(|i| [on_edge(i), on_edge(i) - down]);
    let strips = (0..many).flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 3], [2 * i, 2 * i + 3, 2 * i + 1]]);
    front().mesh(points, strips).mesh([left, left + down, right + down, right], [[0, 1, 2], [0, 2, 3]]).done()
}

fn duplicates() -> Subject {
    let scene = front()
        .matt(v(0.8, 0.2, 0.2))
        .mesh([v(-1.0, -0.8, 0.0), v(1.0, -0.8, 0.0), v(1.0, 0.8, 0.0), v(-1.0, 0.8, 0.0)], [[0, 1, 2], [0, 2, 3]]);
    let copy = [[0u32, 1, 2], [0, 2, 3]];
    scene
        .matt(v(0.2, 0.8, 0.2))
        .mesh([v(-1.0, -0.8, 0.0), v(1.0, -0.8, 0.0), v(1.0, 0.8, 0.0), v(-1.0, 0.8, 0.0)], (0..500).flat_map(|_| copy))
        .done()
}

fn million() -> Subject {
    let side = 708u32;
    let at = |i: u32, j: u32| {
        let [x, z] = [i, j].map(|c| f64::from(c) / f64::from(side) - 0.5);
        v(x, 0.1 * libm::sin(40.0 * x) * libm::cos(40.0 * z), z) * 1e-3
    };
    let points = (0..=side).flat_map(|j| (0..=side).map(move |i| at(i, j)));
    let row = side + 1;
    let cells = (0..side).flat_map(|j| (0..side).map(move |i| j * row + i));
    Scene::seen(v(0.0, 1.2e-3, 1.2e-3), v(0.0, 0.0, 0.0))
        .sun(v(-0.3, -1.0, -0.4), 0.9)
        .matt(v(0.7, 0.6, 0.5))
        .mesh(points, cells.flat_map(|a| [[a, a + row, a + row + 1], [a, a + row + 1, a + 1]]))
        .matt(v(0.3, 0.3, 0.6))
        .ground(v(0.0, -0.001, 0.0), 0.5)
        .done()
}

fn vanishing() -> Subject {
    let globe = |scene: Scene, i: u32| {
        let radius = 0.2 * libm::pow(10.0, -f64::from(i));
        scene.globe(v(-0.8 + 0.4 * f64::from(i), 0.0, 0.0), radius, 9)
    };
    (0..5).fold(front(), globe).done()
}
