//! What firmware says, word by word: its log, and what the host makes of its end, for good runs and for all that go wrong.
//!
//! It stands in `firmware-output`, a file a board and case; `INTRAY_BLESS=1` renews the files. Where a number depends on
//! where the compiler has put things, a word in angle brackets stands for it. Boards that cannot be emulated here are
//! skipped, with a line that says so.

use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

use firmware_rt::board::{BOARDS, Board};
use firmware_rt::status::Status;
use host_tools::builtin;
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware::Wanted;
use host_tools::emulate::{EmulateError, Run};
use host_tools::engine;
use host_tools::import::{Embedded, load_from};
use host_tools::prepare::Options;
use tests::boards::{boards, program};

const LIMIT: Duration = Duration::from_secs(120);

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("firmware-output")
}

/// The built-in scene, small.
fn blob(kernel: &str) -> Vec<u8> {
    let mut model = load_from(&Embedded(builtin::FILES), "scene.toml").expect("the built-in scene").model;
    model.render.size = [32, 24];
    let engine = engine::by_name(kernel).expect("a kernel of this name");
    engine.prepare(&model, &Options::default()).expect("it fits").blob.bytes().to_vec()
}

/// The text with what depends on the compiler's layout, and on time, replaced.
fn masked(line: &str) -> String {
    const PLACES: [(&str, &str, &str); 4] = [
        (" pixels, ", " bytes of stack", "<count>"),
        ("the stack pointer is ", ",", "<address>"),
        ("fault at ", "", "<address>"),
        (" was stopped after ", " without", "<time>"),
    ];
    for (before, after, name) in PLACES {
        let Some((head, rest)) = line.split_once(before) else { continue };
        let end = if after.is_empty() { rest.len() } else { rest.find(after).unwrap_or(rest.len()) };
        return format!("{head}{before}{name}{}", &rest[end..]);
    }
    line.into()
}

/// The log and the end of a run.
fn told(log: &[String], end: &str) -> String {
    log.iter().map(|line| format!("log   {}\n", masked(line))).collect::<String>() + &format!("host  {}\n", masked(end))
}

/// A run that has no picture.
fn ended(board: &Board, elf: &Elf, blob: &[u8], limit: Duration) -> (String, EmulateError) {
    let mut log = Vec::new();
    let error =
        Run { board, elf, blob: Some(blob), counter: None, limit }.perform(&mut log).expect_err("it goes wrong");
    (told(&log, &error.to_string()), error)
}

/// A run that ends well, and its work.
fn good(board: &'static Board) -> String {
    let kernel = "exact14";
    let blob = blob(kernel);
    let wanted = Wanted { board, blob: &blob, hits: None, count: false };
    let run = |elf: &Elf| {
        let mut log = Vec::new();
        let outcome = Run { board, elf, blob: Some(&blob), counter: None, limit: LIMIT }.perform(&mut log);
        (log, outcome.expect("it goes well"))
    };
    let (log, outcome) = run(&wanted.provide().expect("it can be built"));
    // Other firmware counts.
    let work = run(&Wanted { count: true, ..wanted }.provide().expect("it can be built")).1.report;
    let picture = &outcome.picture;
    let mut text = told(&log, &Status::Done.to_string());
    let written = write!(
        text,
        "board {}\nkernel {kernel}\nsize {}x{}\nimage_crc32 {:08x}\nprimary_rays {}\nshadow_rays {}\nbox_tests {}\n\
         triangle_tests {}\n",
        board.name,
        picture.width(),
        picture.height(),
        picture.crc32(),
        work.primary_rays,
        work.shadow_rays,
        work.box_tests,
        work.triangle_tests,
    );
    written.expect("a string takes text");
    text
}

