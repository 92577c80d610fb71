//! All cases, by all kernels, on all machines.

use rayon::prelude::*;

use super::Case;
use super::cases::BENIGN;
use super::chip::Chip;
use super::host::{self, Done};
use super::row::Row;
use crate::engine::Engine;
use crate::report::row::Machine;

/// The cases by every kernel on this computer; `progress` is called for every case.
#[must_use]
pub fn on_host(cases: &[Case], kernels: &[&'static dyn Engine], progress: &dyn Fn()) -> Vec<(Case, Done)> {
    let mut all = Vec::new();
    for case in cases {
        all.extend(host::run(case, kernels).into_iter().map(|done| (*case, done)));
        progress();
    }
    all
}

/// What the host has done, by chips of the same kernels; `progress` is called for every picture, from any thread.
#[must_use]
pub fn on_chips(done: &[(Case, Done)], chips: &[(Machine, Chip)], progress: &(dyn Fn() + Sync)) -> Vec<Row> {
    let jobs: Vec<_> = done
        .iter()
        .flat_map(|job| chips.iter().map(move |chip| (job, chip)))
        .filter(|((_, done), (_, chip))| done.row.kernel == chip.engine().name())
        .collect();
    jobs.par_iter()
        .map(|((case, done), (machine, chip))| {
            let row = chip.run(*machine, case, done);
            progress();
            row
        })
        .collect()
}

/// All rows, in the order of the cases, kernels and machines, with the work relative to the benign scene's where that was
/// drawn too. Rows of the host are left out unless they are wanted.
#[must_use]
pub fn rows(done: Vec<(Case, Done)>, mut on_chips: Vec<Row>, with_host: bool) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for (_, Done { row, .. }) in done {
        let is_same = |other: &Row| other.name == row.name && other.kernel == row.kernel;
        let of_case: Vec<Row> = on_chips.extract_if(.., |other| is_same(other)).collect();
        if with_host {
            rows.push(row);
        }
        rows.extend(of_case);
    }
    let benign: Vec<Row> = rows.iter().filter(|row| row.name == BENIGN).cloned().collect();
    for row in &mut rows {
        let is_same = |other: &&Row| other.kernel == row.kernel && other.machine == row.machine;
        let least = benign.iter().find(is_same).and_then(|row| row.work);
        row.relative_work = row.work.zip(least).map(|(work, least)| work / least);
    }
    rows
}
