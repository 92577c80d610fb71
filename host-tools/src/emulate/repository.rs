//! The repository that this program was built from: firmware is built there, and only there.

use std::env;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::EmulateError;

/// The workspace.
#[derive(Clone, Debug)]
pub(super) struct Repository {
    root: PathBuf,
    target: PathBuf,
}

impl Repository {
    /// The one that this program was built from.
    pub(super) fn find() -> Result<Self, EmulateError> {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let Ok(root) = root
            .canonicalize()
            .map_err(drop)
            .and_then(|root| if root.join("firmware-rt/Cargo.toml").is_file() { Ok(root) } else { Err(()) })
        else {
            return Err(EmulateError::NoSources(root));
        };
        let asked = env::var_os("CARGO_TARGET_DIR").filter(|path| !path.is_empty()).map(PathBuf::from);
        let target = match asked {
            Some(path) => std::path::absolute(&path).unwrap_or(path),
            None => root.join("target"),
        };
        Ok(Self { root, target })
    }

    /// Its folder.
    pub(super) fn root(&self) -> &Path {
        &self.root
    }

    /// Where cargo builds.
    pub(super) fn target(&self) -> &Path {
        &self.target
    }

    /// Runs cargo in it, silent unless it fails; the error is what it says.
    pub(super) fn cargo(&self, arguments: &[&str], variables: &[(&str, OsString)]) -> Result<(), String> {
        // The cargo that runs this program, if one does.
        let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let mut command = Command::new(cargo);
        command.args(arguments).arg("--quiet").current_dir(&self.root).env("CARGO_TARGET_DIR", &self.target);
        command.envs(variables.iter().map(|(name, value)| (name, value))).stdin(Stdio::null());
        match command.output() {
            Ok(output) if output.status.success() => Ok(()),
            Ok(output) => Err(String::from_utf8_lossy(&output.stderr).trim().to_owned()),
            Err(error) => Err(format!("cargo cannot be started: {error}")),
        }
    }
}
