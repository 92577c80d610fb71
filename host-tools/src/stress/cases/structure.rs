//! Trees.

use core_rt::bvh::Child;

use super::benign;
use crate::stress::shapes::{Scene, v};
use crate::stress::{Case, Group, Subject};

const fn case(name: &'static str, expectation: &'static str, subject: fn() -> Subject) -> Case {
    Case::new(Group::Structure, name, expectation, subject)
}

pub(super) fn cases() -> Vec<Case> {
    vec![
        case("one-triangle", "A tree without a node", one_triangle),
        case("none-visible", "All of the scene is behind the camera", none_visible),
        Case { leaf: Some(1), ..case(super::DEEPEST, "Triangles that the tree can only take off one by one", deepest) },
        case("equal-centroids", "500 triangles around one middle, which no plane separates", equal_centroids),
        Case { leaf: Some(1), ..case("leaf-of-1", "The benign scene, a triangle a leaf", || benign().done()) },
        Case {
            leaf: Some(Child::COUNT_MAX),
            ..case("leaf-of-most", "The benign scene, as many triangles a leaf as a blob holds", || benign().done())
        },
    ]
}

fn front() -> Scene {
    Scene::seen(v(0.0, 0.0, 3.0), v(0.0, 0.0, 0.0)).light(v(1.0, 1.0, 3.0), 0.9).matt(v(0.7, 0.6, 0.5))
}

fn one_triangle() -> Subject {
    front().triangle(v(-1.0, -0.7, 0.1), v(0.9, -0.6, -0.2), v(0.1, 0.8, 0.3)).done()
}

fn none_visible() -> Subject {
    let mut subject = front().block(v(-1.0, -1.0, -1.0), v(1.0, 1.0, 1.0)).done();
    subject.model.camera.look_at = v(0.0, 0.0, 6.0);
    subject
}

/// Towards a corner along three axes in turn, each a fifth as far away as the one before: the tree takes off the farthest,
/// and has what is left nearly as it was.
fn deepest() -> Subject {
    let mut scene = front();
    for i in 0..84 {
        let size = libm::pow(0.5, f64::from(i / 3));
        let (along, side) = (size, size * 0.2);
        let corner = match i % 3 {
            0 => v(along, 0.0, 0.0),
            1 => v(0.0, along, 0.0),
            _ => v(0.0, 0.0, along),
        };
        let corner = corner - v(0.5, 0.5, 0.5);
        scene = scene.triangle(corner, corner + v(side, 0.1 * side, 0.0), corner + v(0.0, side, -0.2 * side));
    }
    scene.done()
}

fn equal_centroids() -> Subject {
    (0..500)
        .fold(front(), |scene, i| {
            let size = 0.8 - f64::from(i) / 700.0;
            // Leaning, so that they go through each other.
            let lean = f64::from(i % 7) * 0.1 - 0.3;
            let [a, b] = [v(-size, -size, -lean * size), v(size, -size, -lean * size)];
            scene.triangle(a, b, -a - b)
        })
        .done()
}
