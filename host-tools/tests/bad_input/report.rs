//! Reports: what cannot be asked for, and what a sweep finds in its way.

use std::fs;
use std::process::{Command, Output};

use crate::command::{Folder, TRIANGLE, text};

const HELP: &str = "\nFor more information, try '--help'.\n";

/// A point of the triangle, which is measured in no time.
const SMALL: &str = "--quick --machine host --study kernels --kernel f32 --size 8x6";

#[test]
fn options_that_mean_nothing() {
    let folder = Folder::with_triangle();
    for (option, message) in [
        (
            "--machine z80",
            "invalid value 'z80' for '--machine <MACHINE>'\n  [possible values: host, rv32imac, thumbv6m]\n",
        ),
        (
            "--study knobs",
            "invalid value 'knobs' for '--study <STUDY>'\n  [possible values: kernels, c, d, e, leaf, grid, samples, depth, \
             size, triangles]\n",
        ),
        ("--size 8", "invalid value '8' for '--size <WxH>': expected WIDTHxHEIGHT in pixels, such as 640x480\n"),
        ("--timeout 0", "invalid value '0' for '--timeout <SECONDS>': 0 is not in 1..18446744073709551615\n"),
    ] {
        folder.refuses(&format!("report scene.obj {option} -o out"), &format!("error: {message}{HELP}"));
    }
    let output = folder.run("report scene.obj --kernel exact41 -o out");
    let stderr = text(&output.stderr);
    assert!(stderr.contains("possible values: exact29, ") && stderr.contains("'exact14'"), "{stderr}");
    assert_eq!(output.status.code(), Some(2));
}

#[test]
fn no_scene_that_can_be_read() {
    let folder = Folder::with_triangle();
    folder.refuses(&format!("report none.obj {SMALL} -o out"), "error: none.obj: no such file\n");
    folder.write("scene.blob", b"ITRBLOB");
    let output = folder.run(&format!("report none.obj scene.blob {SMALL} -o out"));
    assert_eq!(output.status.code(), Some(2));
    let stderr = text(&output.stderr);
    assert!(stderr.starts_with("error: none.obj: no such file\n") && stderr.contains("scene.blob: "), "{stderr}");
    assert!(!folder.path("out").exists());
}

/// The others are measured, the page says so, and so does the exit status.
#[test]
fn a_scene_that_cannot_be_read_among_good_ones() {
    let folder = Folder::with_triangle();
    folder.write("bad.obj", b"f 1 2 3\n");
    let Output { status, stdout, stderr } = folder.run(&format!("report scene.obj bad.obj {SMALL} -o out"));
    let stderr = text(&stderr);
    assert!(stderr.starts_with("error: bad.obj:1: "), "{stderr}");
    assert_eq!(text(&stdout), "out: 1 points, 1 of them measured now and 0 without figures\n");
    assert_eq!(status.code(), Some(1));
    let reason = stderr.trim().trim_start_matches("error: bad.obj:1: ");
    assert!(text(&folder.read("out/report.json")).contains(&reason.replace('"', "\\\"")));
}

#[test]
fn a_place_that_is_none() {
    let folder = Folder::with_triangle();
    folder.write("file", b"mine");
    for (place, message) in [
        ("no/such/out", "error: no/such/out: cannot be written: No such file or directory (os error 2)\n"),
        ("file", "error: file: cannot be written: File exists (os error 17)\n"),
    ] {
        let before = folder.contents();
        let output = folder.run(&format!("report scene.obj {SMALL} -o {place}"));
        assert_eq!((text(&output.stderr).as_str(), output.status.code()), (message, Some(2)));
        assert!(folder.contents() == before);
    }
}

