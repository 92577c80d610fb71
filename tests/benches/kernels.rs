//! Kernels side by side: time and instructions as ratios to `f32`, and the work that they do.
//!
//! One thread, scalar code, primary and shadow rays, the whole picture. Kernels take turns within every round, and a ratio
//! is taken within its round: on a machine that others use too, figures that were measured one after the other say
//! little. What is printed is the median of the rounds and their spread. With `--instructions`, valgrind counts them where
//! it is installed; they are the same on every run.
//!
//! `cargo bench -p tests --bench kernels -- [--size N] [--rounds N] [--leaf N] [--instructions] [KERNEL…]`

use std::collections::BTreeMap;
use std::hint::black_box;
use std::process::{Command, ExitCode};
use std::time::Instant;

use clap::Parser;
use core_rt::exact::{Exact14, Exact20, Exact29};
use core_rt::hanika::{HanikaC, HanikaCd, HanikaCons};
use core_rt::kernel::Kernel;
use core_rt::profile::Full;
use core_rt::render::{Tile, Workspace, render_tile};
use core_rt::scene::{MAX_BRANCHES, MAX_DEPTH, Scene};
use core_rt::stats::{Counts, NoStats, Stats};
use float_rt::{Float32, Float64};
use host_tools::model::Model;
use host_tools::prepare::{Blob, Options, prepare};
use host_tools::tree::TreeOptions;
use tests::scenes;

/// How it is measured.
#[derive(Debug, Parser)]
struct Arguments {
    /// Width and height of the pictures
    #[arg(long, default_value_t = 384)]
    size: u32,
    /// Rounds; in each, every kernel renders every scene once
    #[arg(long, default_value_t = 7)]
    rounds: usize,
    /// Leaves of so many triangles or fewer
    #[arg(long)]
    leaf: Option<u32>,
    /// Count instructions too, by valgrind: minutes for the larger scenes
    #[arg(long)]
    instructions: bool,
    /// Render one scene once by one kernel, and nothing else: what is run under valgrind
    #[arg(long, value_name = "SCENE", hide = true)]
    once: Option<String>,
    /// Kernels to compare with f32 [default: all]
    kernels: Vec<String>,
    /// Given by cargo
    #[arg(long, hide = true)]
    bench: bool,
}

