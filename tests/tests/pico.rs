//! Firmware for a Raspberry Pi Pico, which no emulator here has: built, and checked piece by piece against the RP2040's
//! memory map and against what its boot ROM asks for.
//!
//! Where the compiler's library is absent, it is skipped, with a line that says so.

use std::collections::BTreeMap;

use firmware_rt::board::PICO;
use host_tools::builtin;
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware::{self, Transport, Wanted};
use host_tools::emulate::parts::Part;
use host_tools::engine;
use host_tools::flash::{image, uf2};
use host_tools::import::{Embedded, load_from};
use host_tools::prepare::Options;
use object::read::elf::{ElfFile32, ProgramHeader};
use object::{Endianness, Object, ObjectSection, SectionKind};
use tests::symbols::{Category, find};

/// The data sheet's memory map, 2.2: flash by its cached addresses, as much as the Pico has, and SRAM.
const FLASH: std::ops::Range<u64> = 0x1000_0000..0x1020_0000;
const SRAM: std::ops::Range<u64> = 0x2000_0000..0x2004_2000;

/// The built-in scene for a kernel.
fn blob(kernel: &str) -> Vec<u8> {
    let model = load_from(&Embedded(builtin::FILES), "scene.toml").unwrap().model;
    engine::by_name(kernel).unwrap().prepare(&model, &Options::default()).unwrap().blob.bytes().to_vec()
}

/// Firmware for a blob; none where it cannot be built here.
fn firmware(blob: &[u8]) -> Option<Elf> {
    if let Err(error) = firmware::check_board(&PICO) {
        println!("skipped pico: {error}");
        return None;
    }
    Some(Wanted { board: &PICO, blob, hits: None, count: false }.provide_over(Transport::Rtt).unwrap())
}

/// The boot ROM's checksum, bit by bit (data sheet, 2.8.1.3.1): the polynomial 0x04c11db7, from all ones, high bits first,
/// nothing inverted.
fn boot_sum(bytes: &[u8]) -> u32 {
    bytes.iter().fold(u32::MAX, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte) << 24, |sum, _| sum << 1 ^ if sum >> 31 == 1 { 0x04c1_1db7 } else { 0 })
    })
}

/// What the chip's flash has after the file was dragged: the specification's blocks, read on their own.
fn dragged(file: &[u8]) -> BTreeMap<u32, u8> {
    let mut flash = BTreeMap::new();
    assert_eq!(file.len() % 512, 0);
    for block in file.chunks_exact(512) {
        let word = |i: usize| u32::from_le_bytes(block[4 * i..4 * i + 4].try_into().unwrap());
        assert_eq!([word(0), word(1), word(127)], [0x0a32_4655, 0x9e5d_5157, 0x0ab1_6f30]);
        assert_eq!((word(2), word(4), word(7)), (0x2000, 256, 0xe48b_ff56), "the RP2040's family");
        for (address, &byte) in (word(3)..).zip(&block[32..288]) {
            assert_eq!(flash.insert(address, byte), None, "{address:#x} is written twice");
        }
    }
    flash
}

