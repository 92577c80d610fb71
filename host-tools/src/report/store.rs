//! The rows on disk: one line of JSON each, behind a line that says what they are of.
//!
//! A row is written as soon as it is measured, in one write that reaches the disk before the next point is begun. So a sweep
//! that is killed loses the points that it was at, and at most leaves half a line, which is measured again.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::row::{Point, Row, SCHEMA};
use crate::files::{self, FileError};

/// The name of the rows' file in a report's folder.
pub const ROWS: &str = "rows.jsonl";

/// What rows are of: whether they can stand beside new ones.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Header {
    /// [`SCHEMA`].
    pub schema: String,
    /// The version of the program and the CRC-32 of its file: another program may draw another picture.
    pub program: String,
    /// The computer: times of two do not compare.
    pub machine: String,
    /// The options that decide what a point is.
    pub options: String,
    /// The digests of scenes, by name.
    pub scenes: BTreeMap<String, String>,
}

/// Why a sweep cannot go on, or cannot keep what it measures.
#[derive(Debug, Error)]
pub enum StoreError {
    /// A file.
    #[error(transparent)]
    File(#[from] FileError),
    /// A file of another's.
    #[error("{}: this is not of a report, and is left alone; name another folder", .0.display())]
    Foreign(PathBuf),
    /// A file where a report would write, in a folder that has no rows.
    #[error("{}: is there already, and the folder has no report; it is left alone: name another folder", .0.display())]
    Occupied(PathBuf),
    /// Rows that cannot stand beside new ones.
    #[error("{}: {what}; `--fresh` begins anew, or name another folder", path.display())]
    Stale {
        /// The file.
        path: PathBuf,
        /// What is not as it was.
        what: String,
    },
    /// Another process writes.
    #[error("{}: another sweep is writing to it", .0.display())]
    Busy(PathBuf),
}

/// The rows' file, open for more.
#[derive(Debug)]
pub struct Store {
    path: PathBuf,
    file: File,
    /// The length of what is whole.
    length: u64,
}

impl Store {
    /// Opens the rows in `folder`, or begins them; with those that are there already. `fresh` leaves those away.
    /// `others` are the files that a report writes beside it.
    ///
    /// # Errors
    /// Where what is there is not a report's, or of another one.
    pub fn open(
        folder: &Path,
        header: &Header,
        fresh: bool,
        others: impl IntoIterator<Item = PathBuf>,
    ) -> Result<(Self, BTreeMap<Point, Row>), StoreError> {
        let path = folder.join(ROWS);
        let mut rows = BTreeMap::new();
        let mut header = header.clone();
        match fs::symlink_metadata(&path) {
            Ok(_) => {
                let bytes = files::read(&path)?;
                let there = Self::whose(&path, &bytes)?;
                lock(&path)?;
                if !fresh {
                    let there =
                        there.fitting(&header).map_err(|what| StoreError::Stale { path: path.clone(), what })?;
                    rows = Self::rows(&path, &bytes)?;
                    // Those that are away today, such as one that cannot be read, keep their rows.
                    header.scenes = there.scenes.into_iter().chain(header.scenes).collect();
                }
            }
            Err(error) if error.kind() == ErrorKind::NotFound => {
                if let Some(other) = others.into_iter().find(|other| fs::symlink_metadata(other).is_ok()) {
                    return Err(StoreError::Occupied(other));
                }
            }
            Err(source) => return Err(FileError::Read { path, source }.into()),
        }
        // Whole or not at all, so that what is torn is gone and the header is never half.
        let mut text = line(&header);
        rows.values().for_each(|row| text.push_str(&line(row)));
        files::write_atomically(&path, text.as_bytes())?;
        let file = lock(&path)?;
        Ok((Self { path, file, length: text.len() as u64 }, rows))
    }

    /// Adds a row.
    ///
    /// # Errors
    /// Where the system refuses; the rows before it are kept.
    pub fn add(&mut self, row: &Row) -> Result<(), StoreError> {
        let text = line(row);
        if let Err(source) = self.file.write_all(text.as_bytes()).and_then(|()| self.file.sync_data()) {
            // Half a line would be dropped by the next run too.
            let _ = self.file.set_len(self.length);
            return Err(FileError::Write { path: self.path.clone(), source }.into());
        }
        self.length += text.len() as u64;
        Ok(())
    }

    /// The header of a file that a report wrote, of any schema.
    fn whose(path: &Path, bytes: &[u8]) -> Result<There, StoreError> {
        let foreign = || StoreError::Foreign(path.into());
        let first = bytes.split_inclusive(|&byte| byte == b'\n').next().unwrap_or_default();
        let there: There = serde_json::from_slice(first).map_err(|_| foreign())?;
        let family = SCHEMA.split('/').next().unwrap_or_default();
        if there.schema.split('/').next() == Some(family) { Ok(there) } else { Err(foreign()) }
    }

    /// All rows but a torn last one.
    fn rows(path: &Path, bytes: &[u8]) -> Result<BTreeMap<Point, Row>, StoreError> {
        let mut rows = BTreeMap::new();
        for (number, line) in (1..).zip(bytes.split_inclusive(|&byte| byte == b'\n')).skip(1) {
            match serde_json::from_slice::<Row>(line) {
                Ok(row) if line.ends_with(b"\n") => {
                    rows.insert(row.point.clone(), row);
                }
                _ if !line.ends_with(b"\n") => {}
                _ => {
                    let what = format!("line {number} is damaged");
                    return Err(StoreError::Stale { path: path.into(), what });
                }
            }
        }
        Ok(rows)
    }
}

/// A header as it stands in a file, which may be of a schema with other fields.
#[derive(Debug, Deserialize)]
struct There {
    schema: String,
    #[serde(flatten)]
    rest: serde_json::Value,
}

impl There {
    /// The header, where rows under it can stand beside those under `wanted`; what is not as it was otherwise.
    fn fitting(self, wanted: &Header) -> Result<Header, String> {
        if self.schema != SCHEMA {
            return Err(format!("its rows are of the schema {}, and this program writes {SCHEMA}", self.schema));
        }
        let mut fields = self.rest;
        fields["schema"] = self.schema.into();
        let there: Header =
            serde_json::from_value(fields).map_err(|error| format!("its header is damaged: {error}"))?;
        for (what, old, new) in [
            ("by another program", &there.program, &wanted.program),
            ("on another computer", &there.machine, &wanted.machine),
            ("with other options", &there.options, &wanted.options),
        ] {
            if old != new {
                return Err(format!("its rows were measured {what} ({old}; now {new})"));
            }
        }
        let changed =
            wanted.scenes.iter().find(|(name, digest)| there.scenes.get(*name).is_some_and(|old| old != *digest));
        match changed {
            Some((name, _)) => Err(format!("the scene {name} has changed since its rows were measured")),
            None => Ok(there),
        }
    }
}

/// Opens a file for appending, as the only one who does.
fn lock(path: &Path) -> Result<File, StoreError> {
    let refused = |source| StoreError::File(FileError::Write { path: path.into(), source });
    let file = File::options().append(true).open(path).map_err(refused)?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(TryLockError::WouldBlock) => Err(StoreError::Busy(path.into())),
        Err(TryLockError::Error(source)) => Err(refused(source)),
    }
}

/// A value as a line of JSON.
fn line(value: &impl Serialize) -> String {
    // Maps have text for keys, and nothing else in a row can fail.
    let mut text = serde_json::to_string(value).unwrap_or_default();
    text.push('\n');
    text
}
