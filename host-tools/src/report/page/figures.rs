//! The plots of a page, each in its figure with what is seen in it.

use maud::{Markup, PreEscaped, html};

use crate::report::row::{Cause, Causes, Machine, Row, Study};

use super::PageError;
use super::bars::{self, Bar};
use super::context::{Context, by_machine, drawn, failed, grouped, setting};
use super::cost::{Measure, machine_name};
use super::lines::Lines;
use super::metric::{Metric, percent_text};
use super::number::grouped as thousands;
use super::scatter::{Mark, Plot, Scatter};
use super::series::{Series, Shown, series};
use super::study;

/// The class of what is shown when a scene is chosen.
pub(super) fn scene_class(index: usize) -> String {
    format!("scene scene-{index}")
}

/// The class of what is shown when a metric is chosen.
pub(super) fn metric_class(metric: Metric) -> String {
    format!("metric metric-{}", metric as usize)
}

fn figure(heading: &str, plot: &Plot, more_is_better: bool, notes: &[String]) -> Markup {
    let beyond = if more_is_better {
        "A picture equal to the reference is on the line “equal”."
    } else {
        "An error of zero is on the line “0”, at no distance that means anything."
    };
    html! {
        figure {
            h4 { (heading) }
            (PreEscaped(&plot.svg))
            figcaption {
                @if plot.has_place_beyond { (beyond) " " }
                @for note in notes { (note) " " }
                @if !plot.unnamed.is_empty() { "Without a name for want of room: " (plot.unnamed.join(", ")) "." }
            }
        }
    }
}

fn size_text(row: &Row) -> String {
    let [width, height] = row.point.size;
    format!("{width}x{height}")
}

fn missing(rows: &[&Row]) -> Option<String> {
    let failed = failed(rows);
    (!failed.is_empty()).then(|| format!("Failed, and not shown: {}.", failed.join(", ")))
}

/// What a scatter plot has along its axis for cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Against {
    Cost(Machine),
    Bytes,
}

fn scatter(
    context: &Context<'_>,
    rows: &[&Row],
    metric: Metric,
    against: Against,
    heading: &str,
) -> Result<Markup, PageError> {
    let marks: Vec<Mark> = drawn(rows)
        .into_iter()
        .map(|(point, measured)| Mark {
            name: point.kernel.clone(),
            colour: context.colour(&point.kernel),
            cost: match against {
                Against::Cost(_) => Measure::Relative.of(point, measured),
                Against::Bytes => (measured.blob_bytes as f64, None),
            },
            error: metric.of(point, measured),
        })
        .collect();
    let below = match against {
        Against::Cost(machine) => Measure::Relative.axis(machine),
        Against::Bytes => "blob, bytes",
    };
    let mut notes: Vec<String> = missing(rows).into_iter().collect();
    if marks.is_empty() {
        return Ok(html! { figure.empty { h4 { (heading) } figcaption { "Nothing was drawn. " (notes.concat()) } } });
    }
    if against == Against::Cost(Machine::Host) {
        notes.push("A bar is from the least to the greatest ratio of a round.".into());
    }
    let label = format!("{} against {below}: {heading}", metric.axis());
    let axes = (below, metric.axis());
    let plot = Scatter { label: &label, axes, more_is_better: metric.more_is_better(), marks: &marks }.plot()?;
    Ok(figure(heading, &plot, metric.more_is_better(), &notes))
}

/// Error against run time, a plot for each scene, metric and machine; and against the bytes of the blob.
pub(super) fn error_against_cost(context: &Context<'_>) -> Result<Markup, PageError> {
    for_scenes_and_metrics(context, |rows, metric| {
        let mut figures = Vec::new();
        for (machine, rows) in by_machine(rows) {
            for (_, rows) in grouped(&rows, setting) {
                let heading = format!("{}: {} at {}", machine_name(machine), rows[0].point.scene, size_text(rows[0]));
                figures.push(scatter(context, &rows, metric, Against::Cost(machine), &heading)?);
            }
        }
        // The blob is the same on every machine, so the machine that drew most is enough.
        let most = by_machine(rows).into_iter().min_by_key(|(_, rows)| std::cmp::Reverse(drawn(rows).len()));
        for (_, rows) in most.iter().flat_map(|(_, rows)| grouped(rows, setting)) {
            let heading = format!("Size of the blob: {} at {}", rows[0].point.scene, size_text(rows[0]));
            figures.push(scatter(context, &rows, metric, Against::Bytes, &heading)?);
        }
        Ok(figures)
    })
}

fn for_scenes_and_metrics(
    context: &Context<'_>,
    figures: impl Fn(&[&Row], Metric) -> Result<Vec<Markup>, PageError>,
) -> Result<Markup, PageError> {
    let mut parts = Vec::new();
    for (index, scene) in context.scenes.iter().enumerate() {
        let rows = context.rows(Study::Kernels, scene);
        if rows.is_empty() {
            continue;
        }
        for metric in Metric::ALL {
            let class = format!("plots {} {}", scene_class(index), metric_class(metric));
            parts.push(html! { div class=(class) { @for figure in figures(&rows, metric)? { (figure) } } });
        }
    }
    Ok(html! { @for part in &parts { (part) } })
}

