//! A folder with files, and the command run in it.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

/// An OBJ of one triangle.
pub(crate) const TRIANGLE: &str = "v 0 0 0\nv 2 0 0\nv 0 2 2\nf 1 2 3\n";

/// A folder that a command runs in.
pub(crate) struct Folder(TempDir);

impl Folder {
    /// A folder of these files.
    pub(crate) fn new(files: &[(&str, &[u8])]) -> Self {
        let folder = Self(tempfile::tempdir().unwrap());
        for (name, contents) in files {
            folder.write(name, contents);
        }
        folder
    }

    /// A folder with `scene.obj`, one triangle.
    pub(crate) fn with_triangle() -> Self {
        Self::new(&[("scene.obj", TRIANGLE.as_bytes())])
    }

    /// The path of a file in it.
    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes a file.
    pub(crate) fn write(&self, name: &str, contents: &[u8]) {
        fs::write(self.path(name), contents).unwrap();
    }

    /// Reads a file.
    pub(crate) fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// Everything in it: files with their contents, and folders.
    pub(crate) fn contents(&self) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
        let mut found = BTreeMap::new();
        let mut folders = vec![self.0.path().to_path_buf()];
        while let Some(folder) = folders.pop() {
            for entry in fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                let contents = if path.is_dir() { None } else { Some(fs::read(&path).unwrap()) };
                if contents.is_none() {
                    folders.push(path.clone());
                }
                found.insert(path, contents);
            }
        }
        found
    }

    /// `intray` with these arguments, to be run in the folder.
    pub(crate) fn intray(&self, arguments: &[impl AsRef<OsStr>]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_intray"));
        // A panic is to show all that it has to show.
        command.current_dir(self.0.path()).env("RUST_BACKTRACE", "1").args(arguments);
        command
    }

    /// Runs `intray` with the words of `line`.
    pub(crate) fn run(&self, line: &str) -> Output {
        self.intray(&line.split_whitespace().collect::<Vec<_>>()).output().unwrap()
    }

    /// Runs a command that must succeed, and returns what it prints on stdout.
    #[track_caller]
    pub(crate) fn succeeds(&self, line: &str, warnings: &str) -> String {
        let Output { status, stdout, stderr } = self.run(line);
        assert_eq!((text(&stderr), status.code()), (warnings.to_owned(), Some(0)), "intray {line}");
        text(&stdout)
    }

    /// Runs a command that must be refused with this on stderr, leave nothing behind and change nothing; also
    /// where its output is there already.
    #[track_caller]
    pub(crate) fn refuses(&self, line: &str, stderr: &str) {
        let words: Vec<&str> = line.split_whitespace().collect();
        self.refuses_words(&words, stderr);
    }

    /// As [`refuses`](Self::refuses), for words that may hold spaces or nothing.
    #[track_caller]
    pub(crate) fn refuses_words(&self, words: &[&str], stderr: &str) {
        self.refuses_once(words, stderr);
        let output = words.iter().position(|word| *word == "-o").and_then(|option| words.get(option + 1));
        if let Some(output) = output.map(|name| self.path(name))
            && !output.exists()
            && output.parent().is_some_and(Path::is_dir)
        {
            fs::write(&output, "the last good one").unwrap();
            self.refuses_once(words, stderr);
            fs::remove_file(&output).unwrap();
        }
    }

    #[track_caller]
    fn refuses_once(&self, words: &[&str], expected: &str) {
        let before = self.contents();
        let Output { status, stdout, stderr } = self.intray(words).output().unwrap();
        assert_eq!(text(&stderr), expected, "intray {}", words.join(" "));
        assert_eq!(status.code(), Some(2), "the status of intray {}", words.join(" "));
        assert_eq!(text(&stdout), "", "the output of intray {}", words.join(" "));
        assert!(self.contents() == before, "intray {} changed files", words.join(" "));
    }
}

/// Output as text.
pub(crate) fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).unwrap()
}

/// That `refuses` can fail.
mod tests {
    use super::*;

    const MISSING: &str = "error: none.obj: no such file\n";

    #[test]
    fn a_refusal_is_one() {
        Folder::with_triangle().refuses("render none.obj -o out.png", MISSING);
    }

    #[test]
    #[should_panic = "the status of"]
    fn a_success_is_no_refusal() {
        Folder::with_triangle().refuses("--version", "");
    }

    #[test]
    #[should_panic = "intray render none.obj"]
    fn another_message_is_no_refusal() {
        Folder::with_triangle().refuses("render none.obj -o out.png", "error: none.obj: no such folder\n");
    }

    #[test]
    #[should_panic = "is not the same"]
    fn a_change_is_seen() {
        let folder = Folder::with_triangle();
        let before = folder.contents();
        folder.succeeds("prep scene.obj -o scene.blob", "");
        assert!(folder.contents() == before, "is not the same");
    }
}
