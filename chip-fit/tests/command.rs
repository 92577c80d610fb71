//! `intray-fit`, over the real command: what a user reads, the exit status, and the object that other programs read.
//!
//! What builds firmware is skipped where the compiler's libraries or the emulators are absent, with a line that says so.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use chip_fit::core::Isa;
use host_tools::emulate;
use serde_json::Value;
use tempfile::TempDir;

const TRIANGLE: &str = "v 0 0 0\nv 2 0 0\nv 0 2 2\nf 1 2 3\n";

/// A folder with `scene.toml`, one triangle on a small picture.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.obj"), TRIANGLE).unwrap();
    fs::write(folder.path().join("scene.toml"), "model = 'scene.obj'\n[render]\nsize = [24, 18]\n").unwrap();
    folder
}

fn command(folder: &TempDir, line: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_intray-fit"));
    command.current_dir(folder.path()).env("RUST_BACKTRACE", "1").args(line.split(' '));
    command
}

/// Standard output, standard error and the status.
fn said(mut command: Command) -> (String, String, Option<i32>) {
    let Output { status, stdout, stderr } = command.output().unwrap();
    (String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap(), status.code())
}

/// Runs a command that must be refused with this.
#[track_caller]
fn refused(folder: &TempDir, line: &str, message: &str) {
    assert_eq!(said(command(folder, line)), (String::new(), format!("error: {message}\n"), Some(2)), "{line}");
}

/// Whether everything that a measurement takes is here.
fn can_measure() -> bool {
    Isa::ALL.iter().all(|isa| match emulate::check(isa.boards()[0]) {
        Ok(()) => true,
        Err(error) => {
            println!("skipped: {error}");
            false
        }
    })
}

/// A square of so many cells a side, as an OBJ.
fn square(side: usize) -> String {
    let mut text = String::new();
    for i in 0..=side {
        for j in 0..=side {
            text += &format!("v {i} {j} {}\n", (i * j) % 3);
        }
    }
    for i in 0..side {
        for j in 1..=side {
            let (a, b) = (i * (side + 1) + j, (i + 1) * (side + 1) + j);
            text += &format!("f {a} {b} {}\nf {} {b} {}\n", a + 1, a + 1, b + 1);
        }
    }
    text
}

#[test]
fn chips_that_there_are_not_and_chips_of_no_use() {
    let folder = folder();
    for (chip, message) in [
        ("RP2400", "no chip is called RP2400; the nearest are RP2040, RP235x, OL23D0, W7500, CC2340R5"),
        (
            "CH32V003F4P6",
            "CH32V003F4P6: there is no firmware for its core (rv32ec); there is some for thumbv6m and rv32imac",
        ),
        ("riscv64", "riscv64: there is no firmware for its core (riscv64); there is some for thumbv6m and rv32imac"),
        ("cortex-m0", "Cortex-M0: its flash and RAM are not known; name the chip exactly"),
    ] {
        refused(&folder, &format!("scene.toml --chip {chip}"), message);
        refused(&folder, &format!("scene.toml --json --chip {chip}"), message);
    }
}

#[test]
fn scenes_that_cannot_be_read() {
    let folder = folder();
    fs::write(folder.path().join("text.blob"), "not a blob").unwrap();
    refused(&folder, "none.obj --chip RP2040", "none.obj: no such file");
    refused(
        &folder,
        "text.blob",
        "text.blob: not a scene; that is a .toml or .obj file by its name, or a blob that `intray prep` made",
    );
    let (_, stderr, status) = said(command(&folder, "scene.toml --kernel exact41"));
    assert!(stderr.contains("tip: a similar value exists: 'exact14'") && status == Some(2), "{stderr}");
    let (_, stderr, status) = said(command(&folder, "scene.toml --timeout 0"));
    assert!(stderr.starts_with("error: invalid value '0' for '--timeout <SECONDS>'") && status == Some(2), "{stderr}");
}

