//! How a command fails: one message, one exit status.

use std::fmt::Display;
use std::io::Write;
use std::process::ExitCode;

/// A message for a person, and the status that the process ends with.
#[derive(Debug)]
pub struct Failure {
    message: String,
    status: u8,
}

impl Failure {
    /// What was given is wrong: status 2.
    pub fn input(message: impl Into<String>) -> Self {
        Self { message: message.into(), status: 2 }
    }

    /// What was asked for was done, and did not come out well: status 1.
    pub fn check(message: impl Into<String>) -> Self {
        Self { message: message.into(), status: 1 }
    }

    /// Prints the message; the status to end with.
    pub fn report(&self) -> ExitCode {
        message("error", &self.message);
        ExitCode::from(self.status)
    }
}

/// Says on stderr what will not be seen as it was meant.
pub fn warn(warning: impl Display) {
    message("warning", warning);
}

/// Passes on what another says, on stderr.
pub fn note(line: impl Display) {
    let _ = writeln!(std::io::stderr(), "{line}");
}

fn message(kind: &str, text: impl Display) {
    // Where nobody reads it (`2>&1 | head`), the exit status still tells; `eprintln` would panic.
    let _ = writeln!(std::io::stderr(), "{kind}: {text}");
}

/// Errors of the library are about what was given.
impl<E: std::error::Error> From<E> for Failure {
    fn from(error: E) -> Self {
        Self::input(error.to_string())
    }
}
