//! What each study varies, and what it is called.

use crate::report::row::{Measured, Point, Study};

use super::cost::Measure;
use super::metric::pixel_count;

/// All studies, in the order of the page.
pub(super) const STUDIES: [Study; 10] = [
    Study::Kernels,
    Study::Triangles,
    Study::Size,
    Study::Samples,
    Study::Depth,
    Study::C,
    Study::D,
    Study::E,
    Study::Leaf,
    Study::Grid,
];

/// Its heading.
pub(super) fn title(study: Study) -> &'static str {
    match study {
        Study::Kernels => "Kernels as they come",
        Study::C => "C: bits that the box test's reciprocals gain",
        Study::D => "D: bits that the box test's differences lose",
        Study::E => "E: bits that edges over the normal gain",
        Study::Leaf => "Triangles of a leaf",
        Study::Grid => "Bits of the grid",
        Study::Samples => "Camera rays a pixel",
        Study::Depth => "How often a ray may go on",
        Study::Size => "Pixels",
        Study::Triangles => "Triangles, by decimation",
    }
}

/// What stands along its axis.
pub(super) fn axis(study: Study) -> &'static str {
    match study {
        Study::Kernels => "kernel",
        Study::C => "C",
        Study::D => "D",
        Study::E => "E",
        Study::Leaf => "most triangles of a leaf",
        Study::Grid => "bits of the grid",
        Study::Samples => "camera rays a pixel",
        Study::Depth => "depth",
        Study::Size => "pixels",
        Study::Triangles => "triangles and spheres",
    }
}

/// How its costs are compared. f32 in the same run has a study's samples and depth, so that a ratio would hide their cost.
pub(super) fn measure(study: Study) -> Measure {
    match study {
        Study::Samples | Study::Depth | Study::Size | Study::Triangles => Measure::Total,
        _ => Measure::Relative,
    }
}

/// What a study varies, of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Varied {
    /// A number on a scale.
    Amount(f64),
    /// A setting, one of few; `None` where the kernel or the tree builder decides. `None` is after all numbers.
    Setting(Option<u32>),
}

/// What a study varies, and how far; `None` for [`Study::Kernels`], and for an amount that is known of drawn points alone.
pub(super) fn varied(study: Study, point: &Point, measured: Option<&Measured>) -> Option<Varied> {
    Some(match study {
        Study::Kernels => return None,
        Study::C => Varied::Setting(point.knobs[0].map(u32::from)),
        Study::D => Varied::Setting(point.knobs[1].map(u32::from)),
        Study::E => Varied::Setting(point.knobs[2].map(u32::from)),
        Study::Leaf => Varied::Setting(point.leaf),
        Study::Grid => Varied::Setting(point.grid_bits),
        Study::Samples => Varied::Setting(Some(point.samples)),
        Study::Depth => Varied::Setting(Some(point.depth)),
        Study::Size => Varied::Amount(pixel_count(point) as f64),
        Study::Triangles => Varied::Amount(measured?.primitives as f64),
    })
}

/// A point without what its study varies, and without the machine.
pub(super) fn unvaried(point: &Point) -> Point {
    let mut rest = Point { machine: crate::report::row::Machine::Host, ..point.clone() };
    match point.study {
        Study::Kernels => rest.kernel = String::new(),
        Study::C => rest.knobs[0] = None,
        Study::D => rest.knobs[1] = None,
        Study::E => rest.knobs[2] = None,
        Study::Leaf => rest.leaf = None,
        Study::Grid => rest.grid_bits = None,
        Study::Samples => rest.samples = 0,
        Study::Depth => rest.depth = 0,
        Study::Size => rest.size = [0, 0],
        Study::Triangles => rest.triangles = None,
    }
    rest
}

/// What a setting that nobody set is called.
pub(super) fn unset(study: Study) -> &'static str {
    if study == Study::Leaf { "by cost" } else { "own" }
}
