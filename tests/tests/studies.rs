//! The studies of the 2009 report: their figures are the same on every run, their sentences follow from the figures, and
//! the document is of the scenes as they are.

#[path = "../studies/study/mod.rs"]
mod study;

use std::path::Path;

use core_rt::exact::Exact29;
use core_rt::kernel::{Bounds, Kernel, NONE};
use core_rt::profile::Full;
use core_rt::scene::Scene;
use host_tools::files;
use host_tools::prepare::{Options, prepare};
use host_tools::tree::TreeOptions;
use study::chance::Chance;
use study::degenerates::{self, Degenerates};
use study::edge_shift::{self, EdgeShift, Thinnest};
use study::leaf_threshold::{LeafThreshold, Row};
use study::machine::Machine;
use study::paths::{Extent, Paths};
use study::planes::{self, Planes};
use study::scenes::{self, Subject};
use study::seams::{self, Seams};
use study::text::Verdict;
use study::{ALL, Setup, Study, c_and_d, document, epsilon, kernels, leaf_bounds};

/// Two small scenes, small, and no time.
fn tiny() -> Setup {
    let subjects =
        scenes::own(24).into_iter().filter(|subject| ["bench-1k", "inside"].contains(&subject.name.as_str()));
    Setup { size: 24, rounds: 0, subjects: subjects.collect(), absent: vec!["somewhere"] }
}

/// Whether a table's lines have one number of cells each, as far as there are tables.
fn tables_are_whole(text: &str) -> bool {
    let lines: Vec<&str> = text.lines().collect();
    let cells = |line: &str| line.matches(" | ").count();
    let is_row = |line: &str| line.starts_with("| ");
    lines.windows(2).all(|pair| !is_row(pair[0]) || !is_row(pair[1]) || cells(pair[0]) == cells(pair[1]))
}

#[test]
fn a_whole_run_has_every_study_and_is_repeated_bit_for_bit() {
    let run = || {
        let setup = tiny();
        let pages: Vec<_> = ALL.iter().map(|(_, page)| page(&setup)).collect();
        let plots: Vec<_> = pages.iter().filter_map(|page| Some((page.name, page.plot.clone()?))).collect();
        (document(&setup, &pages), plots)
    };
    let (text, plots) = run();
    for (title, _) in ALL {
        assert!(text.contains(&format!("## {title}\n")), "{title}");
    }
    assert!(text.contains("absent: somewhere"));
    assert!(text.matches("**Holds**").count() + text.matches("**Does not hold**").count() >= 2 * ALL.len());
    assert!(tables_are_whole(&text), "{text}");
    assert!(!tables_are_whole("| a | b |\n| --- |\n"));
    assert_eq!(plots.len(), 3);
    for (name, plot) in &plots {
        assert!(
            plot.starts_with("<svg") && plot.ends_with("</svg>\n") && text.contains(&format!("(studies/{name}.svg)"))
        );
    }
    let again = run();
    assert!(again.0 == text && again.1 == plots);
}

#[test]
fn only_pictures_of_the_reports_kernels_may_vary_with_the_leaf_threshold() {
    let study = LeafThreshold::measure(&tiny());
    let exact: Vec<&Row> = study.rows.iter().filter(|row| row.is_exact).collect();
    assert_eq!(exact.iter().map(|row| row.kernel).collect::<Vec<_>>(), ["exact29", "exact20", "exact14"]);
    for row in exact {
        assert!(row.changed.iter().all(|&changed| changed == 0) && row.over_64.iter().all(|&n| n == row.over_64[0]));
    }
    assert!(study.rows.iter().all(|row| row.times.iter().all(Option::is_none)));
}

fn holding(verdicts: &[Verdict]) -> Vec<bool> {
    verdicts.iter().map(|verdict| verdict.holds).collect()
}

