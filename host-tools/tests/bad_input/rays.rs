//! Files of rays that `trace` cannot read, and outputs that it cannot write.

use std::io::Write;
use std::process::Stdio;

use crate::command::{Folder, text};

const HEADER: &str = "ox,oy,oz,dx,dy,dz\n";

/// A ray that hits the triangle at t = 2 and u = v = 1/4.
const RAY: &str = "0.5,0.5,2,0,0,-0.75\n";

#[track_caller]
fn refused(rays: &[u8], message: &str) {
    let folder = Folder::with_triangle();
    folder.write("rays.csv", rays);
    for kernel in ["exact29", "reference"] {
        let line = format!("trace scene.obj --rays rays.csv -o hits.csv --kernel {kernel}");
        folder.refuses(&line, &format!("error: rays.csv{message}\n"));
    }
    folder.refuses("trace scene.obj --rays rays.csv -o -", &format!("error: rays.csv{message}\n"));
}

#[test]
fn what_is_no_file_of_rays() {
    refused(b"", ": the file is empty; rays stand under the line ox,oy,oz,dx,dy,dz");
    for (header, found) in [
        ("0,0,0,0,0,1\n", "0,0,0,0,0,1"),
        ("ox,oy,oz,dx,dy\n", "ox,oy,oz,dx,dy"),
        ("ox;oy;oz;dx;dy;dz\n", "ox;oy;oz;dx;dy;dz"),
        ("dx,dy,dz,ox,oy,oz\n", "dx,dy,dz,ox,oy,oz"),
        ("\nox,oy,oz,dx,dy,dz\n", ""),
        ("o\0x\u{1b}[2J\n", "o\\0x\\u{1b}[2J"),
        ("a line that has nothing to do with rays, and goes on\n", "a line that has nothing to do with rays,…"),
    ] {
        let message = format!(":1: `{found}` where the header ox,oy,oz,dx,dy,dz should be");
        refused(format!("{header}{RAY}").as_bytes(), &message);
    }
    refused(b"\xff\xfeo\0x\0", ":1: this is not UTF-8 text");
    refused(&vec![b'o'; 1 << 20], ":1: a line longer than 65536 bytes; six numbers are not");
}

#[test]
fn what_is_no_ray() {
    const COLUMNS: &str = "columns where 6 should be (ox,oy,oz,dx,dy,dz)";
    let cases: [(&[u8], &str); 16] = [
        (b"0,0,0,0,0,0", "the direction is zero"),
        (b"0,0,0,0,-0.0,1e-400", "the direction is zero"),
        (b"0,0,nan,0,0,1", "oz: `nan` is not a finite number"),
        (b"0,0,0,0,NaN,1", "dy: `NaN` is not a finite number"),
        (b"inf,0,0,0,0,1", "ox: `inf` is not a finite number"),
        (b"0,0,0,0,0,-Infinity", "dz: `-Infinity` is not a finite number"),
        (b"0,1e999,0,0,0,1", "oy: `1e999` is not a finite number"),
        (b"0,zero,0,0,0,1", "oy: `zero` is not a number"),
        (b"0,0,0,0x1,0,1", "dx: `0x1` is not a number"),
        (b"0,0,0,\"0\",0,1", "dx: `\\\"0\\\"` is not a number"),
        (b"0,0,,0,0,1", "oz: `` is not a number"),
        (b"0,0,0,0,1", &format!("5 {COLUMNS}: `0,0,0,0,1`")),
        (b"0,0,0,0,0,1,", &format!("7 {COLUMNS}: `0,0,0,0,0,1,`")),
        (b"0 0 0 0 0 1", &format!("1 {COLUMNS}: `0 0 0 0 0 1`")),
        (b"", &format!("1 {COLUMNS}: ``")),
        (b"0,0,0,\xff,0,1", "this is not UTF-8 text"),
    ];
    for (row, message) in cases {
        // At the end, with and without its line's end, and before good rows.
        for (before, after) in [("", ""), ("", "\n"), (RAY, "\r\n"), (RAY, "\n0,0,0,0,0,1\n")] {
            if row.is_empty() && after.is_empty() {
                continue;
            }
            let line = if before.is_empty() { 2 } else { 3 };
            let rays = [HEADER.as_bytes(), before.as_bytes(), row, after.as_bytes()].concat();
            refused(&rays, &format!(":{line}: {message}"));
        }
    }
}

#[test]
fn a_fault_after_many_good_rays_leaves_nothing() {
    let rays = format!("{HEADER}{}0,0,0,0,0,0\n", RAY.repeat(70_000));
    refused(rays.as_bytes(), ":70002: the direction is zero");
}

