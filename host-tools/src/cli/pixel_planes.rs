//! `intray pixel-planes`: the machine of 1994, modelled.

use std::path::PathBuf;

use clap::Args;
use planes_rt::pixel;
use planes_rt::scene::{Outline, Scene};
use planes_rt::widths::Widths;
use planes_simd::Lockstep;
use serde::Serialize;

use super::failure::{Failure, warn};
use super::input::SceneArguments;
use super::output;
use crate::files;
use crate::pixel_planes::memory::Store;
use crate::pixel_planes::program::Shape;
use crate::pixel_planes::{Machine, Run, regions};
use crate::planes::scene::{DIRECTION_LENGTH, Options, Planes};
use crate::planes::{self, Way};

/// Model the machine of 1994: memory, swaps, cycles, frames a second
#[derive(Debug, Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// Where the picture goes, if anywhere
    #[arg(short, value_name = "PNG")]
    output: Option<PathBuf>,

    /// Bits of a component of a position or a direction
    #[arg(long, value_name = "BITS", default_value_t = Widths::PIXEL_PLANES.coordinate())]
    coordinate_bits: u32,

    /// Bits of a sum of their products
    #[arg(long, value_name = "BITS", default_value_t = Widths::PIXEL_PLANES.product())]
    product_bits: u32,

    /// Bits of the determinant
    #[arg(long, value_name = "BITS", default_value_t = Widths::PIXEL_PLANES.determinant())]
    determinant_bits: u32,

    /// Bits of t below its point
    #[arg(long, value_name = "BITS", default_value_t = Widths::PIXEL_PLANES.t_fraction())]
    t_bits: u32,

    /// The length of the longest direction
    #[arg(long, value_name = "UNITS", default_value_t = DIRECTION_LENGTH)]
    direction: u16,

    /// End a pixel at the first sphere of the list that its ray meets, as the outline has it by the word
    #[arg(long)]
    literal: bool,

    /// Bits of a processor's own memory
    #[arg(long, value_name = "BITS", default_value_t = Store::default().local_bits)]
    local_bits: u32,

    /// Bits of the store behind it
    #[arg(long, value_name = "BITS", default_value_t = Store::default().backing_bits)]
    backing_bits: u32,

    /// Cycles in which 32 bits go to the store or come from it; not in the text
    #[arg(long, value_name = "CYCLES", default_value_t = Store::default().block_cycles)]
    block_cycles: u64,

    /// Cycles that an operation on one bit takes; not in the text
    #[arg(long, value_name = "CYCLES", default_value_t = Machine::default().cycles_per_bit)]
    cycles_per_bit: u64,

    /// The clock; not in the text
    #[arg(long, value_name = "MHZ", default_value_t = Machine::default().clock_hz / 1e6)]
    clock: f64,

    /// Renderers that share the picture
    #[arg(long, value_name = "N", default_value_t = 32, value_parser = clap::value_parser!(u32).range(1..))]
    renderers: u32,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// The answer.
#[derive(Debug, Serialize)]
struct Report {
    width: u32,
    height: u32,
    spheres: u32,
    generations: u32,
    local_bits: u32,
    /// The most bits that are used at once.
    high_water_bits: u32,
    high_water_step: &'static str,
    /// What is held in that step.
    high_water_values: Vec<String>,
    swapped: Vec<Swapped>,
    /// Bits of the store that are used.
    backing_bits: u32,
    blocks_out: u64,
    blocks_in: u64,
    /// Of a region.
    cycles_computing: u64,
    cycles_waiting: u64,
    regions: u32,
    renderers: u32,
    frames_a_second: f64,
    /// Of all pixels, those whose rays look for a sphere, generation by generation.
    enabled: Vec<f64>,
}

