//! What is put into a board's flash, piece by piece, and whether it may lie there.

use firmware_rt::board::{Board, Region};
use object::Endianness;
use object::elf::PT_LOAD;
use object::read::elf::{ElfFile32, ProgramHeader};

use super::FlashError;
use crate::emulate::elf::Elf;

/// The checksum over the RP2040's second boot stage, in its last four bytes (data sheet, 2.8.1.3.1): CRC-32/MPEG-2.
const BOOT_CRC: crc::Crc<u32> = crc::Crc::<u32>::new(&crc::CRC_32_MPEG_2);

/// A run of bytes for the flash.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Piece {
    /// The address of the first.
    pub start: u32,
    /// The bytes.
    pub bytes: Vec<u8>,
}

impl Piece {
    fn is_inside(&self, region: Region) -> bool {
        let end = u64::from(self.start) + self.bytes.len() as u64;
        self.start >= region.start && end <= u64::from(region.end())
    }
}

/// A firmware's pieces, and the blob in its place, in order of addresses and checked: each lies in the flash that the board
/// has for it, none on another, the vectors lead into the stack's memory and into the code, and a boot loader's checksum is
/// right.
///
/// # Errors
/// [`FlashError::Image`] where that is not so.
pub fn pieces(board: &Board, elf: &Elf, blob: &[u8]) -> Result<Vec<Piece>, FlashError> {
    let unfit = |reason: String| FlashError::Image { elf: elf.path().into(), board: board.name, reason };
    let place = elf.blob_place.ok_or_else(|| unfit("it has no place for a blob".into()))?;
    let mut pieces = loaded(elf.bytes()).map_err(unfit)?;
    pieces.push(Piece { start: place.start, bytes: blob.to_vec() });
    pieces.sort_by_key(|piece| piece.start);
    checked(board, place, &pieces).map_err(unfit)?;
    Ok(pieces)
}

/// What an ELF loads into flash.
fn loaded(bytes: &[u8]) -> Result<Vec<Piece>, String> {
    let file = ElfFile32::<Endianness>::parse(bytes).map_err(|error| error.to_string())?;
    let endian = file.endian();
    let mut pieces = Vec::new();
    for header in file.elf_program_headers() {
        let data = header.data(endian, bytes).map_err(|()| "a segment is not whole".to_owned())?;
        if header.p_type(endian) == PT_LOAD && !data.is_empty() {
            pieces.push(Piece { start: header.p_paddr(endian), bytes: data.to_vec() });
        }
    }
    Ok(pieces)
}

/// What is wrong with pieces that are in order.
fn checked(board: &Board, place: Region, pieces: &[Piece]) -> Result<(), String> {
    if place.start < board.flash.start || place.end() > board.flash.end() {
        return Err(format!("the blob's place at {:#010x} is outside its flash", place.start));
    }
    let code = Region { start: board.flash.start, length: place.start.saturating_sub(board.flash.start) };
    for piece in pieces {
        let is_boot = board.boot.is_some_and(|boot| piece.is_inside(boot));
        if !(is_boot || piece.is_inside(code) || piece.is_inside(place)) {
            return Err(format!("{} bytes at {:#010x} are outside its flash", piece.bytes.len(), piece.start));
        }
    }
    let overlaps = |pair: &[Piece]| u64::from(pair[0].start) + pair[0].bytes.len() as u64 > u64::from(pair[1].start);
    if let Some(pair) = pieces.windows(2).find(|pair| overlaps(pair)) {
        return Err(format!("the bytes at {:#010x} and at {:#010x} overlap", pair[0].start, pair[1].start));
    }
    let Some(boot) = board.boot else { return Ok(()) };
    let at = |region: Region| pieces.iter().find(|piece| piece.start == region.start).map(|piece| &piece.bytes);
    let stage = at(boot).filter(|stage| stage.len() == boot.length as usize);
    let (stage, sum) = stage.and_then(|stage| stage.split_last_chunk()).ok_or("it has no boot loader")?;
    if BOOT_CRC.checksum(stage) != u32::from_le_bytes(*sum) {
        return Err("the boot loader's checksum is wrong".into());
    }
    let vectors = at(code).and_then(|code| code.first_chunk::<8>()).ok_or("no vectors follow the boot loader")?;
    let word = |i| u32::from_le_bytes([vectors[i], vectors[i + 1], vectors[i + 2], vectors[i + 3]]);
    let (stack, entry) = (word(0), word(4));
    if stack != board.stack.end() || entry & 1 == 0 || !(code.start..code.end()).contains(&entry) {
        return Err(format!("its vectors are no stack and no code: {stack:#010x} and {entry:#010x}"));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use firmware_rt::board::PICO;

    const PLACE: Region = Region { start: 0x1008_0000, length: 0x18_0000 };

    fn good() -> Vec<Piece> {
        let mut stage = [7; 256];
        let sum = BOOT_CRC.checksum(&stage[..252]);
        stage[252..].copy_from_slice(&sum.to_le_bytes());
        let vectors = [PICO.stack.end().to_le_bytes(), 0x1000_0201_u32.to_le_bytes()].concat();
        vec![
            Piece { start: 0x1000_0000, bytes: stage.to_vec() },
            Piece { start: 0x1000_0100, bytes: [vectors, vec![1; 1000]].concat() },
            Piece { start: 0x1008_0000, bytes: vec![2; 5000] },
        ]
    }

    fn complaint(change: impl FnOnce(&mut Vec<Piece>)) -> String {
        let mut pieces = good();
        change(&mut pieces);
        checked(&PICO, PLACE, &pieces).expect_err("it is wrong")
    }

    #[test]
    fn what_lies_where_it_should_not_is_seen() {
        assert_eq!(checked(&PICO, PLACE, &good()), Ok(()));
        assert!(complaint(|pieces| pieces[0].bytes[3] ^= 1).contains("checksum"));
        assert!(complaint(|pieces| drop(pieces.remove(0))).contains("no boot loader"));
        assert!(complaint(|pieces| drop(pieces.remove(1))).contains("no vectors"));
        assert!(complaint(|pieces| pieces[1].bytes[0] ^= 4).contains("no stack"));
        assert!(complaint(|pieces| pieces[1].bytes[4] ^= 1).contains("no code"));
        assert!(complaint(|pieces| pieces[1].bytes.resize(0x8_0000, 0)).contains("0x10000100 are outside"));
        assert!(complaint(|pieces| pieces[2].bytes.resize(0x18_0001, 0)).contains("0x10080000 are outside"));
        let ram = Piece { start: 0x2000_0000, bytes: vec![0] };
        assert!(complaint(|pieces| pieces.push(ram)).contains("0x20000000 are outside"));
        let place = checked(&firmware_rt::board::MICROBIT, PLACE, &good());
        assert!(place.is_err_and(|reason| reason.contains("place at 0x10080000 is outside")));
        let second = Piece { start: 0x1000_0200, bytes: vec![0] };
        assert!(complaint(|pieces| pieces.insert(2, second)).contains("overlap"));
    }

    /// The parameters, by the check value of the catalogue of CRCs.
    #[test]
    fn the_checksum_is_the_data_sheets() {
        assert_eq!(BOOT_CRC.checksum(b"123456789"), 0x0376_e6e7);
    }
}
