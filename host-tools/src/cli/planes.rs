//! `intray render --kernel planes12`: spheres in the words of 1994.

use std::path::Path;
use std::time::Instant;

use planes_simd::Lockstep;
use serde::Serialize;

use super::failure::{Failure, warn};
use super::input::{SceneArguments, ThreadArguments};
use super::{output, progress};
use crate::planes::scene::{Options, Planes};
use crate::planes::{self, Way};

/// The answer.
#[derive(Debug, Serialize)]
struct Report {
    kernel: &'static str,
    width: u32,
    height: u32,
    /// CRC-32 of the RGB888 bytes.
    image_crc32: String,
    spheres: usize,
    generations: u16,
    /// What the lanes were traced with.
    unit: &'static str,
    threads: usize,
    /// Of rendering alone.
    seconds: f64,
}

pub(super) fn render(
    scene: &SceneArguments,
    threads: &ThreadArguments,
    path: &Path,
    as_json: bool,
) -> Result<(), Failure> {
    let model = scene.model_for_planes()?;
    let planes = Planes::new(&model, &Options::default())
        .map_err(|error| Failure::input(format!("{}: {error}", scene.scene.display())))?;
    planes.warnings.iter().for_each(warn);
    let traced = planes.scene()?;
    let (pool, unit) = (threads.pool()?, Lockstep::detected());
    let [width, height] = model.render.size;
    let bar = progress::bar("rendering", u64::from(width) * u64::from(height));
    let begin = Instant::now();
    let light = pool.install(|| planes::light(&traced, Way::Lanes(unit), &|pixels| bar.inc(pixels)));
    let seconds = begin.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let picture = planes::picture(&traced, &light, model.render.transfer);
    picture.write_png(path)?;
    let report = Report {
        kernel: planes::NAME,
        width,
        height,
        image_crc32: format!("{:08x}", picture.crc32()),
        spheres: traced.spheres().len(),
        generations: traced.settings().generations,
        unit: unit.name(),
        threads: pool.current_num_threads(),
        seconds,
    };
    if as_json {
        return output::json(&report);
    }
    output::line(&format!(
        "{}: {width}x{height} by {}, {} spheres and {} generations in {seconds:.2} s on {} threads ({}), CRC-32 {}",
        path.display(),
        report.kernel,
        report.spheres,
        report.generations,
        report.threads,
        report.unit,
        report.image_crc32,
    ))
}
