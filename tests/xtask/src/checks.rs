//! What `cargo xtask test` runs, the quickest first.
//!
//! Everything is tested with overflow checks. Unit tests run as debug builds; conformance needs millions of rays, so the
//! package `tests` runs under the profile `checked`: optimised, with the checks kept. The goldens are bit-exact files, so
//! that comparing with them in debug and release too shows that no result depends on the optimisation level.

use crate::fuzz;
use crate::qemu::QEMU;
use crate::steps::Step;
use crate::task::Task;
use crate::tool::{CARGO_FUZZ, CHROMIUM, CLIPPY, IMAGEMAGICK, NIGHTLY, RISCV32IMAC, RUSTFMT, THUMBV6M, Tool, XVFB};

/// Seconds of fuzzing a target.
const FUZZ_SECONDS: u32 = 20;

/// Packages that are for a chip alone, its target, and what checking them takes.
const FIRMWARE: [(&str, &str, &[Tool]); 2] = [
    ("firmware-cortexm", "thumbv6m-none-eabi", &[CLIPPY, THUMBV6M]),
    ("firmware-riscv", "riscv32imac-unknown-none-elf", &[CLIPPY, RISCV32IMAC]),
];

/// All checks. `long` makes the tests that draw random input draw ten times as much.
pub(crate) fn steps(long: bool) -> Vec<Step> {
    let test = |line: &str| {
        let task = Task::new(line);
        if long { task.with("INTRAY_LONG", "1") } else { task }
    };
    let mut steps = vec![
        Step::new("formatting", Task::new("cargo fmt --all --check")).needing(&[RUSTFMT]),
        Step::new("lints", Task::new("cargo clippy --workspace --all-targets -- -D warnings")).needing(&[CLIPPY]),
        Step::new(
            "documentation",
            Task::new(
                "cargo doc --no-deps -p core-rt -p float-rt -p host-tools -p chip-fit -p planes-rt -p planes-simd \
                 -p exact-simd -p view",
            )
            .with("RUSTDOCFLAGS", "-D warnings"),
        ),
        Step::new(
            "the cores for the chips",
            Task::new(
                "cargo build -p core-rt -p float-rt -p planes-rt --release --target thumbv6m-none-eabi \
                 --target riscv32imac-unknown-none-elf",
            ),
        )
        .needing(&[THUMBV6M, RISCV32IMAC]),
    ];
    for (package, target, tools) in FIRMWARE {
        for features in ["", " --features rtt", " --features planes"] {
            let line = format!("cargo clippy -p {package} --target {target}{features} -- -D warnings");
            steps.push(Step::new(format!("lints of {package}{features}"), Task::new(&line)).needing(tools));
        }
        if package == "firmware-cortexm" {
            for (features, of) in [("pico,rtt", "the Pico's firmware"), ("roomy", "the roomy board's firmware")] {
                let line = format!("cargo clippy -p {package} --target {target} --features {features} -- -D warnings");
                steps.push(Step::new(format!("lints of {of}"), Task::new(&line)).needing(tools));
            }
        }
        let line = format!("cargo clippy -p probe --target {target} -- -D warnings");
        steps.push(Step::new(format!("lints of the probe for {target}"), Task::new(&line)).needing(tools));
        // As `cargo run` builds it, which must fit too.
        let line = format!("cargo build -p {package} --target {target}");
        steps.push(Step::new(format!("{package} for its chip"), Task::new(&line)).needing(tools));
    }
    steps.extend([
        Step::new(
            "unit tests, debug",
            test("cargo test -p core-rt -p firmware-rt -p float-rt -p host-tools -p planes-rt -p exact-simd -p qemu-plugin \
                  -p xtask"),
        ),
        Step::new("goldens, debug", Task::new("cargo test -p tests --test goldens")),
        Step::new("ImageMagick's counts", Task::new("cargo test -p tests --profile checked --test imagemagick"))
            .needing(&[IMAGEMAGICK]),
        Step::new(
            "the report's page in a browser",
            Task::new("cargo test -p tests --profile checked --test report_page"),
        )
        .needing(&[CHROMIUM]),
        Step::new("instruction counts", Task::new("cargo test -p tests --profile checked --test qemu_plugin"))
            .needing(&[QEMU]),
        // What it lacks, its tests skip and say.
        Step::new(
            "chips, and the boards' firmware for probe-rs",
            Task::new("cargo test -p chip-fit --profile checked"),
        ),
        Step::new("the viewer, without a window", Task::new("cargo test -p view --profile checked --lib --test chip")),
        Step::new("the viewer's window", Task::new("cargo test -p view --profile checked --test window"))
            .needing(&[XVFB]),
        Step::new("all of tests, optimised and overflow-checked", test("cargo test -p tests --profile checked")),
        Step::new("goldens, release", Task::new("cargo test -p tests --release --test goldens")),
    ]);
    steps.extend(fuzz::steps(FUZZ_SECONDS, &[NIGHTLY, CARGO_FUZZ]));
    steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_long_run_is_longer_in_its_tests_only() {
        let long = |steps: Vec<Step>| {
            steps.iter().map(|step| step.task.to_string()).filter(|line| line.contains("INTRAY_LONG")).count()
        };
        assert_eq!(long(steps(false)), 0);
        assert_eq!(long(steps(true)), 2);
    }
}
