//! Rows as text for a person.

use std::fmt::Write;

use super::Group;
use super::row::{Outcome, Row};
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
