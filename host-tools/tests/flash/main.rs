//! `intray flash`, over the real command: what is asked of probe-rs, and what becomes of what it hands over.
//!
//! There is no probe here: `probe-rs.sh` stands for the program, with frames of real pictures. That firmware sends such
//! frames, `tests/rtt` shows by QEMU. Where the compiler's library for a board is absent, what builds firmware is skipped, with
//! a line that says so.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use firmware_rt::board::{Board, MICROBIT, PICO};
use firmware_rt::digits;
use firmware_rt::frame::{self, Begin, Report, TileHead};
use host_tools::builtin;
use host_tools::emulate::firmware;
use host_tools::engine;
use host_tools::import::{Embedded, load_from};
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use tempfile::TempDir;
use zerocopy::IntoBytes;

const SIZE: [u32; 2] = [32, 24];

const OBJ: &[u8] = b"v 0 0 0\nv 2 0 0\nv 0 2 2\nf 1 2 3\n";

/// The built-in scene, small, as a blob and by the host.
fn scene() -> (Vec<u8>, Picture) {
    let mut model = load_from(&Embedded(builtin::FILES), "scene.toml").unwrap().model;
    model.render.size = SIZE;
    let engine = engine::by_name("exact14").unwrap();
    let blob = engine.prepare(&model, &Options::default()).unwrap().blob.bytes().to_vec();
    let picture = engine.render(&blob, [8, 8], &|_| ()).unwrap().picture;
    (blob, picture)
}

/// What a chip sends of a picture, in one tile a row.
fn sent(picture: &Picture) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut send = |kind, parts: &[&[u8]]| {
        frame::write(kind, parts, |part| {
            bytes.extend(part.iter().flat_map(|&byte| digits::of(byte)));
            Ok::<(), ()>(())
        })
        .unwrap();
    };
    let [width, height] = SIZE.map(|side| side as u16);
    send(Begin::KIND, &[Begin { width, height, format: 0 }.as_bytes()]);
    for (y, row) in (0..height).zip(picture.pixels().chunks_exact(width.into())) {
        let head = TileHead { x: 0, y, width, height: 1 };
        send(TileHead::KIND, &[head.as_bytes(), row.as_flattened()]);
    }
    send(Report::KIND, &[Report { stack_bytes: 1234, ..Report::default() }.as_bytes()]);
    bytes
}

/// A folder to run in, with a blob and with a program called probe-rs.
struct Bench {
    folder: TempDir,
}

impl Bench {
    fn new(blob: &[u8], picture: &[u8], log: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let bench = Self { folder };
        bench.write("scene.blob", blob);
        bench.write("triangle.obj", OBJ);
        fs::create_dir(bench.path("fake")).unwrap();
        bench.write("fake/picture", picture);
        bench.write("fake/log", log.as_bytes());
        bench.write("fake/probe-rs", include_bytes!("probe-rs.sh"));
        fs::set_permissions(bench.path("fake/probe-rs"), fs::Permissions::from_mode(0o755)).unwrap();
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        fs::write(self.path(name), bytes).unwrap();
    }

    fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap_or_default()
    }

    /// Runs `intray` with the words of `line`; the status, and what it prints on both ways.
    fn run(&self, line: &str) -> (Option<i32>, String, String) {
        let path = std::env::var_os("PATH").unwrap();
        let path = std::env::join_paths([self.path("fake")].into_iter().chain(std::env::split_paths(&path))).unwrap();
        self.run_in(line, &path)
    }

    fn run_in(&self, line: &str, path: &std::ffi::OsStr) -> (Option<i32>, String, String) {
        let mut command = Command::new(env!("CARGO_BIN_EXE_intray"));
        command.args(line.split_whitespace()).current_dir(self.folder.path());
        command.env("PATH", path).env("FAKE", self.path("fake"));
        let Output { status, stdout, stderr } = command.output().unwrap();
        let [stdout, stderr] = [stdout, stderr].map(|bytes| String::from_utf8(bytes).unwrap());
        (status.code(), stdout, stderr)
    }
}

fn is_there(board: &Board) -> bool {
    let checked = firmware::check_board(board);
    if let Err(error) = &checked {
        println!("skipped {}: {error}", board.name);
    }
    checked.is_ok()
}

