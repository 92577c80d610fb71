//! The task runner. It depends on little, for it is the first thing that a new user waits for.

mod bench_scene;
mod checks;
mod demo_scene;
mod fuzz;
mod obj;
mod qemu;
mod steps;
mod task;
mod tool;

use std::path::Path;
use std::process::ExitCode;

use steps::Step;
use task::Task;

const USAGE: &str = "\
usage: cargo xtask VERB
  setup                installs what the emulated boards need: targets and QEMU
  test [--long]        runs every check, after installing what they need
  fuzz [--seconds N]   fuzzes the blob and the importers, N seconds each (60)
  studies [--quick]    measures the 2009 report's claims and writes docs/STUDIES.md; quickly, and smaller, to out/studies
  planes               measures the tracer of 1994 and writes docs/PLANES.md
  paths                measures error against samples of paths and writes docs/PATHS.md
  bless                renews the goldens and the figures of documents, and shows which changed
  speed [--quick]      compares chips by instructions and hosts by ratios, and writes docs/SPEED.md; quickly to out/speed
  report               measures the gallery and writes docs/report, and the README's part of it
  demo-scene           writes scenes/demo anew
  bench-scene          writes scenes/bench-1k anew";

/// The tests whose files are renewed.
const BLESSED: [&str; 11] = [
    "bench_scene",
    "goldens",
    "machines",
    "firmware_output",
    "instructions",
    "numerics",
    "gallery",
    "layouts",
    "raystones",
    "stress",
    "readme",
];

/// What can be asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verb {
    Setup,
    Test { long: bool },
    Fuzz { seconds: u32 },
    Studies { quick: bool },
    Speed { quick: bool },
    Planes,
    Paths,
    Bless,
    Report,
    DemoScene,
    BenchScene,
}