#[test]
fn a_folder_with_files_of_others() {
    let folder = Folder::with_triangle();
    fs::create_dir(folder.path("out")).unwrap();
    let line = format!("report scene.obj {SMALL} -o out");
    for name in ["index.html", "report.csv", "report.json"] {
        folder.write(&format!("out/{name}"), b"mine");
        let message = format!(
            "error: out/{name}: is there already, and the folder has no report; it is left alone: name another folder\n"
        );
        folder.refuses(&line, &message);
        fs::remove_file(folder.path(&format!("out/{name}"))).unwrap();
    }
    folder.write("out/rows.jsonl", b"mine");
    let message = "error: out/rows.jsonl: this is not of a report, and is left alone; name another folder\n";
    folder.refuses(&line, message);
    folder.refuses(&format!("{line} --fresh"), message);
    fs::remove_file(folder.path("out/rows.jsonl")).unwrap();
    folder.write("out/mine.txt", b"mine");
    folder.succeeds(&line, "");
    assert_eq!(folder.read("out/mine.txt"), b"mine");
}

#[test]
fn rows_of_another_report() {
    let folder = Folder::new(&[("mesh.obj", TRIANGLE.as_bytes())]);
    let line = format!("report mesh.obj {SMALL} -o out");
    folder.succeeds(&line, "");
    let rows = text(&folder.read("out/rows.jsonl"));
    folder.write("out/rows.jsonl", rows.replacen("intray-report/", "intray-report/0.", 1).as_bytes());
    let anew = "`--fresh` begins anew, or name another folder\n";
    let output = folder.run(&line);
    assert!(text(&output.stderr).starts_with("error: out/rows.jsonl: its rows are of the schema intray-report/0."));
    assert!(text(&output.stderr).ends_with(anew));
    assert_eq!(output.status.code(), Some(2));

    folder.write("out/rows.jsonl", rows.as_bytes());
    folder.write("mesh.obj", TRIANGLE.replace("v 0 2 2", "v 0 3 2").as_bytes());
    let message = format!("error: out/rows.jsonl: the scene mesh has changed since its rows were measured; {anew}");
    folder.refuses(&line, &message);
    folder.succeeds(&format!("{line} --fresh"), "");
    folder.succeeds(&line, "out: going on, 1 of 1 points are there\n");
}

/// Without QEMU there are rows of the host alone, and the report says why.
#[test]
fn without_an_emulator() {
    let folder = Folder::with_triangle();
    let mut command =
        folder.intray(&["report", "scene.obj", "--quick", "--study", "kernels", "--kernel", "f32", "-o", "out"]);
    let output = command.env("PATH", "").output().unwrap();
    let stderr = text(&output.stderr);
    for note in
        ["There are no rows of hifive1 (FE310, rv32imac): ", "There are no rows of microbit (nRF51822, Cortex-M0): "]
    {
        assert!(stderr.contains(note), "{stderr}");
        assert!(text(&folder.read("out/report.json")).contains(note));
    }
    assert!(stderr.contains("is not installed; `cargo xtask setup`"), "{stderr}");
    assert_eq!(text(&output.stdout), "out: 1 points, 1 of them measured now and 0 without figures\n");
    assert_eq!(output.status.code(), Some(0));
}

/// A limit on the size of files stands for a full disk: writing fails in the middle of a row.
#[cfg(unix)]
#[test]
fn a_disk_that_is_full() {
    let folder = Folder::with_triangle();
    let all = "report scene.obj --quick --machine host --kernel exact14 --size 8x6 -o out";
    folder.succeeds(&format!("{all} --study kernels"), "");
    let program = env!("CARGO_BIN_EXE_intray");
    // In blocks of 512 bytes: room for a few rows.
    let script = format!("trap '' XFSZ; ulimit -f 8; exec '{program}' {all} --fresh");
    let output = Command::new("sh").current_dir(folder.path("")).args(["-c", &script]).output().unwrap();
    let stderr = text(&output.stderr);
    assert_eq!(stderr, "error: out/rows.jsonl: cannot be written: File too large (os error 27)\n");
    assert_eq!(output.status.code(), Some(2));
    let rows = text(&folder.read("out/rows.jsonl"));
    let count = rows.lines().count() - 1;
    assert!(count >= 2 && rows.ends_with('\n'), "{rows}");
    let output = folder.run(all);
    assert!(text(&output.stderr).starts_with(&format!("out: going on, {count} of ")), "{output:?}");
    assert_eq!(output.status.code(), Some(0));
    assert!(text(&folder.read("out/rows.jsonl")).starts_with(&rows));
}