/// A study as lines: its error by each metric, and its cost on each machine. Empty where no row is of it.
pub(super) fn of_study(context: &Context<'_>, study: Study) -> Result<Markup, PageError> {
    let mut parts = Vec::new();
    for (index, scene) in context.scenes.iter().enumerate() {
        let rows = context.rows(study, scene);
        if drawn(&rows).is_empty() {
            continue;
        }
        let mut figures = Vec::new();
        for metric in Metric::ALL {
            let heading = format!("Error: {scene}");
            let series = series(context, study, &rows, Shown::Error(metric));
            let drawn = lines(study, &series, metric.axis(), metric.more_is_better(), &heading)?;
            figures.push(html! { div class=(metric_class(metric)) { (drawn) } });
        }
        for (machine, rows) in by_machine(&rows) {
            let series = series(context, study, &rows, Shown::Cost);
            if !series.lines.is_empty() {
                let heading = format!("{}: {scene}", machine_name(machine));
                figures.push(lines(study, &series, study::measure(study).axis(machine), false, &heading)?);
            }
        }
        let class = format!("plots {}", scene_class(index));
        parts.push(html! { div class=(class) { @for figure in &figures { (figure) } } });
    }
    Ok(html! { @for part in &parts { (part) } })
}

fn lines(
    study: Study,
    series: &Series,
    beside: &str,
    more_is_better: bool,
    heading: &str,
) -> Result<Markup, PageError> {
    let below = study::axis(study);
    let label = format!("{beside} over {below}: {heading}");
    let categories = series.categories.as_deref();
    let plot =
        Lines { label: &label, axes: (below, beside), categories, more_is_better, lines: &series.lines }.plot()?;
    Ok(figure(heading, &plot, more_is_better, &[]))
}

type CauseOf = fn(&Causes) -> Cause;
type CountOf = fn(&Cause) -> u64;

/// The causes and what they are called, in the order of the colours.
const CAUSES: [(&str, CauseOf); 6] = [
    ("hole", |causes| causes.holes),
    ("another surface", |causes| causes.visibility),
    ("mirrored or refracted ray", |causes| causes.secondary),
    ("shadow", |causes| causes.shadow),
    ("shading", |causes| causes.shading),
    ("quantisation", |causes| causes.quantisation),
];

/// Which pixels are counted.
const COUNTS: [(&str, CountOf); 3] = [
    ("Pixels over 64", |cause| cause.over_64),
    ("Pixels over 4", |cause| cause.over_4),
    ("Pixels that differ at all", |cause| cause.pixels),
];

/// The pixels that differ, split by cause.
pub(super) fn causes(context: &Context<'_>) -> Result<Markup, PageError> {
    let mut parts = Vec::new();
    for (index, scene) in context.scenes.iter().enumerate() {
        let rows = context.rows(Study::Kernels, scene);
        let groups = grouped(&rows, |point| super::study::unvaried(&setting(point)));
        let mut figures = Vec::new();
        for (_, rows) in &groups {
            let mut kernels: Vec<_> = Vec::new();
            for (point, measured) in drawn(rows) {
                // The same pixels on every machine.
                if !kernels.iter().any(|(known, _): &super::context::Drawn<'_>| known.kernel == point.kernel) {
                    kernels.push((point, measured));
                }
            }
            for (title, count) in COUNTS {
                let bar = |(point, measured): &super::context::Drawn<'_>| {
                    let parts: Vec<u64> = CAUSES.iter().map(|(_, cause)| count(&cause(&measured.causes))).collect();
                    let sum = parts.iter().sum();
                    let total = match sum {
                        0 => "none".into(),
                        _ => format!("{} = {}", percent_text(sum, point), thousands(sum)),
                    };
                    Bar { name: point.kernel.clone(), parts, total }
                };
                let bars: Vec<Bar> = kernels.iter().map(bar).collect();
                if bars.is_empty() {
                    continue;
                }
                let heading = format!("{title}: {scene} at {}", size_text(rows[0]));
                let svg = bars::plot(&heading, &bars)?;
                figures.push(figure(&heading, &Plot { svg, has_place_beyond: false, unnamed: vec![] }, false, &[]));
            }
        }
        let class = format!("plots {}", scene_class(index));
        parts.push(html! { div class=(class) { @for figure in &figures { (figure) } } });
    }
    Ok(html! {
        p.legend { @for (index, (name, _)) in CAUSES.iter().enumerate() {
            span { i.chip style={ "background:var(--c" (index) ")" } {} (name) }
        } }
        @for part in &parts { (part) }
    })
}
