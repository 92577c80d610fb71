//! Where a scene's files come from: a folder, or the program itself.

use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::{Path, PathBuf};

use super::error::printable;

/// A set of named files.
///
/// Names are as scenes write them: relative to the scene file (`model`) or to the OBJ (`mtllib`,
/// which the importer joins to the OBJ's own folder), with `/` between folders.
pub trait Source {
    /// Opens a file for reading from its start. A stream, so that the text of a large OBJ need not
    /// stand in memory beside what is made of it.
    ///
    /// # Errors
    /// `NotFound`, `IsADirectory` and whatever else the system says.
    fn open(&self, name: &str) -> io::Result<Box<dyn BufRead + '_>>;

    /// What messages call that file, such as its path. Without control characters.
    fn describe(&self, name: &str) -> String;

    /// The whole of a file.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    fn read(&self, name: &str) -> io::Result<Vec<u8>> {
        let mut bytes = Vec::new();
        self.open(name)?.read_to_end(&mut bytes)?;
        Ok(bytes)
    }
}

/// The files of a folder on disk. Absolute names are taken as they stand.
#[derive(Clone, Debug)]
pub struct Folder(pub PathBuf);

impl Source for Folder {
    fn open(&self, name: &str) -> io::Result<Box<dyn BufRead + '_>> {
        let path = self.0.join(name);
        // Opening a directory succeeds on Unix; reading it then fails with a stranger message.
        if path.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        Ok(Box::new(BufReader::new(File::open(path)?)))
    }

    fn describe(&self, name: &str) -> String {
        printable(&self.0.join(name).to_string_lossy())
    }
}

/// Files in memory, such as those that are part of the program: names and contents.
#[derive(Clone, Copy, Debug)]
pub struct Embedded<'a>(pub &'a [(&'a str, &'a [u8])]);

impl Source for Embedded<'_> {
    fn open(&self, name: &str) -> io::Result<Box<dyn BufRead + '_>> {
        // As paths, so that either separator will do where the system has two.
        let file = self.0.iter().find(|(known, _)| Path::new(known) == Path::new(name));
        match file {
            Some((_, contents)) => Ok(Box::new(*contents)),
            None => Err(io::ErrorKind::NotFound.into()),
        }
    }

    fn describe(&self, name: &str) -> String {
        format!("built-in {}", printable(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn embedded_files_are_found_by_name_only() {
        let files = Embedded(&[("a.obj", b"one"), ("sub/b.mtl", b"two")]);
        assert_eq!(files.read("a.obj").unwrap(), b"one");
        assert_eq!(files.read("sub/b.mtl").unwrap(), b"two");
        assert_eq!(files.read("b.mtl").unwrap_err().kind(), io::ErrorKind::NotFound);
        assert_eq!(files.describe("a.obj"), "built-in a.obj");
    }

    #[test]
    fn a_folder_names_what_it_cannot_give() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("sub")).unwrap();
        std::fs::write(folder.path().join("a.obj"), "text").unwrap();
        let files = Folder(folder.path().into());
        assert_eq!(files.read("a.obj").unwrap(), b"text");
        assert_eq!(files.read("sub").unwrap_err().kind(), io::ErrorKind::IsADirectory);
        assert_eq!(files.read("b.obj").unwrap_err().kind(), io::ErrorKind::NotFound);
        assert!(files.describe("a.obj").ends_with("a.obj"));
    }
}
