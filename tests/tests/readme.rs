//! The README's pictures and figures are what the program and the chips make. `INTRAY_BLESS=1` renews them.
//!
//! The chips' are skipped, with a line that says so, where they cannot be emulated, or where the compiler is another than
//! the one that the README names: instructions and sizes are the compiler's.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::time::{Duration, Instant};

use core_rt::profile::{Need, Needs, Prefer};
use core_rt::stats::Counts;
use firmware_rt::board::{BOARDS, Board, HIFIVE1, MICROBIT};
use host_tools::compare::compare;
use host_tools::emulate::counter::Counter;
use host_tools::emulate::firmware::{self, Wanted};
use host_tools::emulate::machine::Machine;
use host_tools::emulate::probe::{DRAWING, EMPTY, Probe, SMALLEST, WHITTED, WHOLE, alone};
use host_tools::emulate::{self, Run};
use host_tools::engine::{self, ENGINES};
use host_tools::import::{self, Embedded};
use host_tools::model::Model;
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::reference::Reference;
use host_tools::render::Rendered;
use host_tools::report::row::{Cost, Measured, Outcome, Point, Row, Study};
use host_tools::report::{self, Report, page};
use host_tools::{builtin, files};
use tests::documents::{README, check_part, compiler, document, generated, is_blessing, root};

/// Checks a picture of the README, or renews it.
fn check_picture(name: &str, picture: &Picture) {
    if is_blessing() {
        picture.write_png(&root(name)).expect("it can be written");
    }
    let stored = Picture::read_png(&root(name)).expect("the README's picture");
    assert!(stored == *picture, "{name} is not what the program renders; INTRAY_BLESS=1 renews it");
}

fn built_in(size: [u32; 2]) -> Model {
    let mut model = import::load_from(&Embedded(builtin::FILES), "scene.toml").expect("the built-in scene").model;
    model.render.size = size;
    model
}

#[test]
fn the_readme_shows_what_the_program_makes() {
    let mut table = String::from(
        "| kernel | picture | blob, bytes | over 1 | over 4 | over 64 | PSNR, dB |\n| --- | --- | --- | --- | --- | --- | --- |\n",
    );
    let mut shown = None;
    for size in [[640, 480], [160, 128]] {
        let model = built_in(size);
        let [width, height] = size;
        let truth = Reference::new(&model).picture(&|_| {});
        for engine in ENGINES {
            let blob = engine.prepare(&model, &Options::default()).expect("it fits").blob;
            let picture = engine.render(blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture;
            let apart = compare(&picture, &truth).expect("one size");
            let (name, bytes, psnr) = (engine.name(), blob.bytes().len(), apart.psnr.unwrap_or(f64::INFINITY));
            writeln!(
                table,
                "| `{name}` | {width}x{height} | {bytes} | {} | {} | {} | {psnr:.1} |",
                apart.over_1, apart.over_4, apart.over_64
            )
            .expect("a string takes text");
            shown.get_or_insert(picture);
        }
    }

    check_part(README, "figures", &table, |stored, found| stored == found);
    check_picture("docs/demo.png", &shown.expect("there are kernels"));
}

/// A row of the table of needs: a size for each board.
fn sizes_row(name: &str, size: &mut dyn FnMut(&'static Board) -> String) -> String {
    format!("| {name} | {} |\n", SIZED.map(size).join(" | "))
}

/// The boards of the table of needs.
const SIZED: [&Board; 2] = [&MICROBIT, &HIFIVE1];

#[test]
fn the_readme_says_what_needs_take() {
    if let Some(error) = SIZED.into_iter().find_map(|board| firmware::check_board(board).err()) {
        println!("skipped: {error}");
        return;
    }
    let is_other = !generated(&document(README), "needs").expect("the README has the marks").contains(&compiler());
    if is_other && !is_blessing() {
        println!("skipped the sizes of needs: they are those of another compiler");
        return;
    }
    // Most are asked for many times: the smallest with each need.
    let mut known = BTreeMap::new();
    let mut size = |board: &'static Board, program: &'static str, needs: Needs| -> i64 {
        *known.entry((board.name, program, needs.bits())).or_insert_with(|| {
            let probe = Probe { board, program, prefer: Prefer::Size, blob: None, needs: Some(needs) };
            probe.provide().expect("it can be built").text_bytes.cast_signed()
        })
    };
    let mut table = format!(
        "By {}, `exact14`, for size (`firmware-small`).\n\n| bytes of code and constants | {} |\n| --- | --- | --- |\n",
        compiler(),
        SIZED.map(|board| board.name).join(" | "),
    );
    for (name, needs) in [("the smallest profile", SMALLEST), ("all that light may need", WHITTED)] {
        for (program, checks) in [(DRAWING, ""), (WHOLE, ", with the blob's check")] {
            let mut own = |board| {
                (size(board, program, needs) - size(board, EMPTY, Needs::NONE.with(Need::Rgb888, true))).to_string()
            };
            table += &sizes_row(&format!("{name}{checks}"), &mut own);
        }
    }
    for need in Need::ALL {
        if let Some([without, with]) = alone(need) {
            let mut added = |board| format!("{:+}", size(board, WHOLE, with) - size(board, WHOLE, without));
            table += &sizes_row(&need.to_string(), &mut added);
        }
    }
    check_part(README, "needs", &table, |stored, found| stored == found);
}

/// The report of the gallery, as it is stored.
fn report() -> Report {
    let bytes = files::read(&root("docs/report/report.json")).expect("the gallery's report");
    serde_json::from_slice(&bytes).expect("a report of this schema")
}

/// What was measured of the built-in scene by a kernel as it comes.
fn measured<'a>(report: &'a Report, kernel: &str, machine: report::row::Machine) -> &'a Measured {
    let is_it = |row: &&Row| {
        let Point { scene, study, kernel: other, machine: on, size, .. } = &row.point;
        (scene.as_str(), *study, other.as_str(), *on, *size) == ("demo", Study::Kernels, kernel, machine, CHIP_SIZE)
    };
    match report.rows.iter().find(is_it).map(|row| &row.outcome) {
        Some(Outcome::Measured(measured)) => measured,
        other => panic!("{kernel} on {machine:?}: {other:?}"),
    }
}

