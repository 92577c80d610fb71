//! The lines of a study: error or cost over what it varies.

use crate::report::row::{Outcome, Row, Study};

use super::context::{Context, grouped, settings};
use super::fit;
use super::lines::Line;
use super::metric::Metric;
use super::study::{Varied, unset, unvaried, varied};

/// What a line shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shown {
    /// An error.
    Error(Metric),
    /// The cost.
    Cost,
}

/// The lines of a study of a scene, and the names along the axis where what is varied is a setting.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Series {
    /// A line for each kernel, and for what else differs.
    pub(super) lines: Vec<Line>,
    /// Names of settings.
    pub(super) categories: Option<Vec<String>>,
}

/// Of rows of one study and scene; for costs, of one machine. Errors are the same on all machines, so the first is taken.
pub(super) fn series(context: &Context<'_>, study: Study, rows: &[&Row], shown: Shown) -> Series {
    let settings_of_all = {
        let mut all: Vec<Option<u32>> = Vec::new();
        for row in rows {
            if let Some(Varied::Setting(setting)) = varied(study, &row.point, None) {
                all.push(setting);
            }
        }
        all.sort_by_key(|setting| setting.unwrap_or(u32::MAX));
        all.dedup();
        all
    };
    let groups = grouped(rows, unvaried);
    let lines = groups.iter().map(|(rest, rows)| {
        let mut points: Vec<(f64, Option<f64>)> = Vec::new();
        for row in rows {
            let measured = match &row.outcome {
                Outcome::Measured(measured) => Some(&**measured),
                Outcome::Failed(_) => None,
            };
            let x = match varied(study, &row.point, measured) {
                Some(Varied::Amount(amount)) => amount,
                Some(Varied::Setting(setting)) => {
                    settings_of_all.iter().position(|known| *known == setting).unwrap_or(0) as f64
                }
                None => continue,
            };
            let value = measured.map(|measured| match shown {
                Shown::Error(metric) => metric.of(&row.point, measured),
                Shown::Cost => super::study::measure(study).of(&row.point, measured).0,
            });
            match points.iter_mut().find(|point| point.0 == x) {
                Some(point) => point.1 = point.1.or(value),
                None => points.push((x, value)),
            }
        }
        // What the kernel decides is no step on the way from number to number.
        if settings_of_all.last() == Some(&None) {
            points.push((settings_of_all.len() as f64 - 1.5, None));
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let drawn: Vec<(f64, f64)> = points.iter().filter_map(|&(x, value)| Some((x, value?))).collect();
        let mut name = rest.kernel.clone();
        for (key, value) in settings(rest) {
            let differs = groups.iter().any(|(other, _)| !settings(other).contains(&(key, value.clone())));
            if differs {
                name += &format!(", {key} {value}");
            }
        }
        if let (Shown::Cost, true, Some(exponent)) = (shown, settings_of_all.is_empty(), fit::exponent(&drawn)) {
            name += &format!(" (n^{exponent:.2})");
        }
        (drawn.len(), Line { name, colour: context.colour(&rest.kernel), points })
    });
    let lines = lines.filter(|(drawn, _)| *drawn > 0).map(|(_, line)| line).collect();
    let name = |setting: &Option<u32>| setting.map_or(unset(study).to_owned(), |setting| setting.to_string());
    let categories = (!settings_of_all.is_empty()).then(|| settings_of_all.iter().map(name).collect());
    Series { lines, categories }
}