/// A value that had to go.
#[derive(Debug, Serialize)]
struct Swapped {
    value: String,
    bits: u32,
    out: u64,
    back: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    if let Some(path) = &arguments.output {
        files::check_writable(path)?;
    }
    let is_positive = arguments.clock.is_finite() && arguments.clock > 0.0;
    if !is_positive {
        return Err(Failure::input(format!("--clock {}: expected a number of MHz above 0", arguments.clock)));
    }
    let widths =
        Widths::new(arguments.coordinate_bits, arguments.product_bits, arguments.determinant_bits, arguments.t_bits)?;
    let outline = if arguments.literal { Outline::Literal } else { Outline::Nearest };
    let model = arguments.scene.model_for_planes()?;
    let named = |error: &dyn std::fmt::Display| Failure::input(format!("{}: {error}", arguments.scene.scene.display()));
    let options = Options { widths, outline, direction: arguments.direction };
    let planes = Planes::new(&model, &options).map_err(|error| named(&error))?;
    planes.warnings.iter().for_each(warn);
    let scene = planes.scene()?;
    let shape = Shape {
        widths,
        spheres: scene.spheres().len() as u32,
        generations: scene.settings().generations.into(),
        outline,
    };
    let machine = Machine {
        store: Store {
            local_bits: arguments.local_bits,
            backing_bits: arguments.backing_bits,
            block_cycles: arguments.block_cycles,
            ..Store::default()
        },
        cycles_per_bit: arguments.cycles_per_bit,
        clock_hz: arguments.clock * 1e6,
    };
    let modelled = Run::new(&machine, &shape).map_err(|error| named(&error))?;
    if let Some(path) = &arguments.output {
        let light = planes::light(&scene, Way::Lanes(Lockstep::detected()), &|_| ());
        planes::picture(&scene, &light, model.render.transfer).write_png(path)?;
    }
    let report = report(arguments, &shape, &modelled, model.render.size, enabled(&scene));
    if arguments.json { output::json(&report) } else { output::line(&text(&report)) }
}

/// Of all pixels, those whose rays look for a sphere, generation by generation.
fn enabled(scene: &Scene<'_>) -> Vec<f64> {
    let [width, height] = scene.settings().size;
    let mut counts = vec![0u64; scene.settings().generations.into()];
    for pixel in (0..height).flat_map(|y| (0..width).map(move |x| [x, y])) {
        // Of a ray of which nothing is seen there is no next generation.
        let mut lookups = 1;
        pixel::trace_telling(scene, pixel, |met| {
            lookups += usize::from(scene.spheres()[met.sphere].surface.mirror != [0; 3]);
        });
        counts.iter_mut().take(lookups).for_each(|count| *count += 1);
    }
    let pixels = f64::from(width) * f64::from(height);
    counts.into_iter().map(|count| count as f64 / pixels).collect()
}

fn report(arguments: &Arguments, shape: &Shape, run: &Run, size: [u32; 2], enabled: Vec<f64>) -> Report {
    let fullest = run.plan.fullest();
    let swapped = run.plan.swapped.iter().map(|(&value, &[out, back])| Swapped {
        value: format!("{value:?}"),
        bits: shape.bits(value),
        out,
        back,
    });
    Report {
        width: size[0],
        height: size[1],
        spheres: shape.spheres,
        generations: shape.generations,
        local_bits: arguments.local_bits,
        high_water_bits: fullest.map_or(0, |moment| moment.bits),
        high_water_step: fullest.map_or("", |moment| moment.step),
        high_water_values: fullest
            .map_or_else(Vec::new, |moment| moment.held.iter().map(|value| format!("{value:?}")).collect()),
        swapped: swapped.collect(),
        backing_bits: run.plan.backing_bits,
        blocks_out: run.plan.blocks[0],
        blocks_in: run.plan.blocks[1],
        cycles_computing: run.computing,
        cycles_waiting: run.waiting,
        regions: regions(size),
        renderers: arguments.renderers,
        frames_a_second: run.frames_a_second(size, arguments.renderers),
        enabled,
    }
}

fn text(report: &Report) -> String {
    let swapped: Vec<String> = report
        .swapped
        .iter()
        .map(|one| format!("  {:<12} {:>4} bits {:>7} times out {:>7} back", one.value, one.bits, one.out, one.back))
        .collect();
    let swapped = if swapped.is_empty() { "  nothing".into() } else { swapped.join("\n") };
    let enabled: Vec<String> = report.enabled.iter().map(|share| format!("{:.1} %", 100.0 * share)).collect();
    format!(
        "{}x{} pixels, {} spheres, {} generations\n\
         memory     at most {} of {} bits, in `{}`: {}\n\
         swapped, with {} bits of the store used:\n{swapped}\n\
         cycles     {} computing and {} waiting for {} blocks, a region\n\
         enabled    {} of the lanes, generation by generation\n\
         frames     {:.2} a second: {} regions by {} renderers",
        report.width,
        report.height,
        report.spheres,
        report.generations,
        report.high_water_bits,
        report.local_bits,
        report.high_water_step,
        report.high_water_values.join(", "),
        report.backing_bits,
        report.cycles_computing,
        report.cycles_waiting,
        report.blocks_out + report.blocks_in,
        enabled.join(", "),
        report.frames_a_second,
        report.regions,
        report.renderers,
    )
}
