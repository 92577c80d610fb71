//! The generated parts of the project's documents: found by their marks, compared, or renewed with `INTRAY_BLESS=1`.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Mutex;

use host_tools::files;

const END: &str = "<!-- end of generated -->\n";

/// The README, from the root of the project.
pub const README: &str = "README.md";

/// A document is written by one test at a time.
static WRITING: Mutex<()> = Mutex::new(());

/// The path of a file of the project.
#[must_use]
pub fn root(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name)
}

/// How a generated part begins.
fn begin(part: &str) -> String {
    format!("<!-- generated: {part} -->\n")
}

/// The text of a generated part.
#[must_use]
pub fn generated<'a>(text: &'a str, part: &str) -> Option<&'a str> {
    let (_, rest) = text.split_once(&begin(part))?;
    Some(rest.split_once(END)?.0)
}

/// The text with a generated part replaced.
fn replaced(text: &str, part: &str, figures: &str) -> Option<String> {
    let begin = begin(part);
    let (before, rest) = text.split_once(&begin)?;
    let (_, after) = rest.split_once(END)?;
    Some(format!("{before}{begin}{figures}{END}{after}"))
}

/// A document as it is.
///
/// # Panics
/// If it cannot be read.
#[must_use]
pub fn document(name: &str) -> String {
    String::from_utf8(files::read(&root(name)).expect("a document")).expect("it is text")
}

/// Whether figures are to be renewed and not compared.
#[must_use]
pub fn is_blessing() -> bool {
    std::env::var_os("INTRAY_BLESS").is_some()
}

/// Checks a generated part of a document, or renews it.
///
/// # Panics
/// If it is another.
pub fn check_part(name: &str, part: &str, figures: &str, is_same: impl Fn(&str, &str) -> bool) {
    let _lock = WRITING.lock().expect("whoever had it let it go");
    let text = document(name);
    let expected = replaced(&text, part, figures).expect("the document has the marks");
    if is_blessing() {
        files::write_atomically(&root(name), expected.as_bytes()).expect("it can be written");
    } else {
        let stored = generated(&text, part).unwrap_or_default();
        assert!(is_same(stored, figures), "{name}: INTRAY_BLESS=1 renews the figures\n{stored}\n{figures}");
    }
}

/// The compiler that figures are of, and its version.
///
/// # Panics
/// If there is none.
#[must_use]
pub fn compiler() -> String {
    let output = Command::new("rustc").arg("--version").output().expect("there is a compiler");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    text.split(' ').take(2).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_needed_and_stale_figures_are_seen() {
        assert_eq!(replaced("no marks", "x", "y"), None);
        let text = format!("a\n{}old\n{END}b\n{}other\n{END}", begin("x"), begin("y"));
        assert_eq!((generated(&text, "x"), generated(&text, "y")), (Some("old\n"), Some("other\n")));
        let new = format!("a\n{}new\n{END}b\n{}other\n{END}", begin("x"), begin("y"));
        assert_eq!(replaced(&text, "x", "new\n"), Some(new));
    }
}