#[test]
fn files_that_are_not_there() {
    let folder = Folder::with_triangle();
    std::fs::create_dir(folder.path("folder")).unwrap();
    folder.write("rays.csv", HEADER.as_bytes());
    folder.write("scene.blob", b"not a blob");
    let refuses = |arguments: &str, message: &str| {
        folder.refuses(&format!("trace {arguments}"), &format!("error: {message}\n"));
    };
    refuses("scene.obj --rays none.csv -o hits.csv", "none.csv: no such file");
    refuses("scene.obj --rays folder -o hits.csv", "folder: this is a folder; give the name of a file");
    refuses("none.obj --rays rays.csv -o hits.csv", "none.obj: no such file");
    refuses("none.obj --rays rays.csv -o hits.csv --kernel reference", "none.obj: no such file");
    refuses("scene.blob --rays rays.csv -o hits.csv --kernel reference", "scene.blob: a scene is a .toml or .obj file");
    for option in ["--leaf 2", "--epsilon 2"] {
        refuses(
            &format!("scene.obj --rays rays.csv -o hits.csv --kernel reference {option}"),
            "--leaf, --prefer, --grid-bits and the knobs of arithmetic are the kernels'; the reference has none",
        );
    }
    refuses("scene.obj --rays rays.csv -o folder", "folder: this is a folder; give the name of a file");
    refuses(
        "scene.obj --rays rays.csv -o no/hits.csv",
        "no/hits.csv: cannot be written: there is no folder no; create it first",
    );
    refuses(
        "scene.obj --rays rays.csv -o - --json",
        "--json prints to standard output, where -o - sends the hits; give a file",
    );
    refuses(
        "scene.obj --rays rays.csv -o hits.csv --kernel reference --leaf 1",
        "--leaf, --prefer, --grid-bits and the knobs of arithmetic are the kernels'; the reference has none",
    );
}

#[test]
fn good_rays_are_traced_whatever_their_lines_end_in() {
    let folder = Folder::with_triangle();
    let miss = "9,9,9,1,0,0\r\n";
    folder
        .write("rays.csv", format!("\u{feff}{}{RAY}{miss}{}", HEADER.replace('\n', "\r\n"), RAY.trim_end()).as_bytes());
    let expected = "hit,t,prim,u,v\n1,2,0,0.25,0.25\n0,,,,\n1,2,0,0.25,0.25\n";
    let printed = folder.succeeds("trace scene.obj --rays rays.csv -o - --kernel reference", "");
    assert_eq!(printed, expected);
    let said = folder.succeeds("trace scene.obj --rays rays.csv -o hits.csv --kernel reference --threads 1", "");
    assert!(said.starts_with("hits.csv: 3 rays by reference, 2 of them hit, in "), "{said}");
    assert_eq!(text(&folder.read("hits.csv")), expected);

    let rays = folder.read("rays.csv");
    let words = ["trace", "scene.obj", "--rays", "-", "-o", "-", "--kernel", "reference"];
    let mut child =
        folder.intray(&words).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(&rays).unwrap();
    let output = child.wait_with_output().unwrap();
    assert_eq!((text(&output.stdout).as_str(), text(&output.stderr).as_str()), (expected, ""));
}

/// More rays than are in memory at a time.
#[test]
fn the_number_of_threads_does_not_show() {
    let folder = Folder::with_triangle();
    let mut rays = HEADER.to_owned();
    for i in 0..70_000 {
        let (x, y) = (i % 311, i / 311);
        rays += &format!("0.{x},1.{y},2,0.{y},-0.{x},-0.75\n");
    }
    folder.write("rays.csv", rays.as_bytes());
    let hits = [1, 2, 7]
        .map(|threads| folder.succeeds(&format!("trace scene.obj --rays rays.csv -o - --threads {threads}"), ""));
    assert_eq!(hits[0].lines().count(), 70_001);
    let count = |start: &str| hits[0].lines().filter(|line| line.starts_with(start)).count();
    assert!(count("1,") > 1000 && count("0,,,,") > 1000);
    assert!(hits[1..].iter().all(|other| *other == hits[0]));
}

#[test]
fn one_object_tells_what_was_done() {
    let folder = Folder::with_triangle();
    folder.write("rays.csv", format!("{HEADER}{RAY}9,9,9,1,0,0\n").as_bytes());
    let printed = folder.succeeds("trace scene.obj --rays rays.csv -o hits.csv --threads 2 --json", "");
    let found: serde_json::Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(found["kernel"], "exact29");
    assert_eq!(["rays", "hits", "threads"].map(|field| found[field].as_u64()), [2, 1, 2].map(Some));
    assert!(found["seconds"].as_f64().is_some_and(|seconds| seconds >= 0.0));
}
