//! What the vector units bring, and all cores: `exact29` eight children at a time beside scalar `f32` and beside `f32` in the same
//! layout, for the nearest hits of camera rays; and how whole pictures scale with threads, beside a loop that touches no
//! memory.
//!
//! Ways take turns within every round, and a ratio is taken within its round, as in `--bench kernels`. What is printed is the
//! median of the rounds.
//!
//! `cargo bench -p tests --bench host -- [--size N] [--rounds N] [--threads N] [--json] [SCENE…]`

use std::hint::black_box;
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use clap::Parser;
use core_rt::bvh::{Intersect, Waiting};
use core_rt::exact::Exact29;
use core_rt::kernel::{Kernel, NONE};
use core_rt::profile::{Full, Profile};
use core_rt::scene::{MAX_DEPTH, Scene};
use core_rt::stats::NoStats;
use exact_simd::{ByEights, Eights, Tree, Tree32};
use float_rt::Float32;
use host_tools::import;
use host_tools::model::Model;
use host_tools::prepare::{Options, prepare};
use host_tools::render::{TILE, render};
use rayon::ThreadPool;
use rayon::prelude::*;
use serde::Serialize;
use tests::scenes;

/// How it is measured.
#[derive(Debug, Parser)]
struct Arguments {
    /// Width and height of the pictures
    #[arg(long, default_value_t = 384)]
    size: u32,
    /// Rounds; in each, everything is done once
    #[arg(long, default_value_t = 7)]
    rounds: usize,
    /// Threads that whole pictures are drawn by [default: one a core]
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Scenes: .toml or .obj files [default: the shared models that are present, the built-in scene and the gallery]
    scenes: Vec<String>,
    /// Given by cargo
    #[arg(long, hide = true)]
    bench: bool,
}

/// Of one scene: nanoseconds a ray by scalar `f32`, and times as ratios to it.
#[derive(Debug, Serialize)]
struct Row {
    scene: String,
    f32_ns: f64,
    exact29: f64,
    exact29_simd: f64,
    f32_simd: f64,
    exact29_simd_to_f32_simd: f64,
    /// One thread's time by that of all, of the picture.
    scaling: f64,
    /// And of the loop.
    control_scaling: f64,
    scaling_to_control: f64,
}

#[derive(Debug, Serialize)]
struct Report {
    unit: &'static str,
    threads: usize,
    rows: Vec<Row>,
    /// Geometric means.
    mean: Row,
}

/// The camera rays of a picture.
fn rays<P: Profile>(scene: &Scene<'_, P>) -> Vec<<P::Kernel as Kernel>::Ray> {
    let [width, height] = scene.frame.size;
    let places = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    places.filter_map(|[x, y]| scene.primary(&scene.camera, x, y)).collect()
}

/// The hits of rays in the tree as it stands.
#[inline(never)]
fn in_place<P: Profile>(scene: &Scene<'_, P>, rays: &[<P::Kernel as Kernel>::Ray]) -> usize {
    let mut stack = heapless::Vec::<Waiting<P::Kernel>, MAX_DEPTH>::new();
    rays.iter().filter(|ray| scene.bvh.closest(ray, &mut stack, &mut NoStats) != NONE).count()
}

/// Seconds that work takes.
fn seconds<T>(work: impl FnOnce() -> T) -> f64 {
    let begin = Instant::now();
    black_box(work());
    begin.elapsed().as_secs_f64()
}

/// Work without memory: so many parts, each the same.
fn control(parts: usize) -> u64 {
    let part = |seed: usize| (0..1 << 16).fold(seed as u64 | 1, |x: u64, _| (x ^ x >> 7).wrapping_mul(x | 5));
    (0..parts).into_par_iter().map(part).reduce(|| 0, |a, b| a ^ b)
}

