//! Instructions by part of the program and by kind of ray: all are in some cell, the same on every run, and in the cell that
//! the names of functions speak for.
//!
//! Boards for which QEMU or the compiler's library is absent are skipped, with a line that says so.

use std::path::Path;
use std::time::Duration;

use firmware_rt::board::Board;
use host_tools::emulate::breakdown::{Breakdown, KINDS};
use host_tools::emulate::counter::Counter;
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware::Wanted;
use host_tools::emulate::parts::{PARTS, Part, Range};
use host_tools::emulate::{Outcome, Run};
use host_tools::engine;
use host_tools::import;
use host_tools::model::Model;
use host_tools::prepare::Options;
use object::read::elf::ElfFile32;
use object::{Endianness, Object, ObjectSymbol, SymbolKind};
use tests::boards::{boards, counted};
use tests::scenes;

const LIMIT: Duration = Duration::from_secs(120);

fn prepared(model: &Model, kernel: &str) -> Vec<u8> {
    let engine = engine::by_name(kernel).expect("a kernel of this name");
    engine.prepare(model, &Options::default()).expect("it fits").blob.bytes().to_vec()
}

/// Spheres that mirror and let through, small.
fn spheres() -> Model {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/gallery/spheres/scene.toml");
    let mut model = import::load(&path).expect("a scene of the gallery").model;
    model.render.size = [24, 18];
    model
}

fn demo() -> Model {
    let mut model = scenes::named("demo", [24, 18]).expect("the built-in scene");
    model.render.size = [24, 18];
    model
}

fn run(board: &Board, elf: &Elf, blob: &[u8], counter: Option<&Counter>) -> Outcome {
    Run { board, elf, blob: Some(blob), counter, limit: LIMIT }.perform(&mut Vec::new()).expect("it goes well")
}

/// The breakdown, with what it was made of: counts with marks, and instructions without them.
fn broken_down(board: &'static Board, counter: &Counter, model: &Model, kernel: &str) -> (Breakdown, u64, u64) {
    let blob = prepared(model, kernel);
    let wanted = Wanted { board, blob: &blob, hits: None, count: false };
    let plain = run(board, &wanted.provide().expect("it can be built"), &blob, Some(counter));
    let marked = run(board, &wanted.provide_marked().expect("it can be built"), &blob, Some(&counter.by_part()));
    assert_eq!(plain.picture, marked.picture);
    let counting = Wanted { count: true, ..wanted }.provide().expect("it can be built");
    let work = run(board, &counting, &blob, None).report;
    let rays = [work.primary_rays, work.shadow_rays, work.reflection_rays, work.refraction_rays];
    let [plain, marked] = [plain, marked].map(|outcome| outcome.counts.expect("it was counted"));
    let breakdown = Breakdown::new(&marked, plain.instructions, rays).expect("it has marks");
    (breakdown, marked.instructions, plain.instructions)
}

#[test]
fn every_instruction_is_in_one_cell() {
    for (board, counter) in counted() {
        for (model, kernel) in [(demo(), "exact14"), (spheres(), "exact14"), (spheres(), "f32")] {
            let (breakdown, marked, plain) = broken_down(board, &counter, &model, kernel);
            println!("{} {kernel}\n{}", board.name, breakdown.table());
            let cells = KINDS.iter().flat_map(|kind| PARTS.map(|part| (*kind, part)));
            let sum: u64 = cells.map(|(kind, part)| breakdown.of(kind, part)).sum();
            assert_eq!((sum, breakdown.instructions), (marked, marked), "{} {kernel}", board.name);
            assert_eq!(breakdown.added, marked as i64 - plain as i64);
            // Marks are calls of functions of two instructions, and little is moved for them.
            assert!(breakdown.added.unsigned_abs() * 50 < plain, "{} of {plain}", breakdown.added);
            for row in &breakdown.kinds {
                assert_eq!(row.rays > 0, row.instructions > 0, "{}", row.kind);
                // A part that no ray could do without.
                assert_eq!(row.rays > 0, breakdown.of(row.kind, Part::Traversal) > 0, "{}", row.kind);
            }
            // A shadow ray runs through the mark of its beginning, and to that of its end.
            let shadow = &breakdown.kinds[1];
            assert!(breakdown.of(shadow.kind, Part::Marks) >= 2 * shadow.rays);
            assert_eq!(broken_down(board, &counter, &model, kernel).0, breakdown, "a second run");
        }
    }
}

