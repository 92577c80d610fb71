//! A report as one HTML page that needs nothing beside it: pictures and plots stand in it, and without its script all but
//! the sorting of tables works. What is shown of scenes and metrics is chosen by the style sheet alone.
//!
//! `maud` writes the HTML, so no name can end an element: what is not markup by its type is escaped. `plotters` draws.

mod axis;
mod bars;
mod canvas;
mod columns;
mod contact;
mod context;
mod cost;
mod figures;
pub mod fit;
mod labels;
mod lines;
mod metric;
mod number;
mod overview;
mod pareto;
mod scatter;
mod series;
mod study;
mod summary;
mod table;

use std::path::{Path, PathBuf};

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::Report;
use super::row::{Outcome, Row, SCHEMA, Study, name};
use super::sweep::FILES;
use crate::files::{self, FileError};
use context::{Context, settings};
use metric::Metric;
use table::{Cell, Column, table};

/// Why a page could not be made.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PageError {
    /// A plot could not be drawn.
    #[error("a plot could not be drawn: {0}")]
    Plot(String),
}

/// Why a page could not be made anew.
#[derive(Debug, thiserror::Error)]
pub enum RenewError {
    /// A file could not be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// What is there is no report.
    #[error("{}: not a report ({reason}); give the folder of one that `intray report -o` wrote", path.display())]
    NoReport {
        /// The file.
        path: PathBuf,
        /// What the parser says.
        reason: String,
    },
    /// It is of another schema.
    #[error("{}: a report of the schema {found}, and this program reads {SCHEMA}; measure it anew", path.display())]
    OtherSchema {
        /// The file.
        path: PathBuf,
        /// The schema that it names.
        found: String,
    },
    /// The page.
    #[error(transparent)]
    Page(#[from] PageError),
}

/// Makes the page in a report's folder anew from its `report.json` and its pictures; the page's path.
///
/// # Errors
/// [`RenewError`] where there is no report of this schema, or its page cannot be made or written.
pub fn renew(folder: &Path) -> Result<PathBuf, RenewError> {
    /// Enough of a report to know whether the rest can be read.
    #[derive(serde::Deserialize)]
    struct Stated {
        schema: String,
    }
    let [json, _, html] = FILES.map(|name| folder.join(name));
    let bytes = files::read(&json)?;
    let wrong = |error: serde_json::Error| RenewError::NoReport { path: json.clone(), reason: error.to_string() };
    let Stated { schema } = serde_json::from_slice(&bytes).map_err(wrong)?;
    if schema != SCHEMA {
        return Err(RenewError::OtherSchema { path: json, found: schema });
    }
    let report: Report = serde_json::from_slice(&bytes).map_err(wrong)?;
    files::write_atomically(&html, page(&report, folder)?.as_bytes())?;
    Ok(html)
}

/// What a report says in words: a sentence a machine over all scenes, none where there are fewer than two, and each scene
/// with its own.
#[must_use]
pub fn in_words(report: &Report) -> (Vec<String>, Vec<(String, Vec<String>)>) {
    let context = Context::new(report);
    let overview = overview::overview(report, &context.kernels);
    (summary::over_all(&overview), summary::sentences(&context))
}

/// The page of a report whose pictures are in `folder`. A picture that cannot be read is named in its place.
///
/// # Errors
/// [`PageError`] where a plot cannot be drawn.
pub fn page(report: &Report, folder: &Path) -> Result<String, PageError> {
    let context = Context::new(report);
    let plots = plots(&context)?;
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "intray: error against run time" }
                style { (PreEscaped(include_str!("style.css"))) (PreEscaped(choice_style(&context))) }
            }
            body {
                header {
                    h1 { "Error against run time" }
                    p.lead { (lead(&context)) }
                }
                nav { @for (id, title) in PARTS { a href={ "#" (id) } { (title) } } }
                main {
                    (summary(&context))
                    (plots)
                    section #pictures {
                        h2 { "Pictures" }
                        p {
                            "Each kernel's picture, and beside it the gray difference from the reference, "
                            (contact::GAIN) " times as bright as it is: black is equal."
                        }
                        (contact::sheet(&context, folder))
                    }
                    (tables(&context))
                    (failures(&context))
                    (origin(report))
                }
                script { (PreEscaped(include_str!("script.js"))) }
            }
        }
    };
    Ok(page.into_string())
}

/// The parts of a page by their names in addresses.
const PARTS: [(&str, &str); 8] = [
    ("summary", "Summary"),
    ("time", "Error against run time"),
    ("growth", "Growth"),
    ("knobs", "Knobs"),
    ("causes", "Causes"),
    ("pictures", "Pictures"),
    ("tables", "Tables"),
    ("origin", "How it was made"),
];