/// How a stored report that is of other code is brought up to date.
const STALE: &str = "docs/report is of other code; `cargo xtask report` renews it";

#[test]
fn the_readme_says_what_the_report_says() {
    let report = report();
    let (of_all, of_scenes) = page::in_words(&report);
    assert!(!of_all.is_empty() && of_scenes.len() > 1, "the gallery has several scenes");
    let (_, built_in_scene) = of_scenes.iter().find(|(scene, _)| scene == "demo").expect("the built-in scene");
    let lines: String = built_in_scene.iter().chain(&of_all).map(|sentence| format!("- {sentence}\n")).collect();
    check_part(README, "headline", &lines, |stored, found| stored == found);

    let model = built_in(CHIP_SIZE);
    for engine in ENGINES {
        let blob = engine.prepare(&model, &Options::default()).expect("it fits").blob;
        let picture = engine.render(blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture;
        let stored = measured(&report, engine.name(), report::row::Machine::Host);
        assert_eq!(stored.image_crc32, format!("{:08x}", picture.crc32()), "{}: {STALE}", engine.name());
        assert_eq!(stored.blob_bytes, blob.bytes().len() as u64, "{}: {STALE}", engine.name());
    }
}

/// The size of the default firmware's picture.
const CHIP_SIZE: [u32; 2] = [160, 120];

const LIMIT: Duration = Duration::from_secs(300);

/// The boards, with what counts their instructions; says in one line why there is none.
fn countable() -> Option<Vec<(&'static Board, Counter)>> {
    let counter = |board: &'static Board| {
        emulate::check(board).map_err(|error| error.to_string())?;
        Ok((board, Counter::provide(&Machine::of(board).map_err(|error| error.to_string())?)?))
    };
    let all: Result<_, String> = BOARDS.into_iter().filter(|board| Machine::of(board).is_ok()).map(counter).collect();
    all.inspect_err(|reason| println!("skipped the chips' figures: {reason}")).ok()
}

/// The cell of a row that has the bytes of code, counted from the line's start.
const CODE: usize = 7;

/// How much code may differ: the panics of crates name their sources, by the path at which cargo keeps them.
const PATHS: usize = 256;

/// Whether two of the chips' tables are the same, but for what paths do to the size of the code.
fn is_same_but_for_paths(a: &str, b: &str) -> bool {
    let is_same_line = |(a, b): (&str, &str)| {
        let [mut a, mut b] = [a, b].map(|line| line.split('|').map(str::trim).collect::<Vec<_>>());
        let code = |cells: &[&str]| cells.get(CODE).and_then(|cell| cell.parse::<usize>().ok());
        if let (Some(x), Some(y)) = (code(&a), code(&b))
            && x.abs_diff(y) <= PATHS
        {
            a[CODE] = "";
            b[CODE] = "";
        }
        a == b
    };
    a.lines().count() == b.lines().count() && a.lines().zip(b.lines()).all(is_same_line)
}

