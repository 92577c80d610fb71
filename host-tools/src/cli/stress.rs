//! `intray stress`: the stiff and the extreme cases.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use serde::Serialize;

use super::failure::{Failure, warn};
use super::{output, progress};
use crate::emulate;
use crate::engine::{ENGINES, Engine, PLANES12};
use crate::files;
use crate::report::row::Machine;
use crate::stress::chip::{self, Chip};
use crate::stress::row::{Outcome, Row};
use crate::stress::{Case, cases, suite, table};

/// The files in the folder that is asked for.
const JSON: &str = "stress.json";
const TEXT: &str = "stress.txt";

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
    #[arg(long = "kernel", value_name = "K", value_parser = PossibleValuesParser::new(ENGINES.into_iter().chain([PLANES12]).map(|engine| engine.name())))]
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
    let [cases, of_spheres] = chosen(&arguments.cases)?;
    if arguments.list {
        return cases
            .iter()
            .chain(&of_spheres)
            .try_for_each(|case| output::line(&format!("{:<24} {}", case.name, case.expectation)));
    }
    if let Some(folder) = &arguments.output {
        // What is in it already is left alone.
        std::fs::create_dir_all(folder)
            .map_err(|error| Failure::input(format!("{}: no folder can be made there: {error}", folder.display())))?;
        [JSON, TEXT].iter().try_for_each(|file| files::check_writable(&folder.join(file)))?;
    }
    let kernels: Vec<&'static dyn Engine> = ENGINES
        .into_iter()
        .chain([PLANES12])
        .filter(|e| arguments.kernels.is_empty() || arguments.kernels.iter().any(|k| k == e.name()))
        .collect();
    let machines: Vec<Machine> = match arguments.machines.as_slice() {
        [] => vec![Machine::Host, Machine::Rv32imac, Machine::Thumbv6m],
        asked => asked.iter().map(|&name| name.into()).collect(),
    };
    let bar = progress::bar("on the host", (cases.len() + of_spheres.len()) as u64);
    let mut done = suite::on_host(&cases, &kernels, &|| bar.inc(1));
    if kernels.iter().any(|kernel| kernel.id() == PLANES12.id()) {
        done.extend(suite::on_host(&of_spheres, &[PLANES12], &|| bar.inc(1)));
    }
    bar.finish_and_clear();
    let chips = chips(&machines, &kernels, arguments.machines.is_empty())?;
    let bar = progress::bar("on chips", (chips.len() * done.len() / kernels.len().max(1)) as u64);
    let on_chips = suite::on_chips(&done, &chips, &|| bar.inc(1));
    bar.finish_and_clear();
    let rows = suite::rows(done, on_chips, machines.contains(&Machine::Host));
    if let Some(folder) = &arguments.output {
        files::write_atomically(&folder.join(JSON), &serde_json::to_vec_pretty(&Report { cases: &rows })?)?;
        files::write_atomically(&folder.join(TEXT), table::text(&rows).as_bytes())?;
    }
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

/// The firmware of every kernel on the chips among these machines. What cannot be emulated here is an error where it was asked
/// for by name, else a warning.
fn chips(
    machines: &[Machine],
    kernels: &[&'static dyn Engine],
    is_default: bool,
) -> Result<Vec<(Machine, Chip)>, Failure> {
    let mut chips = Vec::new();
    let all = cases::all();
    for &machine in machines {
        let Some(board) = chip::board(machine) else { continue };
        if let Err(error) = emulate::check(board) {
            if is_default {
                warn(format_args!("{} is left out: {error}", table::machine(machine)));
                continue;
            }
            return Err(error.into());
        }
        for &engine in kernels.iter().filter(|engine| chip::has(**engine)) {
            let spinner = progress::spinner("building the firmware");
            let chip = Chip::provide(board, engine, &all);
            spinner.finish_and_clear();
            chips.push((machine, chip?));
        }
    }
    Ok(chips)
}

/// The cases of these names, or all.
fn chosen(names: &[String]) -> Result<[Vec<Case>; 2], Failure> {
    let all = [cases::all(), cases::of_spheres()];
    for name in names {
        if !all.iter().flatten().any(|case| case.name == name) {
            return Err(Failure::input(format!(
                "no case is called `{}`; `intray stress --list` lists them",
                name.escape_debug()
            )));
        }
    }
    let is_chosen = |case: &Case| names.is_empty() || names.iter().any(|name| name == case.name);
    Ok(all.map(|cases| cases.into_iter().filter(is_chosen).collect()))
}
