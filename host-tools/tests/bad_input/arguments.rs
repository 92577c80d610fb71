//! Arguments that are missing, unknown or out of range.

use host_tools::engine::ENGINES;

use crate::command::Folder;

const HELP: &str = "\nFor more information, try '--help'.\n";

/// A command line that is refused before anything is read.
#[track_caller]
fn refused(line: &str, message: &str) {
    Folder::with_triangle().refuses(line, &format!("error: {message}\n{HELP}"));
}

#[test]
fn sizes() {
    const RANGE: &str = "a picture has 1 to 16384 pixels a side, and at most 67108864 in all";
    const FORM: &str = "expected WIDTHxHEIGHT in pixels, such as 640x480";
    for (size, reason) in [
        ("0x480", RANGE),
        ("640x0", RANGE),
        ("-1x4", RANGE),
        ("4x-1", RANGE),
        ("99999999x2", RANGE),
        ("99999999999x2", RANGE),
        ("16384x16384", RANGE),
        ("640", FORM),
        ("axb", FORM),
        ("640x480x3", FORM),
        ("6.5x4", FORM),
        ("nanxinf", FORM),
    ] {
        let message = format!("invalid value '{size}' for '--size <WxH>': {reason}");
        refused(&format!("render scene.obj --size {size} -o out.png"), &message);
        refused(&format!("prep scene.obj --size={size} -o out.blob"), &message);
    }
}

#[test]
fn numbers_out_of_range() {
    for (option, range) in [("leaf", "1..=64"), ("threads", "1..=1024")] {
        for value in ["0", "-1", "1025"] {
            refused(
                &format!("render scene.obj --{option} {value} -o out.png"),
                &format!("invalid value '{value}' for '--{option} <N>': {value} is not in {range}"),
            );
        }
        refused(
            &format!("render scene.obj --{option} many -o out.png"),
            &format!("invalid value 'many' for '--{option} <N>': invalid digit found in string"),
        );
    }
    refused("inspect scene.obj --leaf 65", "invalid value '65' for '--leaf <N>': 65 is not in 1..=64");
}

#[test]
fn kernels_that_do_not_exist() {
    // Such as: exact29, exact14.
    let known = format!("{}, planes12, auto", ENGINES.map(|engine| engine.name()).join(", "));
    refused(
        "render scene.obj --kernel sixteen -o out.png",
        &format!("invalid value 'sixteen' for '--kernel <KERNEL>'\n  [possible values: {known}]"),
    );
    refused(
        "inspect scene.obj --kernel exact41",
        &format!(
            "invalid value 'exact41' for '--kernel <KERNEL>'\n  [possible values: {known}]\n\n  \
             tip: a similar value exists: 'exact14'"
        ),
    );
}

#[test]
fn boards_that_are_unknown() {
    refused(
        "inspect scene.obj --board microbyt",
        "invalid value 'microbyt' for '--board <BOARD>'\n  [possible values: microbit, hifive1, pico]\n\n  \
         tip: a similar value exists: 'microbit'",
    );
    // Nothing counts what QEMU cannot run.
    let output = Folder::with_triangle().run("inspect scene.obj --kernel exact14 --board pico");
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty());
    assert!(String::from_utf8_lossy(&output.stderr).contains("QEMU has no such machine"));
}

#[test]
fn arguments_that_are_missing() {
    for (line, missing, usage) in [
        ("render", "  -o <PNG>\n  <SCENE>", "intray render -o <PNG> <SCENE>"),
        ("render scene.obj", "  -o <PNG>", "intray render -o <PNG> <SCENE>"),
        ("prep scene.obj", "  -o <BLOB>", "intray prep -o <BLOB> <SCENE>"),
        ("inspect", "  <SCENE>", "intray inspect <SCENE>"),
        ("compare a.png", "  <B>", "intray compare <A> <B>"),
    ] {
        refused(line, &format!("the following required arguments were not provided:\n{missing}\n\nUsage: {usage}"));
    }
    Folder::with_triangle().refuses_words(&["render", "", "-o", "out.png"], {
        "error: a value is required for '<SCENE>' but none was supplied\n\nFor more information, try '--help'.\n"
    });
}

#[test]
fn words_that_mean_nothing() {
    refused("frobnicate", "unrecognized subcommand 'frobnicate'\n\nUsage: intray [COMMAND]");
    refused(
        "rendr scene.obj -o out.png",
        "unrecognized subcommand 'rendr'\n\n  tip: some similar subcommands exist: 'report', 'render'\n\nUsage: intray [COMMAND]",
    );
    refused(
        "inspect scene.obj --jsn",
        "unexpected argument '--jsn' found\n\n  tip: a similar argument exists: '--json'\n\n\
         Usage: intray inspect --json <SCENE>",
    );
    refused(
        "inspect scene.obj other.obj",
        "unexpected argument 'other.obj' found\n\nUsage: intray inspect [OPTIONS] <SCENE>",
    );
}
