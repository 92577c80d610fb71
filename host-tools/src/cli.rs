//! The command line: one module a verb.
//!
//! Results go to stdout, everything else to stderr. The exit status is 0, or 1 for a failed check, or 2 for bad input.

mod board;
mod compare;
mod demo;
mod emulate;
mod external;
mod failure;
mod flash;
mod help;
mod input;
mod inspect;
mod load;
pub mod output;
mod pixel_planes;
mod planes;
mod prep;
pub mod progress;
mod render;
mod report;
mod run_elf;
mod stress;
mod trace;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

pub use failure::{Failure, note, warn};
pub use help::smaller;
pub use input::{SceneArguments, size as picture_size};
pub use load::Scene;

/// Integer ray tracing for chips without an FPU, and on a PC, bit for bit the same.
///
/// Without a command, renders the built-in scene to out/demo.png and says how far it is from f64.
#[derive(Debug, Parser)]
#[command(name = "intray", version, propagate_version = true)]
struct Arguments {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Prep(prep::Arguments),
    Inspect(inspect::Arguments),
    Render(render::Arguments),
    Trace(trace::Arguments),
    Compare(compare::Arguments),
    Emulate(emulate::Arguments),
    Flash(flash::Arguments),
    /// Say which chips a scene fits, and by how much it misses others
    #[command(disable_help_flag = true, disable_version_flag = true)]
    Fit(external::Arguments),
    /// Open a window to move in, to see a scene by any kernel or as a chip would show it
    #[command(disable_help_flag = true, disable_version_flag = true)]
    View(external::Arguments),
    Stress(stress::Arguments),
    Report(report::Arguments),
    PixelPlanes(Box<pixel_planes::Arguments>),
    #[command(hide = true)]
    RunElf(run_elf::Arguments),
}

/// Runs the command that the process was called with.
#[must_use]
pub fn run() -> ExitCode {
    let done: Result<(), Failure> = match Arguments::parse().command {
        None => demo::run(),
        Some(Command::Prep(arguments)) => prep::run(&arguments),
        Some(Command::Inspect(arguments)) => inspect::run(&arguments),
        Some(Command::Render(arguments)) => render::run(&arguments),
        Some(Command::Trace(arguments)) => trace::run(&arguments),
        Some(Command::Compare(arguments)) => compare::run(&arguments),
        Some(Command::Emulate(arguments)) => emulate::run(&arguments),
        Some(Command::Flash(arguments)) => flash::run(&arguments),
        Some(Command::Fit(arguments)) => return arguments.run(&external::FIT),
        Some(Command::View(arguments)) => return arguments.run(&external::VIEW),
        Some(Command::Stress(arguments)) => stress::run(&arguments),
        Some(Command::Report(arguments)) => report::run(&arguments),
        Some(Command::PixelPlanes(arguments)) => pixel_planes::run(&arguments),
        Some(Command::RunElf(arguments)) => run_elf::run(&arguments),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
