//! The task runner.

mod demo_scene;

use std::path::Path;
use std::process::ExitCode;

fn main() -> ExitCode {
    let verb = std::env::args().nth(1);
    let outcome = match verb.as_deref() {
        Some("demo-scene") => {
            demo_scene::write(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/demo"))
        }
        _ => {
            eprintln!("usage: cargo xtask demo-scene");
            return ExitCode::from(2);
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("scenes/demo: {error}");
            ExitCode::FAILURE
        }
    }
}
