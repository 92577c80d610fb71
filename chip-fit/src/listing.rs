//! All chips, by family, for a person.

use std::collections::BTreeMap;

use crate::cli::Asked;
use crate::database::Kind;
use crate::fit::{Judged, Margin};
use crate::single::{headline, missing, seconds};

/// How many families of near misses are told.
const MISSES: usize = 10;

/// Chips of a family with one core and clock.
type Group<'a> = BTreeMap<(&'a str, String, Option<u32>), Vec<&'a Judged<'a>>>;

/// The answer for all chips.
pub(crate) fn text(asked: &Asked, judged: &[Judged<'_>]) -> String {
    let mut lines = vec![headline(asked)];
    for need in &asked.needs {
        let stack = if need.stack_is_measured { "of stack" } else { "reserved for the stack" };
        lines.push(format!(
            "{}: flash {} bytes, {} of code and {} of scene; RAM {} bytes, {} of variables and {} {stack}{}",
            need.isa.name(),
            need.flash(),
            need.text_bytes,
            need.scene_bytes,
            need.ram(),
            need.static_bytes,
            need.stack_bytes,
            need.instructions.map_or_else(String::new, |count| format!("; {count} instructions a frame")),
        ));
    }
    let fitting: Vec<_> = judged.iter().filter(|judged| judged.fits()).collect();
    let missing: Vec<_> = judged.iter().filter(|judged| judged.misses()).collect();
    let all = fitting.len() + missing.len();
    lines.push(format!("\nfits {} of {all} chips that are known to have no FPU", fitting.len()));
    if !fitting.is_empty() {
        lines.extend(fits(&fitting));
    }
    if !missing.is_empty() {
        lines.push(format!("\nmisses {}, the nearest of each family by", missing.len()));
        lines.extend(misses(asked, &missing));
    }
    lines.push(format!("\n{}", others(judged)));
    lines.join("\n")
}

/// The families that it fits, a line each.
fn fits(fitting: &[&Judged<'_>]) -> Vec<String> {
    let mut groups = Group::new();
    for &judged in fitting {
        let chip = judged.chip;
        let key = (chip.family.as_str(), chip.core(), chip.known.map(|row| row.clock_mhz));
        groups.entry(key).or_default().push(judged);
    }
    let head = ["family", "core", "MHz", "chips", "the smallest", "flash", "RAM", "s a frame"].map(String::from);
    let mut rows = vec![head];
    for ((family, core, clock), chips) in groups {
        let Some(least) = chips.iter().min_by_key(|judged| (judged.chip.flash, judged.chip.ram)) else { continue };
        let unknown = || "?".to_owned();
        rows.push([
            family.into(),
            core,
            clock.map_or_else(unknown, |clock| clock.to_string()),
            chips.len().to_string(),
            least.chip.name.clone(),
            match least.chip.known {
                Some(row) if row.flash_is_apart => "apart".into(),
                _ => kibibytes(least.chip.flash),
            },
            kibibytes(least.chip.ram),
            match least.time {
                Some(time) if time.cycle_model.is_none() => format!(">{}", seconds(time)),
                Some(time) => seconds(time),
                None => unknown(),
            },
        ]);
    }
    aligned(&rows, [false, false, true, true, false, true, true, true])
}

/// The nearest misses, a line a family.
fn misses(asked: &Asked, missed: &[&Judged<'_>]) -> Vec<String> {
    let mut nearest: BTreeMap<&str, (&Judged<'_>, Margin)> = BTreeMap::new();
    for judged in missed {
        let Some(margin) = judged.margin else { continue };
        let found = nearest.entry(&judged.chip.family).or_insert((judged, margin));
        if margin.missing() < found.1.missing() {
            *found = (judged, margin);
        }
    }
    let mut nearest: Vec<_> = nearest.into_values().collect();
    nearest.sort_by_key(|(judged, margin)| (margin.missing(), &judged.chip.name));
    let mut rows = vec![["family", "chip", "too few"].map(String::from)];
    for (judged, margin) in nearest.iter().take(MISSES) {
        rows.push([judged.chip.family.clone(), judged.chip.name.clone(), missing(*margin)]);
    }
    let mut lines = aligned(&rows, [false; 3]);
    if nearest.len() > MISSES {
        lines.push(format!("and {} families more", nearest.len() - MISSES));
    }
    if let Some((judged, margin)) = nearest.first() {
        let need = asked.needs.iter().find(|need| Some(need.isa) == judged.chip.isa());
        let help = need.map_or_else(String::new, |need| asked.help(need, judged.chip, *margin));
        lines.push(format!("what would help on {}: {help}", judged.chip.name));
    }
    lines
}

/// The chips that are not judged, in a line.
fn others(judged: &[Judged<'_>]) -> String {
    let count = |kind| judged.iter().filter(|judged| judged.kind == kind).count();
    let said = [
        (Kind::Unknown, "are unknown: their cores come with an FPU or without"),
        (Kind::Float, "have an FPU (`--chip` takes them all the same)"),
        (Kind::Foreign, "run neither thumbv6m nor rv32imac"),
        (Kind::Unmapped, "have no memory map"),
    ];
    let said = said.into_iter().map(|(kind, what)| (count(kind), what)).filter(|&(count, _)| count > 0);
    let said: Vec<String> = said.map(|(count, what)| format!("{count} {what}")).collect();
    format!("of the other chips, {}", said.join("; "))
}

/// KiB, rounded down.
fn kibibytes(bytes: u64) -> String {
    format!("{}K", bytes >> 10)
}

/// Rows in columns, of numbers to the right.
fn aligned<const N: usize>(rows: &[[String; N]], is_number: [bool; N]) -> Vec<String> {
    let widths: [usize; N] =
        std::array::from_fn(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    let cell = |row: &[String; N], column: usize| {
        let (text, width) = (&row[column], widths[column]);
        if is_number[column] { format!("{text:>width$}") } else { format!("{text:<width$}") }
    };
    let line = |row| (0..N).map(|column| cell(row, column)).collect::<Vec<_>>().join("  ").trim_end().to_owned();
    rows.iter().map(line).collect()
}