/// A row of the chips' table, and the chip's picture, which is the host's.
fn row(board: &'static Board, counter: &Counter, kernel: &str, blob: &[u8], host: &Rendered) -> (String, Picture) {
    let elf = Wanted { board, blob, hits: None, count: false }.provide().expect("it can be built");
    let begin = Instant::now();
    let run = Run { board, elf: &elf, blob: Some(blob), counter: Some(counter), limit: LIMIT };
    let outcome = run.perform(&mut Vec::new()).expect("it goes well");
    println!("{kernel} on {}: {:.1} s", board.name, begin.elapsed().as_secs_f64());
    assert!(outcome.picture == host.picture, "{kernel} on {}", board.name);
    let Counts { box_tests, triangle_tests, .. } = host.counts;
    let per_ray = |count: u64| count as f64 / host.counts.rays() as f64;
    let instructions = outcome.counts.expect("they were counted").instructions;
    let chips = [report::row::Machine::Rv32imac, report::row::Machine::Thumbv6m];
    let machine = chips.into_iter().find(|chip| chip.board() == Some(board)).expect("every board is in the report");
    match &measured(&report(), kernel, machine).cost {
        // As much as instructions may grow before the guard of `instructions` asks for a look.
        Cost::Instructions(stored) => {
            let apart = stored.instructions.abs_diff(instructions);
            assert!(
                apart * 100 <= instructions,
                "{kernel}, {machine:?}: {} and {instructions}: {STALE}",
                stored.instructions
            );
        }
        Cost::Time(_) => panic!("the cost of a chip is in instructions"),
    }
    let ram = elf.static_bytes + u64::from(outcome.report.stack_bytes);
    let row = format!(
        "| {} | `{kernel}` | {:.0} | {:.1} | {:.1} | {ram} | {} | {} |\n",
        board.name,
        per_ray(instructions),
        per_ray(box_tests),
        per_ray(triangle_tests),
        elf.text_bytes,
        blob.len(),
    );
    (row, outcome.picture)
}

#[test]
fn the_readme_shows_what_the_chips_make() {
    let Some(boards) = countable() else { return };
    let [width, height] = CHIP_SIZE;
    let mut table = format!(
        "{width}x{height} pixels, firmware by {}.\n\n\
         | board | kernel | instructions a ray | box tests a ray | triangle tests a ray | RAM, bytes | code, bytes | blob, \
         bytes |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n",
        compiler()
    );
    let is_other = !generated(&document(README), "chips").expect("the README has the marks").contains(&compiler());
    if is_other && !is_blessing() {
        println!("skipped the chips' figures: they are those of another compiler");
        return;
    }
    let model = built_in(CHIP_SIZE);
    let all: Vec<_> = ["exact14", "exact29", "f32"]
        .into_iter()
        .map(|kernel| {
            let engine = engine::by_name(kernel).expect("a kernel of this name");
            let blob = engine.prepare(&model, &Options::default()).expect("it fits").blob;
            let host = engine.render(blob.bytes(), [16, 16], &|_| {}).expect("a blob just made");
            (kernel, blob, host)
        })
        .collect();
    // Side by side: each board has a process of its own.
    let all = &all;
    let made: Vec<(String, Picture)> = std::thread::scope(|scope| {
        let rows = |(board, counter)| {
            scope.spawn(move || -> Vec<_> {
                all.iter().map(|(kernel, blob, host)| row(board, counter, kernel, blob.bytes(), host)).collect()
            })
        };
        let threads: Vec<_> = boards.iter().map(|(board, counter)| rows((*board, counter))).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("pictures like the host's")).collect()
    });
    table.extend(made.iter().map(|(row, _)| row.as_str()));
    check_part(README, "chips", &table, is_same_but_for_paths);
    check_picture("docs/host.png", &all[0].2.picture);
    check_picture("docs/chip-microbit.png", &made[0].1);
}

#[test]
fn other_figures_of_a_chip_are_seen_and_other_paths_are_not() {
    let row =
        "| board | kernel | instructions |\n| microbit | `exact14` | 5000 | 22.1 | 7.4 | 4004 | 36276 | 77336 |\n";
    assert!(is_same_but_for_paths(row, row));
    assert!(is_same_but_for_paths(row, &row.replace("36276", "36300")));
    for (old, new) in [("36276", "36800"), ("5000", "5001"), ("4004", "4008"), ("77336", "77344"), ("\n", "\n\n")] {
        assert!(!is_same_but_for_paths(row, &row.replace(old, new)), "{old}");
    }
}
