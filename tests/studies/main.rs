//! Measures what the 2009 report claims, and writes docs/STUDIES.md and its plots.
//!
//! `studies [--quick]`: quickly is smaller, and goes to out/studies, so that the document is always of a whole run.
//! `studies --planes` writes docs/PLANES.md, on the tracer of 1994, instead, and `studies --paths` docs/PATHS.md, on paths.

mod study;

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use host_tools::files;
use study::chance::Chance;
use study::machine::Machine;
use study::paths::{Extent, Paths};
use study::planes::{Planes, SIZE as PLANES_SIZE};
use study::{ALL, Page, Setup, document, scenes};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let done = match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => run(false),
        ["--quick"] => run(true),
        ["--planes"] => planes(),
        ["--paths"] => paths(),
        _ => {
            eprintln!("usage: studies [--quick | --planes | --paths]");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(quick: bool) -> Result<(), String> {
    let (size, rounds) = if quick { (128, 1) } else { (1024, 7) };
    let begin = Instant::now();
    let mut subjects = scenes::own(size);
    let (shared, absent) = scenes::shared(size);
    subjects.extend(shared);
    let setup = Setup { size, rounds, subjects, absent };
    let pages: Vec<Page> = ALL
        .iter()
        .enumerate()
        .map(|(place, (title, page))| {
            eprintln!("{:>4.0} s  {} of {}: {title}", begin.elapsed().as_secs_f64(), place + 1, ALL.len());
            page(&setup)
        })
        .collect();
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(if quick { "out/studies" } else { "docs" });
    let plots = root.join("studies");
    std::fs::create_dir_all(&plots).map_err(|error| format!("{}: {error}", plots.display()))?;
    let write = |name: String, text: &str| {
        files::write_atomically(&root.join(name), text.as_bytes()).map_err(|error| error.to_string())
    };
    for page in &pages {
        if let Some(plot) = &page.plot {
            write(format!("studies/{}.svg", page.name), plot)?;
        }
    }
    write("STUDIES.md".into(), &document(&setup, &pages))?;
    eprintln!("{:>4.0} s  written: {}", begin.elapsed().as_secs_f64(), root.join("STUDIES.md").display());
    Ok(())
}

/// The tracer of 1994, which is quickly measured.
fn planes() -> Result<(), String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let (figures, chance) = (Planes::measure(PLANES_SIZE), Chance::measure());
    let machine = Machine::measure(PLANES_SIZE);
    let write =
        |name: &str, bytes: &[u8]| files::write_atomically(&root.join(name), bytes).map_err(|error| error.to_string());
    write("PLANES.md", (figures.document() + &chance.document() + &machine.document()).as_bytes())?;
    write("studies/planes-machine.svg", machine.plot().as_bytes())?;
    write("studies/planes.svg", figures.plot().as_bytes())?;
    for (picture, name) in figures.pictures.iter().zip(["literal", "nearest"]) {
        let path = root.join(format!("studies/planes-{name}.png"));
        picture.write_png(&path).map_err(|error| error.to_string())?;
    }
    Ok(())
}

/// Paths, by every kernel: some minutes, most of them the reference's.
fn paths() -> Result<(), String> {
    let begin = Instant::now();
    let figures =
        Paths::measure(Extent::whole(), &|what| eprintln!("{:>4.0} s  {what}", begin.elapsed().as_secs_f64()));
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let write = |name: &str, text: &str| {
        files::write_atomically(&root.join(name), text.as_bytes()).map_err(|error| error.to_string())
    };
    write("PATHS.md", &figures.document())?;
    write("studies/paths.svg", &figures.plot())
}
