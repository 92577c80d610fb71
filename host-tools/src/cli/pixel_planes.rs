//! `intray pixel-planes`: the machine of 1994, modelled.

use std::fmt::Write as _;
use std::path::PathBuf;

use clap::Args;
use planes_rt::scene::Outline;
use planes_rt::widths::Widths;
use planes_simd::Lockstep;
use serde::Serialize;

use super::failure::{Failure, warn};
use super::input::SceneArguments;
use super::{output, progress};
use crate::files;
use crate::pixel_planes::memory::Store;
use crate::pixel_planes::picture::Drawn;
use crate::pixel_planes::program::{Operation, Shape};
use crate::pixel_planes::{Machine, Run, plot, regions};
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

    /// Where plots go, if anywhere: frames a second against renderers, spheres and generations, and enabled lanes over time
    #[arg(long, value_name = "SVG")]
    plot: Option<PathBuf>,

    /// Where the steps go, if anywhere: the operations and the enabled lanes of each, and the bits in which each value is
    #[arg(long, value_name = "CSV")]
    steps: Option<PathBuf>,

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
    /// CRC-32 of the RGB888 bytes of the picture, which is the kernel's.
    image_crc32: String,
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
    for path in [&arguments.output, &arguments.plot, &arguments.steps].into_iter().flatten() {
        files::check_writable(path)?;
    }
    let is_positive = arguments.clock.is_finite() && arguments.clock > 0.0;
    if !is_positive {
        return Err(Failure::input(format!("--clock {}: expected a number of MHz above 0", arguments.clock)));
    }
    let widths =
        Widths::new(arguments.coordinate_bits, arguments.product_bits, arguments.determinant_bits, arguments.t_bits)?;
    let outline = if arguments.literal { Outline::Literal } else { Outline::Nearest };
    let mut model = arguments.scene.model_for_planes()?;
    if model.materials.iter().any(|material| material.roughness > 0.0) {
        warn("the machine is the text's, whose mirrors are sharp; `intray render --kernel planes12` has rough ones");
        model.materials.iter_mut().for_each(|material| material.roughness = 0.0);
    }
    if model.render.paths {
        warn("the machine is the text's, whose program follows no paths; `intray render --kernel planes12` does");
        model.render.paths = false;
    }
    if model.render.samples > 1 {
        warn(
            "the machine is the text's, with one ray through the middle of each pixel; `intray render --kernel planes12` has more",
        );
        model.render.samples = 1;
    }
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
    let machine = arguments.machine();
    let modelled = Run::new(&machine, &shape).map_err(|error| named(&error))?;
    let size = model.render.size;
    let bar = progress::bar("tracing bit by bit", size.map(u64::from).iter().product());
    let drawn = modelled.draw(&scene, &shape, &|pixels| bar.inc(pixels));
    bar.finish_and_clear();
    if drawn.light != planes::light(&scene, Way::Lanes(Lockstep::detected()), &|_| ()) {
        return Err(Failure::check("the modelled processors and the kernel do not agree on the picture"));
    }
    let picture = planes::picture(&scene, &drawn.light, model.render.transfer);
    let pixels = f64::from(size[0]) * f64::from(size[1]);
    let enabled: Vec<f64> = drawn.enabled.iter().map(|&count| count as f64 / pixels).collect();
    if let Some(path) = &arguments.plot {
        let plot = plot::svg(&machine, &shape, &modelled, (size, arguments.renderers), &enabled);
        files::write_atomically(path, plot.map_err(Failure::check)?.as_bytes())?;
    }
    if let Some(path) = &arguments.steps {
        files::write_atomically(path, steps(&modelled, &drawn).as_bytes())?;
    }
    if let Some(path) = &arguments.output {
        picture.write_png(path)?;
    }
    let begins = modelled.steps.iter().zip(&enabled).filter(|(step, _)| step.operation == Operation::Begin);
    let by_generation = begins.map(|(_, &share)| share).collect();
    let image_crc32 = format!("{:08x}", picture.crc32());
    let report = report(arguments, &shape, &modelled, size, by_generation, image_crc32);
    if arguments.json { output::json(&report) } else { output::line(&text(&report)) }
}

impl Arguments {
    fn machine(&self) -> Machine {
        Machine {
            store: Store {
                local_bits: self.local_bits,
                backing_bits: self.backing_bits,
                block_cycles: self.block_cycles,
                ..Store::default()
            },
            cycles_per_bit: self.cycles_per_bit,
            clock_hz: self.clock * 1e6,
        }
    }
}

/// A row a step, of values as `name=bits`, the bits as ranges that a space parts.
fn steps(run: &Run, drawn: &Drawn) -> String {
    let mut text = String::from("step,sphere,bit_operations,enabled,bits,out,in,values\n");
    for ((step, moment), enabled) in run.steps.iter().zip(&run.plan.moments).zip(&drawn.enabled) {
        let moved = |is_outward| {
            let moved = moment.transfers.iter().filter(|transfer| transfer.is_outward == is_outward);
            moved.map(|transfer| format!("{:?}", transfer.value)).collect::<Vec<_>>().join(" ")
        };
        let values: Vec<String> =
            moment.places.iter().map(|(value, places)| format!("{value:?}={}", ranges(places))).collect();
        // A string takes text.
        let _ = writeln!(
            text,
            "{},{},{},{enabled},{},{},{},{}",
            moment.step,
            step.sphere,
            step.bit_operations,
            moment.bits,
            moved(true),
            moved(false),
            values.join(";")
        );
    }
    text
}

/// Places in the order of a value's bits, those in a row as one range.
fn ranges(places: &[usize]) -> String {
    let runs = places.chunk_by(|a, b| a + 1 == *b);
    let runs = runs.filter_map(|run| Some(format!("{}-{}", run.first()?, run.last()?)));
    runs.collect::<Vec<_>>().join(" ")
}

fn report(
    arguments: &Arguments,
    shape: &Shape,
    run: &Run,
    size: [u32; 2],
    enabled: Vec<f64>,
    image_crc32: String,
) -> Report {
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
            .map_or_else(Vec::new, |moment| moment.held().map(|value| format!("{value:?}")).collect()),
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
        image_crc32,
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
         frames     {:.2} a second: {} regions by {} renderers\n\
         picture    of CRC-32 {}, bit for bit the kernel's",
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
        report.image_crc32,
    )
}
