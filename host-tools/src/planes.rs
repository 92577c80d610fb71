//! Pictures by the tracer of Pixel-Planes 5 ([`planes_rt`]): a model's spheres in its words, and all cores.
//!
//! What it knows is less than what other kernels do: spheres, one light without shadows, diffuse and mirrored shares. The
//! rest of a model is refused where leaving it out would show another scene, and said where it shows the same one plainer.

pub mod blob;
pub mod engine;
pub mod scene;
mod stage;
pub mod trace;

use planes_rt::colour::{Light, encode};
use planes_rt::pixel;
use planes_rt::scene::Scene;
use planes_simd::Lockstep;
use rayon::prelude::*;

use crate::model;
use crate::picture::Picture;
use crate::prepare::transfer;
use crate::render::Progress;

/// The kernel's name.
pub const NAME: &str = "planes12";

/// Lanes of a tile.
const LANES: usize = 32;
/// How many of them are side by side.
const ACROSS: u16 = 8;

/// How pixels are taken. Pictures are the same.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// One after the other.
    Pixels,
    /// Tiles in lockstep.
    Lanes(Lockstep),
}

/// The light of all pixels, row by row, on the threads of the current rayon pool.
pub fn light(scene: &Scene<'_>, way: Way, progress: Progress<'_>) -> Vec<Light> {
    let [width, height] = scene.settings().size;
    let rows = if way == Way::Pixels { 1 } else { LANES as u16 / ACROSS };
    let mut light = vec![[0; 3]; usize::from(width) * usize::from(height)];
    let bands = light.par_chunks_mut(usize::from(width) * usize::from(rows));
    (0..height).into_par_iter().step_by(rows.into()).zip(bands).for_each(|(y, band)| {
        match way {
            Way::Pixels => (0..width).zip(&mut *band).for_each(|(x, light)| *light = pixel::trace(scene, [x, y])),
            Way::Lanes(unit) => tiles(scene, unit, y, band),
        }
        progress(band.len() as u64);
    });
    light
}

/// Rows of pixels from `y` on, as many as a tile has or as are left.
fn tiles(scene: &Scene<'_>, unit: Lockstep, y: u16, band: &mut [Light]) {
    let width = scene.settings().size[0];
    for x in (0..width).step_by(ACROSS.into()) {
        let pixels: [[u16; 2]; LANES] =
            std::array::from_fn(|lane| [x + lane as u16 % ACROSS, y + lane as u16 / ACROSS]);
        for ([column, row], light) in pixels.into_iter().zip(unit.trace(scene, &pixels)) {
            let place = usize::from(row - y) * usize::from(width) + usize::from(column);
            if column < width
                && let Some(pixel) = band.get_mut(place)
            {
                *pixel = light;
            }
        }
    }
}

/// How many rays look for a sphere, generation by generation. Of a ray of which nothing is seen there is no next one.
#[must_use]
pub fn lookups(scene: &Scene<'_>) -> Vec<u64> {
    let [width, height] = scene.settings().size;
    let none = || vec![0; scene.settings().generations.into()];
    let of_row = |y| {
        let mut counts: Vec<u64> = none();
        for (x, sample) in (0..width).flat_map(|x| scene.samples().map(move |sample| (x, sample))) {
            let mut lookups = 1;
            pixel::trace_telling(scene, [x, y], sample, |met| lookups += usize::from(met.is_seen));
            counts.iter_mut().take(lookups).for_each(|count| *count += 1);
        }
        counts
    };
    let sum = |a: Vec<u64>, b: Vec<u64>| a.into_iter().zip(b).map(|(a, b)| a + b).collect();
    (0..height).into_par_iter().map(of_row).reduce(none, sum)
}

/// Light as a picture.
#[must_use]
pub fn picture(scene: &Scene<'_>, light: &[Light], encoding: model::Transfer) -> Picture {
    let [width, height] = scene.settings().size;
    let mut picture = Picture::new(width.into(), height.into());
    for (pixel, light) in picture.pixels_mut().iter_mut().zip(light) {
        *pixel = encode(*light, transfer(encoding));
    }
    picture
}
