//! Instructions of a picture by part of the program and by kind of ray.
//!
//! The counter is given the [parts](super::parts) of the firmware as ranges of addresses, and the addresses of the marks
//! that the firmware passes where the kind of ray changes. Both are exact: each instruction between the marks of the window
//! is in one cell. A hit's shading is counted for the ray that hit, a shadow ray's preparation for the shadow ray, and that
//! of a ray that goes on for the ray that it goes on from.

use std::fmt::Write;

use serde::Serialize;

use super::EmulateError;
use super::counter::Counts;
use super::parts::{PARTS, Part};

/// The names of the kinds of ray, in the order of all arrays.
pub const KINDS: [&str; 4] = ["primary", "shadow", "reflection", "refraction"];

/// What instructions were for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Breakdown {
    /// The sum of all cells: instructions between the marks of the window.
    pub instructions: u64,
    /// How many more these are than where no kinds of ray are marked.
    pub added: i64,
    /// A row a kind of ray.
    pub kinds: Vec<Row>,
}

/// What instructions for a kind of ray were for.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Row {
    /// The kind's name.
    pub kind: &'static str,
    /// How many rays there were.
    pub rays: u64,
    /// The sum of the parts.
    pub instructions: u64,
    /// The cells.
    pub parts: Vec<Cell>,
}

/// Instructions for a part and a kind of ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Cell {
    /// The part.
    pub part: Part,
    /// How many.
    pub instructions: u64,
}

impl Breakdown {
    /// From what was counted with marks, the instructions without them, and the rays of each kind.
    ///
    /// # Errors
    /// Where the counts are not those of a firmware with marks.
    pub fn new(counts: &Counts, plain: u64, rays: [u64; 4]) -> Result<Self, EmulateError> {
        let damaged = |what: &str| EmulateError::Counter(what.into());
        let mut cells = [[0; PARTS.len()]; KINDS.len()];
        for named in &counts.symbols {
            // What is for whoever calls it was counted for that.
            let Some(part) = Part::by_name(&named.name) else { continue };
            let place = PARTS.iter().position(|&other| other == part).unwrap_or_default();
            let by_kind = named.rays.ok_or_else(|| damaged("rays were not told apart"))?;
            for (row, instructions) in cells.iter_mut().zip(by_kind) {
                row[place] += instructions;
            }
        }
        let kinds = KINDS.into_iter().zip(rays).zip(cells).map(|((kind, rays), row)| {
            let parts = PARTS.into_iter().zip(row).map(|(part, instructions)| Cell { part, instructions });
            Row { kind, rays, instructions: row.iter().sum(), parts: parts.collect() }
        });
        let kinds: Vec<Row> = kinds.collect();
        let instructions = kinds.iter().map(|row| row.instructions).sum();
        if instructions != counts.instructions {
            return Err(damaged("instructions outside of all parts"));
        }
        Ok(Self { instructions, added: instructions.cast_signed() - plain.cast_signed(), kinds })
    }

    /// Instructions for a part and a kind of ray.
    #[must_use]
    pub fn of(&self, kind: &str, part: Part) -> u64 {
        let row = self.kinds.iter().find(|row| row.kind == kind);
        row.and_then(|row| row.parts.iter().find(|cell| cell.part == part)).map_or(0, |cell| cell.instructions)
    }

    /// A table for a person: instructions a ray of each kind, and the share of a part in all.
    #[must_use]
    pub fn table(&self) -> String {
        let per_ray = |row: &Row, instructions: u64| match row.rays {
            0 => "-".into(),
            rays => format!("{:.1}", instructions as f64 / rays as f64),
        };
        let share = |instructions: u64| format!("{:.1}", 100.0 * instructions as f64 / self.instructions.max(1) as f64);
        let mut lines = vec![(
            "instructions a ray".into(),
            self.kinds.iter().map(|row| row.kind.into()).collect(),
            "all, %".into(),
        )];
        for part in PARTS {
            let all = self.kinds.iter().map(|row| self.of(row.kind, part)).sum();
            if all > 0 {
                let cells = self.kinds.iter().map(|row| per_ray(row, self.of(row.kind, part))).collect();
                lines.push((part.name().into(), cells, share(all)));
            }
        }
        let sums = self.kinds.iter().map(|row| per_ray(row, row.instructions)).collect();
        lines.push(("sum".into(), sums, share(self.instructions)));
        lines.push(("share, %".into(), self.kinds.iter().map(|row| share(row.instructions)).collect(), String::new()));
        lines.push(("rays".into(), self.kinds.iter().map(|row| row.rays.to_string()).collect(), String::new()));
        let mut text = String::new();
        for (name, cells, all) in lines as Vec<(String, Vec<String>, String)> {
            let cells: String = cells.iter().map(|cell| format!("{cell:>12}")).collect();
            // A string takes text.
            let _ = writeln!(text, "{}", format!("{name:<20}{cells}{all:>8}").trim_end());
        }
        let added = 100.0 * self.added as f64 / (self.instructions.cast_signed() - self.added).max(1) as f64;
        let _ = write!(text, "the marks of rays add {} instructions, {added:.2} %", self.added);
        text
    }
}
