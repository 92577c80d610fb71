//! `intray compare`: how far two pictures are apart.

use std::path::PathBuf;

use super::failure::Failure;
use super::output;
use crate::compare::{compare, difference};
use crate::picture::Picture;

/// Measure how far two pictures are apart
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// A PNG
    a: PathBuf,
    /// A PNG of the same size
    b: PathBuf,

    /// Where a picture of the differences goes
    #[arg(short, value_name = "DIFF.png")]
    output: Option<PathBuf>,

    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let (a, b) = (Picture::read_png(&arguments.a)?, Picture::read_png(&arguments.b)?);
    let found = compare(&a, &b)
        .map_err(|error| Failure::input(format!("{}, {}: {error}", arguments.a.display(), arguments.b.display())))?;
    if let Some(path) = &arguments.output {
        difference(&a, &b)?.write_png(path)?;
    }
    if arguments.json { output::json(&found) } else { output::line(&found.to_string()) }
}