#[test]
fn every_section_is_where_the_chip_has_memory_for_it() {
    let blob = blob("exact14");
    let Some(elf) = firmware(&blob) else { return };
    let file = ElfFile32::<Endianness>::parse(elf.bytes()).unwrap();
    let address = |name| file.section_by_name(name).map(|section| section.address());
    assert_eq!([".boot", ".vector_table"].map(address), [Some(0x1000_0000), Some(0x1000_0100)]);
    assert_eq!(file.section_by_name(".boot").unwrap().size(), 256);
    let mut found = 0;
    for header in file.elf_program_headers() {
        let [at, from, size, in_file] = [
            header.p_vaddr(Endianness::Little),
            header.p_paddr(Endianness::Little),
            header.p_memsz(Endianness::Little),
            header.p_filesz(Endianness::Little),
        ]
        .map(u64::from);
        if header.p_type(Endianness::Little) != object::elf::PT_LOAD || size == 0 {
            continue;
        }
        found += 1;
        let is_inside = |range: &std::ops::Range<u64>, start| range.contains(&start) && start + size <= range.end;
        assert!(is_inside(&FLASH, at) || is_inside(&SRAM, at), "{at:#x}");
        // What is loaded comes from in front of the blob.
        let blob = u64::from(elf.blob_place.unwrap().start);
        assert!(in_file == 0 || (FLASH.start..blob).contains(&from) && from + in_file <= blob, "{from:#x}");
    }
    assert!(found >= 3, "{found}");
    let variables = file.sections().filter(|section| section.kind() == SectionKind::UninitializedData);
    assert!(variables.into_iter().all(|section| section.address() >= u64::from(PICO.stack.end())));
    assert_eq!(elf.blob_place.unwrap().start % 4096, 0, "a blob is flashed by itself, in whole sectors");
    assert!(elf.symbol("_SEGGER_RTT").is_some_and(|address| SRAM.contains(&address)));
    println!("pico: {} bytes of text, {} of RAM", elf.text_bytes, elf.static_bytes);
}

#[test]
fn the_file_for_the_drive_boots_by_the_roms_rules() {
    for kernel in ["exact14", "exact29"] {
        let blob = blob(kernel);
        let Some(elf) = firmware(&blob) else { return };
        let pieces = image::pieces(&PICO, &elf, &blob).unwrap();
        let flash = dragged(&uf2::file(PICO.uf2_family.unwrap(), &pieces));
        let bytes = |start: u32, length: u32| (start..start + length).map(|at| flash[&at]).collect::<Vec<u8>>();
        let word = |start| u32::from_le_bytes(bytes(start, 4).try_into().unwrap());
        // The ROM: a right checksum over 252 bytes, then vectors behind them.
        assert_eq!(boot_sum(&bytes(0x1000_0000, 252)), word(0x1000_00fc), "{kernel}");
        assert_eq!(word(0x1000_0100), PICO.stack.end());
        let entry = elf.symbol("Reset").unwrap() as u32;
        assert_eq!(word(0x1000_0104), entry | 1);
        assert!(flash.contains_key(&(entry & !1)));
        // The firmware: the blob where it looks for it.
        let place = PICO.blob(engine::by_name(kernel).unwrap().id()).start;
        assert!(bytes(place, blob.len() as u32) == blob, "{kernel}");
        // Erratum E14: whole sectors.
        let of_sectors = flash.keys().fold(BTreeMap::new(), |mut counts: BTreeMap<u32, u32>, address| {
            *counts.entry(address / 4096).or_default() += 1;
            counts
        });
        assert!(of_sectors.values().all(|&count| count == 4096));
    }
}

/// Other firmware is refused by the checks that this board's passes.
#[test]
fn firmware_of_another_board_is_none() {
    let blob = blob("exact14");
    let Some(elf) = firmware(&blob) else { return };
    let other = &firmware_rt::board::MICROBIT;
    let theirs = Wanted { board: other, blob: &blob, hits: None, count: false }.provide_over(Transport::Rtt).unwrap();
    let error = image::pieces(&PICO, &theirs, &blob).map(drop).unwrap_err().to_string();
    assert!(error.contains("not firmware for pico: ") && error.contains(" outside its flash"), "{error}");
    let error = image::pieces(other, &elf, &blob).map(drop).unwrap_err().to_string();
    assert!(error.contains("not firmware for microbit: "), "{error}");
    assert_eq!(boot_sum(b"123456789"), 0x0376_e6e7, "the catalogue's check value");
}

#[test]
fn it_computes_without_floats_and_is_known_by_its_parts() {
    let blob = blob("exact14");
    let Some(elf) = firmware(&blob) else { return };
    assert_eq!(find(elf.bytes()).unwrap().get(&Category::SoftFloat), None);
    assert!(elf.parts().unwrap().iter().any(|range| range.part == Some(Part::Traversal)));
}