/// Figures as the report has them, and figures that contradict every claim.
#[test]
fn sentences_follow_from_the_figures() {
    let c_and_d = |over_64: [Vec<u64>; 3], duel: f64| {
        let [plain, refined, other] = over_64;
        let cell = |bits, over_64| c_and_d::Cell { bits, over_64, times: vec![None; 2] };
        let cells = vec![cell([12, 12], plain), cell([15, 9], refined), cell([18, 12], other)];
        let names = vec!["a".into(), "b".into()];
        holding(&c_and_d::CAndD { scenes: names, cells, duels: vec![Some(duel); 2] }.verdicts())
    };
    assert_eq!(c_and_d([vec![9, 0], vec![3, 0], vec![4, 0]], 1.01), [true; 3]);
    assert_eq!(c_and_d([vec![9, 0], vec![3, 1], vec![0, 0]], 1.03), [false; 3]);
    assert_eq!(c_and_d([vec![0, 0], vec![0, 0], vec![0, 0]], 1.0), [false, true, true], "nothing shows nothing");

    let threshold = |counts: [u64; 2], time: f64, changed: u64| {
        let row = |kernel, is_exact| Row {
            kernel,
            is_exact,
            over_64: counts.to_vec(),
            changed: vec![0, changed],
            times: vec![Some(1.0), Some(time)],
        };
        let rows = vec![row("hanika-c", false), row("hanika-cd", false), row("exact29", true)];
        holding(&LeafThreshold { rows }.verdicts())
    };
    assert_eq!(threshold([497, 111], 2.0, 0), [true; 4]);
    assert_eq!(threshold([111, 111], 0.9, 1), [false; 4]);

    let bounds = |last: [u64; 2], cons: u64| {
        let over_64 = vec![[100, 50, cons, 0], [last[0], last[1], cons, 0]];
        holding(&leaf_bounds::LeafBounds { over_64 }.verdicts())
    };
    assert_eq!(bounds([50, 25], 50), [true; 3]);
    assert_eq!(bounds([51, 26], 51), [false; 3]);

    let epsilon = |hits_below: usize, widths: [f64; 2], exact: u64| {
        let errors = |place: usize| epsilon::Errors {
            self_hits: u64::from(place < hits_below),
            rays: 10,
            leaks: 1,
            width: widths[usize::from(place == 15)],
        };
        let fixed = [epsilon::Errors { self_hits: exact, ..Default::default() }; 3];
        holding(&epsilon::Epsilon { set: (0..16).map(|place| [errors(place); 3]).collect(), fixed }.verdicts())
    };
    assert_eq!(epsilon(1, [2.0, 9.0], 0), [true; 4]);
    assert_eq!(epsilon(5, [2.0, 9.0], 0), [false, true, true, true]);
    assert_eq!(epsilon(6, [2.0, 2.0], 1), [false; 4]);
    assert_eq!(epsilon(16, [2.0, 2.0], 1), [false; 4], "never enough");

    let edge_shift = |own: u8, at_10: u64, own_over_64: u64| {
        let forced_by = Thinnest { prim: 0, edge: 1, normal: 1 };
        let mut fixed = vec![5; 16];
        fixed[7] = at_10;
        holding(
            &EdgeShift { rows: vec![edge_shift::Row { scene: "a".into(), fixed, own, own_over_64, forced_by }] }
                .verdicts(),
        )
    };
    assert_eq!(edge_shift(7, 9, 5), [true; 3]);
    assert_eq!(edge_shift(13, 6, 6), [false; 3]);

    let seams = |holes: [u64; 4]| {
        let names = ["hanika-c", "hanika-cd", "hanika-cons", "exact29"];
        let rows = names.into_iter().zip(holes.map(|count| vec![count])).collect();
        holding(&Seams { meshes: vec!["a".into()], rows, open: Vec::new() }.verdicts())
    };
    assert_eq!(seams([10, 2, 0, 0]), [true; 3]);
    assert_eq!(seams([10, 10, 5, 1]), [false; 3]);

    let degenerates = |zero_edge: u64| {
        let counts = vec![degenerates::Count { zero_edge, zero_area: 0 }];
        holding(&Degenerates { rows: vec![degenerates::Row { scene: "a".into(), triangles: 9, counts }] }.verdicts())
    };
    assert_eq!(degenerates(4), [true; 2]);
    assert_eq!(degenerates(3), [true, false]);
    assert_eq!(degenerates(0), [false; 2]);
    let verdict = |holds| Verdict { claim: "so it is", holds, because: "1 of 2".into() }.to_string();
    assert_eq!(verdict(true), "**Holds**: so it is (1 of 2).");
    assert_eq!(verdict(false), "**Does not hold**: so it is (1 of 2).");
}

