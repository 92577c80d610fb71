//! What the rows say, in words.

use crate::report::row::{Cost, Machine, Measured, Outcome, Point, Row, Study};

use super::context::{Context, Drawn, by_machine, drawn, grouped, setting};
use super::cost::{MACHINES, machine_phrase};
use super::metric::percent_text;
use super::number::{grouped as thousands, significant};
use super::overview::Overview;
use super::pareto;

/// What others are measured by.
const BASE: &str = "f32";

/// Kernels that use floats: what integers are compared with.
pub(super) fn is_float(kernel: &str) -> bool {
    matches!(kernel, "f32" | "f64")
}

/// How many times as fast as f32 a row is: on a chip from the row of f32, on the host from the rounds of its own.
pub(super) fn speed(measured: &Measured, base: Option<&Measured>) -> Option<f64> {
    let speed = match (&measured.cost, base.map(|base| &base.cost)) {
        (Cost::Time(time), _) => 1.0 / time.ratio[1],
        (Cost::Instructions(work), Some(Cost::Instructions(base))) => {
            base.instructions as f64 / work.instructions as f64
        }
        (Cost::Instructions(_), _) => return None,
    };
    speed.is_finite().then_some(speed)
}

/// Every scene that could be read, with a sentence for each machine and size of which there are rows of
/// [`Study::Kernels`], in the order of the report.
pub(super) fn sentences(context: &Context<'_>) -> Vec<(String, Vec<String>)> {
    let scenes = context.report.scenes.iter().filter(|scene| scene.failed.is_none());
    let of_scene = |scene: &str| {
        let rows = context.rows(Study::Kernels, scene);
        let machines = by_machine(&rows).into_iter();
        machines.flat_map(|(_, rows)| grouped(&rows, setting)).map(|(_, rows)| sentence(&rows)).collect()
    };
    scenes.map(|scene| (scene.name.clone(), of_scene(&scene.name))).collect()
}

/// A sentence for each machine of a report of several scenes: the integer kernels that nothing beats in speed and in
/// pixels over 64 at once.
pub(super) fn over_all(overview: &[Overview]) -> Vec<String> {
    let tried = overview.iter().map(|row| row.drawn.1).max().unwrap_or(0);
    if tried < 2 {
        return Vec::new();
    }
    let of_machine = |&machine: &Machine| {
        // What could not draw everything is not compared with what could.
        let whole = |row: &&Overview| row.machine == machine && row.drawn.0 == row.drawn.1;
        let rows: Vec<(&Overview, [f64; 3], [f64; 2])> = overview
            .iter()
            .filter(whole)
            .filter(|row| !is_float(&row.kernel))
            .filter_map(|row| Some((row, row.speed?, row.over_64?)))
            .collect();
        let points: Vec<(f64, f64)> = rows.iter().map(|(_, speed, over)| (-speed[1], over[1])).collect();
        let stays = pareto::front(&points);
        let mut best: Vec<_> = rows.into_iter().zip(stays).filter(|(_, stays)| *stays).map(|(row, _)| row).collect();
        best.sort_by(|a, b| b.1[1].total_cmp(&a.1[1]));
        let clauses = best.iter().enumerate().map(|(index, (row, [least, mean, most], over))| {
            let [least, mean, most] = [least, mean, most].map(|&speed| significant(speed));
            if index == 0 {
                let over = format!("at most {} % of pixels over 64 in any", significant(over[1]));
                format!(
                    "{} is {mean} times as fast as {} ({least} to {most}), with {over}",
                    row.kernel,
                    base_name(machine)
                )
            } else {
                format!(
                    "{} is {mean} times as fast ({least} to {most}), with at most {} %",
                    row.kernel,
                    significant(over[1])
                )
            }
        });
        let clauses: Vec<String> = clauses.collect();
        let place = format!("Over {} scenes {}", best.first()?.0.drawn.1, machine_phrase(machine));
        Some(format!("{}, {}.", place, clauses.join("; ")))
    };
    MACHINES.iter().filter_map(of_machine).collect()
}

