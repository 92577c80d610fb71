//! `intray fit` and `intray view`, which are programs of their own: where they are absent, and what they are given where they are
//! there.
#![cfg(unix)]

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{Folder, text};

/// `intray` in a folder of its own, since builds may have put the other program beside it. Others write it: what this process
/// writes, the commands of other tests could still have open, and it cannot be run then.
fn apart(folder: &Folder) -> PathBuf {
    let path = folder.path("intray");
    assert!(Command::new("cp").arg(env!("CARGO_BIN_EXE_intray")).arg(&path).status().unwrap().success());
    path
}

/// A program that says what it is given, and ends with a status.
fn script(path: &Path, says: &str, status: i32) {
    let line = format!("printf '#!/bin/sh\\necho \"{says}: $*\"\\nexit {status}\\n' > \"$0\" && chmod +x \"$0\"");
    assert!(Command::new("sh").arg("-c").arg(line).arg(path).status().unwrap().success());
}

#[test]
fn where_it_is_absent_the_command_that_installs_it_is_said() {
    let folder = Folder::with_triangle();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap();
    let intray = apart(&folder);
    for (verb, reason, package) in [
        ("fit", "has the memory maps of some 4,000 chips in it", "chip-fit"),
        ("view", "brings what windows, fonts and gamepads take", "view"),
    ] {
        let expected = format!(
            "error: `intray {verb}` is a program of its own, intray-{verb}, which {reason}, and it is neither beside this \
             program nor on the PATH; `cargo install --path {}` installs it\n",
            root.join(package).display()
        );
        for rest in [&["scene.obj"][..], &["--help"], &[]] {
            let output = Command::new(&intray)
                .arg(verb)
                .args(rest)
                .current_dir(folder.path(""))
                .env("PATH", folder.path(""))
                .output()
                .unwrap();
            assert_eq!((text(&output.stderr), output.status.code()), (expected.clone(), Some(2)), "{verb} {rest:?}");
            assert_eq!(text(&output.stdout), "");
        }
        assert!(root.join(package).join("Cargo.toml").is_file());
    }
}

#[test]
fn where_it_is_there_it_is_given_everything_and_its_status_is_ours() {
    let folder = Folder::with_triangle();
    let intray = apart(&folder);
    fs::create_dir(folder.path("path")).unwrap();
    script(&folder.path("path/intray-fit"), "on the PATH", 0);
    let run = |line: &str| {
        let output = Command::new(&intray).args(line.split(' ')).env("PATH", folder.path("path")).output().unwrap();
        (text(&output.stdout), text(&output.stderr), output.status.code())
    };
    assert_eq!(run("fit a b"), ("on the PATH: a b\n".into(), String::new(), Some(0)));
    // What is beside counts.
    script(&folder.path("intray-fit"), "beside", 1);
    for rest in ["scene.obj --chip RP2040 --json", "--help", "--version scene.obj", "--no-such-option", "a -- --chip"] {
        assert_eq!(run(&format!("fit {rest}")), (format!("beside: {rest}\n"), String::new(), Some(1)));
    }
}
