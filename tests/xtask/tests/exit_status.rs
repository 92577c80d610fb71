//! The runner's own exit status: a check that fails must not look like one that passed.

use std::process::{Command, Output};

fn xtask(arguments: &[&str], path: Option<&str>) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    if let Some(path) = path {
        command.env("PATH", path);
    }
    command.args(arguments).output().unwrap()
}

#[test]
fn wrong_arguments_are_status_2() {
    let output = xtask(&["tset"], None);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).starts_with("usage: cargo xtask"));
}

#[test]
fn a_step_that_fails_is_status_1_and_names_its_command() {
    // Without a PATH there is no cargo: what has tools is skipped, and the first step without any fails.
    let output = xtask(&["test"], Some(""));
    let (said, complaint) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.status.code(), Some(1), "{said}{complaint}");
    assert!(said.contains("formatting: skipped"), "{said}");
    assert!(complaint.contains("repeat it by: RUSTDOCFLAGS='-D warnings' cargo doc"), "{complaint}");
    assert!(!said.contains("steps passed"), "{said}");
}
