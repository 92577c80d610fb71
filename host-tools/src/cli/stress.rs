//! `intray stress`: the stiff and the extreme cases.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use serde::Serialize;

use super::failure::Failure;
use super::{output, progress};
use crate::engine::{ENGINES, Engine};
use crate::report::row::Machine;
use crate::stress::cases;
use crate::stress::row::{Outcome, Row};
use crate::stress::{Case, host, table};

/// The file that the rows go to, in the folder that is asked for.
const FILE: &str = "stress.json";

/// Draw the stiff and the extreme cases by every kernel, and check each against what is promised
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A folder for stress.json and stress.txt
    #[arg(short, value_name = "DIR")]
    output: Option<PathBuf>,

    /// Print one JSON object
    #[arg(long)]
    json: bool,

    /// Only this case; may be given more than once
    #[arg(long = "case", value_name = "NAME")]
    cases: Vec<String>,

    /// Only this kernel; may be given more than once
    #[arg(long = "kernel", value_name = "K", value_parser = PossibleValuesParser::new(ENGINES.map(|engine| engine.name())))]
    kernels: Vec<String>,

    /// Only on this machine; may be given more than once
    #[arg(long = "machine", value_name = "M", value_enum)]
    machines: Vec<MachineName>,

    /// List the cases, with what is expected of them
    #[arg(long)]
    list: bool,
}

/// A machine by its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum MachineName {
    /// This computer
    Host,
    /// The hifive1 in QEMU
    Rv32imac,
    /// The microbit in QEMU
    Thumbv6m,
}

impl From<MachineName> for Machine {
    fn from(name: MachineName) -> Self {
        match name {
            MachineName::Host => Self::Host,
            MachineName::Rv32imac => Self::Rv32imac,
            MachineName::Thumbv6m => Self::Thumbv6m,
        }
    }
}

/// The answer.
#[derive(Debug, Serialize)]
struct Report<'a> {
    cases: &'a [Row],
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let cases = chosen(&arguments.cases)?;
    if arguments.list {
        return cases.iter().try_for_each(|case| output::line(&format!("{:<24} {}", case.name, case.expectation)));
    }
    let kernels: Vec<&'static dyn Engine> = ENGINES
        .into_iter()
        .filter(|e| arguments.kernels.is_empty() || arguments.kernels.iter().any(|k| k == e.name()))
        .collect();
    let bar = progress::bar("on the host", cases.len() as u64);
    let mut rows = Vec::new();
    for case in &cases {
        rows.extend(host::run(case, &kernels).into_iter().map(|done| done.row));
        bar.inc(1);
    }
    bar.finish_and_clear();
    if arguments.json {
        output::json(&Report { cases: &rows })?
    } else {
        output::line(&table::text(&rows))?
    }
    match rows.iter().filter(|row| row.outcome == Outcome::Fail).count() {
        0 => Ok(()),
        failed => Err(Failure::check(format!("{failed} of {} rows fail", rows.len()))),
    }
}

/// The cases of these names, or all.
fn chosen(names: &[String]) -> Result<Vec<Case>, Failure> {
    let all = cases::all();
    for name in names {
        if !all.iter().any(|case| case.name == name) {
            return Err(Failure::input(format!(
                "no case is called `{}`; `intray stress --list` lists them",
                name.escape_debug()
            )));
        }
    }
    Ok(all.into_iter().filter(|case| names.is_empty() || names.iter().any(|name| name == case.name)).collect())
}
