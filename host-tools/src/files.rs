//! Reading and writing whole files, with one clear line for whatever goes wrong.
//!
//! A file is written beside its target and renamed over it when it is complete, so a full disk or an
//! interrupt leaves the old file, never half of the new one.

use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

/// More than any scene or picture that the tracer could use; a guard against `/dev/zero` and the like.
const MOST_BYTES: u64 = 1 << 30;

/// Why a file could not be read or written. Each message names the path.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// Nothing has that name.
    #[error("{}: no such file", .0.display())]
    Missing(PathBuf),
    /// A folder has that name.
    #[error("{}: this is a folder; give the name of a file", .0.display())]
    IsFolder(PathBuf),
    /// The folder to write into is not there.
    #[error("{}: cannot be written: there is no folder {}; create it first", path.display(), folder.display())]
    NoFolder {
        /// The file to be written.
        path: PathBuf,
        /// The folder that it would be in.
        folder: PathBuf,
    },
    /// Larger than 1 GiB.
    #[error("{}: larger than 1 GiB; no scene or picture is", .0.display())]
    TooLarge(PathBuf),
    /// The operating system refused while reading.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Its reason.
        source: io::Error,
    },
    /// The operating system refused while writing.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Its reason.
        source: io::Error,
    },
}

/// Reads a whole file of at most 1 GiB.
///
/// # Errors
/// [`FileError`] where it is missing, a folder, too large or unreadable.
pub fn read(path: &Path) -> Result<Vec<u8>, FileError> {
    let refused = |source: io::Error| match source.kind() {
        io::ErrorKind::NotFound => FileError::Missing(path.into()),
        io::ErrorKind::IsADirectory => FileError::IsFolder(path.into()),
        _ => FileError::Read { path: path.into(), source },
    };
    if path.is_dir() {
        return Err(FileError::IsFolder(path.into()));
    }
    let mut bytes = Vec::new();
    // The length is counted and not asked for: a device or a pipe has none.
    File::open(path).and_then(|file| file.take(MOST_BYTES + 1).read_to_end(&mut bytes)).map_err(refused)?;
    if bytes.len() as u64 > MOST_BYTES {
        return Err(FileError::TooLarge(path.into()));
    }
    Ok(bytes)
}

/// Checks that a file could be written, so that what takes long is not begun in vain.
///
/// # Errors
/// [`FileError`] where the target is a folder or its folder is absent.
pub fn check_writable(path: &Path) -> Result<(), FileError> {
    target(path).map(drop)
}

/// Where a write goes.
enum Target {
    /// To a file of this name in this folder, whole or not at all.
    File(PathBuf, PathBuf),
    /// To what is there and is no regular file (`/dev/null`, a pipe): a rename would replace it.
    Device,
}

fn target(path: &Path) -> Result<Target, FileError> {
    let file = match fs::metadata(path) {
        Ok(there) if there.is_dir() => return Err(FileError::IsFolder(path.into())),
        Ok(there) if !there.is_file() => return Ok(Target::Device),
        // A link is followed.
        Ok(_) => fs::canonicalize(path).map_err(|source| FileError::Write { path: path.into(), source })?,
        Err(_) => path.to_path_buf(),
    };
    let folder = match file.parent() {
        Some(parent) if parent.as_os_str().is_empty() => Path::new(".").to_path_buf(),
        Some(parent) => parent.to_path_buf(),
        None => return Err(FileError::IsFolder(path.into())),
    };
    if folder.is_dir() {
        Ok(Target::File(file, folder))
    } else {
        Err(FileError::NoFolder { path: path.into(), folder })
    }
}

/// A file that is written bit by bit, and is there only when it is complete: a temporary one in the same folder, which
/// then takes the target's name. Until then, and if that does not come, the old file is as it was.
///
/// What is no regular file (`/dev/null`, a pipe) is written as it comes.
#[derive(Debug)]
pub struct AtomicFile {
    path: PathBuf,
    place: Place,
}

#[derive(Debug)]
enum Place {
    Beside(NamedTempFile, PathBuf),
    Device(File),
}

