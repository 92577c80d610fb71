//! `intray report`: error against run time.

use std::path::{Path, PathBuf};
use std::time::Duration;

use clap::builder::PossibleValuesParser;
use indicatif::ProgressBar;

use super::failure::{Failure, note, warn};
use super::input::size;
use super::{output, progress};
use crate::engine::{ENGINES, PLANES12};
use crate::report::page;
use crate::report::plan::Selection;
use crate::report::row::{Machine, Outcome, Study};
use crate::report::scene;
use crate::report::sweep::{Sweep, Watch};

/// Measure error against run time, on this computer and on emulated chips
///
/// A sweep that was interrupted goes on where it stopped.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// scene.toml and .obj files [default: the built-in scene]
    #[arg(value_name = "SCENE")]
    scenes: Vec<PathBuf>,

    /// The folder that the report goes to
    #[arg(short, value_name = "DIR", required_unless_present = "page_only")]
    output: Option<PathBuf>,

    /// Make the page of the report in this folder anew, and measure nothing
    #[arg(long, value_name = "DIR", exclusive = true)]
    page_only: Option<PathBuf>,

    /// Few points and small pictures
    #[arg(long)]
    quick: bool,

    /// Measure this kernel; more than once for several [default: all]
    #[arg(long, value_parser = PossibleValuesParser::new(ENGINES.into_iter().chain([PLANES12]).map(|engine| engine.name())))]
    kernel: Vec<String>,

    /// Measure on this machine; more than once for several [default: all]
    #[arg(long, value_enum)]
    machine: Vec<Machine>,

    /// Make this study; more than once for several [default: all]
    #[arg(long, value_enum)]
    study: Vec<Study>,

    /// Draw pictures of this size; more than once for several [default: the scene's, at most 640x480, and at most 160x128
    /// on chips, where knobs are varied, and with --quick]
    #[arg(long, value_name = "WxH", value_parser = size, allow_hyphen_values = true)]
    size: Vec<[u32; 2]>,

    /// Leave rows away that are there already
    #[arg(long)]
    fresh: bool,

    /// Stop QEMU after so long
    #[arg(long, value_name = "SECONDS", default_value_t = 600, value_parser = clap::value_parser!(u64).range(1..))]
    timeout: u64,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let Arguments { quick, kernel, machine, study, size, fresh, timeout, .. } = arguments;
    if let Some(folder) = &arguments.page_only {
        let page = page::renew(folder)?;
        return output::line(&format!("{}: made anew", page.display()));
    }
    let Some(folder) = &arguments.output else {
        return Err(Failure::input("there is no folder for the report; name one by -o"));
    };
    let scenes = scene::read(&arguments.scenes);
    for scene in &scenes {
        scene.content.iter().flat_map(|content| &content.warnings).for_each(warn);
    }
    let selection = Selection {
        quick: *quick,
        kernels: kernel.clone(),
        machines: machine.clone(),
        studies: study.clone(),
        sizes: size.clone(),
    };
    let bar = progress::bar("measuring", 0);
    let sweep = Sweep {
        scenes: &scenes,
        selection: &selection,
        folder,
        fresh: *fresh,
        limit: Duration::from_secs(*timeout),
        command: command(arguments, folder, &selection),
    };
    let swept = sweep.run(&Shown(&bar));
    bar.finish_and_clear();
    let swept = swept?;

    let rows = &swept.report.rows;
    let unfit = rows.iter().filter(|row| matches!(row.outcome, Outcome::Failed(_))).count();
    output::line(&format!(
        "{}: {} points, {} of them measured now and {unfit} without figures",
        folder.display(),
        rows.len(),
        rows.len() - swept.kept,
    ))?;
    let failed = scenes.iter().filter_map(|scene| scene.facts.failed.clone());
    let wrong: Vec<String> = failed.chain(swept.broken).collect();
    if wrong.is_empty() { Ok(()) } else { Err(Failure::check(wrong.join("\n"))) }
}

/// The command line that makes the report again.
fn command(arguments: &Arguments, folder: &Path, selection: &Selection) -> String {
    let scenes = arguments.scenes.iter().map(|path| path.display().to_string());
    let words = ["intray".to_owned(), "report".to_owned()].into_iter().chain(scenes);
    let words = words.chain(["-o".to_owned(), folder.display().to_string(), selection.to_string()]);
    words.filter(|word| !word.is_empty()).collect::<Vec<_>>().join(" ")
}

/// Shows a sweep on the terminal.
struct Shown<'a>(&'a ProgressBar);

impl Watch for Shown<'_> {
    fn say(&self, line: &str) {
        self.0.suspend(|| note(line));
    }

    fn begin(&self, work: u64) {
        self.0.set_length(work);
    }

    fn done(&self, work: u64) {
        self.0.inc(work);
    }
}
