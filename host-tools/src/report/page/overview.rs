//! Each kernel over all scenes: what a reader who has not decided on a scene wants first.

use crate::report::Report;
use crate::report::row::{Machine, Measured, Outcome, Point, Study};

use super::context::drawn;
use super::cost::MACHINES;
use super::metric::percent;
use super::summary::speed;

/// A kernel on a machine, over the scenes that it drew.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Overview {
    /// The machine.
    pub(super) machine: Machine,
    /// The kernel.
    pub(super) kernel: String,
    /// How many points it drew, and of how many.
    pub(super) drawn: (usize, usize),
    /// How many times as fast as f32: the least, the geometric mean, the greatest; over points that f32 drew too.
    pub(super) speed: Option<[f64; 3]>,
    /// Pixels over 64, per cent: the median and the most.
    pub(super) over_64: Option<[f64; 2]>,
    /// Pixels over 4, likewise.
    pub(super) over_4: Option<[f64; 2]>,
}

/// All kernels on all machines, from the rows of [`Study::Kernels`].
pub(super) fn overview(report: &Report, kernels: &[String]) -> Vec<Overview> {
    let pairs = MACHINES.iter().flat_map(|&machine| kernels.iter().map(move |kernel| (machine, kernel)));
    pairs.filter_map(|(machine, kernel)| of_one(report, machine, kernel)).collect()
}

fn of_one(report: &Report, machine: Machine, kernel: &str) -> Option<Overview> {
    let own = |point: &Point| point.study == Study::Kernels && point.machine == machine && point.kernel == kernel;
    let rows: Vec<_> = report.rows.iter().filter(|row| own(&row.point)).collect();
    let measured = drawn(&rows);
    let base = |point: &Point| {
        let sought = Point { kernel: "f32".into(), ..point.clone() };
        report.rows.iter().find(|row| row.point == sought).and_then(|row| match &row.outcome {
            Outcome::Measured(measured) => Some(&**measured),
            Outcome::Failed(_) => None,
        })
    };
    let speeds: Vec<f64> = measured.iter().filter_map(|(point, measured)| speed(measured, base(point))).collect();
    let spread = |over: fn(&Measured) -> u64| {
        middle_and_most(measured.iter().map(|(point, measured)| percent(over(measured), point)).collect())
    };
    (!rows.is_empty()).then(|| Overview {
        machine,
        kernel: kernel.into(),
        drawn: (measured.len(), rows.len()),
        speed: (!speeds.is_empty()).then(|| {
            let logs: f64 = speeds.iter().map(|&speed| libm::log(speed)).sum();
            let least = speeds.iter().fold(f64::INFINITY, |a, &b| a.min(b));
            let most = speeds.iter().fold(0.0f64, |a, &b| a.max(b));
            [least, libm::exp(logs / speeds.len() as f64), most]
        }),
        over_64: spread(|measured| measured.error.over_64),
        over_4: spread(|measured| measured.error.over_4),
    })
}

/// The median, the upper of two, and the most.
fn middle_and_most(mut values: Vec<f64>) -> Option<[f64; 2]> {
    values.sort_by(f64::total_cmp);
    Some([*values.get(values.len() / 2)?, *values.last()?])
}