const LOG: &str = "INFO 32x24 pixels, 1234 bytes of stack\nINFO the end, status 0\n";

const FLASH: &str = "flash scene.blob --board microbit -o out.png";

#[test]
fn the_picture_comes_through_and_the_right_things_are_asked_for() {
    let (blob, picture) = scene();
    if !is_there(&MICROBIT) {
        return;
    }
    let bench = Bench::new(&blob, &sent(&picture), LOG);
    let (status, stdout, stderr) = bench.run(&format!("{FLASH} --json --probe 2e8a:000c"));
    assert_eq!((status, stderr.as_str()), (Some(0), LOG), "{stdout}");
    let json: serde_json::Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!(json["image_crc32"], format!("{:08x}", picture.crc32()));
    assert_eq!((&json["width"], &json["stack_bytes"]), (&32.into(), &1234.into()));
    assert_eq!(Picture::read_png(&bench.path("out.png")).unwrap(), picture);

    assert_eq!(fs::read(bench.path("fake/downloaded")).unwrap(), blob);
    assert_eq!(bench.text("fake/download"), "nRF51822_xxAA bin 0x14000\n");
    let elf = Path::new(json["elf"].as_str().unwrap());
    assert_eq!(fs::read(bench.path("fake/ran")).unwrap(), fs::read(elf).unwrap());
    let asked = bench.text("fake/asked");
    let verbs: Vec<_> = asked.lines().map(|line| line.split(' ').next().unwrap()).collect();
    assert_eq!(verbs, ["list", "download", "run"]);
    assert_eq!(asked.matches("--probe 2e8a:000c").count(), 2, "{asked}");
    // Without these, faults end before the firmware can say what they are, and times stand among the digits.
    assert_eq!(asked.matches("--no-catch-hardfault --no-timestamps").count(), 1, "{asked}");

    // Nobody needs to keep the picture; and what the program says after a good end is of no consequence.
    bench.write("fake/failure", b"Error: the probe went away\n");
    let (status, stdout, _) = bench.run("flash scene.blob --board microbit");
    assert_eq!(status, Some(0));
    assert!(stdout.starts_with("32x24 by exact14 on microbit (nRF51822, Cortex-M0), CRC-32 "), "{stdout}");
}

#[test]
fn what_goes_wrong_on_the_way_is_told_and_leaves_no_picture() {
    let (blob, picture) = scene();
    if !is_there(&MICROBIT) {
        return;
    }
    let whole = sent(&picture);
    let failed = |picture: &[u8], log: &str, file: Option<(&str, &str)>, expected_status: i32, expected: &str| {
        let bench = Bench::new(&blob, picture, log);
        if let Some((name, text)) = file {
            bench.write(name, text.as_bytes());
        }
        let (status, stdout, stderr) = bench.run(FLASH);
        assert_eq!((status, stdout.as_str()), (Some(expected_status), ""), "{stderr}");
        assert!(stderr.contains(expected), "{stderr}");
        assert!(!bench.path("out.png").exists());
    };
    let mut flipped = whole.clone();
    flipped[1001] ^= 1;
    failed(&flipped, LOG, None, 1, "what came from the chip is damaged: the checksum of a frame is wrong");
    failed(&whole[..1001], LOG, None, 1, "the picture is not whole");
    failed("iF\u{fffd}".as_bytes(), LOG, None, 1, "no hexadecimal digit");
    failed(
        &[],
        "ERROR the blob was refused: damaged\nINFO the end, status 10\n",
        None,
        1,
        "on microbit, the blob was refused",
    );
    failed(&[], "INFO the end, status 77\n", None, 1, "a status that there is not");
    // After a fault the chip stands still, and the program would wait for ever.
    let hangs = Some(("fake/hangs", ""));
    failed(&[], "ERROR fault at 0x00000100\nINFO the end, status 14\n", hangs, 1, "on microbit, the core took a fault");
    let reset = Some(("fake/failure", "Error: the probe went away\n"));
    failed(
        &whole,
        "INFO 32x24 pixels\n",
        reset,
        1,
        "probe-rs run ended with exit status: 1: Error: the probe went away",
    );
    failed(&whole, "", Some(("fake/unplugged", "")), 2, "probe-rs finds no debug probe");
    failed(
        &whole,
        "",
        Some(("fake/protected", "")),
        1,
        "probe-rs download ended with exit status: 1: Error: The flash",
    );
}

