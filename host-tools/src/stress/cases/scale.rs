//! Relative scale.

use super::{benign, objects, table};
use crate::stress::shapes::{Scene, v};
use crate::stress::{Case, Group, Subject};

const fn case(name: &'static str, expectation: &'static str, subject: fn() -> Subject) -> Case {
    Case::new(Group::Scale, name, expectation, subject)
}

pub(super) fn cases() -> Vec<Case> {
    // A sun that is 60 degrees high, or a lamp about as high as the scene is wide: shadows fall no farther than that.
    vec![
        case(super::BENIGN, "Nothing is difficult: every kernel is within its bound", || benign().done()),
        Case {
            part_grids: true,
            ..case(
                "ground-1e4",
                "Objects of size 1 on a ground of 10,000: a unit of 14 bits is the size of the objects' halves",
                || ground(1e4),
            )
        },
        Case {
            part_grids: true,
            ..case(
                "ground-1e6",
                "Objects of size 1 on a ground of 1,000,000: only 29 bits tell their faces apart",
                || ground(1e6),
            )
        },
        Case {
            part_grids: true,
            ..case(
                "sun-as-a-point",
                "A point light at the distance of the sun in metres, 1.5e11: a light takes the grid's bits, whatever the kernel",
                || table(seen().light(v(0.5e11, 1.3e11, 0.6e11), 0.8)).done(),
            )
        },
        case("sun-as-a-direction", "The same sun as a direction costs nothing", || {
            table(seen().sun(v(-0.5, -1.3, -0.6), 0.8)).done()
        }),
        case("tiny-far-away", "A scene of size 0.004 at 1,000 from the origin: the grid is where the scene is", || {
            benign().placed(1e-3, v(1000.0, -1000.0, 1000.0)).done()
        }),
        Case {
            part_grids: true,
            ..case(
                "tiny-beside-large",
                "An object of size 0.001 seen close, and another of size 1000 behind: the grid spans both",
                || {
                    let small = objects(seen().sun(v(-0.5, -1.3, -0.6), 0.8)).placed(1e-3, v(0.0, 0.0, 0.0));
                    small.matt(v(0.6, 0.6, 0.2)).block(v(-500.0, -500.0, -1100.0), v(500.0, 500.0, -100.0)).done()
                },
            )
        },
        case("scale-1e-12", "The benign scene in units of 10^-12", || benign().placed(1e-12, v(0.0, 0.0, 0.0)).done()),
        case("scale-1e12", "The benign scene in units of 10^12", || benign().placed(1e12, v(0.0, 0.0, 0.0)).done()),
        case("offset-1e9", "The benign scene 10^9 from the origin: f64 has 2^-23 there", || {
            benign().placed(1.0, v(1e9, 1e9, -1e9)).done()
        }),
        case("offset-1e9-micro", "The same of size 10^-6: f64 itself does not tell its points apart", || {
            benign().placed(1e-6, v(1e9, 1e9, -1e9)).done()
        }),
    ]
}

fn seen() -> Scene {
    Scene::seen(v(1.5, 2.0, 4.0), v(0.0, 0.4, 0.0))
}

fn ground(half: f64) -> Subject {
    objects(seen().sun(v(-0.5, -1.3, -0.6), 0.8).matt(v(0.5, 0.5, 0.4)).ground(v(0.0, 0.0, 0.0), half)).done()
}
