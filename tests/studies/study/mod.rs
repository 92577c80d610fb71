//! What the 2009 report claims of its integer tracer, measured: a module a study.
//!
//! Heinly, Recker, Bensema, Porch & Gribble, "Integer Ray Tracing" (GCC-CS-001-2009), sections 2.2 to 4. A study measures
//! figures, and says by them alone which claims hold here.

pub(crate) mod c_and_d;
pub(crate) mod chance;
pub(crate) mod degenerates;
pub(crate) mod edge_shift;
pub(crate) mod epsilon;
pub(crate) mod kernels;
pub(crate) mod leaf_bounds;
pub(crate) mod leaf_threshold;
pub(crate) mod machine;
pub(crate) mod paths;
pub(crate) mod planes;
pub(crate) mod plot;
pub(crate) mod scenes;
pub(crate) mod seams;
pub(crate) mod text;

use std::fmt::Write;

use scenes::Subject;
use text::Verdict;

/// For studies of the tree, larger scenes tell nothing more, and take long with leaves of 64.
const TRIANGLES_MAX: usize = 100_000;

/// What is measured, and how large.
pub(crate) struct Setup {
    /// Pixels a side.
    pub(crate) size: u32,
    /// Rounds of timing; without any, no time is measured, and every figure is the same on every run.
    pub(crate) rounds: usize,
    /// The scenes.
    pub(crate) subjects: Vec<Subject>,
    /// Names of shared scenes that are not there.
    pub(crate) absent: Vec<&'static str>,
}

/// One study: its figures, and what they say.
pub(crate) trait Study: Sized {
    /// The name of its plot's file, without an ending.
    const NAME: &'static str;
    /// Its heading.
    const TITLE: &'static str;
    /// What the report claims, with its section, and what is measured here.
    const CLAIM: &'static str;

    /// Measures.
    fn measure(setup: &Setup) -> Self;
    /// The tables, in Markdown, each followed by an empty line.
    fn tables(&self) -> String;
    /// What holds and what does not, by the figures.
    fn verdicts(&self) -> Vec<Verdict>;
    /// What a plot says better, as SVG.
    fn plot(&self) -> Option<String> {
        None
    }
}

/// A study as it is written.
pub(crate) struct Page {
    /// See [`Study::NAME`].
    pub(crate) name: &'static str,
    /// In Markdown.
    pub(crate) text: String,
    /// See [`Study::plot`].
    pub(crate) plot: Option<String>,
}

/// Measures and writes a study.
fn page<S: Study>(setup: &Setup) -> Page {
    let study = S::measure(setup);
    let plot = study.plot();
    let mut text = format!("## {}\n\n{}\n\n{}", S::TITLE, S::CLAIM, study.tables());
    if plot.is_some() {
        let _ = writeln!(text, "![{}](studies/{}.svg)\n", S::TITLE, S::NAME);
    }
    for verdict in study.verdicts() {
        let _ = writeln!(text, "- {verdict}");
    }
    Page { name: S::NAME, text, plot }
}

/// A study's title, and what measures and writes it.
pub(crate) type Entry = (&'static str, fn(&Setup) -> Page);

/// All studies.
pub(crate) const ALL: [Entry; 7] = [
    (c_and_d::CAndD::TITLE, page::<c_and_d::CAndD>),
    (leaf_threshold::LeafThreshold::TITLE, page::<leaf_threshold::LeafThreshold>),
    (leaf_bounds::LeafBounds::TITLE, page::<leaf_bounds::LeafBounds>),
    (epsilon::Epsilon::TITLE, page::<epsilon::Epsilon>),
    (edge_shift::EdgeShift::TITLE, page::<edge_shift::EdgeShift>),
    (seams::Seams::TITLE, page::<seams::Seams>),
    (degenerates::Degenerates::TITLE, page::<degenerates::Degenerates>),
];

/// The document.
pub(crate) fn document(setup: &Setup, pages: &[Page]) -> String {
    let Setup { size, rounds, subjects, absent } = setup;
    let absent = if absent.is_empty() { "none".to_owned() } else { absent.join(", ") };
    let mut text = format!(
        "# Studies of the 2009 report's claims\n\n\
         Written whole by `cargo xtask studies`; edit `tests/studies` instead.\n\n\
         The report is Heinly, Recker, Bensema, Porch & Gribble, \"Integer Ray Tracing\" (GCC-CS-001-2009). It compares an \
         integer tracer with the same tracer in floating point, and so do these studies: `hanika-c` and `hanika-cd` are the \
         report's, and a picture is compared with that of the kernel `f64`, which goes through the same tree, camera and \
         shaders. **Over 64** is the report's count: pixels whose difference, summed over the channels, exceeds 64 of 255. \
         Pictures have {size}x{size} pixels, with one primary ray a pixel and one shadow ray a light. Times are ratios within \
         rounds in which all candidates take turns, on one thread; each is the median of {rounds} rounds. Whether a claim \
         holds is decided by the figures, when this is written.\n\n\
         The report's own scenes are not at hand. Those here are the project's own, and shared ones where they are there \
         (absent: {absent}). The last two columns say how far the kernels `f64` and `exact29` are from the independent \
         tracer of the undiscretised scene.\n\n"
    );
    let rows = subjects.iter().map(|subject| {
        let [float, exact] = subject.over_64_of_reference();
        vec![subject.name.clone(), subject.model.triangles.len().to_string(), float.to_string(), exact.to_string()]
    });
    text += &text::table(&["scene", "triangles", "`f64`, over 64", "`exact29`, over 64"], rows);
    for page in pages {
        text += &page.text;
        text.push('\n');
    }
    text.truncate(text.trim_end().len());
    text.push('\n');
    text
}