#[test]
fn a_blob_that_is_larger_than_the_flash_is_refused_before_anything_is_built() {
    let folder = folder();
    fs::write(folder.path().join("square.obj"), square(24)).unwrap();
    // Nothing is there to build with.
    let mut command = command(&folder, "square.obj --chip STM32F030F4");
    command.env("PATH", folder.path());
    let (stdout, stderr, status) = said(command);
    assert_eq!((stdout.as_str(), status), ("", Some(2)));
    let begin = "error: square.obj: the blob has ";
    let rest = stderr.strip_prefix(begin).unwrap_or_else(|| panic!("{stderr}"));
    let bytes: u64 = rest.split(' ').next().unwrap().parse().unwrap();
    let expected = format!(
        "{begin}{bytes} bytes, and STM32F030F4 has 16384 of flash: {} too many, without its code. What would help: fewer \
         triangles (`intray prep --triangles {}` instead of 1152); triangles that share vertices, for time (`--prefer size`)\n",
        bytes - 16384,
        1152 * 16384 / bytes * 49 / 50
    );
    assert_eq!(stderr, expected);
}

/// A `rustc` that knows no chip.
#[test]
#[cfg(unix)]
fn a_missing_target_is_said_with_the_command_that_installs_it() {
    use std::os::unix::fs::PermissionsExt;

    let folder = folder();
    let path = folder.path().join("rustc");
    fs::write(&path, "#!/bin/sh\necho /no/such/folder\n").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
    for (line, target) in [
        ("scene.toml", "thumbv6m-none-eabi"),
        ("scene.toml --chip RP2040", "thumbv6m-none-eabi"),
        ("scene.toml --chip fe310-g002", "riscv32imac-unknown-none-elf"),
    ] {
        let mut command = command(&folder, line);
        command.env("PATH", folder.path());
        let message = format!(
            "error: scene.toml: the compiler has no library for {target}: `rustup target add {target}`, or `cargo xtask setup`\n"
        );
        assert_eq!(said(command), (String::new(), message, Some(2)), "{line}");
    }
}

#[test]
fn one_chip_is_told_in_full() {
    if !can_measure() {
        return;
    }
    let folder = folder();
    let run = |line: &str| said(command(&folder, line));
    let (stdout, stderr, status) = run("scene.toml --chip nrf51822_xxaa --json");
    assert_eq!((stderr.as_str(), status), ("", Some(0)));
    let found: Value = serde_json::from_str(&stdout).unwrap();
    let need = &found["needs"][0];
    let [text, scene, flash, variables, stack, ram] =
        ["text_bytes", "scene_bytes", "flash_bytes", "static_bytes", "stack_bytes", "ram_bytes"]
            .map(|name| need[name].as_u64().unwrap());
    assert_eq!((need["board"].as_str(), need["stack_is_measured"].as_bool()), (Some("microbit"), Some(true)));
    assert_eq!((flash, ram), (text.div_ceil(8) * 8 + scene, variables + stack));
    assert!((10_000..81_920).contains(&text) && (300..8192).contains(&stack), "{need}");
    let chip = &found["chips"][0];
    assert_eq!([&chip["name"], &chip["core"], &chip["kind"]], ["nRF51822_xxAA", "Cortex-M0", "integer"]);
    assert_eq!(chip["flash_margin"].as_i64(), Some(262_144 - flash as i64));
    assert_eq!(chip["ram_margin"].as_i64(), Some(16_384 - ram as i64));
    assert_eq!((chip["fits"].as_bool(), &chip["help"]), (Some(true), &Value::Null));
    // The data sheet's clock, and between one and three cycles an instruction.
    let instructions = need["instructions"].as_f64().unwrap();
    let cycles_each = chip["seconds"].as_f64().unwrap() * 16e6 / instructions;
    assert!((1.0..3.0).contains(&cycles_each), "{cycles_each}");

    let (stdout, stderr, status) = run("scene.toml --chip nrf51822_xxaa");
    assert_eq!((stderr.as_str(), status), ("", Some(0)));
    let first = "scene.toml at 24x18 by exact14 fits nRF51822_xxAA (nRF51, Cortex-M0)\n";
    assert!(stdout.starts_with(first) && stdout.contains(&format!("{flash} of    262144 bytes")), "{stdout}");
}

