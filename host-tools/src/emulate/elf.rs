//! What a firmware's ELF says: how large it is, where its marks are.

use std::path::{Path, PathBuf};

use firmware_rt::board::{Board, Region};
use object::elf::SHF_ALLOC;
use object::read::elf::{ElfFile32, ElfSymbol32};
use object::{Endianness, Object, ObjectSection, ObjectSymbol, SectionFlags, SectionKind, SymbolKind};

use super::EmulateError;
use super::parts::{self, Range};
use crate::files;

/// A firmware's file.
#[derive(Clone, Debug)]
pub struct Elf {
    path: PathBuf,
    bytes: Vec<u8>,
    /// Bytes of flash that code and constants take, the blob left out.
    pub text_bytes: u64,
    /// Bytes of RAM that variables take, the stack left out.
    pub static_bytes: u64,
    /// Bytes of the blob that is part of it, 0 if none is.
    pub blob_bytes: u64,
    /// The flash in which a blob has its place; `None` for what is no firmware for blobs.
    pub blob_place: Option<Region>,
    /// The addresses of the marks between which instructions are counted.
    pub window: Option<[u64; 2]>,
}

impl Elf {
    /// Reads a firmware's file.
    ///
    /// # Errors
    /// Where it cannot be read, or is no 32-bit ELF.
    pub fn read(path: &Path, board: &Board) -> Result<Self, EmulateError> {
        let bytes = files::read(path)?;
        // QEMU has a folder of its own.
        let path = std::path::absolute(path).unwrap_or_else(|_| path.into());
        let mut found =
            Self { path, bytes, text_bytes: 0, static_bytes: 0, blob_bytes: 0, blob_place: None, window: None };
        let file =
            ElfFile32::<Endianness>::parse(found.bytes.as_slice()).map_err(|error| found.unfit(error.to_string()))?;
        let (mut text_bytes, mut static_bytes, mut blob_bytes) = (0, 0, 0);
        for section in file.sections() {
            let is_loaded =
                matches!(section.flags(), SectionFlags::Elf { sh_flags } if sh_flags & u64::from(SHF_ALLOC) != 0);
            if !is_loaded {
                continue;
            }
            if section.name() == Ok(".blob") {
                blob_bytes += section.size();
            } else if section.kind() != SectionKind::UninitializedData {
                text_bytes += section.size();
            }
            if (u64::from(board.ram.start)..u64::from(board.ram.end())).contains(&section.address()) {
                static_bytes += section.size();
            }
        }
        let blob_address = address(&file, "_intray_blob").and_then(|address| address.try_into().ok());
        let start = blob_address.filter(|&start| start <= board.flash.end());
        found.blob_place = start.map(|start| Region { start, length: board.flash.end() - start });
        let window = address(&file, "intray_window_begin").zip(address(&file, "intray_window_end"));
        found.window = window.map(|(begin, end)| [begin, end]);
        (found.text_bytes, found.static_bytes, found.blob_bytes) = (text_bytes, static_bytes, blob_bytes);
        Ok(found)
    }

    /// Where it is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Its bytes.
    #[must_use]
    pub fn bytes(&self) -> &[u8] {
        &self.bytes
    }

    /// The address of a symbol.
    #[must_use]
    pub fn symbol(&self, name: &str) -> Option<u64> {
        let file = ElfFile32::<Endianness>::parse(self.bytes.as_slice()).ok()?;
        address(&file, name)
    }

    /// What its code is for.
    ///
    /// # Errors
    /// Where its debug information cannot be read.
    pub fn parts(&self) -> Result<Vec<Range>, EmulateError> {
        let unfit = |reason: String| self.unfit(reason);
        let file = ElfFile32::<Endianness>::parse(self.bytes.as_slice()).map_err(|error| unfit(error.to_string()))?;
        parts::parts(&file).map_err(unfit)
    }

    /// Its routines, a line each: address, bytes, name.
    pub(super) fn routines(&self) -> Result<String, EmulateError> {
        let file = ElfFile32::<Endianness>::parse(self.bytes.as_slice()).map_err(|e| self.unfit(e.to_string()))?;
        // The lowest bit of an address says that it is Thumb code.
        let routine = |symbol: ElfSymbol32<'_, '_, Endianness>| {
            let name = symbol.name().ok().filter(|_| symbol.kind() == SymbolKind::Text && symbol.size() > 0)?;
            Some(format!("{:#x} {:#x} {name}\n", symbol.address() & !1, symbol.size()))
        };
        Ok(file.symbols().filter_map(routine).collect())
    }

    pub(super) fn unfit(&self, reason: String) -> EmulateError {
        EmulateError::Elf { path: self.path.clone(), reason }
    }
}

fn address(file: &ElfFile32<'_, Endianness>, name: &str) -> Option<u64> {
    Some(file.symbols().find(|symbol| symbol.name() == Ok(name))?.address())
}
