//! `intray render`: a scene becomes a PNG.

use std::path::PathBuf;
use std::time::Instant;

use serde::Serialize;

use super::failure::Failure;
use super::input::{SceneArguments, ThreadArguments};
use super::load::Scene;
use super::{output, progress};
use crate::files;
use crate::render::{Rendered, TILE};

/// Render a scene to a PNG
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// Where the picture goes
    #[arg(short, value_name = "PNG")]
    output: PathBuf,

    #[command(flatten)]
    threads: ThreadArguments,

    /// Without the vector units that exact29 uses by itself; the picture is the same
    #[arg(long)]
    plain: bool,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// The answer.
#[derive(Debug, Serialize)]
struct Report {
    kernel: &'static str,
    width: u32,
    height: u32,
    /// CRC-32 of the RGB888 bytes.
    image_crc32: String,
    rays: Rays,
    box_tests: u64,
    triangle_tests: u64,
    threads: usize,
    /// The vector units that were used.
    simd: Option<&'static str>,
    /// Of rendering alone.
    seconds: f64,
}

#[derive(Debug, Serialize)]
struct Rays {
    primary: u64,
    shadow: u64,
    reflection: u64,
    refraction: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    files::check_writable(&arguments.output)?;
    if arguments.scene.is_planes() {
        return super::planes::render(&arguments.scene, &arguments.threads, &arguments.output, arguments.json);
    }
    let scene = arguments.scene.load()?;
    let pool = arguments.threads.pool()?;
    let begin = Instant::now();
    let Rendered { picture, counts } = pool.install(|| picture(&scene, arguments.plain))?;
    let seconds = begin.elapsed().as_secs_f64();
    picture.write_png(&arguments.output)?;
    let report = Report {
        kernel: scene.engine.name(),
        width: picture.width(),
        height: picture.height(),
        image_crc32: format!("{:08x}", picture.crc32()),
        rays: Rays {
            primary: counts.primary_rays,
            shadow: counts.shadow_rays,
            reflection: counts.reflection_rays,
            refraction: counts.refraction_rays,
        },
        box_tests: counts.box_tests,
        triangle_tests: counts.triangle_tests,
        threads: pool.current_num_threads(),
        simd: scene.engine.lanes().filter(|_| !arguments.plain),
        seconds,
    };
    if arguments.json {
        return output::json(&report);
    }
    let per_ray = |tests: u64| tests as f64 / counts.rays().max(1) as f64;
    output::line(&format!(
        "{}: {}x{} by {}, {} rays in {:.2} s on {} threads, {:.1} box and {:.1} triangle tests a ray, CRC-32 {}",
        arguments.output.display(),
        report.width,
        report.height,
        report.kernel,
        counts.rays(),
        seconds,
        report.threads,
        per_ray(counts.box_tests),
        per_ray(counts.triangle_tests),
        report.image_crc32
    ))
}

/// Renders with a progress bar; `is_plain` says without vector units.
pub(super) fn picture(scene: &Scene, is_plain: bool) -> Result<Rendered, Failure> {
    let (header, _) = scene.engine.inspect(scene.blob.bytes())?;
    let bar = progress::bar("rendering", header.size.map(u64::from).iter().product());
    let (blob, progress) = (scene.blob.bytes(), |pixels| bar.inc(pixels));
    let rendered = if is_plain {
        scene.engine.render(blob, TILE, &progress)?
    } else {
        scene.engine.render_in_lanes(blob, TILE, &progress)?
    };
    bar.finish_and_clear();
    Ok(rendered)
}