fn lead(context: &Context<'_>) -> String {
    let count = |number: usize, what: &str| format!("{number} {what}{}", if number == 1 { "" } else { "s" });
    let rows = &context.report.rows;
    let failed = rows.iter().filter(|row| matches!(row.outcome, Outcome::Failed(_))).count();
    let failed = if failed == 0 { String::new() } else { format!(", {failed} of which failed") };
    format!(
        "Ray tracing with integers on chips without a floating-point unit: how far pictures are from an f64 reference of \
         the scene as it was given, and what drawing them takes. {} of {} with {}{failed}.",
        count(rows.len(), "point"),
        count(context.scenes.len(), "scene"),
        count(context.kernels.len(), "kernel"),
    )
}

/// What hides the scenes and metrics that are not chosen.
fn choice_style(context: &Context<'_>) -> String {
    let rule = |kind: &str, index: usize| {
        format!("body:has(#choose-{kind}-{index}:checked) .{kind}:not(.{kind}-{index}){{display:none}}\n")
    };
    let scenes = (0..context.scenes.len()).map(|index| rule("scene", index));
    scenes.chain((0..Metric::ALL.len()).map(|index| rule("metric", index))).collect()
}

fn choice(kind: &str, title: &str, names: &[&str], hints: &[&str]) -> Markup {
    html! {
        fieldset {
            legend { (title) }
            @for (index, name) in names.iter().enumerate() {
                @let id = format!("choose-{kind}-{index}");
                input type="radio" name={ "choose-" (kind) } id=(id) checked[index == 0];
                label for=(id) title=[hints.get(index)] { (name) }
            }
        }
    }
}

fn summary(context: &Context<'_>) -> Markup {
    let sentences = summary::sentences(context);
    let overview = overview::overview(context.report, &context.kernels);
    let of_all = summary::over_all(&overview);
    html! {
        section #summary {
            h2 { "Summary" }
            @if !of_all.is_empty() { ul { @for sentence in &of_all { li { (sentence) } } } }
            // What is short need not be opened first.
            details open[sentences.len() <= 2] {
                summary { "Scene by scene" }
                @for (scene, sentences) in &sentences {
                    h3 { (scene) }
                    ul { @for sentence in sentences { li { (sentence) } } }
                    @if sentences.is_empty() { p { "Nothing was measured." } }
                }
            }
            @if !overview.is_empty() {
                h3 { "Kernels over all scenes" }
                (table("table-overview", &columns::overview(&overview), &vec![None; overview.len()]))
                p.note {
                    "Speed on a chip is in instructions, which are exact; on the host in time, as a ratio to f32 in the \
                     same run. On chips f32 is soft float: what one would do without integers."
                }
            }
        }
    }
}

fn plots(context: &Context<'_>) -> Result<Markup, PageError> {
    let names = Metric::ALL.map(Metric::name);
    let hints = Metric::ALL.map(Metric::explanation);
    let mut growth = Vec::new();
    for study in [Study::Triangles, Study::Size] {
        growth.push((study, figures::of_study(context, study)?));
    }
    let mut knobs = Vec::new();
    for study in [Study::Samples, Study::Depth, Study::C, Study::D, Study::E, Study::Leaf, Study::Grid] {
        knobs.push((study, figures::of_study(context, study)?));
    }
    let of_studies = |studies: &[(Study, Markup)]| {
        html! {
            @if studies.iter().all(|(_, plots)| plots.0.is_empty()) { p { "Not in this report." } }
            @for (study, plots) in studies { @if !plots.0.is_empty() {
                h3 { (study::title(*study)) }
                (plots)
            } }
        }
    };
    Ok(html! {
        form.chooser {
            (choice("metric", "Error", &names, &hints))
            @if context.scenes.len() > 1 { (choice("scene", "Scene", &context.scenes, &[])) }
        }
        section #time {
            h2 { "Error against run time" }
            @for (index, metric) in Metric::ALL.into_iter().enumerate() {
                p class={ "metric metric-" (index) } { strong { (metric.name()) ": " } (metric.explanation()) }
            }
            p {
                "Left is faster, below is nearer to the reference. Filled points are on the Pareto front, the line: no other \
                 is as fast and as near. Gray rings are dominated: some other kernel is at least as good in both. The \
                 last plot has in place of the time the bytes of the blob, the scene as a chip stores it."
            }
            (figures::error_against_cost(context)?)
        }
        section #growth {
            h2 { "Growth" }
            p {
                "Cost over the number of triangles and of pixels. Behind a name stands the exponent of the power law that \
                 fits best (least squares in the logarithms of both): n^0.50 would be a cost that doubles when n is \
                 fourfold."
            }
            (of_studies(&growth))
        }
        section #knobs {
            h2 { "Knobs" }
            p { "One setting is varied, the others stay. A gap in a line is a point that failed." }
            (of_studies(&knobs))
        }
        section #causes {
            h2 { "Why pixels differ" }
            p {
                "Pixels by the first cause that applies, as shares of those that differ; how many these are, of all \
                 pixels, stands behind each bar."
            }
            (figures::causes(context)?)
        }
    })
}