#[test]
fn without_a_probe_or_the_program_there_is_advice_before_anything_is_built() {
    if ![&MICROBIT, &PICO].into_iter().all(is_there) {
        return;
    }
    let bench = Bench::new(&scene().0, &[], "");
    bench.write("fake/no-probe", b"");
    let no_probe =
        "error: probe-rs finds no debug probe; plug one in that is wired to the board (`probe-rs list` shows them)";
    let uf2 = "; without one, `--uf2 FILE` writes what can be dragged to the board's own drive";
    let refused = |expected: String, found: (Option<i32>, String, String)| {
        assert_eq!(found, (Some(2), String::new(), expected));
        assert!(!bench.path("out.png").exists());
    };
    refused(format!("{no_probe}\n"), bench.run(FLASH));
    refused(format!("{no_probe}{uf2}\n"), bench.run("flash scene.blob --board pico -o out.png"));

    // The compiler is asked for its library first, and it alone is there.
    let rustc = Command::new("rustc").args(["--print", "sysroot"]).output().unwrap().stdout;
    let path = Path::new(String::from_utf8(rustc).unwrap().trim()).join("bin");
    let no_program = "error: probe-rs is not installed, which takes firmware to a board: `cargo install probe-rs-tools \
                      --locked`, or see https://probe.rs";
    refused(format!("{no_program}\n"), bench.run_in(FLASH, path.as_os_str()));
    let pico = bench.run_in("flash scene.blob --board pico", path.as_os_str());
    refused(format!("{no_program}{uf2}\n"), pico);
}

#[test]
fn bad_input_is_refused_without_a_word_to_the_program() {
    let bench = Bench::new(&scene().0, &[], "");
    let refused = |line: &str, expected: &str| {
        let (status, stdout, stderr) = bench.run(line);
        assert_eq!((status, stdout.as_str()), (Some(2), ""), "{line}: {stderr}");
        assert!(stderr.contains(expected), "{line}: {stderr}");
    };
    refused("flash none.obj --board pico", "error: none.obj: no such file");
    refused(
        "flash scene.blob --board piko",
        "invalid value 'piko' for '--board <BOARD>'\n  [possible values: microbit, hifive1, pico]",
    );
    refused("flash scene.blob --board pico -o none/out.png", "none/out.png: cannot be written");
    refused("flash scene.blob --board pico --uf2 none/out.uf2", "none/out.uf2: cannot be written");
    refused(
        "flash scene.blob --board microbit --uf2 out.uf2",
        "error: microbit has no drive that takes a UF2 file; pico has one",
    );
    refused("flash scene.blob --board pico --uf2 out.uf2 -o out.png", "cannot be used with");
    refused("flash scene.blob --board pico --timeout 0", "invalid value '0' for '--timeout <SECONDS>'");
    let pico = "error: pico (RP2040, Cortex-M0+) cannot be emulated: QEMU has no such machine; microbit and hifive1 can, and \
                `intray flash` takes a scene to a real pico";
    refused("emulate scene.blob --board pico -o out.png", pico);
    refused("run-elf scene.blob --board pico -o out.png", pico);
    if is_there(&MICROBIT) {
        // A mesh of 10,000 triangles, too many for 176 KiB.
        let vertices = (0..30_000).map(|i| format!("v {} {} {}\n", i % 173, i % 211, i % 97));
        let faces = (0..10_000).map(|i| format!("f {} {} {}\n", 3 * i + 1, 3 * i + 2, 3 * i + 3));
        bench.write("large.obj", vertices.chain(faces).collect::<String>().as_bytes());
        refused("flash large.obj --board microbit", " for it in its flash: ");
    }
    assert_eq!(bench.text("fake/asked"), "");
    let files: Vec<_> = ["out.png", "out.uf2"].into_iter().filter(|name| bench.path(name).exists()).collect();
    assert_eq!(files, [""; 0]);
}
