//! Coverage-guided fuzzing by cargo-fuzz and libFuzzer.

use std::io;
use std::path::Path;

use crate::steps::Step;
use crate::task::Task;
use crate::tool::Tool;

/// The targets, by the names of their files.
const TARGETS: [&str; 3] = ["blob", "obj", "scene_toml"];

/// Where new inputs go; beside the build, since the committed corpus is for inputs that were looked at.
const FOUND: &str = "tests/fuzz/target/found";

/// One step a target.
pub(crate) fn steps(seconds: u32, tools: &'static [Tool]) -> Vec<Step> {
    TARGETS
        .into_iter()
        .map(|target| {
            // libFuzzer writes to the first folder and reads all of them. An input that takes 10 s is a fault.
            let line = format!(
                "rustup run nightly cargo fuzz run --fuzz-dir tests/fuzz {target} {FOUND}/{target} \
                 tests/fuzz/corpus/{target} -- -max_total_time={seconds} -timeout=10"
            );
            Step::new(format!("fuzzing {target}"), Task::new(&line)).needing(tools)
        })
        .collect()
}

/// Makes the folders that libFuzzer expects to be there.
///
/// # Errors
/// Where the file system refuses.
pub(crate) fn prepare() -> io::Result<()> {
    TARGETS.iter().try_for_each(|target| std::fs::create_dir_all(Path::new(FOUND).join(target)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_target_there_is_is_run() {
        let fuzz = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fuzz");
        let mut files: Vec<String> = std::fs::read_dir(fuzz.join("fuzz_targets"))
            .unwrap()
            .map(|entry| entry.unwrap().path().file_stem().unwrap().to_str().unwrap().to_owned())
            .collect();
        files.sort();
        assert_eq!(files, TARGETS);
        for target in TARGETS {
            assert!(fuzz.join("corpus").join(target).is_dir(), "no corpus for {target}");
        }
    }
}