impl Verb {
    fn parse(words: &[&str]) -> Option<Self> {
        match *words {
            ["setup"] => Some(Self::Setup),
            ["test"] => Some(Self::Test { long: false }),
            ["test", "--long"] => Some(Self::Test { long: true }),
            ["fuzz"] => Some(Self::Fuzz { seconds: 60 }),
            ["fuzz", "--seconds", seconds] => Some(Self::Fuzz { seconds: seconds.parse().ok()? }),
            ["speed"] => Some(Self::Speed { quick: false }),
            ["speed", "--quick"] => Some(Self::Speed { quick: true }),
            ["studies"] => Some(Self::Studies { quick: false }),
            ["studies", "--quick"] => Some(Self::Studies { quick: true }),
            ["planes"] => Some(Self::Planes),
            ["paths"] => Some(Self::Paths),
            ["bless"] => Some(Self::Bless),
            ["report"] => Some(Self::Report),
            ["demo-scene"] => Some(Self::DemoScene),
            ["bench-scene"] => Some(Self::BenchScene),
            _ => None,
        }
    }
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let Some(verb) = Verb::parse(&words) else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let done = std::env::set_current_dir(&root)
        .map_err(|error| format!("{}: {error}", root.display()))
        .and_then(|()| perform(verb));
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

/// Does what was asked for, in the root of the workspace.
fn perform(verb: Verb) -> Result<(), String> {
    match verb {
        Verb::Setup => tool::provide_all(&[tool::THUMBV6M, tool::RISCV32IMAC, qemu::QEMU]),
        Verb::Test { long } => {
            fuzz::prepare().map_err(|error| format!("tests/fuzz: {error}"))?;
            run(&checks::steps(long)).map(drop)
        }
        Verb::Fuzz { seconds } => {
            fuzz::prepare().map_err(|error| format!("tests/fuzz: {error}"))?;
            let skipped = run(&fuzz::steps(seconds, &[tool::NIGHTLY, tool::CARGO_FUZZ_INSTALLED]))?;
            if skipped == 0 { Ok(()) } else { Err("nothing was fuzzed".into()) }
        }
        Verb::Speed { quick } => {
            let option = if quick { " -- --quick" } else { "" };
            let line = format!("cargo run --quiet --release -p tests --bin speed{option}");
            run(&[Step::new("speed", Task::new(&line))]).map(drop)
        }
        Verb::Studies { quick } => {
            let option = if quick { " -- --quick" } else { "" };
            let line = format!("cargo run --quiet --release -p tests --bin studies{option}");
            run(&[Step::new("studies", Task::new(&line))]).map(drop)
        }
        Verb::Planes => {
            let line = "cargo run --quiet --release -p tests --bin studies -- --planes";
            run(&[Step::new("the tracer of 1994", Task::new(line))]).map(drop)
        }
        Verb::Paths => {
            let line = "cargo run --quiet --release -p tests --bin studies -- --paths";
            run(&[Step::new("paths", Task::new(line))]).map(drop)
        }
        Verb::Bless => run(&[
            Step::new(
                "new goldens",
                Task::new(&format!(
                    "cargo test -p tests --profile checked {}",
                    BLESSED.map(|test| format!("--test {test}")).join(" ")
                ))
                .with("INTRAY_BLESS", "1"),
            ),
            Step::new(
                "the README's example of chips",
                Task::new("cargo test -p chip-fit --profile checked --test readme").with("INTRAY_BLESS", "1"),
            ),
            Step::new("what changed", Task::new("git --no-pager diff --stat -- tests README.md docs")),
            Step::new("what is new", Task::new("git status --short -- tests README.md docs")),
        ])
        .map(drop),
        Verb::Report => {
            let scenes = report_scenes().map_err(|error| format!("scenes/gallery: {error}"))?.join(" ");
            let line = format!("cargo run --quiet --release -- report {scenes} -o docs/report --quick --fresh");
            let renew = Task::new("cargo test -p tests --profile checked --test readme").with("INTRAY_BLESS", "1");
            run(&[Step::new("the report", Task::new(&line)), Step::new("the README's part of it", renew)]).map(drop)
        }
        Verb::DemoScene => demo_scene::write(Path::new("scenes/demo")).map_err(|error| format!("scenes/demo: {error}")),
        Verb::BenchScene => {
            bench_scene::write(Path::new("scenes/bench-1k")).map_err(|error| format!("scenes/bench-1k: {error}"))
        }
    }
}

/// The scenes of `docs/report`: the built-in one, the gallery and the one that other tracers are timed on.
fn report_scenes() -> std::io::Result<Vec<String>> {
    let folders = std::fs::read_dir("scenes/gallery")?.collect::<Result<Vec<_>, _>>()?;
    let mut names: Vec<String> = folders.iter().map(|entry| entry.path().display().to_string()).collect();
    names.sort_unstable();
    let ends = ["scenes/demo".to_owned()].into_iter().chain(names).chain(["scenes/raystones".to_owned()]);
    let mut scenes = Vec::new();
    for scene in ends.map(|folder| format!("{folder}/scene.toml")) {
        // What is drawn by chance has a document of its own: pixel by pixel its grain is compared, and chips take hours for it.
        if !std::fs::read_to_string(&scene)?.lines().any(|line| line.trim() == "paths = true") {
            scenes.push(scene);
        }
    }
    Ok(scenes)
}

/// Runs steps and sums up; how many were skipped.
fn run(steps: &[Step]) -> Result<usize, String> {
    let start = std::time::Instant::now();
    let summary =
        steps::run(steps).map_err(|failure| format!("{}\nrepeat it by: {}", failure.reason, failure.command))?;
    let skipped = summary.skipped.len();
    let list = summary.skipped.join(", ");
    let list = if skipped == 0 { String::new() } else { format!(": {list}") };
    println!("{} steps passed in {:.0} s, {skipped} skipped{list}", summary.passed, start.elapsed().as_secs_f64());
    Ok(skipped)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verbs_are_taken_whole_or_not_at_all() {
        assert_eq!(Verb::parse(&["setup"]), Some(Verb::Setup));
        assert_eq!(Verb::parse(&["test"]), Some(Verb::Test { long: false }));
        assert_eq!(Verb::parse(&["test", "--long"]), Some(Verb::Test { long: true }));
        assert_eq!(Verb::parse(&["fuzz", "--seconds", "5"]), Some(Verb::Fuzz { seconds: 5 }));
        assert_eq!(Verb::parse(&["planes"]), Some(Verb::Planes));
        assert_eq!(Verb::parse(&["paths"]), Some(Verb::Paths));
        assert_eq!(Verb::parse(&["report"]), Some(Verb::Report));
        assert_eq!(Verb::parse(&["speed", "--quick"]), Some(Verb::Speed { quick: true }));
        assert_eq!(Verb::parse(&["studies", "--quick"]), Some(Verb::Studies { quick: true }));
        for wrong in [
            &[][..],
            &["tset"],
            &["test", "--lnog"],
            &["fuzz", "--seconds", "-5"],
            &["bless", "now"],
            &["studies", "now"],
        ] {
            assert_eq!(Verb::parse(wrong), None, "{wrong:?}");
        }
    }
}