#[test]
fn what_does_not_fit_is_a_failed_check_and_what_would_help_is_said() {
    if !can_measure() {
        return;
    }
    let folder = folder();
    let (stdout, stderr, status) = said(command(&folder, "scene.toml --chip STM32F030F4"));
    assert_eq!(status, Some(1), "{stderr}");
    assert!(
        stdout.starts_with("scene.toml at 24x18 by exact14 does not fit STM32F030F4 (STM32F0, Cortex-M0)\n"),
        "{stdout}"
    );
    assert!(
        stdout.contains(" too many: ")
            && stdout.contains("\nwhat would help: nothing, as the code alone is larger than the flash\n"),
        "{stdout}"
    );
    assert!(
        stderr.starts_with("error: STM32F030F4 has ") && stderr.ends_with(" bytes of flash too few for it\n"),
        "{stderr}"
    );
    let (stdout, _, status) = said(command(&folder, "scene.toml --chip STM32F030F4 --json"));
    let found: Value = serde_json::from_str(&stdout).unwrap();
    assert_eq!((status, found["chips"][0]["fits"].as_bool()), (Some(1), Some(false)));
    assert!(found["chips"][0]["help"].as_str().is_some_and(|help| help.starts_with("nothing, ")), "{found}");
}

/// Whoever does what is said gets what was missed.
#[test]
fn what_is_said_to_help_does() {
    if !can_measure() {
        return;
    }
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes");
    let folder = folder();
    let run = |scene: &str, chip: &str, rest: &str| {
        let scene = scenes.join(scene).join("scene.toml");
        let mut command = command(&folder, "--json");
        command.arg(scene).args(["--chip", chip, "--size", "32x24"]).args(rest.split_whitespace());
        let (stdout, stderr, status) = said(command);
        let found: Value = serde_json::from_str(&stdout).unwrap_or_else(|_| panic!("{stderr}"));
        (found["chips"][0]["help"].as_str().unwrap_or_default().to_owned(), status)
    };
    let (help, status) = run("bench-1k", "STM32F030C8", "");
    let fewer = help.strip_prefix("fewer triangles (`intray prep --triangles ").and_then(|rest| rest.split('`').next());
    assert_eq!(status, Some(1), "{help}");
    let fewer = format!("--triangles {}", fewer.unwrap_or_else(|| panic!("{help}")));
    assert_eq!(run("bench-1k", "STM32F030C8", &fewer), (String::new(), Some(0)), "{fewer}");

    let (help, status) = run("gallery/spheres", "MSPM0L1306", "");
    assert_eq!((help.as_str(), status), ("less RAM by `--depth 0` or `--format gray8`", Some(1)));
    assert_eq!(run("gallery/spheres", "MSPM0L1306", "--depth 0 --format gray8"), (String::new(), Some(0)));
}

#[test]
fn chips_with_an_fpu_or_perhaps_one_are_taken_with_a_remark() {
    if !can_measure() {
        return;
    }
    let folder = folder();
    for (chip, remark) in [
        ("nRF52832_xxAA", "it has an FPU: this works, and leaves it idle"),
        (
            "STM32H743ZI",
            "whether its core (armv7em) has an FPU is not in the table; the firmware does without, and is the same",
        ),
        ("fe310-g002", "its flash is a chip of its own: the database has the addresses for it, the board its size"),
    ] {
        let (stdout, stderr, status) = said(command(&folder, &format!("scene.toml --chip {chip}")));
        assert_eq!((stderr.as_str(), status), ("", Some(0)), "{chip}");
        assert!(stdout.lines().any(|line| line == remark), "{stdout}");
    }
}