#[test]
fn without_lights_there_are_no_shadows() {
    for (board, counter) in counted() {
        let mut model = scenes::matt(demo());
        model.lights.clear();
        let (breakdown, ..) = broken_down(board, &counter, &model, "exact14");
        let sums: Vec<u64> = breakdown.kinds.iter().map(|row| row.instructions).collect();
        assert_eq!(sums, [breakdown.instructions, 0, 0, 0], "{}", board.name);
    }
}

/// Functions that are not inlined, by their names, and what their code is for.
const KNOWN: [(&str, Option<Part>); 6] = [
    ("::leaf_in::", Some(Part::Traversal)),
    ("core_rt::exact::triangle::filtered", Some(Part::Intersection)),
    ("core_rt::space::grid14::normalise", Some(Part::Shading)),
    ("core_rt::camera::sum_2x", Some(Part::Rays)),
    ("intray_shadow", Some(Part::Marks)),
    ("memcpy", None),
];

/// What is wrong with the parts of a firmware whose functions are known: most of a function's bytes must be for what it is
/// for; the rest may be inlined from elsewhere.
fn complaints(elf: &Elf, parts: &[Range]) -> Vec<String> {
    let file = ElfFile32::<Endianness>::parse(elf.bytes()).expect("an ELF");
    let mut wrong = Vec::new();
    for (known, expected) in KNOWN {
        let mut found = 0;
        for symbol in file.symbols().filter(|symbol| symbol.kind() == SymbolKind::Text && symbol.size() > 0) {
            let name = format!("{}", rustc_demangle::demangle(symbol.name().unwrap_or_default()));
            if !name.contains(known) {
                continue;
            }
            found += 1;
            let (start, size) = (symbol.address() & !1, symbol.size());
            let overlap =
                |range: &Range| (range.start + range.size).min(start + size).saturating_sub(range.start.max(start));
            let right: u64 = parts.iter().filter(|range| range.part == expected).map(overlap).sum();
            if right * 2 <= size {
                wrong.push(format!("{name}: {right} of {size} bytes are for {expected:?}"));
            }
        }
        if found == 0 {
            wrong.push(format!("there is no {known}"));
        }
    }
    wrong
}

#[test]
fn functions_are_for_what_their_names_say_and_an_exchange_is_noticed() {
    for board in boards() {
        let blob = prepared(&spheres(), "exact14");
        let wanted = Wanted { board, blob: &blob, hits: None, count: false };
        let elf = wanted.provide_marked().expect("it can be built");
        let parts = elf.parts().expect("it has debug information");
        assert_eq!(complaints(&elf, &parts), [""; 0], "{}", board.name);
        // Each part exchanged with the next.
        for pair in PARTS[..5].windows(2) {
            let exchanged: Vec<Range> = parts
                .iter()
                .map(|range| {
                    let part = range.part.map(|part| match part {
                        part if part == pair[0] => pair[1],
                        part if part == pair[1] => pair[0],
                        part => part,
                    });
                    Range { part, ..*range }
                })
                .collect();
            assert!(complaints(&elf, &exchanged).len() >= 2, "{pair:?}");
        }
        // And code that is for whoever calls it, counted for itself.
        let claimed: Vec<Range> =
            parts.iter().map(|range| Range { part: range.part.or(Some(Part::Other)), ..*range }).collect();
        assert!(!complaints(&elf, &claimed).is_empty());
    }
}

#[test]
fn the_innermost_file_that_says_so_decides() {
    let of = |files: &[&str]| Part::of(files.iter().copied());
    let (num, core) = ("/a/core-rt/src/num/mod.rs", "/rustc/core/src/num/mod.rs");
    assert_eq!(of(&[core, num, "/a/core-rt/src/exact/boxes.rs", "/a/core-rt/src/bvh.rs"]), Some(Part::Traversal));
    assert_eq!(of(&[num, "/a/core-rt/src/exact/triangle.rs", "/a/core-rt/src/bvh.rs"]), Some(Part::Intersection));
    assert_eq!(of(&[num, "/a/core-rt/src/space/grid14.rs", "/a/core-rt/src/exact/resolve.rs"]), Some(Part::Shading));
    assert_eq!(of(&[r"C:\a\core-rt\src\exact\ray.rs", "/a/core-rt/src/light.rs"]), Some(Part::Rays));
    // Arithmetic alone, another crate's file of the same name, nothing.
    for files in [&[core, num][..], &["/x/other-1.0/src/sphere.rs"], &[]] {
        assert_eq!(of(files), None, "{files:?}");
    }
}
