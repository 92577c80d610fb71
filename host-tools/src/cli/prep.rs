//! `intray prep`: a scene becomes a blob.

use std::path::PathBuf;

use core_rt::blob::Counts;

use super::failure::Failure;
use super::input::SceneArguments;
use super::output;
use crate::choose::budget::Budget;
use crate::files;

/// Turn a scene into a blob for one kernel and one picture size
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    #[command(flatten)]
    scene: SceneArguments,

    /// Take the cheapest kernel and the coarsest grid whose picture stays inside, such as `over_4<0.1%@160x128` or
    /// `psnr>40,flip<0.01`, and say what was tried
    #[arg(long, value_name = "BOUNDS", conflicts_with_all = ["kernel", "grid_bits"])]
    budget: Option<Budget>,

    /// Where the blob goes
    #[arg(short, value_name = "BLOB")]
    output: PathBuf,
}

pub(super) fn run(arguments: &Arguments) -> Result<(), Failure> {
    files::check_writable(&arguments.output)?;
    let scene = match &arguments.budget {
        Some(budget) => arguments.scene.load_within(budget)?,
        None => arguments.scene.load_for_mesh()?,
    };
    files::write_atomically(&arguments.output, scene.blob.bytes())?;
    let (header, _) = scene.engine.inspect(scene.blob.bytes())?;
    output::line(&format!(
        "{}: {} bytes for {}, {}{}",
        arguments.output.display(),
        scene.blob.bytes().len(),
        scene.engine.name(),
        primitives(&header.counts),
        scene.choice.map_or_else(String::new, |choice| format!("; {choice}"))
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
