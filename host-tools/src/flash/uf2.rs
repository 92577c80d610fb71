//! UF2: what a boot loader's drive takes, by [Microsoft's specification](https://github.com/microsoft/uf2).
//!
//! A file is blocks of 512 bytes, each with 256 of the flash and the address where they go. The RP2040 erases a sector of
//! 4 KiB at its first block, and must be given the others of it too (erratum RP2040-E14), so that sectors are filled up.

use std::collections::BTreeMap;

use super::image::Piece;

const MAGICS: [u32; 2] = [0x0a32_4655, 0x9e5d_5157];
const LAST_MAGIC: u32 = 0x0ab1_6f30;

/// The eighth word is a family's number.
const HAS_FAMILY: u32 = 0x2000;

const BLOCK: usize = 512;
const HEAD: usize = 32;
const PAGE: usize = 256;
const SECTOR: u32 = 4096;

/// The file of pieces that do not overlap, for the boot loaders of a family. What is between them in a sector is zeros.
#[must_use]
pub fn file(family: u32, pieces: &[Piece]) -> Vec<u8> {
    let mut sectors: BTreeMap<u32, [u8; SECTOR as usize]> = BTreeMap::new();
    for Piece { start, bytes } in pieces {
        for (address, &byte) in (*start..).zip(bytes) {
            let sector = sectors.entry(address / SECTOR * SECTOR).or_insert([0; SECTOR as usize]);
            sector[(address % SECTOR) as usize] = byte;
        }
    }
    let count = (sectors.len() * SECTOR as usize / PAGE) as u32;
    let pages = sectors.iter().flat_map(|(&start, sector)| (start..).step_by(PAGE).zip(sector.chunks_exact(PAGE)));
    let mut file = Vec::with_capacity(count as usize * BLOCK);
    for (number, (address, page)) in (0_u32..).zip(pages) {
        let head = [MAGICS[0], MAGICS[1], HAS_FAMILY, address, PAGE as u32, number, count, family];
        file.extend(head.into_iter().flat_map(u32::to_le_bytes));
        file.extend_from_slice(page);
        file.resize(file.len() + BLOCK - HEAD - PAGE - 4, 0);
        file.extend(LAST_MAGIC.to_le_bytes());
    }
    file
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sectors_are_whole_and_blocks_are_numbered() {
        let pieces =
            [Piece { start: 0x1000_0000, bytes: vec![1; 257] }, Piece { start: 0x1000_1fff, bytes: vec![2, 3] }];
        let file = file(0xe48b_ff56, &pieces);
        assert_eq!(file.len(), 48 * 512);
        for (number, block) in file.chunks_exact(512).enumerate() {
            assert_eq!((&block[..8], &block[508..]), (&b"UF2\nWQ]\x9e"[..], &b"\x30\x6f\xb1\x0a"[..]));
            let word = |i: usize| u32::from_le_bytes(block[i..i + 4].try_into().unwrap());
            let expected = [0x2000, 0x1000_0000 + 256 * number as u32, 256, number as u32, 48, 0xe48b_ff56];
            assert_eq!([8, 12, 16, 20, 24, 28].map(word), expected);
            assert!(block[288..508].iter().all(|&byte| byte == 0));
        }
        let at = |address: usize| file[address / 256 * 512 + 32 + address % 256];
        assert_eq!([0, 255, 256, 257, 0x1ffe, 0x1fff, 0x2000, 0x2001].map(at), [1, 1, 1, 0, 0, 2, 3, 0]);
    }
}
