//! Frames a second of the machine over what changes them, and how many of its processors are enabled over time, as SVG.

use plotters::prelude::*;

use super::program::Shape;
use super::{Machine, Run};

/// A line over marks.
type Line = (String, Vec<(f64, f64)>);

/// One of the drawings.
struct Panel {
    title: &'static str,
    /// What stands along the horizontal axis.
    x: &'static str,
    lines: Vec<Line>,
    /// Whether the vertical axis has a logarithmic scale.
    is_logarithmic: bool,
}

const SIZE: (u32, u32) = (960, 720);

/// Told apart by those who see few colours (Okabe & Ito, "Color Universal Design", 2008).
const COLOURS: [RGBColor; 4] =
    [RGBColor(0, 114, 178), RGBColor(213, 94, 0), RGBColor(0, 158, 115), RGBColor(204, 121, 167)];

/// The greatest numbers that are drawn.
const RENDERERS: u32 = 64;
const SPHERES: u32 = 32;
const GENERATIONS: u32 = 8;

/// The file's text: frames a second against renderers, spheres and generations, around a run of a picture; and of all lanes, the
/// share that was enabled at each step of it.
///
/// # Errors
/// What cannot be drawn.
pub fn svg(
    machine: &Machine,
    shape: &Shape,
    run: &Run,
    (size, renderers): ([u32; 2], u32),
    enabled: &[f64],
) -> Result<String, String> {
    let frames = |shape: Shape, number: u32| {
        Run::new(machine, &shape).ok().map(|run| (f64::from(number), run.frames_a_second(size, renderers)))
    };
    let quarter = size.map(|side| side.div_ceil(2));
    let by_size = [size, quarter].map(|size| {
        let points = (1..=RENDERERS).map(|count| (f64::from(count), run.frames_a_second(size, count)));
        (format!("{}x{}", size[0], size[1]), points.collect())
    });
    let counts = |most: u32, other: u32| [1, 2, 3].map(|step| (other * step).div_ceil(3).clamp(1, most));
    let spheres = |generations| -> Line {
        let points = (1..=SPHERES).filter_map(|spheres| frames(Shape { spheres, generations, ..*shape }, spheres));
        (format!("{generations} generations"), points.collect())
    };
    let generations = |spheres| -> Line {
        let points =
            (1..=GENERATIONS).filter_map(|generations| frames(Shape { spheres, generations, ..*shape }, generations));
        (format!("{spheres} spheres"), points.collect())
    };
    let distinct = |mut counts: Vec<u32>| {
        counts.dedup();
        counts
    };
    let of_generations = distinct(counts(GENERATIONS, shape.generations).to_vec());
    let of_spheres = distinct(counts(SPHERES, shape.spheres).to_vec());
    let mut begun = 0;
    let over_time = run.steps.iter().zip(enabled).map(|(step, share)| {
        begun += step.bit_operations * machine.cycles_per_bit;
        (begun as f64 / 1000.0, 100.0 * share)
    });
    let panel = |title, x, lines| Panel { title, x, lines, is_logarithmic: true };
    let panels = [
        panel("Frames a second against renderers", "renderers", by_size.to_vec()),
        panel("Frames a second against spheres", "spheres", of_generations.into_iter().map(spheres).collect()),
        panel("Frames a second against generations", "generations", of_spheres.into_iter().map(generations).collect()),
        Panel {
            title: "Enabled lanes over time, %",
            x: "thousand cycles of computing",
            lines: vec![(String::new(), over_time.collect())],
            is_logarithmic: false,
        },
    ];
    let mut text = String::new();
    draw(SVGBackend::with_string(&mut text, SIZE), &panels).map_err(|error| error.to_string())?;
    Ok(text)
}

fn draw<B: DrawingBackend>(backend: B, panels: &[Panel]) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let root = backend.into_drawing_area();
    root.fill(&WHITE)?;
    for (area, panel) in root.split_evenly((2, 2)).iter().zip(panels) {
        let values = || panel.lines.iter().flat_map(|(_, points)| points.iter().copied());
        let width = values().fold(1.0, |most: f64, point| most.max(point.0));
        let most = values().fold(f64::MIN_POSITIVE, |most: f64, point| most.max(point.1));
        let least = values().fold(most, |least: f64, point| least.min(point.1));
        if panel.is_logarithmic {
            axes(area, panel, 0.0..width, (least / 1.3..most * 1.3).log_scale())?;
        } else {
            axes(area, panel, 0.0..width, 0.0..most.max(1.0))?;
        }
    }
    root.present()
}

fn axes<B: DrawingBackend, Y>(
    area: &DrawingArea<B, plotters::coord::Shift>,
    panel: &Panel,
    x: std::ops::Range<f64>,
    y: Y,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>>
where
    Y: plotters::coord::ranged1d::AsRangedCoord<Value = f64>,
    Y::CoordDescType: plotters::coord::ranged1d::ValueFormatter<f64>,
{
    let mut chart = ChartBuilder::on(area)
        .caption(panel.title, ("sans-serif", 17))
        .margin(10)
        .margin_right(24)
        .x_label_area_size(42)
        .y_label_area_size(56)
        .build_cartesian_2d(x, y)?;
    chart
        .configure_mesh()
        .x_desc(panel.x)
        .x_labels(8)
        .y_labels(6)
        .x_label_formatter(&|x| format!("{x:.0}"))
        .light_line_style(WHITE)
        .bold_line_style(RGBColor(225, 225, 225))
        .label_style(("sans-serif", 13))
        .draw()?;
    let (xs, ys) = chart.plotting_area().get_pixel_range();
    for (number, ((name, points), colour)) in panel.lines.iter().zip(COLOURS).enumerate() {
        chart.plotting_area().draw(&PathElement::new(points.clone(), colour.stroke_width(2)))?;
        if name.is_empty() {
            continue;
        }
        let (base_x, base_y) = area.get_base_pixel();
        // Above lines that fall, below lines that rise.
        let rises = points.first().zip(points.last()).is_some_and(|(first, last)| first.1 < last.1);
        let top = if rises { ys.end - base_y - 17 * panel.lines.len() as i32 } else { ys.start - base_y + 14 };
        let (x, y) = (xs.end - base_x - 130, top + 17 * number as i32);
        area.draw(&PathElement::new([(x, y), (x + 20, y)], colour.stroke_width(3)))?;
        area.draw(&Text::new(name.clone(), (x + 26, y - 7), ("sans-serif", 13)))?;
    }
    Ok(())
}
