//! What is linked for a chip: no routine for floats in any firmware, and in rendering code alone no way to panic and no
//! text either. Each check has a program that must fail it.
//!
//! Boards for which the compiler's library is absent are skipped, with a line that says so.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use core_rt::exact::Exact14;
use core_rt::kernel::Kernel;
use core_rt::profile::Prefer;
use firmware_rt::board::{BOARDS, Board};
use firmware_rt::build::Traits;
use host_tools::builtin;
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware::{self, Wanted};
use host_tools::emulate::probe::Probe;
use host_tools::engine;
use host_tools::import::{Embedded, load_from};
use host_tools::prepare::Options;
use object::read::archive::ArchiveFile;
use object::{Object, ObjectSymbol, SymbolKind};
use tests::symbols::{Category, Found, category, find};

/// The boards that can be built for here.
fn boards() -> impl Iterator<Item = &'static Board> {
    BOARDS.into_iter().filter(|board| {
        let traits = Traits { kernel: Exact14::ID, needs: 0, depth: 16, branches: 0 };
        let checked = firmware::check(board, &traits);
        if let Err(error) = &checked {
            println!("skipped {}: {error}", board.name);
        }
        checked.is_ok()
    })
}

/// The built-in scene for a kernel.
fn built_in(kernel: &str) -> Vec<u8> {
    let model = load_from(&Embedded(builtin::FILES), "scene.toml").unwrap().model;
    let prepared = engine::by_name(kernel).unwrap().prepare(&model, &Options::default()).unwrap();
    prepared.blob.bytes().to_vec()
}

/// A program of the package `probe`, for a blob or for the default one.
fn probe(board: &'static Board, program: &str, blob: Option<&Path>) -> Elf {
    Probe { board, program, prefer: Prefer::Speed, blob, needs: None }.provide().unwrap()
}

fn categories(found: &Found) -> Vec<Category> {
    found.keys().copied().collect()
}

#[test]
fn firmware_computes_without_floats_unless_its_kernel_is_one() {
    for board in boards() {
        for kernel in ["exact14", "exact29", "f32"] {
            let blob = built_in(kernel);
            let elf = Wanted { board, blob: &blob, hits: None, count: false }.provide().unwrap();
            let found = find(elf.bytes()).unwrap();
            let floats = found.get(&Category::SoftFloat);
            assert_eq!(floats.is_some(), kernel == "f32", "{} {kernel}: {floats:?}", board.name);
            // Firmware may panic, and say so.
            assert!(found.contains_key(&Category::Panic), "{} {kernel}", board.name);
        }
    }
}

#[test]
fn rendering_has_no_floats_no_panic_and_no_text() {
    let folder = tempfile::tempdir().unwrap();
    for board in boards() {
        let entry = probe(board, "empty", None);
        assert_eq!(find(entry.bytes()).unwrap(), Found::new(), "{}", board.name);
        for (kernel, expected) in [("exact14", vec![]), ("exact29", vec![Category::WideDivision])] {
            let blob = folder.path().join(kernel);
            fs::write(&blob, built_in(kernel)).unwrap();
            let elf = probe(board, "probe", Some(&blob));
            let found = find(elf.bytes()).unwrap();
            assert_eq!(categories(&found), expected, "{} {kernel}: {found:?}", board.name);
            // It is all there: nothing was found superfluous by the optimiser.
            assert!(elf.text_bytes > entry.text_bytes + 16_384, "{} {kernel}: {}", board.name, elf.text_bytes);
        }
    }
}

#[test]
fn what_leaks_is_found() {
    let leaks = [
        ("leaks-float", Category::SoftFloat, "__addsf3"),
        ("leaks-panic", Category::Panic, "probe_panicked"),
        ("leaks-format", Category::Formatting, "core::fmt::write"),
    ];
    for board in boards() {
        for (program, category, name) in leaks {
            let found = find(probe(board, program, None).bytes()).unwrap();
            assert_eq!(categories(&found), [category], "{} {program}: {found:?}", board.name);
            let names = &found[&category];
            assert!(names.iter().any(|found| found.ends_with(name)), "{} {program}: {names:?}", board.name);
        }
    }
}

