//! `intray fit`, which is a program of its own: where it is absent, and what it is given where it is there.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{Folder, text};

/// `intray` in a folder of its own, since builds may have put the other program beside it.
fn apart(folder: &Folder) -> PathBuf {
    let path = folder.path(&format!("intray{}", std::env::consts::EXE_SUFFIX));
    fs::copy(env!("CARGO_BIN_EXE_intray"), &path).unwrap();
    path
}

#[test]
fn where_it_is_absent_the_command_that_installs_it_is_said() {
    let folder = Folder::with_triangle();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").canonicalize().unwrap();
    let expected = format!(
        "error: `intray fit` is a program of its own, intray-fit, which has the memory maps of some 4,000 chips in it, and it \
         is neither beside this program nor on the PATH; `cargo install --path {}` installs it\n",
        root.join("chip-fit").display()
    );
    for line in ["fit scene.obj", "fit --help", "fit"] {
        let output = Command::new(apart(&folder))
            .args(line.split(' '))
            .current_dir(folder.path(""))
            .env("PATH", folder.path(""))
            .output()
            .unwrap();
        assert_eq!((text(&output.stderr), output.status.code()), (expected.clone(), Some(2)), "{line}");
        assert_eq!(text(&output.stdout), "");
    }
    assert!(root.join("chip-fit/Cargo.toml").is_file());
}

#[test]
#[cfg(unix)]
fn where_it_is_there_it_is_given_everything_and_its_status_is_ours() {
    use std::os::unix::fs::PermissionsExt;

    let folder = Folder::with_triangle();
    let intray = apart(&folder);
    // Beside, and on the PATH alone; what is beside counts.
    fs::create_dir(folder.path("path")).unwrap();
    for (name, says, status) in [("path/intray-fit", "on the PATH", 0), ("intray-fit", "beside", 1)] {
        folder.write(name, format!("#!/bin/sh\necho \"{says}: $*\"\nexit {status}\n").as_bytes());
        fs::set_permissions(folder.path(name), fs::Permissions::from_mode(0o755)).unwrap();
    }
    let run = |line: &str| {
        let output = Command::new(&intray).args(line.split(' ')).env("PATH", folder.path("path")).output().unwrap();
        (text(&output.stdout), text(&output.stderr), output.status.code())
    };
    let beside = |rest: &str| (format!("beside: {rest}\n"), String::new(), Some(1));
    for rest in ["scene.obj --chip RP2040 --json", "--help", "--version scene.obj", "--no-such-option", "-- --chip"] {
        assert_eq!(run(&format!("fit {rest}")), beside(rest));
    }
    fs::remove_file(folder.path("intray-fit")).unwrap();
    assert_eq!(run("fit a b"), ("on the PATH: a b\n".into(), String::new(), Some(0)));
}