fn tables(context: &Context<'_>) -> Markup {
    let of_study = |study: Study| {
        let rows: Vec<(usize, &Row)> = context.report.rows.iter().enumerate().collect();
        let drawn = |row: &Row| row.point.study == study && matches!(row.outcome, Outcome::Measured(_));
        let (indices, rows): (Vec<_>, Vec<_>) =
            rows.into_iter().filter(|(_, row)| drawn(row)).map(|(index, row)| (Some(index), row)).unzip();
        (!rows.is_empty()).then(|| {
            let (columns, common) = columns::columns(&rows);
            html! {
                h3 { (study::title(study)) }
                @if !common.is_empty() { p.note { "All with: " (common) "." } }
                (table(&format!("table-{}", name(&study)), &columns, &indices))
            }
        })
    };
    html! {
        section #tables {
            h2 { "Tables" }
            p { "A click on a header sorts, another one the other way round. The address then keeps it." }
            @for table in study::STUDIES.into_iter().filter_map(of_study) { (table) }
        }
    }
}

fn failures(context: &Context<'_>) -> Markup {
    let report = context.report;
    let failed: Vec<(usize, &Row, &String)> = report
        .rows
        .iter()
        .enumerate()
        .filter_map(|(index, row)| match &row.outcome {
            Outcome::Failed(reason) => Some((index, row, reason)),
            Outcome::Measured(_) => None,
        })
        .collect();
    let column = |title: &str, cell: &dyn Fn(&Row, &String) -> String| Column {
        title: title.into(),
        hint: "",
        cells: failed.iter().map(|(_, row, reason)| Cell::Word(cell(row, reason))).collect(),
    };
    let columns = [
        column("scene", &|row, _| row.point.scene.clone()),
        column("machine", &|row, _| name(&row.point.machine)),
        column("kernel", &|row, _| row.point.kernel.clone()),
        column("study", &|row, _| name(&row.point.study)),
        column("settings", &|row, _| {
            settings(&row.point).into_iter().map(|(key, value)| format!("{key} {value}")).collect::<Vec<_>>().join(", ")
        }),
        column("why", &|_, reason| reason.clone()),
    ];
    let indices: Vec<_> = failed.iter().map(|(index, ..)| Some(*index)).collect();
    let unread: Vec<_> = report.scenes.iter().filter_map(|scene| Some((scene, scene.failed.as_ref()?))).collect();
    html! {
        @if !unread.is_empty() || !failed.is_empty() || !report.notes.is_empty() {
            section #failures {
                h2 { "What is missing" }
                @for note in &report.notes { p { (note) } }
                @if !unread.is_empty() {
                    h3 { "Scenes that could not be read" }
                    ul { @for (scene, reason) in &unread { li { strong { (scene.path) } ": " (reason) } } }
                }
                @if !failed.is_empty() {
                    h3 { "Points that failed" }
                    (table("table-failed", &columns, &indices))
                }
            }
        }
    }
}

fn origin(report: &Report) -> Markup {
    html! {
        section #origin {
            h2 { "How it was made" }
            p { "This command renews the page:" }
            pre { code { (report.command) } }
            dl {
                dt { "schema" } dd { (report.schema) }
                dt { "host" } dd {
                    (report.machine.cpu) ", " (report.machine.cores)
                    @if report.machine.cores == 1 { " core, " } @else { " cores, " }
                    (report.machine.os)
                }
                @for (name, version) in &report.versions { dt { (name) } dd { (version) } }
            }
            @if !report.scenes.is_empty() {
                h3 { "Scenes" }
                ul { @for scene in &report.scenes { li {
                    strong { (scene.name) } ": " (scene.path)
                    @if scene.failed.is_none() {
                        ", " (number::grouped(scene.triangles)) " triangles, "
                        (number::grouped(scene.spheres)) " spheres"
                    }
                } } }
            }
            h3 { "What is measured" }
            ul {
                li { "Error: against the reference, an independent f64 tracer, of the scene as it was given, at the same \
                      size, samples and depth." }
                li { "Where samples are random, chips draw few of them, at most 4 a pixel, and small pictures: the column of samples \
                      has how many." }
                li { "Instructions: counted by QEMU, exactly, from the first camera ray of each tile to its last pixel." }
                li { "Cycles: a model, named in its column. QEMU has no notion of a chip's pipeline or flash." }
                li { "Time: of one thread on the host, every kernel taking its turn in each round; the ratio to f32 is of \
                      the same round." }
            }
        }
    }
}