/// The study's own count is the kernel's: no scene forces another shift than the triangle that is named.
#[test]
fn the_thinnest_triangle_forces_the_kernels_edge_shift() {
    for (name, model) in tests::scenes::all() {
        let blob = kernels::blob("hanika-cd", &model, &Options::default());
        let engine = host_tools::engine::by_name("hanika-cd").expect("a kernel of this name");
        let header = engine.inspect(blob.bytes()).expect("a blob just made").0;
        let found = edge_shift::thinnest(&model).expect("there are triangles");
        assert_eq!(found.edge_shift(), header.arithmetic.edge_shift, "{name}: {found:?}");
    }
}

#[test]
fn closed_meshes_are_told_from_open_ones_and_a_missing_triangle_is_a_hole() {
    let mut model = tests::scenes::inside(9);
    model.render.size = [48; 2];
    let seen = |model: &host_tools::model::Model| {
        let exact = kernels::by_name("exact29");
        (exact.seen)(&kernels::blob(exact.name, model, &Options::default()))
    };
    assert_eq!((seams::open_edges(&model), seams::open_edges(&scenes::columns())), (0, 0));
    assert_eq!(seams::open_edges(&scenes::spheres()), 0);
    let mut found = seen(&model);
    assert_eq!(seams::holes(&model, &found), 0);
    // What the middle sees is taken for nothing, and for something far off.
    let middle = 24 * 48 + 24;
    let missing = found[middle];
    found[middle] = NONE;
    let holes = seams::holes(&model, &found);
    assert_eq!(holes, 1);
    found[middle] = (missing + 324) % 648;
    assert_eq!(seams::holes(&model, &found), 1);
    model.triangles.remove(missing as usize);
    assert_eq!(seams::open_edges(&model), 3);
}

/// A mesh whose own shadow rays it may not block: every corner is on or behind the plane of every face.
#[test]
fn meshes_for_self_hits_are_convex_and_closed() {
    let snapped = |model: &host_tools::model::Model| -> Vec<[[i32; 3]; 3]> {
        let grid = host_tools::grid::Grid::fit::<Exact29>(model).expect("it fits");
        grid.snap(model).iter().collect()
    };
    for model in epsilon::convex() {
        assert_eq!(seams::open_edges(&model), 0);
        let triangles = snapped(&model);
        let corners: std::collections::BTreeSet<[i32; 3]> = triangles.iter().flatten().copied().collect();
        for &[a, b, c] in &triangles {
            let from = |to: [i32; 3]| [0, 1, 2].map(|axis| i128::from(to[axis] - a[axis]));
            let (e1, e2) = (from(b), from(c));
            let normal = [e1[1] * e2[2] - e1[2] * e2[1], e1[2] * e2[0] - e1[0] * e2[2], e1[0] * e2[1] - e1[1] * e2[0]];
            let above = |&corner: &[i32; 3]| from(corner).iter().zip(normal).map(|(p, n)| p * n).sum::<i128>() > 0;
            assert!(!corners.iter().any(above), "{} triangles", triangles.len());
        }
    }
}

