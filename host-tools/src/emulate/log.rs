//! The firmware's log, from defmt's frames to lines.

use defmt_decoder::{DecodeError, Table};

use super::EmulateError;
use super::elf::Elf;

/// Decodes a log.
#[derive(Debug)]
pub struct Log {
    table: Option<Table>,
    /// Bytes of a frame that is not whole yet.
    rest: Vec<u8>,
}

impl Log {
    /// For the log of a firmware, whose strings are in its ELF.
    ///
    /// # Errors
    /// Where the ELF's strings cannot be read, or are of another version.
    pub fn new(elf: &Elf) -> Result<Self, EmulateError> {
        let table = Table::parse(elf.bytes()).map_err(|error| elf.unfit(error.to_string()))?;
        Ok(Self { table, rest: Vec::new() })
    }

    /// Takes what has come, in pieces of any size, and gives whole lines to `tell`.
    pub fn take(&mut self, bytes: &[u8], tell: &mut impl FnMut(&str)) {
        let Some(table) = &self.table else { return };
        self.rest.extend_from_slice(bytes);
        // A frame ends with a zero.
        let Some(end) = self.rest.iter().rposition(|&byte| byte == 0) else { return };
        let mut decoder = table.new_stream_decoder();
        let whole: Vec<u8> = self.rest.drain(..=end).collect();
        decoder.received(&whole);
        loop {
            match decoder.decode() {
                Ok(frame) => {
                    let level = frame.level().map_or("", |level| level.as_str());
                    tell(&format!("{level:<5} {}", frame.display_message()));
                }
                Err(DecodeError::UnexpectedEof) => return,
                Err(DecodeError::Malformed) => tell("?     a line of the log that cannot be read"),
            }
        }
    }
}