impl AtomicFile {
    /// Begins a file.
    ///
    /// # Errors
    /// [`FileError`] where the target is a folder, its folder is absent, or the system refuses.
    pub fn create(path: &Path) -> Result<Self, FileError> {
        let refused = |source: io::Error| FileError::Write { path: path.into(), source };
        let place = match target(path)? {
            Target::Device => Place::Device(File::create(path).map_err(refused)?),
            Target::File(file, folder) => {
                let mut builder = tempfile::Builder::new();
                builder.prefix(".intray-");
                #[cfg(unix)]
                {
                    // What File::create would give: everyone's, less the umask. A temporary file is private otherwise.
                    use std::os::unix::fs::PermissionsExt;
                    builder.permissions(fs::Permissions::from_mode(0o666));
                }
                Place::Beside(builder.tempfile_in(folder).map_err(refused)?, file)
            }
        };
        Ok(Self { path: path.into(), place })
    }

    /// Appends bytes.
    ///
    /// # Errors
    /// [`FileError`] where the system refuses.
    pub fn write(&mut self, bytes: &[u8]) -> Result<(), FileError> {
        let written = match &mut self.place {
            Place::Beside(file, _) => file.write_all(bytes),
            Place::Device(device) => device.write_all(bytes),
        };
        written.map_err(|source| FileError::Write { path: self.path.clone(), source })
    }

    /// Gives the file its name.
    ///
    /// # Errors
    /// [`FileError`] where the system refuses.
    pub fn finish(self) -> Result<(), FileError> {
        let Self { path, place } = self;
        let Place::Beside(file, target) = place else { return Ok(()) };
        // The name must not reach the disk before the bytes do.
        let persisted = file.as_file().sync_all().and_then(|()| Ok(file.persist(target)?));
        persisted.map(drop).map_err(|source| FileError::Write { path, source })
    }
}

/// Writes a whole [`AtomicFile`].
///
/// # Errors
/// [`FileError`] where the target is a folder, its folder is absent, or the system refuses. The old file, if
/// there was one, is then as it was.
pub fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    let mut file = AtomicFile::create(path)?;
    file.write(bytes)?;
    file.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }

    #[test]
    fn what_was_written_is_read_and_nothing_else_is_left() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.bin");
        write_atomically(&path, b"first").unwrap();
        write_atomically(&path, b"second").unwrap();
        assert_eq!(read(&path).unwrap(), b"second");
        assert_eq!(names(folder.path()), ["a.bin"]);
    }

    #[test]
    fn failures_say_what_and_leave_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let inside = |name: &str| folder.path().join(name);
        let message = |result: Result<(), FileError>| result.unwrap_err().to_string();

        assert!(message(read(&inside("none")).map(drop)).contains("none: no such file"));
        assert!(message(read(folder.path()).map(drop)).contains("is a folder"));
        assert!(message(write_atomically(folder.path(), b"x")).contains("is a folder"));
        let absent = message(write_atomically(&inside("no/such/a.png"), b"x"));
        assert!(absent.contains("there is no folder") && absent.contains("create it first"), "{absent}");
        assert_eq!(names(folder.path()), [""; 0]);
    }

    #[cfg(unix)]
    #[test]
    fn links_and_devices_stay_what_they_are() {
        use std::os::unix::fs::{FileTypeExt, PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        fs::write(&file, b"old").unwrap();
        symlink("file", &link).unwrap();
        write_atomically(&link, b"new").unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read(&file).unwrap(), b"new");

        write_atomically(Path::new("/dev/null"), b"x").unwrap();
        assert!(fs::metadata("/dev/null").unwrap().file_type().is_char_device());
        assert!(matches!(read(Path::new("/dev/null")), Ok(empty) if empty.is_empty()));

        let plain = folder.path().join("plain");
        fs::write(&plain, b"x").unwrap();
        let mode = |path| fs::metadata(path).unwrap().permissions().mode();
        assert_eq!(mode(&file), mode(&plain), "as open to others as any new file");
    }
}
