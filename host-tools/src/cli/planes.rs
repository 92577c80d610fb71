//! `intray render` and `intray emulate` with `--kernel planes12`: spheres in the words of 1994.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use firmware_rt::board::Board;
use planes_rt::blob::KERNEL;
use planes_simd::Lockstep;
use serde::Serialize;

use super::emulate::Shown;
use super::failure::{Failure, warn};
use super::input::{SceneArguments, ThreadArguments};
use super::{output, progress};
use crate::emulate::counter::Counter;
use crate::emulate::machine::Machine;
use crate::emulate::{EmulateError, Outcome, Run, planes as firmware, room};
use crate::model::Model;
use crate::planes::scene::{Options, Planes};
use crate::planes::{self, Way};
use crate::prepare::transfer;

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

/// A scene in the kernel's words, and the model that it was made from. Warnings go to stderr.
pub(super) fn prepare(scene: &SceneArguments) -> Result<(Planes, Model), Failure> {
    let model = scene.model_for_planes()?;
    let planes = Planes::new(&model, &Options::default())
        .map_err(|error| Failure::input(format!("{}: {error}", scene.scene.display())))?;
    planes.warnings.iter().for_each(warn);
    Ok((planes, model))
}

pub(super) fn render(
    scene: &SceneArguments,
    threads: &ThreadArguments,
    path: &Path,
    as_json: bool,
) -> Result<(), Failure> {
    let (planes, model) = prepare(scene)?;
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

/// What an emulation is asked for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Emulation<'a> {
    pub(super) scene: &'a SceneArguments,
    pub(super) board: &'static Board,
    pub(super) path: &'a Path,
    pub(super) limit: Duration,
    pub(super) as_json: bool,
}

/// The answer of a board.
#[derive(Debug, Serialize)]
struct Emulated {
    board: &'static str,
    chip: &'static str,
    kernel: &'static str,
    width: u32,
    height: u32,
    /// CRC-32 of the RGB888 bytes, which are the host's.
    image_crc32: String,
    spheres: usize,
    generations: u16,
    /// Rays that look for a sphere.
    rays: u64,
    primary_rays: u64,
    reflection_rays: u64,
    /// There is neither a tree nor a triangle.
    box_tests: u64,
    triangle_tests: u64,
    /// From the first camera ray of each tile to its last pixel; none where they cannot be counted.
    instructions: Option<u64>,
    instructions_per_ray: Option<f64>,
    instructions_per_pixel: Option<f64>,
    /// Checking the blob, sending, start and end.
    instructions_apart: Option<u64>,
    /// Code and constants.
    text_bytes: u64,
    /// The blob.
    scene_bytes: u64,
    /// Variables, and the stack at its deepest.
    ram_bytes: u64,
    stack_bytes: u64,
    elf: PathBuf,
}

pub(super) fn emulate(wanted: Emulation<'_>) -> Result<(), Failure> {
    let Emulation { scene, board, path, limit, as_json } = wanted;
    let (planes, model) = prepare(scene)?;
    let traced = planes.scene()?;
    let blob = planes::blob::blob(&traced, &planes.place(), transfer(model.render.transfer));
    let failure = |error: EmulateError| match error {
        error if error.is_input() => Failure::input(format!("{}: {error}", scene.scene.display())),
        error => Failure::check(error.to_string()),
    };
    let bytes = blob.bytes();
    room(board, firmware::place(board, KERNEL), bytes.len() as u64, || "fewer spheres".into()).map_err(failure)?;
    let machine = Machine::of(board)?;
    machine.version().map_err(failure)?;
    let spinner = progress::spinner("building the firmware");
    let elf = firmware::provide(board).map_err(failure)?;
    let counter = Counter::provide(&machine);
    spinner.finish_and_clear();
    let counter = counter.inspect_err(|reason| warn(format_args!("instructions are not counted: {reason}"))).ok();
    let [width, height] = model.render.size;
    let pixels = u64::from(width) * u64::from(height);
    let bar = progress::bar("rendering", pixels);
    let run = Run { board, elf: &elf, blob: Some(bytes), counter: counter.as_ref(), limit };
    let outcome = run.perform(&mut Shown { bar: &bar, is_logged: true });
    bar.finish_and_clear();
    let Outcome { picture, report, counts } = outcome.map_err(failure)?;
    let light = planes::light(&traced, Way::Pixels, &|_| ());
    let host = planes::picture(&traced, &light, model.render.transfer);
    if host != picture {
        let (first, second) = (host.crc32(), picture.crc32());
        return Err(failure(EmulateError::Unequal { board: board.name, first, second }));
    }
    picture.write_png(path)?;
    let lookups = planes::lookups(&traced);
    let primary = lookups.first().copied().unwrap_or_default();
    let reflected: u64 = lookups.iter().skip(1).sum();
    let rays = primary + reflected;
    let instructions = counts.as_ref().map(|counts| counts.instructions);
    let report = Emulated {
        board: board.name,
        chip: board.chip,
        kernel: planes::NAME,
        width,
        height,
        image_crc32: format!("{:08x}", picture.crc32()),
        spheres: traced.spheres().len(),
        generations: traced.settings().generations,
        rays,
        primary_rays: primary,
        reflection_rays: reflected,
        box_tests: 0,
        triangle_tests: 0,
        instructions,
        instructions_per_ray: instructions.map(|count| count as f64 / rays as f64),
        instructions_per_pixel: instructions.map(|count| count as f64 / pixels as f64),
        instructions_apart: counts.map(|counts| counts.run.instructions.saturating_sub(counts.instructions)),
        text_bytes: elf.text_bytes,
        scene_bytes: bytes.len() as u64,
        ram_bytes: elf.static_bytes + u64::from(report.stack_bytes),
        stack_bytes: report.stack_bytes.into(),
        elf: elf.path().into(),
    };
    if as_json { output::json(&report) } else { output::line(&emulated(path, &report)) }
}

fn emulated(path: &Path, report: &Emulated) -> String {
    let instructions = match (report.instructions, report.instructions_per_ray, report.instructions_per_pixel) {
        (Some(all), Some(ray), Some(pixel)) => format!("{all} instructions, {ray:.0} a ray and {pixel:.0} a pixel"),
        _ => "instructions not counted".into(),
    };
    format!(
        "{}: {}x{} by {} on {} ({}), {} spheres and {} generations, {} rays: {instructions}, CRC-32 {}, the host's\n\
         flash {} bytes of code and {} of scene; RAM {} bytes, {} of them stack\n\
         {}",
        path.display(),
        report.width,
        report.height,
        report.kernel,
        report.board,
        report.chip,
        report.spheres,
        report.generations,
        report.rays,
        report.image_crc32,
        report.text_bytes,
        report.scene_bytes,
        report.ram_bytes,
        report.stack_bytes,
        report.elf.display(),
    )
}
