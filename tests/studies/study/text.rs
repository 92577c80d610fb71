//! Tables and sentences.

use std::fmt::{Display, Formatter};

/// A Markdown table and an empty line.
pub(crate) fn table<S: AsRef<str>>(head: &[S], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let line = |cells: &[&str]| format!("| {} |\n", cells.join(" | "));
    let head: Vec<&str> = head.iter().map(AsRef::as_ref).collect();
    let mut text = line(&head) + &line(&vec!["---"; head.len()]);
    for row in rows {
        text += &line(&row.iter().map(String::as_str).collect::<Vec<_>>());
    }
    text.push('\n');
    text
}

/// A ratio of times with two decimals, or a dash where none was measured.
pub(crate) fn ratio(value: Option<f64>) -> String {
    value.map_or("-".into(), |value| format!("{value:.2}"))
}

/// A claim, and whether the figures bear it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Verdict {
    /// The claim, as a sentence without its point.
    pub(crate) claim: &'static str,
    /// Whether it holds.
    pub(crate) holds: bool,
    /// The figures that decide.
    pub(crate) because: String,
}

impl Display for Verdict {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { claim, holds, because } = self;
        let holds = if *holds { "Holds" } else { "Does not hold" };
        write!(f, "**{holds}**: {claim} ({because}).")
    }
}