/// An origin on the wrong side is a leak, and the reference alone has none.
#[test]
fn leaks_grow_with_epsilon() {
    let errors = |epsilon: u8| {
        let knobs = core_rt::arithmetic::Knobs { epsilon: Some(epsilon), ..Default::default() };
        let scale = kernels::scale("hanika-cd", &epsilon::room(16384.0));
        let mut room = epsilon::room(scale);
        room.render.size = [64; 2];
        let picture = kernels::picture("hanika-cd", &room, &Options { knobs, ..Options::default() });
        let dark = host_tools::picture::Picture::new(64, 64);
        assert_eq!(epsilon::leaks(&room, &dark, scale), (0, 0.0));
        epsilon::leaks(&room, &picture, scale)
    };
    let [near, far] = [2, 16].map(errors);
    assert!(near.0 > 0 && far.0 > 2 * near.0 && far.1 > 2.0 * near.1, "{near:?} {far:?}");
}

/// Larger boxes are accepted, and larger; what loses no hit does not see them.
#[test]
fn larger_leaves_hold_what_they_held() {
    let subject: Subject = scenes::own(32).swap_remove(1);
    for by in [0, 5, 1 << 20] {
        let options = leaf_bounds::options(&subject.model, by);
        let blob = prepare::<Exact29>(&subject.model, &options).expect("it fits").blob;
        let scene = Scene::<Full<Exact29>>::new_checked(blob.bytes()).expect("parents contain children");
        let none = Options { tree: TreeOptions { leaf_growth: None, ..options.tree }, ..options };
        let plain = prepare::<Exact29>(&subject.model, &none).expect("it fits").blob;
        let plain_scene = Scene::<Full<Exact29>>::new_checked(plain.bytes()).expect("a blob just made");
        let mut larger = 0;
        for (grown, own) in scene.bvh.nodes.iter().zip(plain_scene.bvh.nodes) {
            let pairs: [(Bounds, Bounds); 2] =
                [0, 1].map(|child| (Exact29::boxes(grown)[child], Exact29::boxes(own)[child]));
            assert!(pairs.iter().all(|(grown, own)| grown.contains(own)));
            larger += pairs.iter().filter(|(grown, own)| grown != own).count();
        }
        assert_eq!(larger > 0, by > 0);
        assert!(kernels::drawn("exact29", &blob) == kernels::drawn("exact29", &plain));
    }
}

/// The rows of the document that cost little are made again.
#[test]
fn the_document_is_of_the_scenes_as_they_are() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/STUDIES.md");
    let text = String::from_utf8(files::read(&path).expect("the document")).expect("it is text");
    let (shared, absent) = scenes::shared(8);
    let subjects = scenes::own(8).into_iter().chain(shared).collect();
    let setup = Setup { size: 8, rounds: 0, subjects, absent };
    let made = Degenerates::measure(&setup).tables();
    let is_row = |line: &&str| setup.subjects.iter().any(|subject| line.starts_with(&format!("| {} |", subject.name)));
    let rows: Vec<&str> = made.lines().filter(is_row).collect();
    assert_eq!(rows.len(), 3 * setup.subjects.len());
    let stale = |text: &str| rows.iter().find(|row| !text.lines().any(|line| line == **row)).copied();
    assert_eq!(stale(&text), None, "docs/STUDIES.md: `cargo xtask studies` renews it");
    assert_eq!(stale(&text.replace(rows[0], "")), Some(rows[0]));
    for (title, _) in ALL {
        assert!(
            text.contains(&format!("## {title}\n")),
            "docs/STUDIES.md lacks {title}: `cargo xtask studies` renews it"
        );
    }
    let claims = [c_and_d::CAndD::CLAIM, LeafThreshold::CLAIM, leaf_bounds::LeafBounds::CLAIM, epsilon::Epsilon::CLAIM];
    let claims = claims.into_iter().chain([EdgeShift::CLAIM, Seams::CLAIM, Degenerates::CLAIM]);
    assert!(claims.into_iter().all(|claim| text.contains(claim)), "docs/STUDIES.md: `cargo xtask studies` renews it");
}

