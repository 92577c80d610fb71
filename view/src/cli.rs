//! The command line of `intray view`.

use std::path::PathBuf;
use std::process::ExitCode;
use std::sync::Arc;

use clap::Parser;
use clap::builder::PossibleValuesParser;
use host_tools::cli::{Failure, note, output, picture_size, warn};
use host_tools::import::{self, Imported};

use crate::canvas::draft_size;
use crate::chip::TARGETS;
use crate::kernels::{KERNELS, place, refusal};
use crate::measure::{self, Pilot, Report};
use crate::painter::Scene;
use crate::scene_file;
use crate::viewer::Setup;
use crate::window::{self, WindowError};

/// Open a window to move in: by mouse, keys or gamepad, with any kernel, or as a chip's panel would show it.
///
/// While one moves, a quarter of the pixels is drawn, and all of them once one rests. H shows what the keys do.
#[derive(Debug, Parser)]
#[command(name = "intray view", bin_name = "intray view", version)]
struct Arguments {
    /// A scene.toml or a bare .obj
    scene: PathBuf,

    /// The arithmetic [default: exact29, on a chip exact14]
    #[arg(long, value_parser = PossibleValuesParser::new(KERNELS.map(|engine| engine.name())))]
    kernel: Option<String>,

    /// The window's size in pixels
    #[arg(long, value_name = "WxH", value_parser = picture_size, default_value = "640x512", allow_hyphen_values = true)]
    size: [u32; 2],

    /// Begin with the panel of this board
    #[arg(long, value_parser = PossibleValuesParser::new(TARGETS.map(|target| target.board.name)))]
    board: Option<String>,

    /// The size of a board's panel in pixels
    #[arg(long, value_name = "WxH", value_parser = picture_size, default_value = "160x128", allow_hyphen_values = true)]
    panel: [u32; 2],

    /// Threads that draw [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), allow_negative_numbers = true)]
    threads: Option<u16>,

    /// Move and stop by itself, and print how fast it is as one JSON object; where there is no display, into memory
    #[arg(long)]
    measure: bool,
}

/// Runs the command that the process was called with.
#[must_use]
pub fn run() -> ExitCode {
    match answer(&Arguments::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

fn answer(arguments: &Arguments) -> Result<(), Failure> {
    let path = &arguments.scene;
    let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
    if !path.is_dir() && path.exists() && !extension.is_some_and(|extension| extension == "toml" || extension == "obj")
    {
        return Err(Failure::input(format!(
            "{}: not a scene.toml or an .obj; a blob has its camera in it, so give the scene that it was made from",
            path.display()
        )));
    }
    let Imported { model, warnings } = import::load(path)?;
    warnings.iter().for_each(warn);
    let has_headlight = scene_file::has_headlight(path).map_err(Failure::input)?;
    let scene = Scene { model: Arc::new(model), has_headlight };
    let setup = setup(arguments);
    if let Some(reason) = setup.kernels.into_iter().find_map(|kernel| refusal(kernel, &scene.model)) {
        return Err(Failure::input(format!("{}: {reason}", path.display())));
    }
    let threads = match arguments.threads {
        Some(threads) => threads.into(),
        None => std::thread::available_parallelism().map_or(1, usize::from),
    };
    let known = known(&setup, threads);
    let pilot = arguments.measure.then(Pilot::default);
    let report = match window::run(path, &scene, setup, threads, pilot) {
        Ok(None) => return Ok(()),
        Ok(Some(pilot)) => pilot.report(Report { window: true, ..known }),
        Err(WindowError::NoDisplay(reason)) if arguments.measure => {
            note(format_args!("there is no display ({reason}), so frames go to memory"));
            measure::without_window(&scene, setup, threads).map_err(Failure::input)?.report(known)
        }
        Err(WindowError::NoDisplay(reason)) => {
            return Err(Failure::input(format!(
                "there is no display ({reason}); `intray render {} -o PNG` draws without one",
                path.display()
            )));
        }
        Err(WindowError::Failed(reason)) => return Err(Failure::input(reason)),
    };
    output::json(&report)
}

/// How one begins.
fn setup(arguments: &Arguments) -> Setup {
    let asked = arguments.kernel.as_deref().and_then(place);
    let board = arguments.board.as_deref();
    let board = board.and_then(|name| TARGETS.iter().position(|target| target.board.name == name));
    Setup {
        kernels: [asked.unwrap_or_default(), asked.or_else(|| place("exact14")).unwrap_or_default()],
        size: arguments.size,
        board: board.unwrap_or_default(),
        panel: arguments.panel,
        is_chip: board.is_some(),
    }
}

/// What a measurement need not measure.
fn known(setup: &Setup, threads: usize) -> Report {
    let draft = if setup.is_chip { setup.panel } else { draft_size(setup.size) };
    Report {
        kernel: KERNELS[setup.kernels[usize::from(setup.is_chip)]].name(),
        width: setup.size[0],
        height: setup.size[1],
        draft_width: draft[0],
        draft_height: draft[1],
        threads,
        ..Report::default()
    }
}
