//! Firmware for a blob: built by cargo, or as it was built before.
//!
//! One ELF per board, kernel and profile serves every scene that it suffices for, so it is kept under a name that says
//! these. Beside it stands what it was made from, the compiler and the sources, and it is made anew where that changed.

use std::ffi::OsString;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use core_rt::profile::Prefer;
use firmware_rt::board::Board;
use firmware_rt::build::{BLOB_VARIABLE, COUNT_VARIABLE, HITS_VARIABLE, MARKS_VARIABLE, Traits};
use firmware_rt::hits::Way;

use super::EmulateError;
use super::elf::Elf;
use super::repository::Repository;
use crate::engine::{self, ENGINES};
use crate::files;

/// What firmware is for.
#[derive(Clone, Copy, Debug)]
pub struct Wanted<'a> {
    /// The board.
    pub board: &'static Board,
    /// The blob that its profile comes from.
    pub blob: &'a [u8],
    /// The nearest hits alone, instead of the picture.
    pub hits: Option<Way>,
    /// Whether it counts rays and tests.
    pub count: bool,
}

/// Cargo's profile for what is preferred.
pub(super) const fn cargo_profile(prefer: Prefer) -> &'static str {
    match prefer {
        Prefer::Speed => "firmware",
        Prefer::Size => "firmware-small",
    }
}

/// How firmware reaches the host.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Transport {
    /// An emulator or a debugger does what it asks for.
    #[default]
    Semihosting,
    /// A probe reads its buffers.
    Rtt,
}

/// How firmware is built.
#[derive(Clone, Copy, Debug, Default)]
struct How {
    transport: Transport,
    marks: bool,
    prefer: Prefer,
    by_hand: bool,
}

/// Checks that firmware can be built here: that the sources and the compiler's library are there.
///
/// # Errors
/// What is missing.
pub fn check_board(board: &Board) -> Result<(), EmulateError> {
    Repository::find()?;
    if has_library(board.target) { Ok(()) } else { Err(EmulateError::NoTarget { target: board.target }) }
}

/// Checks that firmware can be built here for a blob: that its kernel has one, and what [`check_board`] does.
///
/// # Errors
/// What is missing.
pub fn check(board: &Board, traits: &Traits) -> Result<(), EmulateError> {
    if traits.kernel_path().is_none() {
        let has_firmware = |id| Traits { kernel: id, ..*traits }.kernel_path().is_some();
        let known: Vec<&str> =
            ENGINES.iter().filter(|engine| has_firmware(engine.id())).map(|engine| engine.name()).collect();
        let kernel = engine::by_id(traits.kernel).map_or("of this blob", |engine| engine.name());
        return Err(EmulateError::NoFirmware { kernel, known: known.join(", ") });
    }
    check_board(board)
}

