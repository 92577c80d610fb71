//! The regression guard of speed on chips: what a fixed set of runs takes, in instructions, which are exact.
//!
//! `instructions.toml` has the counts. One that grows by more than a hundredth fails, and `INTRAY_BLESS=1` renews the file.
//! The counts are those of one compiler, which the file names; with another nothing is compared, and a line says so. So it
//! does for boards where nothing can be counted.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use firmware_rt::board::Board;
use firmware_rt::hits::Way;
use host_tools::emulate::counter::Counter;
use serde::{Deserialize, Serialize};
use tests::boards;
use tests::chips::{Job, scene};

/// What a count may grow by: a hundredth.
const GROWTH: u64 = 100;

/// How the file is renewed.
const RENEWED: &str = "INTRAY_BLESS=1 cargo test -p tests --profile checked --test instructions";

/// Scene, kernel, size, and the nearest hits alone.
const SET: [(&str, &str, [u32; 2], Option<Way>); 6] = [
    ("bench-1k", "exact14", [80, 64], Some(Way::Single)),
    ("bench-1k", "exact14", [160, 128], Some(Way::Tile)),
    ("bench-1k", "exact29", [80, 64], Some(Way::Single)),
    ("bench-1k", "f32", [40, 32], Some(Way::Single)),
    ("built-in", "exact14", [32, 24], None),
    ("raystones", "exact14", [40, 20], None),
];

/// The file.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
struct Counts {
    /// What `rustc --version` says.
    compiler: String,
    /// Instructions by board and run.
    boards: BTreeMap<String, BTreeMap<String, u64>>,
}

fn path() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("instructions.toml")
}

fn compiler() -> String {
    let output = Command::new("rustc").arg("--version").output().expect("there is a compiler");
    String::from_utf8_lossy(&output.stdout).trim().to_owned()
}

fn counted(board: &'static Board, counter: &Counter) -> BTreeMap<String, u64> {
    let count = |(name, kernel, size, hits): (&str, &str, [u32; 2], Option<Way>)| {
        let instructions = Job::new(board, &scene(name, size), kernel, hits).counts(counter).instructions;
        let [width, height] = size;
        let what = match hits {
            None => "",
            Some(Way::Single) => ", hits",
            Some(Way::Tile) => ", hits of tiles",
        };
        let name = format!("{name} {width}x{height} by {kernel}{what}");
        println!("{} {name}: {instructions}, {} a pixel", board.name, instructions / u64::from(width * height));
        (name, instructions)
    };
    SET.into_iter().map(count).collect()
}

/// What is worse than it was, a line each.
fn complaints(board: &str, found: &BTreeMap<String, u64>, expected: &BTreeMap<String, u64>) -> String {
    let worse = |(name, &found): (&String, &u64)| match expected.get(name) {
        None => Some(format!("{board}: {name} is not in the file\n")),
        Some(&expected) if found > expected + expected / GROWTH => {
            Some(format!("{board}: {name} takes {found} instructions, and took {expected}\n"))
        }
        Some(_) => None,
    };
    let stale = expected.keys().filter(|name| !found.contains_key(*name));
    let stale = stale.map(|name| format!("{board}: {name} is in the file, and is not counted\n"));
    found.iter().filter_map(worse).chain(stale).collect()
}

#[test]
fn nothing_takes_more_instructions_than_it_did() {
    let mut found = Counts { compiler: compiler(), ..Counts::default() };
    for (board, counter) in boards::counted() {
        found.boards.insert(board.name.into(), counted(board, &counter));
    }
    if std::env::var_os("INTRAY_BLESS").is_some() {
        let text = toml::to_string(&found).expect("counts are TOML");
        std::fs::write(path(), format!("# Instructions of chips. Renewed by {RENEWED}\n\n{text}")).expect("a file");
    }
    let text = std::fs::read_to_string(path()).expect("the counts");
    let expected: Counts = toml::from_str(&text).expect("counts in TOML");
    if found.compiler != expected.compiler {
        println!("skipped: the counts are of {}", expected.compiler);
        return;
    }
    let none = BTreeMap::new();
    let complaints: String = found
        .boards
        .iter()
        .map(|(board, found)| complaints(board, found, expected.boards.get(board).unwrap_or(&none)))
        .collect();
    assert!(complaints.is_empty(), "{complaints}where that is meant, this renews tests/instructions.toml:\n{RENEWED}");
}

#[test]
fn a_hundredth_more_is_noticed() {
    let counts = |count: u64| BTreeMap::from([("a".to_owned(), count)]);
    assert_eq!(complaints("b", &counts(1010), &counts(1000)), "");
    assert_eq!(complaints("b", &counts(5), &counts(1000)), "");
    assert!(complaints("b", &counts(1011), &counts(1000)).contains("takes 1011 instructions, and took 1000"));
    assert!(complaints("b", &counts(1), &BTreeMap::new()).contains("is not in the file"));
    assert!(complaints("b", &BTreeMap::new(), &counts(1)).contains("is not counted"));
}
