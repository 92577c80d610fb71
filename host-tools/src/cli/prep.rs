//! `intray prep`: a scene becomes a blob.

use std::path::PathBuf;

use core_rt::blob::Counts;

use super::failure::Failure;
use super::input::SceneArguments;
use super::output;
use crate::files;

/// Turn a scene into a blob for one kernel and one picture size
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// Where the blob goes
    #[arg(short, value_name = "BLOB")]
    output: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    files::check_writable(&arguments.output)?;
    let scene = arguments.scene.load()?;
    files::write_atomically(&arguments.output, scene.blob.bytes())?;
    let (header, _) = scene.engine.inspect(scene.blob.bytes())?;
    output::line(&format!(
        "{}: {} bytes for {}, {}",
        arguments.output.display(),
        scene.blob.bytes().len(),
        scene.engine.name(),
        primitives(&header.counts)
    ))
}

/// How many triangles there are, and how many spheres if there are any.
fn primitives(counts: &Counts) -> String {
    match (counts.triangles, counts.spheres) {
        (triangles, 0) => format!("{triangles} triangles"),
        (0, spheres) => format!("{spheres} spheres"),
        (triangles, spheres) => format!("{triangles} triangles, {spheres} spheres"),
    }
}
