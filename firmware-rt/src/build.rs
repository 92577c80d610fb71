//! For build scripts: a linker script from a board, and a profile from a blob's header.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use core_rt::blob::{Header, PREFIX_SIZE, Prefix};
use core_rt::exact::{Exact14, Exact20, Exact29};
use core_rt::hanika::{HanikaC, HanikaCd, HanikaCons};
use core_rt::kernel::Kernel;
use core_rt::profile::{Need, Prefer};
use float_rt::{Float32, Float64};
use zerocopy::FromBytes;

use crate::board::Board;

/// The blob that firmware is built for where no other is asked for; it is part of the program then.
pub const DEFAULT_BLOB: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/default.blob");

/// The variable that names the blob that firmware is built for.
pub const BLOB_VARIABLE: &str = "INTRAY_BLOB";

/// The variable that gives a probe other needs than its blob's, in hexadecimal digits.
pub const NEEDS_VARIABLE: &str = "INTRAY_NEEDS";

/// The variable that says what is drawn: nothing for the picture, `single` or `tile` for the nearest hits,
/// `by-hand` for the picture by a loop for the smallest profile alone.
pub const HITS_VARIABLE: &str = "INTRAY_HITS";

/// The variable that, set to 1, makes firmware count its work.
pub const COUNT_VARIABLE: &str = "INTRAY_COUNT";

/// The variable that, set to 1, makes firmware mark the kinds of ray.
pub const MARKS_VARIABLE: &str = "INTRAY_MARKS";

/// What is compiled in for a blob.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Traits {
    /// [`Kernel::ID`].
    pub kernel: u16,
    /// The bits of the header's needs.
    pub needs: u64,
    /// Levels of a tree, a multiple of 16, so that scenes share firmware.
    pub depth: usize,
    /// Rays of a pixel that may wait: none, or a multiple of 4.
    pub branches: usize,
}

impl Traits {
    /// Of a blob; `None` where it is none. Nothing is checked that is not needed here: the firmware does that.
    #[must_use]
    pub fn of(blob: &[u8]) -> Option<Self> {
        let kernel = Prefix::read(blob).ok()?.kernel;
        let (prefix, _) = Prefix::read_from_prefix(blob).ok()?;
        let header = blob.get(PREFIX_SIZE..)?.get(..prefix.header_size as usize)?;
        let (header, _) = postcard::take_from_bytes::<Header>(header).ok()?;
        Some(Self::new(kernel, &header))
    }

    /// Of a blob's header.
    #[must_use]
    pub fn new(kernel: u16, header: &Header) -> Self {
        let depth = usize::from(header.depth).next_multiple_of(16).max(16);
        let branches = match header.needs.has(Need::Bounces) {
            true => (usize::from(header.max_depth) + 1).next_multiple_of(4),
            false => 0,
        };
        // Where ids stand depends on how many there are: firmware that has them apart takes smaller scenes too.
        let needs = header.needs.with(Need::IdsInRecords, header.needs.has(Need::Ids)).bits();
        Self { kernel, needs, depth, branches }
    }

    /// The kernel's type as a path in Rust; `None` where no firmware has it.
    #[must_use]
    pub fn kernel_path(&self) -> Option<&'static str> {
        const KERNELS: [(u16, &str); 8] = [
            (Exact14::ID, "core_rt::exact::Exact14"),
            (Exact20::ID, "core_rt::exact::Exact20"),
            (Exact29::ID, "core_rt::exact::Exact29"),
            (HanikaC::ID, "core_rt::hanika::HanikaC"),
            (HanikaCd::ID, "core_rt::hanika::HanikaCd"),
            (HanikaCons::ID, "core_rt::hanika::HanikaCons"),
            (Float32::ID, "float_rt::Float32"),
            (Float64::ID, "float_rt::Float64"),
        ];
        KERNELS.into_iter().find(|&(id, _)| id == self.kernel).map(|(_, path)| path)
    }
}