/// What the compiler's library offers besides floats and wide divisions. A name that is new here must be looked at.
const INTEGERS: &str = "\
    __absvdi2 __absvsi2 __absvti2 __addvdi3 __addvsi3 __addvti3 __aeabi_idiv __aeabi_idiv0 __aeabi_idivmod __aeabi_lasr \
    __aeabi_lcmp __aeabi_ldiv0 __aeabi_llsl __aeabi_llsr __aeabi_lmul __aeabi_memclr __aeabi_memclr4 __aeabi_memclr8 \
    __aeabi_memcpy __aeabi_memcpy4 __aeabi_memcpy8 __aeabi_memmove __aeabi_memmove4 __aeabi_memmove8 __aeabi_memset \
    __aeabi_memset4 __aeabi_memset8 __aeabi_uidiv __aeabi_uidivmod __aeabi_ulcmp __ashldi3 __ashlsi3 __ashlti3 __ashrdi3 \
    __ashrsi3 __ashrti3 __bswapdi2 __bswapsi2 __bswapti2 __clzdi2 __clzsi2 __clzti2 __cmpdi2 __cmpti2 \
    __compilerrt_abort_impl __ctzdi2 __ctzsi2 __ctzti2 __divmodsi4 __divsi3 __ffsdi2 __ffsti2 __lshrdi3 __lshrsi3 __lshrti3 \
    __modsi3 __muldi3 __mulodi4 __mulosi4 __muloti4 __mulsi3 __multi3 __mulvdi3 __mulvsi3 __mulvti3 __negdi2 __negti2 \
    __negvdi2 __negvsi2 __negvti2 __paritydi2 __paritysi2 __parityti2 __popcountdi2 __popcountsi2 __popcountti2 \
    __rust_i128_add __rust_i128_addo __rust_i128_mulo __rust_i128_sub __rust_i128_subo __rust_u128_add __rust_u128_addo \
    __rust_u128_mulo __rust_u128_sub __rust_u128_subo __subvdi3 __subvsi3 __subvti3 __ucmpdi2 __ucmpti2 __udivmodsi4 \
    __udivsi3 __umodsi3 bcmp memcmp memcpy memmove memset strlen";

/// The functions that the compiler's own library for a target offers to all that it compiles.
fn offered(board: &Board) -> BTreeSet<String> {
    let asked = ["--print", "target-libdir", "--target", board.target];
    let answer = Command::new("rustc").args(asked).stdin(Stdio::null()).output().unwrap();
    let folder = PathBuf::from(String::from_utf8(answer.stdout).unwrap().trim());
    let is_library = |path: &PathBuf| {
        let name = path.file_name().unwrap().to_str().unwrap();
        name.starts_with("libcompiler_builtins-") && name.ends_with(".rlib")
    };
    let path = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).find(is_library).unwrap();
    let bytes = fs::read(path).unwrap();
    let mut names = BTreeSet::new();
    for member in ArchiveFile::parse(&*bytes).unwrap().members() {
        // The metadata is no object.
        let Ok(file) = object::File::parse(member.unwrap().data(&*bytes).unwrap()) else { continue };
        let symbols = file.symbols().filter(|symbol| symbol.is_global() && symbol.kind() == SymbolKind::Text);
        names.extend(symbols.map(|symbol| symbol.name().unwrap().to_owned()).filter(|name| !name.starts_with("_R")));
    }
    names
}

#[test]
fn the_compilers_routines_are_all_known() {
    let integers: BTreeSet<&str> = INTEGERS.split_whitespace().collect();
    for board in boards() {
        let names = offered(board);
        assert!(names.contains("__addsf3") && names.contains("__divdi3"), "{}: {names:?}", board.name);
        for name in names {
            let innocent = integers.contains(name.as_str());
            let expected = matches!(category(&name), Some(Category::SoftFloat | Category::WideDivision));
            assert!(innocent != expected, "{}: {name} is {:?}", board.name, category(&name));
        }
    }
}
