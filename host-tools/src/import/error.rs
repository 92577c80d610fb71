//! What can be wrong with a scene: errors, which end the import, and warnings, which do not.

use std::fmt;
use std::io;

/// Why a scene could not be imported.
///
/// The text names the file, the line where there is one, what is wrong and what would be right.
#[derive(Debug, thiserror::Error)]
pub enum ImportError {
    /// A file that is not there, is a directory, or cannot be read.
    #[error("{file}: {}", reason(source))]
    Unreadable {
        /// The file.
        file: String,
        /// What the system said.
        source: io::Error,
    },
    /// A name that ends in neither `.toml` nor `.obj`.
    #[error("{file}: a scene is a .toml or .obj file")]
    Extension {
        /// The file.
        file: String,
    },
    /// A file of zero bytes.
    #[error("{file}: the file is empty")]
    Empty {
        /// The file.
        file: String,
    },
    /// UTF-16, which some editors write.
    #[error("{file}: the file is UTF-16; save it as UTF-8 text")]
    Utf16 {
        /// The file.
        file: String,
    },
    /// An OBJ without an `f` statement.
    #[error("{file}: no faces; an OBJ scene needs at least one `f` statement")]
    NoFaces {
        /// The file.
        file: String,
    },
    /// All vertices in one place, to within [`SMALLEST`](super::SMALLEST).
    #[error("{file}: the scene has no extent: every vertex is at ({x}, {y}, {z})")]
    NoExtent {
        /// The OBJ.
        file: String,
        /// Where the vertices are, scene units.
        x: f64,
        /// See `x`.
        y: f64,
        /// See `x`.
        z: f64,
    },
    /// Something wrong in one line.
    #[error("{file}:{line}: {message}")]
    Line {
        /// The file.
        file: String,
        /// The line, from 1.
        line: u64,
        /// What is wrong and what would be right.
        message: String,
    },
}

impl ImportError {
    /// An error in one line of a file.
    pub(super) fn line(file: &str, line: u64, message: impl Into<String>) -> Self {
        Self::Line { file: file.into(), line, message: message.into() }
    }

    /// A file that could not be opened or read.
    pub(super) fn unreadable(file: &str, source: io::Error) -> Self {
        Self::Unreadable { file: file.into(), source }
    }
}

/// Something in a scene that will not be drawn as its author may expect. One line of text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Warning(String);

impl Warning {
    /// A warning that names its place itself.
    pub(super) fn text(message: String) -> Self {
        Self(message)
    }

    /// A warning about a whole file.
    pub(super) fn file(file: &str, message: impl fmt::Display) -> Self {
        Self(format!("{file}: {message}"))
    }

    /// A warning about one line, counted from 1.
    pub(super) fn line(file: &str, line: u64, message: impl fmt::Display) -> Self {
        Self(format!("{file}:{line}: {message}"))
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// An I/O error in words that do not depend on the operating system, where there are such words.
pub(super) fn reason(error: &io::Error) -> String {
    match error.kind() {
        io::ErrorKind::NotFound => "no such file".into(),
        io::ErrorKind::IsADirectory => "this is a folder; name the .toml or .obj file in it".into(),
        io::ErrorKind::PermissionDenied => "permission denied".into(),
        _ => error.to_string(),
    }
}

/// Names for a message: the first three in backquotes, and how many more there are.
pub(super) fn list<S: AsRef<str>>(names: &[S]) -> String {
    const SHOWN: usize = 3;
    let shown: Vec<String> = names.iter().take(SHOWN).map(|name| format!("`{}`", excerpt(name.as_ref()))).collect();
    match names.len().saturating_sub(SHOWN) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}

/// A piece of a foreign text for a one-line message: the start of it, made printable.
pub(super) fn excerpt(text: &str) -> String {
    const LENGTH: usize = 40;
    match text.char_indices().nth(LENGTH) {
        Some((end, _)) => printable(&text[..end]) + "…",
        None => printable(text),
    }
}

/// A foreign text with its control characters escaped.
pub(super) fn printable(text: &str) -> String {
    let mut shown = String::new();
    for c in text.chars() {
        if c.is_control() {
            shown.extend(c.escape_debug());
        } else {
            shown.push(c);
        }
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn long_lists_and_long_words_are_cut() {
        assert_eq!(list(&["a"]), "`a`");
        assert_eq!(list(&["a", "b", "c"]), "`a`, `b`, `c`");
        assert_eq!(list(&["a", "b", "c", "d", "e"]), "`a`, `b`, `c` and 2 more");
        assert_eq!(printable("C:\\a\u{1}\n"), "C:\\a\\u{1}\\n");
        assert_eq!(excerpt(&"x".repeat(40)), "x".repeat(40));
        assert_eq!(excerpt(&"x".repeat(41)), format!("{}…", "x".repeat(40)));
    }
}