#[test]
fn all_chips_are_told() {
    if !can_measure() {
        return;
    }
    let folder = folder();
    let (stdout, stderr, status) = said(command(&folder, "scene.toml --json"));
    assert_eq!((stderr.as_str(), status, stdout.lines().count()), ("", Some(0), 1));
    let found: Value = serde_json::from_str(&stdout).unwrap();
    let chips = found["chips"].as_array().unwrap();
    assert_eq!(chips.len(), chip_fit::database::chips().len());
    let integer = chips.iter().filter(|chip| chip["kind"] == "integer");
    let count = |name: &str| found[name].as_u64().unwrap();
    assert_eq!(integer.clone().count() as u64, count("fits") + count("misses"));
    assert_eq!(integer.filter(|chip| chip["fits"] == true).count() as u64, count("fits"));
    assert_eq!(chips.iter().filter(|chip| chip["kind"] == "unknown").count() as u64, count("unknown"));
    assert!(count("fits") > 100 && count("misses") > 100);
    for isa in ["thumbv6m", "rv32imac"] {
        assert!(found["needs"].as_array().unwrap().iter().any(|need| need["isa"] == isa), "{isa}");
    }

    let (stdout, _, _) = said(command(&folder, "scene.toml"));
    let line =
        format!("fits {} of {} chips that are known to have no FPU", count("fits"), count("fits") + count("misses"));
    assert!(stdout.lines().any(|found| found == line), "{stdout}");
    for family in ["RP2040 ", "nRF51 ", "fe310 ", "STM32F0 "] {
        assert!(stdout.lines().any(|line| line.starts_with(family)), "{family}: {stdout}");
    }
    assert!(stdout.contains(&format!("{} are unknown", count("unknown"))), "{stdout}");
}

/// A blob for which the micro:bit has no room is run on one that has more, and instructions are those of any other.
#[test]
fn what_is_too_large_for_the_emulated_board_is_measured_all_the_same() {
    if !can_measure() {
        return;
    }
    let folder = folder();
    fs::write(folder.path().join("square.obj"), square(70)).unwrap();
    let (stdout, stderr, status) = said(command(&folder, "square.obj --size 16x16 --chip RP2040 --json"));
    assert_eq!((stderr.as_str(), status), ("", Some(0)));
    let found: Value = serde_json::from_str(&stdout).unwrap();
    let need = &found["needs"][0];
    assert!(need["scene_bytes"].as_u64().unwrap() > 180_224, "{need}");
    assert_eq!((need["board"].as_str(), need["stack_is_measured"].as_bool()), (Some("roomy"), Some(true)));
    assert!(found["chips"][0]["seconds"].as_f64().is_some_and(|seconds| seconds > 0.0), "{found}");
}

/// Every program of the PATH but the emulators.
#[cfg(unix)]
fn without_emulators(folder: &TempDir) -> PathBuf {
    let bin = folder.path().join("bin");
    fs::create_dir(&bin).unwrap();
    for path in std::env::split_paths(&std::env::var_os("PATH").unwrap_or_default()) {
        for entry in fs::read_dir(path).into_iter().flatten().flatten() {
            let is_emulator = entry.file_name().to_string_lossy().starts_with("qemu-system-");
            let link = bin.join(entry.file_name());
            if !is_emulator && link.symlink_metadata().is_err() {
                std::os::unix::fs::symlink(entry.path(), link).unwrap();
            }
        }
    }
    bin
}

#[test]
#[cfg(unix)]
fn without_an_emulator_sizes_are_told_and_seconds_are_not() {
    if !can_measure() {
        return;
    }
    let folder = folder();
    let path: &Path = &without_emulators(&folder);
    let mut command = command(&folder, "scene.toml --chip nRF51822_xxAA --json");
    command.env("PATH", path);
    let (stdout, stderr, status) = said(command);
    assert_eq!(status, Some(0), "{stderr}");
    assert!(stderr.starts_with("warning: thumbv6m: qemu-system-arm is not installed; "), "{stderr}");
    assert!(
        stderr.ends_with("so there are no seconds, and the stack is taken to be what firmware reserves for it\n"),
        "{stderr}"
    );
    let found: Value = serde_json::from_str(&stdout).unwrap();
    let need = &found["needs"][0];
    assert_eq!((need["stack_bytes"].as_u64(), need["stack_is_measured"].as_bool()), (Some(8192), Some(false)));
    assert_eq!(found["chips"][0]["seconds"], Value::Null);
}