/// Medians of the rounds' ratios of two columns.
fn ratio<const N: usize>(rounds: &[[f64; N]], of: usize, to: usize) -> f64 {
    median(rounds.iter().map(|round| round[of] / round[to]).collect())
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn measure(name: &str, model: &Model, arguments: &Arguments, pools: &[ThreadPool; 2]) -> Row {
    let options = Options::default();
    let floats = prepare::<Float32>(model, &options).expect("every kernel holds these scenes").blob;
    let exacts = prepare::<Exact29>(model, &options).expect("every kernel holds these scenes").blob;
    let floats = Scene::<Full<Float32>>::new_checked(floats.bytes()).expect("a blob just made");
    let mut exacts = Scene::<ByEights>::new_checked(exacts.bytes()).expect("a blob just made");
    let (tree, tree32) = (Tree::new(&exacts.bvh), Tree32::new(&floats.bvh));
    let (tree, tree32) = (tree.expect("there are vector units"), tree32.expect("there are vector units"));
    exacts.walk = Eights::new(Some(&tree), &exacts);
    let (float_rays, exact_rays) = (rays(&floats), rays(&exacts));
    let parts = 64 * pools[1].current_num_threads();
    let mut rounds = Vec::new();
    for _ in 0..arguments.rounds.max(1) {
        let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
        let eights = |ray: &&_| tree.closest(&exacts.bvh, ray, &mut stack, &mut NoStats) != NONE;
        let floats_in_eights = |ray: &&_| tree32.closest(&floats.bvh, ray, &mut NoStats) != NONE;
        rounds.push([
            seconds(|| in_place(&floats, &float_rays)),
            seconds(|| in_place(&exacts, &exact_rays)),
            seconds(|| exact_rays.iter().filter(eights).count()),
            seconds(|| float_rays.iter().filter(floats_in_eights).count()),
            pools[0].install(|| seconds(|| render(&exacts, TILE, &|_| {}))),
            pools[0].install(|| seconds(|| control(parts))),
            pools[1].install(|| seconds(|| render(&exacts, TILE, &|_| {}))),
            pools[1].install(|| seconds(|| control(parts))),
        ]);
    }
    let efficiency = |[.., one, control, all, all_control]: &[f64; 8]| (one / all) / (control / all_control);
    Row {
        scene: name.into(),
        f32_ns: median(rounds.iter().map(|round| round[0] / float_rays.len() as f64 * 1e9).collect()),
        exact29: ratio(&rounds, 1, 0),
        exact29_simd: ratio(&rounds, 2, 0),
        f32_simd: ratio(&rounds, 3, 0),
        exact29_simd_to_f32_simd: ratio(&rounds, 2, 3),
        scaling: ratio(&rounds, 4, 6),
        control_scaling: ratio(&rounds, 5, 7),
        scaling_to_control: median(rounds.iter().map(efficiency).collect()),
    }
}

/// The geometric means of the columns.
fn mean(rows: &[Row]) -> Row {
    let of = |column: fn(&Row) -> f64| {
        libm::exp(rows.iter().map(|row| libm::log(column(row))).sum::<f64>() / rows.len() as f64)
    };
    Row {
        scene: format!("geometric mean of {}", rows.len()),
        f32_ns: of(|row| row.f32_ns),
        exact29: of(|row| row.exact29),
        exact29_simd: of(|row| row.exact29_simd),
        f32_simd: of(|row| row.f32_simd),
        exact29_simd_to_f32_simd: of(|row| row.exact29_simd_to_f32_simd),
        scaling: of(|row| row.scaling),
        control_scaling: of(|row| row.control_scaling),
        scaling_to_control: of(|row| row.scaling_to_control),
    }
}

/// The scenes that are asked for, with their names.
fn models(arguments: &Arguments) -> Result<Vec<(String, Model)>, String> {
    let sized = |mut model: Model| {
        model.render.size = [arguments.size; 2];
        model
    };
    let load = |path: &Path| import::load(path).map(|loaded| sized(loaded.model)).map_err(|error| error.to_string());
    if !arguments.scenes.is_empty() {
        return arguments.scenes.iter().map(|name| Ok((name.clone(), load(Path::new(name))?))).collect();
    }
    let shared = scenes::with_shared([arguments.size; 2]).into_iter();
    let mut models: Vec<_> =
        shared.filter(|(name, _)| name.contains('/')).map(|(name, model)| (name.to_owned(), model)).collect();
    for name in ["demo", "gallery/materials", "gallery/mirrors", "gallery/glass", "gallery/textures", "raystones"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name).join("scene.toml");
        models.push((name.to_owned(), load(&path)?));
    }
    Ok(models)
}

fn print(row: &Row) {
    println!(
        "| {} | {:.0} ns | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} | {:.2} |",
        row.scene,
        row.f32_ns,
        row.exact29,
        row.exact29_simd,
        row.f32_simd,
        row.exact29_simd_to_f32_simd,
        row.scaling,
        row.control_scaling,
        row.scaling_to_control
    );
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let Some(unit) = exact_simd::unit() else {
        eprintln!("this machine has no vector units that are used");
        return ExitCode::FAILURE;
    };
    let models = match models(&arguments) {
        Ok(models) => models,
        Err(error) => {
            eprintln!("{error}");
            return ExitCode::from(2);
        }
    };
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let (Ok(one), Ok(all)) = (pool(1), pool(arguments.threads)) else { return ExitCode::FAILURE };
    let pools = [one, all];
    let threads = pools[1].current_num_threads();
    if !arguments.json {
        println!(
            "| scene | camera ray by `f32` | `exact29` | `exact29`, {unit} | `f32`, {unit} | `exact29` / `f32`, {unit} | \
             {threads} threads | a loop's | of it |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |"
        );
    }
    let mut rows = Vec::new();
    for (name, model) in &models {
        rows.push(measure(name, model, &arguments, &pools));
        if !arguments.json {
            rows.last().into_iter().for_each(print);
        }
    }
    let mean = mean(&rows);
    if arguments.json {
        println!("{}", serde_json::to_string(&Report { unit, threads, rows, mean }).expect("numbers and names"));
    } else {
        print(&mean);
    }
    ExitCode::SUCCESS
}
