//! Triangles that have no area on a grid, by the grid's width.

use glam::DVec3;
use host_tools::model::Model;

use super::text::{Verdict, table};
use super::{Setup, Study};

/// Bits of a coordinate.
const WIDTHS: [u32; 22] = [8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29];

/// Degenerate triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Count {
    /// Two corners are one.
    pub(crate) zero_edge: u64,
    /// Three corners are in one line.
    pub(crate) zero_area: u64,
}

impl Count {
    fn total(self) -> u64 {
        self.zero_edge + self.zero_area
    }
}

/// A scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Row {
    /// Its name.
    pub(crate) scene: String,
    /// Its triangles, before any are removed.
    pub(crate) triangles: u64,
    /// For each width.
    pub(crate) counts: Vec<Count>,
}

/// Degenerates of a model on a grid of so many bits, whose greatest extent is the grid's.
pub(crate) fn count(model: &Model, bits: u32) -> Count {
    let vertices = || model.triangles.iter().flat_map(|t| t.vertices).map(|v| model.positions[v as usize]);
    let low = vertices().reduce(DVec3::min).unwrap_or_default();
    let high = vertices().reduce(DVec3::max).unwrap_or_default();
    let scale = f64::from((1 << bits) - 1) / (high - low).max_element();
    let place = |v: u32| ((model.positions[v as usize] - low) * scale).to_array().map(|c| (c + 0.5).floor() as i64);
    let mut count = Count::default();
    for triangle in &model.triangles {
        let [a, b, c] = triangle.vertices.map(place);
        let edge = |to: [i64; 3]| [0, 1, 2].map(|axis| to[axis] - a[axis]);
        let (e1, e2) = (edge(b), edge(c));
        let normal = |i: usize| e1[(i + 1) % 3] * e2[(i + 2) % 3] - e1[(i + 2) % 3] * e2[(i + 1) % 3];
        if a == b || b == c || c == a {
            count.zero_edge += 1;
        } else if (0..3).all(|axis| normal(axis) == 0) {
            count.zero_area += 1;
        }
    }
    count
}

/// See [`Study::CLAIM`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Degenerates {
    /// The scenes.
    pub(crate) rows: Vec<Row>,
}

impl Study for Degenerates {
    const NAME: &'static str = "degenerates";
    const TITLE: &'static str = "Degenerates by grid width";
    const CLAIM: &'static str = "\
Triangles that have an edge of no length, or no area, on the grid are removed (2.2). On the 29-bit grid most of the report's \
scenes have a few, and *kalabsha* more than a third of all (3, Table 2). Here the greatest extent of a scene is that of the grid.";

    fn measure(setup: &Setup) -> Self {
        let row = |subject: &super::scenes::Subject| Row {
            scene: subject.name.clone(),
            triangles: subject.model.triangles.len() as u64,
            counts: WIDTHS.iter().map(|&bits| count(&subject.model, bits)).collect(),
        };
        Self { rows: setup.subjects.iter().map(row).collect() }
    }

    fn tables(&self) -> String {
        let report = self.rows.iter().filter_map(|row| {
            let removed = row.counts.last()?.total();
            let actual = row.triangles - removed;
            let share = 100.0 * actual as f64 / row.triangles as f64;
            Some(vec![row.scene.clone(), removed.to_string(), actual.to_string(), format!("{share:.1}")])
        });
        let mut head = vec!["scene".to_owned()];
        head.extend(WIDTHS.map(|bits| bits.to_string()));
        let by_width = |pick: fn(&Count) -> u64| {
            let rows = self.rows.iter().map(move |row| {
                [row.scene.clone()].into_iter().chain(row.counts.iter().map(|count| pick(count).to_string())).collect()
            });
            table(&head, rows)
        };
        format!(
            "On the 29-bit grid, with the columns of Table 2:\n\n{}With an edge of no length, by the grid's bits:\n\n{}With \
             edges, but without area, by the grid's bits:\n\n{}",
            table(&["scene", "degen", "actual", "% orig"], report),
            by_width(|count| count.zero_edge),
            by_width(|count| count.zero_area)
        )
    }

    fn verdicts(&self) -> Vec<Verdict> {
        let at_29 = || self.rows.iter().filter_map(|row| Some((row, row.counts.last()?.total())));
        let some: Vec<String> =
            at_29().filter(|(_, count)| *count > 0).map(|(row, count)| format!("{} {count}", row.scene)).collect();
        let third = at_29().filter(|(row, count)| 3 * count > row.triangles).count();
        let scenes = self.rows.len();
        let named = if some.is_empty() { String::new() } else { format!(": {}", some.join(", ")) };
        vec![
            Verdict {
                claim: "most scenes have degenerate triangles on the 29-bit grid",
                holds: 2 * some.len() > scenes,
                because: format!("{} of {scenes}{named}", some.len()),
            },
            Verdict {
                claim: "there are scenes of which more than a third is degenerate on it",
                holds: third > 0,
                because: format!("{third} of {scenes}"),
            },
        ]
    }
}