/// A kernel's name, and what can be done with it.
type Entry = (&'static str, fn(&Model, &Options) -> Blob, fn(&Blob), fn(&Blob) -> Counts);

fn entry<K: Kernel>() -> Entry {
    (
        K::NAME,
        |model, options| prepare::<K>(model, options).expect("every kernel holds these scenes").blob,
        |blob| draw::<K>(blob, &mut NoStats),
        |blob| {
            let mut counts = Counts::default();
            draw::<K>(blob, &mut counts);
            counts
        },
    )
}

/// `f32`, what all are compared with, is the first.
fn entries() -> [Entry; 8] {
    [
        entry::<Float32>(),
        entry::<Float64>(),
        entry::<Exact29>(),
        entry::<Exact20>(),
        entry::<Exact14>(),
        entry::<HanikaC>(),
        entry::<HanikaCd>(),
        entry::<HanikaCons>(),
    ]
}

/// Renders a picture, tile by tile, and lets it go.
#[inline(never)]
fn draw<K: Kernel>(blob: &Blob, stats: &mut impl Stats) {
    const SIDE: u16 = 32;
    let scene = Scene::<Full<K>>::new_checked(blob.bytes()).expect("a blob just made");
    let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
    let (mut hits, mut pixels) = ([0; 1024], [0; 3 * 1024]);
    let mut branches = heapless::Vec::<_, { MAX_BRANCHES + 1 }>::new();
    let mut workspace = Workspace { stack: &mut stack, branches: &mut branches, hits: &mut hits, pixels: &mut pixels };
    intray_measured(|| {
        for tile in Tile::of(scene.frame.size, [SIDE; 2]) {
            black_box(render_tile(&scene, tile, &mut workspace, stats).expect("the workspace has room"));
        }
    });
}

/// What valgrind counts, by this name.
#[inline(never)]
fn intray_measured(work: impl FnOnce()) {
    work();
}

fn options(leaf: Option<u32>) -> Options {
    let tree = TreeOptions::default();
    let tree = leaf.map_or(tree, |leaf_max| TreeOptions { leaf_max, leaf_always: true, ..tree });
    Options { tree, ..Options::default() }
}

/// Instructions of one picture; `None` where valgrind is not to be had.
fn instructions(arguments: &Arguments, scene: &str, kernel: &str) -> Option<u64> {
    let mut command = Command::new("valgrind");
    command.args(["--tool=callgrind", "--toggle-collect=*intray_measured*", "--callgrind-out-file=/dev/null"]);
    command.arg(std::env::current_exe().ok()?).args(["--size", "96", "--once", scene, kernel]);
    if let Some(leaf) = arguments.leaf {
        command.args(["--leaf", &leaf.to_string()]);
    }
    let output = command.output().ok().filter(|output| output.status.success())?;
    let text = String::from_utf8(output.stderr).ok()?;
    text.lines().find_map(|line| line.split_once("Collected : ")?.1.split_whitespace().next()?.parse().ok())
}

fn median(values: &mut [f64]) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

fn geometric_mean(values: &[f64]) -> f64 {
    libm::exp(values.iter().map(|&v| libm::log(v)).sum::<f64>() / values.len() as f64)
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let wanted =
        |name: &str| arguments.kernels.is_empty() || name == "f32" || arguments.kernels.iter().any(|k| k == name);
    let entries: Vec<Entry> = entries().into_iter().filter(|&(name, ..)| wanted(name)).collect();
    let options = options(arguments.leaf);
    if let Some(scene) = &arguments.once {
        let kernel = arguments.kernels.first().map_or("f32", String::as_str);
        let named = entries.iter().find(|&&(name, ..)| name == kernel);
        let (Some((_, prepare, draw, _)), Some(model)) = (named, scenes::named(scene, [arguments.size; 2])) else {
            return ExitCode::from(2);
        };
        draw(&prepare(&model, &options));
        return ExitCode::SUCCESS;
    }
    let models: Vec<(&str, Model)> = scenes::with_shared([arguments.size; 2])
        .into_iter()
        .filter(|(name, _)| name.contains('/') || ["demo", "inside", "flat"].contains(name))
        .collect();
    if entries.len() < 2 {
        eprintln!("no kernel has a name of {:?}", arguments.kernels);
        return ExitCode::from(2);
    }
    println!(
        "| scene | kernel | time / f32 (spread) | instructions / f32 | box tests a ray | triangle tests a ray |\n\
         | --- | --- | --- | --- | --- | --- |"
    );
    let mut all: BTreeMap<&str, (Vec<f64>, Vec<f64>)> = BTreeMap::new();
    for (scene, model) in &models {
        let blobs: Vec<Blob> = entries.iter().map(|(_, prepare, ..)| prepare(model, &options)).collect();
        let mut rounds = vec![Vec::new(); entries.len()];
        for _ in 0..arguments.rounds.max(1) {
            let seconds: Vec<f64> = entries
                .iter()
                .zip(&blobs)
                .map(|((_, _, draw, _), blob)| {
                    let begin = Instant::now();
                    draw(blob);
                    begin.elapsed().as_secs_f64()
                })
                .collect();
            for (ratios, time) in rounds.iter_mut().zip(&seconds) {
                ratios.push(time / seconds[0]);
            }
        }
        let base = arguments.instructions.then(|| instructions(&arguments, scene, "f32")).flatten();
        for (((name, _, _, count), blob), ratios) in entries.iter().zip(&blobs).zip(&mut rounds) {
            let ratio = median(ratios);
            let (least, most) = (ratios[0], ratios[ratios.len() - 1]);
            let counts = count(blob);
            let per_ray = |tests: u64| tests as f64 / counts.rays() as f64;
            let counted = base.and_then(|base| Some(instructions(&arguments, scene, name)? as f64 / base as f64));
            let shown = counted.map_or("-".into(), |ratio| format!("{ratio:.2}"));
            println!(
                "| {scene} | `{name}` | {ratio:.2} ({least:.2} to {most:.2}) | {shown} | {:.1} | {:.1} |",
                per_ray(counts.box_tests),
                per_ray(counts.triangle_tests)
            );
            let (times, counts) = all.entry(name).or_default();
            times.push(ratio);
            counts.extend(counted);
        }
    }
    for (name, ..) in &entries {
        let (times, counts) = &all[name];
        let counted = if counts.is_empty() { "-".into() } else { format!("{:.2}", geometric_mean(counts)) };
        println!("| **geometric mean of {}** | `{name}` | {:.2} | {counted} | | |", times.len(), geometric_mean(times));
    }
    ExitCode::SUCCESS
}
