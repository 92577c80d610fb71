//! Standard output. A reader that stops reading (`| head`) is no error.

use std::io::{ErrorKind, Write};

use super::failure::Failure;

/// Prints a line.
///
/// # Errors
/// Where it cannot be written.
pub fn line(text: &str) -> Result<(), Failure> {
    match writeln!(std::io::stdout().lock(), "{text}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::input(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}

/// Prints an object as JSON, in one line.
///
/// # Errors
/// Where it cannot be written.
pub fn json(value: &impl serde::Serialize) -> Result<(), Failure> {
    line(&serde_json::to_string(value)?)
}