/// What the compiler was told to prefer.
#[must_use]
pub fn prefer() -> Prefer {
    match env::var("OPT_LEVEL").as_deref() {
        Ok("s" | "z") => Prefer::Size,
        _ => Prefer::Speed,
    }
}

/// What a build script does: nothing on the host; else `memory.x`, `firmware.rs` and the linker's arguments.
///
/// # Errors
/// Where the blob cannot be read, or no firmware can be built for it.
pub fn script(board: &Board, constant: &str) -> io::Result<()> {
    for variable in [BLOB_VARIABLE, HITS_VARIABLE, COUNT_VARIABLE, MARKS_VARIABLE] {
        println!("cargo::rerun-if-env-changed={variable}");
    }
    if env::var("CARGO_CFG_TARGET_OS").as_deref() != Ok("none") {
        return Ok(());
    }
    let asked = env::var_os(BLOB_VARIABLE).map(PathBuf::from);
    let path = asked.as_deref().unwrap_or(Path::new(DEFAULT_BLOB));
    println!("cargo::rerun-if-changed={}", path.display());
    let wrong = |what: &str| io::Error::other(format!("{}: {what}", path.display()));
    let blob = fs::read(path).map_err(|error| wrong(&error.to_string()))?;
    let traits = Traits::of(&blob).ok_or_else(|| wrong("not a blob"))?;
    let kernel = traits.kernel_path().ok_or_else(|| wrong("no firmware has this blob's kernel"))?;
    let draw = match env::var(HITS_VARIABLE).as_deref() {
        Ok("single") => "Draw::Hits(firmware_rt::hits::Way::Single)",
        Ok("tile") => "Draw::Hits(firmware_rt::hits::Way::Tile)",
        Ok("by-hand") => "Draw::ByHand",
        _ => "Draw::Picture",
    };
    let watched = [COUNT_VARIABLE, MARKS_VARIABLE].map(|variable| env::var(variable).as_deref() == Ok("1"));
    let embedded = asked.is_none().then_some((path, blob.len()));

    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or_else(|| wrong("no OUT_DIR"))?);
    let is_riscv = env::var("CARGO_CFG_TARGET_ARCH").as_deref() == Ok("riscv32");
    fs::write(out.join("memory.x"), memory(board, traits.kernel, is_riscv))?;
    fs::write(out.join("firmware.rs"), firmware(constant, kernel, &traits, draw, watched, embedded))?;
    println!("cargo::rustc-link-search={}", out.display());
    for argument in ["--nmagic", "-Tlink.x", "-Tdefmt.x"] {
        println!("cargo::rustc-link-arg-bins={argument}");
    }
    Ok(())
}

/// The linker script of a board, for cortex-m-rt and for riscv-rt.
fn memory(board: &Board, kernel: u16, is_riscv: bool) -> String {
    let mut text = String::from("MEMORY\n{\n");
    let regions =
        [("FLASH", board.code(kernel)), ("BLOB", board.blob(kernel)), ("STACK", board.stack), ("RAM", board.ram)];
    for (name, region) in board.boot.map(|boot| ("BOOT", boot)).into_iter().chain(regions) {
        let _ = writeln!(text, "  {name} : ORIGIN = {:#010x}, LENGTH = {:#x}", region.start, region.length);
    }
    text.push_str(
        "}\n_intray_blob = ORIGIN(BLOB);\n_stack_start = ORIGIN(STACK) + LENGTH(STACK);\n_stack_end = ORIGIN(STACK);\n",
    );
    if is_riscv {
        let aliases = [
            ("TEXT", "FLASH"),
            ("RODATA", "FLASH"),
            ("DATA", "RAM"),
            ("BSS", "RAM"),
            ("HEAP", "RAM"),
            ("STACK", "STACK"),
        ];
        for (alias, region) in aliases {
            let _ = writeln!(text, "REGION_ALIAS(\"REGION_{alias}\", {region});");
        }
    }
    // Nothing unwinds, and the tables would otherwise follow the blob into its region.
    text.push_str("SECTIONS { /DISCARD/ : { *(.eh_frame .eh_frame.*); } }\n");
    text.push_str("SECTIONS { .blob : { KEEP(*(.blob)); } > BLOB } INSERT AFTER .rodata;\n");
    if board.boot.is_some() {
        text.push_str("SECTIONS { .boot ORIGIN(BOOT) : { KEEP(*(.boot)); } > BOOT } INSERT BEFORE .text;\n");
    }
    text
}

