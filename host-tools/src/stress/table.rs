//! Rows as text for a person.

use std::fmt::Write;

use super::row::{Outcome, Row};
use super::{Case, Group};
use crate::report::row::Machine;

/// A machine as it is called on the command line and in the JSON.
#[must_use]
pub const fn machine(machine: Machine) -> &'static str {
    match machine {
        Machine::Host => "host",
        Machine::Rv32imac => "rv32imac",
        Machine::Thumbv6m => "thumbv6m",
    }
}

/// All rows by group, and how many came out how.
#[must_use]
pub fn text(rows: &[Row]) -> String {
    let mut text = String::new();
    for group in [Group::Scale, Group::Triangles, Group::Rays, Group::Shading, Group::Structure] {
        let of_group: Vec<&Row> = rows.iter().filter(|row| row.group == group).collect();
        if of_group.is_empty() {
            continue;
        }
        // A string takes whatever there is.
        let _ = writeln!(
            text,
            "{}\n  {:<24} {:<12} {:<9} {:<8} {:>9} {:>8} {:>7} {:>6} {:>9} {:>9} {:>6}  {:<8}  reason",
            group.title(),
            "case",
            "kernel",
            "machine",
            "outcome",
            "measured",
            "over 64",
            "over 4",
            "holes",
            "self-hits",
            "saturated",
            "work",
            "CRC-32"
        );
        for row in of_group {
            let _ = writeln!(text, "  {}", line(row));
        }
    }
    let count = |outcome| rows.iter().filter(|row| row.outcome == outcome).count();
    let _ = write!(
        text,
        "{} rows: {} pass, {} refused, {} fail",
        rows.len(),
        count(Outcome::Pass),
        count(Outcome::Refused),
        count(Outcome::Fail)
    );
    text
}

fn line(row: &Row) -> String {
    let number =
        |get: fn(&super::row::Figures) -> u64| row.figures.as_ref().map_or(String::from("-"), |f| get(f).to_string());
    let measured = row.measured.map_or(String::from("-"), |measured| format!("{measured}/{}", row.bound));
    let work = row.relative_work.map_or(String::from("-"), |work| format!("{work:.2}"));
    let crc = row.figures.as_ref().map_or("-", |figures| &figures.image_crc32);
    let grids = if row.part_grids { " [grids of their own for its parts would hold it]" } else { "" };
    format!(
        "{:<24} {:<12} {:<9} {:<8} {measured:>9} {:>8} {:>7} {:>6} {:>9} {:>9} {work:>6}  {crc:<8}  {}{grids}",
        row.name,
        row.kernel,
        machine(row.machine),
        row.outcome.name(),
        number(|f| f.over_64),
        number(|f| f.over_4),
        number(|f| f.holes),
        number(|f| f.self_hits),
        number(|f| f.saturated),
        row.reason,
    )
}

/// The cases of a group in Markdown: a line a case with what is expected and what each kernel makes of it, and under the
/// table why, where that is not simply a pass. `rows` are the host's.
///
/// Lines of cases that have no rows are left out.
#[must_use]
pub fn markdown(cases: &[Case], kernels: &[&str], rows: &[Row]) -> Vec<(Group, String, String)> {
    let of = |name: &str| -> Vec<&Row> { rows.iter().filter(|row| row.name == name).collect() };
    let drawn = cases.iter().map(|case| (case, of(case.name))).filter(|(_, rows)| !rows.is_empty());
    drawn.map(|(case, rows)| (case.group, case_line(case, kernels, &rows), reasons(case, &rows))).collect()
}

/// A line of the table.
fn case_line(case: &Case, kernels: &[&str], rows: &[&Row]) -> String {
    let cell = |kernel: &&str| match rows.iter().find(|row| row.kernel == *kernel) {
        None => String::from("-"),
        Some(row) => match row.measured {
            None => row.outcome.name().into(),
            Some(measured) => format!("{} {measured}/{}", row.outcome.name(), row.bound),
        },
    };
    let cells: Vec<String> = kernels.iter().map(cell).collect();
    let grids = if case.part_grids { " \\*" } else { "" };
    format!("| `{}`{grids} | {} | {} |\n", case.name, case.expectation, cells.join(" | "))
}

/// Why, with the kernels of which the same is said together.
fn reasons(case: &Case, rows: &[&Row]) -> String {
    // What differs in nothing but the kernel's name is the same.
    let is_of_name = |c: char| c.is_alphanumeric() || c == '-';
    let general = |row: &Row| -> String {
        // By whole words: one name may begin another.
        let words = row.reason.split_inclusive(|c| !is_of_name(c));
        words
            .map(|word| match word.strip_prefix(row.kernel) {
                Some(rest) if !rest.contains(is_of_name) => format!("the kernel{rest}"),
                _ => word.to_owned(),
            })
            .collect()
    };
    let mut said: Vec<(String, Vec<&Row>)> = Vec::new();
    for row in rows.iter().filter(|row| !row.reason.is_empty()) {
        match said.iter_mut().find(|(reason, _)| *reason == general(row)) {
            Some((_, rows)) => rows.push(row),
            None => said.push((general(row), vec![row])),
        }
    }
    let mut text = String::new();
    for (reason, rows) in said {
        let kernels: Vec<String> = rows.iter().map(|row| format!("`{}`", row.kernel)).collect();
        // A string takes whatever there is.
        let _ = writeln!(text, "- `{}`, {}: {reason}.", case.name, kernels.join(", "));
    }
    text
}
