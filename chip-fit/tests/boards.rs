//! The firmware of every board, held against our memory map of the board, and against probe-rs's own loader with its map of
//! the board's chip: what `intray flash` would flash, without a probe.
//!
//! Boards for which the compiler's library is absent are skipped, with a line that says so.

use std::fs::{self, File};
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::process::Command;

use firmware_rt::board::{BOARDS, Board, HIFIVE1, MICROBIT, Region};
use host_tools::builtin;
use host_tools::emulate::firmware::{self, Transport, Wanted};
use host_tools::engine;
use host_tools::import::{Embedded, load_from};
use host_tools::prepare::Options;
use object::Endianness::Little;
use object::elf::{PT_LOAD, ProgramHeader32};
use object::read::elf::{ElfFile32, ProgramHeader};
use probe_rs::config::Registry;
use probe_rs::flashing::{DownloadOptions, ElfLoader, ElfOptions, FlashLoader};
use probe_rs::integration::FakeProbe;
use probe_rs::{Permissions, Session};

/// A place where no board and no chip of them has memory.
const NOWHERE: u32 = 0x7000_0000;

/// The boards that can be built for here.
fn boards() -> impl Iterator<Item = &'static Board> {
    BOARDS.into_iter().filter(|board| {
        let checked = firmware::check_board(board);
        if let Err(error) = &checked {
            println!("skipped {}: {error}", board.name);
        }
        checked.is_ok()
    })
}

/// The firmware as `cargo build` makes it, with the default blob in it.
fn default_firmware(board: &Board) -> Vec<u8> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let target = std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root.join("target"), PathBuf::from);
    let target = std::path::absolute(target).unwrap();
    // One at a time, and not while scenes' firmware is built: cargo has one place for all firmware of a package.
    fs::create_dir_all(target.join("firmware")).unwrap();
    let lock = File::create(target.join("firmware/lock")).unwrap();
    lock.lock().unwrap();
    let mut command = Command::new(env!("CARGO"));
    command.args(["build", "--quiet", "--profile", "firmware", "--package", board.package, "--bin", board.package]);
    command.args(["--target", board.target]).env("CARGO_TARGET_DIR", &target).current_dir(&root);
    command.args(board.feature.into_iter().flat_map(|feature| ["--features", feature]));
    assert!(command.status().unwrap().success());
    fs::read(target.join(board.target).join("firmware").join(board.package)).unwrap()
}

/// The firmware that `intray flash` flashes, for the built-in scene by a kernel.
fn flashed_firmware(board: &'static Board, kernel: &str) -> Vec<u8> {
    let model = load_from(&Embedded(builtin::FILES), "scene.toml").unwrap().model;
    let prepared = engine::by_name(kernel).unwrap().prepare(&model, &Options::default()).unwrap();
    let wanted = Wanted { board, blob: prepared.blob.bytes(), hits: None, count: false };
    wanted.provide_over(Transport::Rtt).unwrap().bytes().to_vec()
}

/// All of them, each with what it is.
fn images(board: &'static Board) -> Vec<(String, Vec<u8>)> {
    let mut images = vec![(format!("{}, as cargo builds it", board.name), default_firmware(board))];
    for kernel in ["exact14", "exact29"] {
        images.push((format!("{}, {kernel} by RTT", board.name), flashed_firmware(board, kernel)));
    }
    images
}

/// The segments of an ELF that are loaded or take memory.
fn segments(bytes: &[u8]) -> Vec<ProgramHeader32<object::Endianness>> {
    let file = ElfFile32::<object::Endianness>::parse(bytes).unwrap();
    let is_there = |header: &&ProgramHeader32<_>| header.p_type(Little) == PT_LOAD && header.p_memsz(Little) > 0;
    file.elf_program_headers().iter().filter(is_there).copied().collect()
}

/// The segments that are not where our map of the board has memory for them: loaded from flash, and at work in flash or RAM.
fn misplaced(board: &Board, bytes: &[u8]) -> Vec<u32> {
    let is_inside = |regions: &[Region], start: u32, length: u32| {
        let end = u64::from(start) + u64::from(length);
        regions.iter().any(|region| region.start <= start && end <= u64::from(region.end()))
    };
    let flash: Vec<Region> = board.boot.into_iter().chain([board.flash]).collect();
    let all: Vec<Region> = flash.iter().copied().chain([board.stack, board.ram]).collect();
    let wrong = |header: &ProgramHeader32<_>| {
        let (from, at) = (header.p_paddr(Little), header.p_vaddr(Little));
        let (stored, taken) = (header.p_filesz(Little), header.p_memsz(Little));
        let is_loaded_well = stored == 0 || is_inside(&flash, from, stored);
        (!is_loaded_well || !is_inside(&all, at, taken)).then_some(from)
    };
    segments(bytes).iter().filter_map(wrong).collect()
}

