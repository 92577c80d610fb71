//! The README's example of `intray fit` is what it prints, in extracts. `INTRAY_BLESS=1` renews it.
//!
//! It is skipped, with a line that says so, where nothing can be emulated, or where the compiler is another than the one that
//! the example names: instructions and sizes are the compiler's.

use std::process::Command;

use chip_fit::core::Isa;
use host_tools::emulate;
use tests::documents::{README, check_part, document, generated, is_blessing, root};

/// The scene, and the chips that are shown in full.
const SCENE: &str = "scenes/bench-1k/scene.toml";
const CHIP: &str = "STM32F030C8";

/// Families whose lines are shown, and how many near misses.
const FAMILIES: [&str; 6] = ["family ", "CH32V2 ", "RP2040 ", "SAMD21 ", "fe310 ", "nRF51 "];
const MISSES: usize = 3;

fn printed(program: &mut Command) -> String {
    String::from_utf8(program.output().unwrap().stdout).unwrap()
}

/// The example: two commands, the compiler, and of what they print what is shown.
fn example() -> String {
    let fit = || {
        let mut command = Command::new(env!("CARGO_BIN_EXE_intray-fit"));
        command.current_dir(root("")).arg(SCENE);
        command
    };
    let all = printed(&mut fit());
    let (fits, misses) = all.split_once("\nmisses ").unwrap();
    let mut lines = vec![format!("$ intray fit {SCENE}")];
    let (head, families) = fits.split_once("\nfamily ").unwrap();
    lines.extend(head.lines().map(String::from));
    let families = format!("family {families}");
    let is_shown = |line: &&str| FAMILIES.iter().any(|family| line.starts_with(family));
    lines.extend(families.lines().filter(is_shown).map(String::from));
    lines.push("...\n".into());
    lines.extend(format!("misses {misses}").lines().take(MISSES + 2).map(String::from));
    lines.push("...".into());
    lines.extend(misses.lines().skip_while(|line| !line.starts_with("what would help")).map(String::from));
    lines.push(format!("\n$ intray fit {SCENE} --chip {CHIP}"));
    lines.extend(printed(fit().args(["--chip", CHIP])).lines().map(String::from));
    let compiler = printed(Command::new("rustc").arg("--version"));
    let version = compiler.split(' ').nth(1).unwrap();
    format!("```text\n{}\n```\n\nFirmware by rustc {version}.\n", lines.join("\n"))
}

#[test]
fn the_readme_shows_what_is_printed() {
    if let Some(error) = Isa::ALL.iter().find_map(|isa| emulate::check(isa.boards()[0]).err()) {
        println!("skipped: {error}");
        return;
    }
    let found = example();
    let compiler = |text: &str| text.lines().last().map(String::from);
    let readme = document(README);
    let stored = generated(&readme, "fit").expect("the README has the marks");
    if !is_blessing() && compiler(stored) != compiler(&found) {
        println!("skipped: the README's figures are those of another compiler");
        return;
    }
    check_part(README, "fit", &found, |a, b| a == b);
}