/// What rows of different kernels, otherwise alike, come to. There is at least one.
fn sentence(rows: &[&Row]) -> String {
    let point = &rows[0].point;
    let [width, height] = point.size;
    let place = format!("For {} at {width}x{height} {},", point.scene, machine_phrase(point.machine));

    let measured = drawn(rows);
    let base = measured.iter().find(|(point, _)| point.kernel == BASE).map(|found| found.1);
    let integer: Vec<Drawn<'_>> = measured.iter().copied().filter(|(point, _)| !is_float(&point.kernel)).collect();
    let Some(best) = front(&integer) else {
        let failed = rows.iter().find_map(|row| match &row.outcome {
            Outcome::Failed(reason) if !is_float(&row.point.kernel) => Some((&row.point.kernel, reason)),
            _ => None,
        });
        return match failed {
            Some((kernel, reason)) => format!("{place} no integer kernel could draw it ({kernel}: {reason})."),
            None => format!("{place} no integer kernel was measured."),
        };
    };

    let mut text = place;
    for (index, &(point, measured)) in best.iter().enumerate() {
        text += if index == 0 { " " } else { "; " };
        text += &point.kernel;
        text += " ";
        if index == 0 {
            text += &work(measured);
            text += if speed(measured, base).is_some() { " and " } else { "" };
        }
        text += &speed_text(measured, base, index == 0);
        text += if speed(measured, base).is_some() { ", " } else { " " };
        text += &errors(point, measured, base, index == 0);
    }
    match base {
        None if point.machine == Machine::Host => {}
        None => {
            text += "; ";
            text += &match rows.iter().find(|row| row.point.kernel == BASE).map(|row| &row.outcome) {
                Some(Outcome::Failed(reason)) => format!("{} could not draw it ({reason})", base_name(point.machine)),
                _ => format!("{} was not measured", base_name(point.machine)),
            };
        }
        Some(base) => {
            if best.iter().all(|(_, measured)| measured.error.over_64 > base.error.over_64) {
                text += "; none of the integer kernels has as few of them as f32";
            }
        }
    }
    text + "."
}

/// What nothing beats in cost and in pixels over 64 at once, from the quickest on; `None` of nothing.
fn front<'a>(rows: &[Drawn<'a>]) -> Option<Vec<Drawn<'a>>> {
    let cost = |measured: &Measured| match &measured.cost {
        Cost::Time(time) => time.ratio[1],
        Cost::Instructions(work) => work.instructions as f64,
    };
    let points: Vec<(f64, f64)> =
        rows.iter().map(|(_, measured)| (cost(measured), measured.error.over_64 as f64)).collect();
    let stays = pareto::front(&points);
    let mut best: Vec<_> = rows.iter().copied().zip(stays).filter(|(_, stays)| *stays).map(|(row, _)| row).collect();
    best.sort_by(|a, b| cost(a.1).total_cmp(&cost(b.1)));
    (!best.is_empty()).then_some(best)
}

fn base_name(machine: Machine) -> &'static str {
    if machine == Machine::Host { "f32" } else { "soft-float f32" }
}

/// What drawing took, as a predicate.
fn work(measured: &Measured) -> String {
    match &measured.cost {
        Cost::Time(time) => format!("takes {}", duration(time.seconds)),
        Cost::Instructions(work) if measured.rays > 0 => {
            format!("takes {} instructions a ray", thousands((work.instructions + measured.rays / 2) / measured.rays))
        }
        Cost::Instructions(work) => format!("takes {} instructions", thousands(work.instructions)),
    }
}

/// A time with three digits.
pub(super) fn duration(seconds: f64) -> String {
    if seconds < 1.0 { format!("{} ms", significant(1000.0 * seconds)) } else { format!("{} s", significant(seconds)) }
}

/// How fast that is beside f32, as a predicate, in full where it is `first`; nothing where that is not known.
fn speed_text(measured: &Measured, base: Option<&Measured>, first: bool) -> String {
    let Some(speed) = speed(measured, base) else { return String::new() };
    let (name, spread) = match &measured.cost {
        Cost::Time(time) => {
            let [quick, _, slow] = time.ratio.map(|ratio| format!("{:.2}", 1.0 / ratio));
            let rounds = if time.rounds == 1 { "1 round".into() } else { format!("{} rounds", time.rounds) };
            (base_name(Machine::Host), format!(" ({slow} to {quick} in {rounds})"))
        }
        Cost::Instructions(_) => (base_name(Machine::Thumbv6m), String::new()),
    };
    // Less than half a per cent is not a difference that a reader should act on.
    let speed = if (speed - 1.0).abs() < 0.005 { String::new() } else { format!("{} times ", significant(speed)) };
    if first { format!("is {speed}as fast as {name}{spread}") } else { format!("is {speed}as fast") }
}

/// Its pixels over 64, in full and beside those of f32 where it is `first`.
fn errors(point: &Point, measured: &Measured, base: Option<&Measured>, first: bool) -> String {
    let own = measured.error.over_64;
    let beside = match base.map(|base| base.error.over_64).filter(|_| first) {
        Some(base) if base == own => " (as many as f32)".into(),
        Some(base) => format!(" (f32: {})", percent_text(base, point)),
        None => String::new(),
    };
    match (own, first) {
        (0, true) => format!("with no pixel over 64{beside}"),
        (0, false) => "with none".into(),
        (_, true) => format!("at {} of pixels over 64{beside}", percent_text(own, point)),
        (_, false) => format!("at {}", percent_text(own, point)),
    }
}

#[cfg(test)]
#[path = "summary_tests.rs"]
mod tests;