impl Wanted<'_> {
    /// The firmware for QEMU, built if need be.
    ///
    /// # Errors
    /// Where it cannot be built.
    pub fn provide(&self) -> Result<Elf, EmulateError> {
        self.provide_over(Transport::Semihosting)
    }

    /// The firmware for QEMU that marks the kinds of ray, for a [breakdown](super::breakdown), built if need be.
    ///
    /// # Errors
    /// Where it cannot be built.
    pub fn provide_marked(&self) -> Result<Elf, EmulateError> {
        self.provide_as(How { marks: true, ..How::default() })
    }

    /// The firmware that reaches the host in some way, built if need be.
    ///
    /// # Errors
    /// Where it cannot be built.
    pub fn provide_over(&self, transport: Transport) -> Result<Elf, EmulateError> {
        self.provide_as(How { transport, ..How::default() })
    }

    /// The firmware for QEMU that is compiled for speed or for size, built if need be.
    ///
    /// # Errors
    /// Where it cannot be built.
    pub fn provide_for(&self, prefer: Prefer) -> Result<Elf, EmulateError> {
        self.provide_as(How { prefer, ..How::default() })
    }

    /// The firmware for QEMU that draws the picture of the smallest profile by a loop for it alone, built if need be.
    ///
    /// # Errors
    /// Where it cannot be built.
    pub fn provide_by_hand(&self) -> Result<Elf, EmulateError> {
        self.provide_as(How { by_hand: true, ..How::default() })
    }

    fn provide_as(&self, how: How) -> Result<Elf, EmulateError> {
        let damaged = EmulateError::Damaged("the blob has no header");
        let traits = Traits::of(self.blob).ok_or(damaged)?;
        check(self.board, &traits)?;
        let folders = ["core-rt", "float-rt", "firmware-rt", self.board.package];
        kept(self.board, &self.name(&traits, how), &folders, |repository, path| self.build(repository, path, how))
    }

    /// Board, kernel, profile and transport.
    fn name(&self, traits: &Traits, how: How) -> String {
        let kernel = engine::by_id(traits.kernel).map_or("unknown", |engine| engine.name());
        let hits = match self.hits {
            None => "",
            Some(Way::Single) => "-single",
            Some(Way::Tile) => "-tile",
        };
        let count = if self.count { "-count" } else { "" };
        let marks = if how.marks { "-marks" } else { "" };
        let transport = match how.transport {
            Transport::Semihosting => "",
            Transport::Rtt => "-rtt",
        };
        let small = if how.prefer == Prefer::Size { "-small" } else { "" };
        let by_hand = if how.by_hand { "-by-hand" } else { "" };
        let Traits { needs, depth, branches, .. } = traits;
        let board = self.board.name;
        format!("{board}-{kernel}-{needs:x}-{depth}-{branches}{hits}{count}{marks}{transport}{small}{by_hand}")
    }

    fn build(&self, repository: &Repository, path: &Path, how: How) -> Result<(), EmulateError> {
        let How { transport, marks, prefer, by_hand } = how;
        let profile = cargo_profile(prefer);
        let Board { target, package, feature, .. } = *self.board;
        // A name that stays the same from build to build, so that cargo knows what it has.
        let blob = path.with_extension("blob");
        files::write_atomically(&blob, self.blob)?;
        let hits = match self.hits {
            None if by_hand => "by-hand",
            None => "",
            Some(Way::Single) => "single",
            Some(Way::Tile) => "tile",
        };
        let set = |is_set| if is_set { "1" } else { "0" };
        let variables: [(&str, OsString); 4] = [
            (BLOB_VARIABLE, blob.clone().into()),
            (HITS_VARIABLE, hits.into()),
            (COUNT_VARIABLE, set(self.count).into()),
            (MARKS_VARIABLE, set(marks).into()),
        ];
        let mut arguments =
            vec!["build", "--package", package, "--bin", package, "--target", target, "--profile", profile];
        let rtt = (transport == Transport::Rtt).then_some("rtt");
        arguments.extend(feature.into_iter().chain(rtt).flat_map(|feature| ["--features", feature]));
        repository
            .cargo(&arguments, &variables)
            .map_err(|output| EmulateError::Build { package: package.into(), output })?;
        let built = repository.target().join(target).join(profile).join(package);
        files::write_atomically(path, &files::read(&built)?)?;
        // Only the build needed it.
        fs::remove_file(blob).map_err(EmulateError::folder)
    }
}

/// The firmware of a name, built where it is not there or was made from something else than what is in the folders now.
pub(super) fn kept(
    board: &Board,
    name: &str,
    folders: &[&str],
    build: impl FnOnce(&Repository, &Path) -> Result<(), EmulateError>,
) -> Result<Elf, EmulateError> {
    let repository = Repository::find()?;
    let folder = repository.target().join("firmware");
    fs::create_dir_all(&folder).map_err(EmulateError::folder)?;
    let path = folder.join(format!("{name}.elf"));
    let origin_path = path.with_extension("origin");
    // One at a time: cargo has one place for all profiles of a package.
    let lock = File::create(folder.join("lock")).and_then(|file| file.lock().map(|()| file));
    let _lock = lock.map_err(EmulateError::folder)?;
    let origin = origin(repository.root(), folders).map_err(EmulateError::folder)?;
    if !path.is_file() || !fs::read_to_string(&origin_path).is_ok_and(|made_from| made_from == origin) {
        build(&repository, &path)?;
        files::write_atomically(&origin_path, origin.as_bytes())?;
    }
    Elf::read(&path, board)
}

/// Whether the compiler has a library for the target. Asks rustc and not rustup: there are other packagings of Rust.
fn has_library(target: &str) -> bool {
    let asked = Command::new("rustc")
        .args(["--print", "target-libdir", "--target", target])
        .stdin(Stdio::null())
        .output()
        .ok()
        .filter(|output| output.status.success());
    asked.is_some_and(|output| Path::new(String::from_utf8_lossy(&output.stdout).trim()).is_dir())
}

/// What firmware is made from: the compiler, and a checksum over the sources.
fn origin(root: &Path, folders: &[&str]) -> io::Result<String> {
    let mut paths = vec![root.join("Cargo.toml"), root.join("Cargo.lock"), root.join(".cargo/config.toml")];
    for folder in folders {
        collect(&root.join(folder), &mut paths)?;
    }
    paths.sort();
    let mut bytes = Vec::new();
    for path in paths {
        bytes.extend(path.strip_prefix(root).unwrap_or(&path).as_os_str().as_encoded_bytes());
        bytes.extend(fs::read(&path)?);
    }
    let compiler = Command::new("rustc").args(["--version", "--verbose"]).stdin(Stdio::null()).output()?;
    Ok(format!("{:08x}\n{}", core_rt::blob::crc32(&bytes), String::from_utf8_lossy(&compiler.stdout)))
}

/// The files in a folder and in those below it.
fn collect(folder: &Path, paths: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, paths)?;
        } else {
            paths.push(path);
        }
    }
    Ok(())
}