/// The Rust of a firmware: its profile, its storage, and the blob if that is part of it.
fn firmware(
    board: &str,
    kernel: &str,
    traits: &Traits,
    draw: &str,
    [count, marks]: [bool; 2],
    embedded: Option<(&Path, usize)>,
) -> String {
    let Traits { needs, depth, branches, .. } = traits;
    let prefer = prefer();
    let blob = embedded.map_or_else(String::new, |(path, length)| {
        format!(
            "#[used]\n#[unsafe(link_section = \".blob\")]\nstatic BLOB: [u8; {length}] = *include_bytes!({:?});\n",
            path.display().to_string()
        )
    });
    format!(
        "use core_rt::profile::{{Needs, Prefer, Profile}};\n\
         use firmware_rt::board::{{self, Board}};\n\
         use firmware_rt::run::{{Draw, Firmware, Storage}};\n\
         \n\
         #[derive(Clone, Copy, Debug, Default)]\n\
         struct This;\n\
         \n\
         impl Profile for This {{\n    type Kernel = {kernel};\n    type Walk<'a> = core_rt::bvh::InPlace;\n    const NEEDS: Needs = Needs::from_bits({needs:#x});\n    \
         const PREFER: Prefer = Prefer::{prefer:?};\n}}\n\
         \n\
         impl Firmware for This {{\n    type Profile = Self;\n    const BOARD: &'static Board = &board::{board};\n    \
         const DRAW: Draw = {draw};\n    const COUNT: bool = {count};\n    const MARKS: bool = {marks};\n}}\n\
         \n\
         static mut STORAGE: Storage<{kernel}, {depth}, {branches}, {{ run::tile_bytes(Needs::from_bits({needs:#x}), {draw}) }}> = Storage::new();\n\
         {blob}"
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::board::{HIFIVE1, MICROBIT, PICO};

    #[test]
    fn traits_are_read_from_a_blob_and_from_nothing_else() {
        let blob = fs::read(DEFAULT_BLOB).unwrap();
        let traits = Traits::of(&blob).unwrap();
        assert_eq!((traits.kernel, traits.depth % 16), (Exact14::ID, 0));
        assert_eq!(traits.kernel_path(), Some("core_rt::exact::Exact14"));
        assert_eq!(Traits { kernel: 0xffff, ..traits }.kernel_path(), None);
        for length in [0, 8, PREFIX_SIZE, blob.len() - 8] {
            assert_eq!(Traits::of(&blob[..length]), None, "{length}");
        }
    }

    #[test]
    fn scripts_have_the_boards_memory() {
        let text = memory(&MICROBIT, 14, false);
        assert!(text.contains("STACK : ORIGIN = 0x20000000, LENGTH = 0x2000\n"), "{text}");
        assert!(!text.contains("REGION_ALIAS") && !text.contains("BOOT"), "{text}");
        let text = memory(&PICO, 14, false);
        assert!(text.contains("BOOT : ORIGIN = 0x10000000, LENGTH = 0x100\n") && text.contains("> BOOT }"), "{text}");
        assert!(text.contains("BLOB : ORIGIN = 0x10080000, LENGTH = 0x180000\n"), "{text}");
        let text = memory(&HIFIVE1, 29, true);
        assert!(text.contains("BLOB : ORIGIN = 0x20080000") && text.contains("(\"REGION_STACK\", STACK)"), "{text}");
    }
}
