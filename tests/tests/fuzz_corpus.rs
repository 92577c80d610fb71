//! Replays the fuzzers' committed corpora, so that stable toolchains check them too.

use std::path::Path;

/// Runs every file of a corpus, in order of name; how many there were.
fn replay(target: &str, run: impl Fn(&[u8])) -> usize {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let mut files: Vec<_> = std::fs::read_dir(&folder)
        .unwrap_or_else(|error| panic!("{}: {error}", folder.display()))
        .map(|entry| entry.unwrap().path())
        .collect();
    files.sort();
    for file in &files {
        run(&std::fs::read(file).unwrap());
    }
    files.len()
}

#[test]
fn obj() {
    assert!(replay("obj", tests::fuzz::obj) >= 15);
}

#[test]
fn scene_toml() {
    assert!(replay("scene_toml", tests::fuzz::scene_toml) >= 15);
}

#[test]
fn blob() {
    assert!(replay("blob", tests::fuzz::blob) >= 8);
}
