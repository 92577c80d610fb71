//! Pixels in which rounding decides what is seen: surfaces lie in one plane there, or an edge goes through the middle.

use host_tools::model::Model;
use host_tools::reference::{Reference, encode};

/// Whether two surfaces lie in one place at a pixel's centre: within 2^-26 of the distance, about what the 29-bit grid
/// resolves.
#[must_use]
pub fn is_tie(model: &Model, reference: &Reference<'_>, x: u32, y: u32) -> bool {
    let (origin, direction) = reference.camera_ray(model.render.size, f64::from(x) + 0.5, f64::from(y) + 0.5);
    reference.candidates(origin, direction, 1.0 / f64::from(1 << 26)).len() > 1
}

/// Whether the reference itself changes as much within 2^-14 of a pixel: an edge, or a shadow's, goes through the very
/// middle of it. A unit of the 29-bit grid is 2^-19 of a pixel in a picture 1024 wide.
#[must_use]
pub fn is_on_an_edge(reference: &Reference<'_>, model: &Model, x: u32, y: u32) -> bool {
    let gray = |dx: f64, dy: f64| -> i32 {
        let (x, y) = (f64::from(x) + 0.5 + dx, f64::from(y) + 0.5 + dy);
        let (origin, direction) = reference.camera_ray(model.render.size, x, y);
        let seen = encode(reference.sample(origin, direction).colour, model.render.transfer);
        seen.map(i32::from).iter().sum()
    };
    let step = 1.0 / f64::from(1 << 14);
    let here = gray(0.0, 0.0);
    [(step, 0.0), (-step, 0.0), (0.0, step), (0.0, -step)].iter().any(|&(dx, dy)| (gray(dx, dy) - here).abs() > 64)
}
