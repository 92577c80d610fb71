//! Verbs that are programs of their own, since they bring what this one should not: found beside this program or on the PATH,
//! as cargo finds its own.

use std::env;
use std::ffi::OsString;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitCode};

use super::failure::Failure;

/// A verb that is a program of its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Program {
    verb: &'static str,
    /// What it is called, and the folder of its package in the repository.
    name: &'static str,
    package: &'static str,
    /// Why it is none of this program.
    reason: &'static str,
}

/// `intray fit`.
pub(super) const FIT: Program = Program {
    verb: "fit",
    name: "intray-fit",
    package: "chip-fit",
    reason: "has the memory maps of some 4,000 chips in it",
};

/// `intray view`.
pub(super) const VIEW: Program = Program {
    verb: "view",
    name: "intray-view",
    package: "view",
    reason: "brings what windows, fonts and gamepads take",
};

/// All that follows the verb, for the program to read.
#[derive(Debug, clap::Args)]
pub(super) struct Arguments {
    /// What the program is given; `--help` says what it takes
    #[arg(value_name = "ARGUMENT", trailing_var_arg = true, allow_hyphen_values = true)]
    arguments: Vec<OsString>,
}

impl Arguments {
    /// Runs the program; the status that it ends with.
    pub(super) fn run(&self, program: &Program) -> ExitCode {
        let path = program.beside().unwrap_or_else(|| program.name.into());
        match Command::new(&path).args(&self.arguments).status() {
            Ok(status) => ExitCode::from(status.code().and_then(|code| u8::try_from(code).ok()).unwrap_or(1)),
            Err(error) if error.kind() == ErrorKind::NotFound => program.is_missing().report(),
            Err(error) => Failure::input(format!("{} cannot be started: {error}", path.display())).report(),
        }
    }
}

impl Program {
    /// It, where it lies beside this program.
    fn beside(&self) -> Option<PathBuf> {
        let here = env::current_exe().ok()?;
        let path = here.with_file_name(format!("{}{}", self.name, env::consts::EXE_SUFFIX));
        path.is_file().then_some(path)
    }

    fn is_missing(&self) -> Failure {
        let Self { verb, name, package, reason } = self;
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let folder = root.canonicalize().unwrap_or(root).join(package);
        Failure::input(format!(
            "`intray {verb}` is a program of its own, {name}, which {reason}, and it is neither beside this program nor on the \
             PATH; `cargo install --path {}` installs it",
            folder.display()
        ))
    }
}