/// An ELF with one of its loaded segments moved, both where it is loaded and where it works.
fn moved(bytes: &[u8], to: u32) -> Vec<u8> {
    /// Bytes of a program header of ELF-32, and where the virtual address stands in it; the physical one follows.
    const HEADER: (usize, usize) = (32, 8);
    /// Where the ELF's header says where the first of them is.
    const TABLE: usize = 28;
    let table = u32::from_le_bytes(bytes[TABLE..TABLE + 4].try_into().unwrap()) as usize;
    let file = ElfFile32::<object::Endianness>::parse(bytes).unwrap();
    let headers = file.elf_program_headers();
    let is_loaded = |header: &ProgramHeader32<_>| header.p_type(Little) == PT_LOAD && header.p_filesz(Little) > 0;
    let place = table + headers.iter().position(is_loaded).unwrap() * HEADER.0 + HEADER.1;
    let mut bytes = bytes.to_vec();
    for at in [place, place + 4] {
        bytes[at..at + 4].copy_from_slice(&to.to_le_bytes());
    }
    bytes
}

/// A session with a chip that is not there. probe-rs reads files only with one.
fn session(chip: &str) -> Option<Session> {
    FakeProbe::with_mocked_core().into_probe().attach(chip, Permissions::default()).ok()
}

/// What probe-rs's loader makes of an ELF and of a blob that fills its place; why it refuses them, if it does.
fn loaded(board: &Board, elf: &[u8]) -> Result<FlashLoader, String> {
    let target = Registry::from_builtin_families().get_target_by_name(board.probe_rs_chip).unwrap();
    let mut loader = target.flash_loader();
    // The session serves the loader's signature alone: the map is the target's.
    let mut any = session(MICROBIT.probe_rs_chip).expect("probe-rs's own tests attach to it");
    loader
        .load_image(&mut any, &mut Cursor::new(elf), ElfLoader(ElfOptions::default()), None)
        .map_err(|error| format!("{error:?}"))?;
    Ok(loader)
}

/// Plans the flashing of what was loaded, and does nothing.
fn planned(loader: &FlashLoader, session: &mut Session) -> Result<(), String> {
    let mut options = DownloadOptions::default();
    options.dry_run = true;
    loader.commit(session, options).map_err(|error| format!("{error:?}"))
}

#[test]
fn every_segment_is_where_our_map_and_probe_rs_have_memory_for_it() {
    for board in boards() {
        for (what, elf) in images(board) {
            assert_eq!(misplaced(board, &elf), [0_u32; 0], "{what}");
            assert!(segments(&elf).len() >= 2, "{what}");
            let loader = loaded(board, &elf).unwrap_or_else(|error| panic!("{what}: {error}"));
            for header in segments(&elf).iter().filter(|header| header.p_filesz(Little) > 0) {
                let [first, last] = [0, header.p_filesz(Little) - 1].map(|at| u64::from(header.p_paddr(Little) + at));
                assert!(loader.has_data_for_address(first) && loader.has_data_for_address(last), "{what}: {first:#x}");
            }
            // With the algorithms for its flash, by which sectors are laid out; a core that is no Arm cannot be mocked.
            match session(board.probe_rs_chip) {
                Some(mut session) => planned(&loader, &mut session).unwrap_or_else(|error| panic!("{what}: {error}")),
                None => assert_eq!(*board, HIFIVE1, "{what}: there is no mock of its chip"),
            }
        }
    }
}

/// The blob is flashed by itself: its place is flash of the chip to its last byte.
#[test]
fn every_place_for_a_blob_is_flash_of_the_chip() {
    for board in BOARDS {
        for kernel in ["exact14", "exact29"] {
            let place = board.blob(engine::by_name(kernel).unwrap().id());
            let target = Registry::from_builtin_families().get_target_by_name(board.probe_rs_chip).unwrap();
            let add = |length: usize| target.flash_loader().add_data(place.start.into(), &vec![0; length]);
            add(place.length as usize).unwrap_or_else(|error| panic!("{}: {error:?}", board.name));
            let region = target.memory_region_by_address(place.start.into()).unwrap();
            assert!(region.is_nvm() && region.address_range().end >= u64::from(place.end()), "{}", board.name);
            if *board == MICROBIT {
                assert!(add(place.length as usize + 1).is_err(), "the flash ends there");
            }
        }
    }
}

#[test]
fn a_segment_elsewhere_is_refused_by_both() {
    for board in boards() {
        let elf = default_firmware(board);
        let elsewhere = moved(&elf, NOWHERE);
        assert_eq!(misplaced(board, &elsewhere), [NOWHERE], "{}", board.name);
        let error = loaded(board, &elsewhere).map(drop).unwrap_err();
        assert!(error.contains("NoSuitableNvm") && error.contains(&NOWHERE.to_string()), "{}: {error}", board.name);
    }
}

/// Our map is the narrower one: the boot loader's part of the flash is the chip's, and not ours.
#[test]
fn a_segment_on_the_boot_loader_is_refused_by_our_map_alone() {
    let Some(board) = boards().find(|board| **board == HIFIVE1) else { return };
    let on_it = moved(&default_firmware(board), 0x2000_0000);
    assert_eq!(misplaced(board, &on_it), [0x2000_0000]);
    assert!(loaded(board, &on_it).is_ok());
}

/// What the nRF51's flash is to have, the algorithms of a chip whose flash is elsewhere cannot write.
#[test]
fn a_plan_for_another_chip_is_refused() {
    let Some(board) = boards().find(|board| **board == MICROBIT) else { return };
    let loader = loaded(board, &default_firmware(board)).unwrap();
    let error = planned(&loader, &mut session("STM32F030F4").unwrap()).unwrap_err();
    assert!(error.contains("Algorithm"), "{error}");
}
