//! The camera's coefficients: `docs/BLOB.md` says what they are of.

use core_rt::camera::CameraHeader;
use core_rt::kernel::Kernel;
use glam::DVec3;

use crate::grid::Grid;
use crate::model::{Model, Projection};
use crate::plane::Plane;

/// Bits below a direction's unit in camera coefficients: at 2^14 pixels a side, the rounding of a step adds up to a
/// quarter of a unit.
const FRACTION_BITS: u8 = 16;

/// How many lengths of the direction of parallel rays are tried.
const LENGTHS: i64 = 1 << 12;

/// The camera for the model's picture size and number of samples.
pub(crate) fn camera<K: Kernel>(model: &Model, grid: &Grid) -> CameraHeader {
    match model.camera.projection {
        Projection::Perspective { fov_y } => perspective::<K>(model, fov_y, grid),
        Projection::Orthographic { height } => parallel::<K>(model, &Plane::new(model, height), grid),
    }
}

/// Whether samples are anywhere in their pixel, and not one in its middle.
fn is_sampled(model: &Model) -> bool {
    model.render.samples > 1 || model.render.paths
}

/// Whether steps are taken along an axis of so many pixels. In a picture of one column (or row) with one sample in its middle
/// none is, and a wide view's would not fit.
fn takes_steps(model: &Model, pixels: f64) -> bool {
    pixels > 1.0 || is_sampled(model)
}

/// Rays from the eye, by a vertical field of view in radians.
fn perspective<K: Kernel>(model: &Model, fov_y: f64, grid: &Grid) -> CameraHeader {
    let camera = &model.camera;
    let forward = (camera.look_at - camera.position).normalize();
    let right = forward.cross(camera.up).normalize();
    let up = right.cross(forward);
    let [width, height] = model.render.size.map(f64::from);
    // The half extents of the picture at distance 1, and a pixel's share of them.
    let half_height = libm::tan(fov_y / 2.0);
    let pixel = 2.0 * half_height / height;
    let first = forward + right * (pixel * (1.0 - width) / 2.0) - up * (pixel * (1.0 - height) / 2.0);
    let step = |direction: DVec3, pixels| if takes_steps(model, pixels) { direction * pixel } else { DVec3::ZERO };
    let (step_right, step_down) = (step(right, width), step(-up, height));

    // The largest component of any direction; it is at a corner, since directions are linear in the place. Samples are
    // anywhere in their pixel.
    let out = if is_sampled(model) { 0.5 } else { 0.0 };
    let (last_x, last_y) = (width - 1.0 + out, height - 1.0 + out);
    let largest = [(-out, -out), (last_x, -out), (-out, last_y), (last_x, last_y)]
        .map(|(x, y)| (first + step_right * x + step_down * y).abs().max_element())
        .into_iter()
        .fold(0.0, f64::max);
    // Two units are left for the rounding of coefficients and of directions.
    let unit = ((1i64 << K::DIRECTION_BITS) - 2) as f64 / largest * f64::from(1u32 << FRACTION_BITS);
    CameraHeader {
        eye: grid.place(camera.position),
        along: [0; 3],
        first: rounded(first * unit),
        right: rounded(step_right * unit),
        down: rounded(step_down * unit),
        fraction_bits: FRACTION_BITS,
    }
}

/// Parallel rays from a plane.
fn parallel<K: Kernel>(model: &Model, plane: &Plane, grid: &Grid) -> CameraHeader {
    let [width, height] = model.render.size.map(f64::from);
    let pixel = 2.0 * plane.half[1] / height;
    let first = plane.right * (pixel * (1.0 - width) / 2.0) - plane.up * (pixel * (1.0 - height) / 2.0);
    let step = |direction: DVec3, pixels| if takes_steps(model, pixels) { direction * pixel } else { DVec3::ZERO };
    // Origins are counted from a grid point, so that the coefficients have what it is off by. The word has a sign and
    // holds twice the largest origin.
    let eye = grid.place(plane.middle);
    let off = (plane.middle - grid.origin) * grid.scale - DVec3::from_array(eye.map(f64::from));
    let word_bits = 8 * size_of::<K::Word>() as u32;
    let fraction_bits = FRACTION_BITS.min((word_bits - 3 - K::GRID_BITS) as u8);
    let unit = f64::from(1u32 << fraction_bits);
    CameraHeader {
        eye,
        along: along::<K>(plane.forward),
        first: rounded((first * grid.scale + off) * unit),
        right: rounded(step(plane.right, width) * grid.scale * unit),
        down: rounded(step(-plane.up, height) * grid.scale * unit),
        fraction_bits,
    }
}

/// A direction of all rays in whole numbers: of many lengths, the one that rounding turns the least.
fn along<K: Kernel>(forward: DVec3) -> [i32; 3] {
    let longest = (1i64 << K::DIRECTION_BITS) - 1;
    let shortest = (longest / 2 + 1).max(longest - LENGTHS + 1);
    let mut best = (f64::INFINITY, [0; 3]);
    for length in (shortest..=longest).rev() {
        let whole = rounded(forward * (length as f64 / forward.abs().max_element()));
        let turned = DVec3::from_array(whole.map(|c| c as f64)).normalize().cross(forward).length();
        if turned < best.0 {
            best = (turned, whole);
        }
    }
    best.1.map(|c| c as i32)
}

fn rounded(v: DVec3) -> [i64; 3] {
    v.to_array().map(|c| (c + 0.5).floor() as i64)
}