#[test]
fn the_document_on_the_tracer_of_1994_is_of_the_tracer_as_it_is() {
    let docs = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let renew = "renew it with `cargo xtask planes`";
    let read = |name: &str| String::from_utf8(files::read(&docs.join(name)).unwrap()).unwrap();
    let (figures, chance) = (Planes::measure(planes::SIZE), Chance::measure());
    let machine = Machine::measure(planes::SIZE);
    let document = figures.document() + &chance.document() + &machine.document();
    assert!(tables_are_whole(&document));
    assert_eq!(read("PLANES.md"), document, "{renew}");
    assert_eq!(read("studies/planes-machine.svg"), machine.plot(), "{renew}");
    assert_eq!(read("studies/planes.svg"), figures.plot(), "{renew}");
    for (picture, name) in figures.pictures.iter().zip(["literal", "nearest"]) {
        let path = docs.join(format!("studies/planes-{name}.png"));
        assert_eq!(host_tools::picture::Picture::read_png(&path).unwrap(), *picture, "{name}: {renew}");
    }
    assert!(figures.verdicts().iter().all(|verdict| verdict.holds) && chance.verdict().holds);
    // A tracer whose reflections are wrong with 6 bits too bears nothing out.
    let mut wrong = figures;
    wrong.rows.iter_mut().for_each(|row| (row.wrong, row.up_to_2) = (row.rays, 0));
    assert!(wrong.verdicts().iter().all(|verdict| !verdict.holds));
    // Nor do samples that are the same.
    let mut same = chance;
    same.row.errors.iter_mut().for_each(|(_, error)| *error = 0.1);
    assert!(!same.verdict().holds);
}

#[test]
fn the_fall_of_noise_is_told_from_what_does_not_fall() {
    let extent = Extent { size: [6, 4], counts: vec![1, 4, 16], truth_samples: 64 };
    let mut figures = Paths::measure(extent, &|_| ());
    let text = figures.document();
    assert!(tables_are_whole(&text) && text.contains("| `exact29` | "), "{text}");
    assert!(figures.plot().contains("exact29"));
    for row in &mut figures.rows {
        row.errors = vec![(1, 0.4), (4, 0.2), (16, 0.1)];
        assert!((row.exponent() + 0.5).abs() < 1e-12 && row.own() < 1e-8);
    }
    assert!(figures.verdict().holds);
    // An error of the kernel's own, and noise that falls too slowly.
    figures.rows[0].errors = [1.0, 4.0, 16.0].map(|n| (n as u32, libm::sqrt(0.01 / n + 1e-6))).to_vec();
    assert!((figures.rows[0].own() - 1e-3).abs() < 1e-9 && figures.verdict().holds);
    figures.rows[0].errors = vec![(1, 0.4), (4, 0.26), (16, 0.17)];
    assert!(!figures.verdict().holds);
}

#[test]
fn the_document_on_paths_is_of_this_measurement() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs");
    let text = std::fs::read_to_string(root.join("PATHS.md")).expect("the document");
    let renew = "renew it with `cargo xtask paths`";
    // To measure anew takes minutes; what it says of how is as it is now.
    let ours = Paths { rows: Vec::new(), noise: 0.0, extent: Extent::whole() }.document();
    let before_figures = |text: &str| text.split_once("Its own noise").map(|(before, _)| before.to_owned());
    assert_eq!(before_figures(&text), before_figures(&ours), "{renew}");
    assert!(tables_are_whole(&text) && text.contains("**Holds**: the error falls"), "{renew}");
    for engine in host_tools::engine::ENGINES {
        assert!(text.contains(&format!("| `{}` | ", engine.name())), "{renew}");
    }
    assert!(root.join("studies/paths.svg").is_file(), "{renew}");
}
