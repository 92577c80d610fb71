//! What all parts of a page ask of a report.

use crate::report::Report;
use crate::report::row::{Machine, Measured, Outcome, Point, Row, Study};

use super::cost::MACHINES;

/// A point that was drawn.
pub(super) type Drawn<'a> = (&'a Point, &'a Measured);

/// A report, with its kernels and scenes in the order of their first row.
#[derive(Clone, Debug)]
pub(super) struct Context<'a> {
    /// The report.
    pub(super) report: &'a Report,
    /// Its kernels.
    pub(super) kernels: Vec<String>,
    /// The scenes that have rows.
    pub(super) scenes: Vec<&'a str>,
}

impl<'a> Context<'a> {
    /// Of a report.
    pub(super) fn new(report: &'a Report) -> Self {
        let (mut kernels, mut scenes): (Vec<String>, Vec<&str>) = (Vec::new(), Vec::new());
        for Row { point, .. } in &report.rows {
            if !kernels.contains(&point.kernel) {
                kernels.push(point.kernel.clone());
            }
            if !scenes.contains(&point.scene.as_str()) {
                scenes.push(&point.scene);
            }
        }
        Self { report, kernels, scenes }
    }

    /// The colour of a kernel, the same throughout the page.
    pub(super) fn colour(&self, kernel: &str) -> usize {
        self.kernels.iter().position(|known| known == kernel).unwrap_or(0)
    }

    /// The rows of a study of a scene.
    pub(super) fn rows(&self, study: Study, scene: &str) -> Vec<&'a Row> {
        self.report.rows.iter().filter(|row| row.point.study == study && row.point.scene == scene).collect()
    }
}

/// What was drawn among rows.
pub(super) fn drawn<'a>(rows: &[&'a Row]) -> Vec<Drawn<'a>> {
    let measured = |row: &&'a Row| match &row.outcome {
        Outcome::Measured(measured) => Some((&row.point, &**measured)),
        Outcome::Failed(_) => None,
    };
    rows.iter().filter_map(measured).collect()
}

/// The kernels of rows that failed.
pub(super) fn failed<'a>(rows: &[&'a Row]) -> Vec<&'a str> {
    let failed = |row: &&&'a Row| matches!(row.outcome, Outcome::Failed(_));
    rows.iter().filter(failed).map(|row| row.point.kernel.as_str()).collect()
}

/// The rows of each machine that has any.
pub(super) fn by_machine<'a>(rows: &[&'a Row]) -> Vec<(Machine, Vec<&'a Row>)> {
    let of = |machine| rows.iter().copied().filter(|row| row.point.machine == machine).collect::<Vec<_>>();
    MACHINES.map(|machine| (machine, of(machine))).into_iter().filter(|(_, rows)| !rows.is_empty()).collect()
}

/// Rows by what `key` says of their points, in the order of their first.
pub(super) fn grouped<'a>(rows: &[&'a Row], key: impl Fn(&Point) -> Point) -> Vec<(Point, Vec<&'a Row>)> {
    let mut groups: Vec<(Point, Vec<&Row>)> = Vec::new();
    for &row in rows {
        let key = key(&row.point);
        match groups.iter_mut().find(|group| group.0 == key) {
            Some(group) => group.1.push(row),
            None => groups.push((key, vec![row])),
        }
    }
    groups
}

/// A point's settings without its kernel: what kernels are compared at.
pub(super) fn setting(point: &Point) -> Point {
    Point { kernel: String::new(), ..point.clone() }
}

/// The settings of a point that are set, by name: size, samples, depth, and knobs.
pub(super) fn settings(point: &Point) -> Vec<(&'static str, String)> {
    let [width, height] = point.size;
    let mut set = vec![
        ("size", format!("{width}x{height}")),
        ("samples", point.samples.to_string()),
        ("depth", point.depth.to_string()),
    ];
    set.extend(point.set().map(|(name, value)| (name, value.to_string())));
    set
}