/// What the firmware of a board says in every case, and with it the name of the case.
fn cases(board: &'static Board) -> Vec<(&'static str, String)> {
    let whole = blob("exact14");
    let elf = Wanted { board, blob: &whole, hits: None, count: false }.provide().expect("it can be built");
    let refused = |blob: &[u8]| {
        let (text, error) = ended(board, &elf, blob, LIMIT);
        assert!(matches!(error, EmulateError::Firmware { status: Status::Refused, .. }), "{error}");
        text
    };
    let mut damaged = whole.clone();
    damaged[whole.len() / 2] ^= 1;

    let elf = program(board, "misbehave");
    let misbehaved = |asked: u32, status: Status| {
        let (text, error) = ended(board, &elf, &asked.to_le_bytes(), LIMIT);
        assert!(matches!(error, EmulateError::Firmware { status: found, .. } if found == status), "{error}");
        text
    };
    let (timeout, error) = ended(board, &elf, &2u32.to_le_bytes(), Duration::from_secs(2));
    assert!(matches!(error, EmulateError::Timeout { .. }), "{error}");
    let (silent, error) = ended(board, &elf, &0u32.to_le_bytes(), LIMIT);
    assert!(matches!(error, EmulateError::Damaged(_)), "{error}");
    vec![
        ("good", good(board)),
        ("damaged-blob", refused(&damaged)),
        ("no-blob", refused(&[0; 64])),
        ("other-kernel", refused(&blob("exact29"))),
        ("stack-overflow", misbehaved(1, Status::StackOverflow)),
        ("panic", misbehaved(3, Status::Panicked)),
        ("fault", misbehaved(4, Status::Fault)),
        ("timeout", timeout),
        ("no-picture", silent),
    ]
}

#[test]
fn firmware_says_what_was_written_down() {
    let (folder, bless) = (folder(), std::env::var_os("INTRAY_BLESS").is_some());
    let path = |board: &Board, case: &str| folder.join(format!("{}-{case}.txt", board.name));
    let found: Vec<_> =
        boards().flat_map(|board| cases(board).into_iter().map(move |(case, text)| (board, case, text))).collect();
    if bless {
        for (board, case, text) in &found {
            std::fs::write(path(board, case), text).expect("it can be written");
        }
    }
    let mut wrong = String::new();
    for (board, case, text) in &found {
        let expected = std::fs::read_to_string(path(board, case)).unwrap_or_default();
        if *text != expected {
            write!(wrong, "{} {case}, expected:\n{expected}found:\n{text}", board.name).expect("a string takes text");
        }
    }
    assert!(wrong.is_empty(), "INTRAY_BLESS=1 renews tests/firmware-output\n{wrong}");

    // Nothing that was written down is of no case.
    for entry in std::fs::read_dir(&folder).expect("the folder") {
        let file = entry.expect("an entry").path();
        let of_a_case =
            |board: &Board| found.iter().any(|(of, case, _)| of.name == board.name && path(of, case) == file);
        let name = file.file_name().and_then(|name| name.to_str()).expect("a name");
        let board = BOARDS.into_iter().find(|board| name.starts_with(board.name));
        let is_skipped = board.is_some_and(|board| found.iter().all(|(of, ..)| of.name != board.name));
        assert!(is_skipped || board.is_some_and(of_a_case), "{name} is of no case");
    }
}

#[test]
fn only_what_the_layout_decides_is_masked() {
    assert_eq!(masked("info  32x24 pixels, 1808 bytes of stack"), "info  32x24 pixels, <count> bytes of stack");
    assert_eq!(
        masked("error stack overflow: the stack pointer is 0x1fffffa8, and the stack has 0x20000000 to 0x20002000"),
        "error stack overflow: the stack pointer is <address>, and the stack has 0x20000000 to 0x20002000"
    );
    assert_eq!(masked("error fault at 0x000012a4"), "error fault at <address>");
    assert_eq!(masked("qemu was stopped after 2 s without an end"), "qemu was stopped after <time> without an end");
    assert_eq!(masked("error panic at a.rs:3"), "error panic at a.rs:3");
}
