//! A report's sweep: what is measured is the same every time, nothing that was measured is lost, and what cannot be measured
//! is said.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::time::Duration;

use host_tools::compare::compare;
use host_tools::picture::Picture;
use host_tools::report::plan::Selection;
use host_tools::report::row::{Cost, Machine, Measured, Outcome, Row, Study, Time};
use host_tools::report::scene::{self, Scene};
use host_tools::report::store::ROWS;
use host_tools::report::sweep::{FILES, Sweep, Swept, Watch};
use host_tools::report::{Report, SweepError};
use tests::boards::boards;

/// Two triangles before each other, the nearer one a mirror.
const OBJ: &str = "v -2 -2 0\nv 2 -2 0\nv 0 2 0\nv -1 -1 1\nv 1 -1 1\nv 0 1 1\nf 1 2 3\nusemtl mirror\nf 4 5 6\n";
const TOML: &str = "model = 'mesh.obj'\n[render]\nsize = [24, 18]\n[background]\ncolour = [0.1, 0.2, 0.3]\n\
                    [material.mirror]\nkind = 'mirror'\n[camera]\nposition = [1, 1, 6]\nlook_at = [0, 0, 0]\n";

/// What was said.
#[derive(Default)]
struct Said(Mutex<Vec<String>>);

impl Watch for Said {
    fn say(&self, line: &str) {
        self.0.lock().unwrap().push(line.into());
    }

    fn begin(&self, _: u64) {}

    fn done(&self, _: u64) {}
}

/// A folder with the scene, for a report beside it.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        let place = Self(tempfile::tempdir().unwrap());
        fs::create_dir(place.path("a")).unwrap();
        place.write("a/mesh.obj", OBJ);
        place.write("a/scene.toml", TOML);
        place
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).unwrap();
    }

    fn scenes(&self) -> Vec<Scene> {
        scene::read(&[self.path("a/scene.toml")])
    }

    fn rows(&self) -> String {
        fs::read_to_string(self.path("out").join(ROWS)).unwrap()
    }

    fn run(&self, selection: &Selection, fresh: bool) -> (Result<Swept, SweepError>, Vec<String>) {
        sweep(&self.scenes(), selection, &self.path("out"), fresh)
    }

    fn succeeds(&self, selection: &Selection) -> Swept {
        self.run(selection, false).0.unwrap()
    }

    fn refused(&self, selection: &Selection) -> String {
        let before = fs::read(self.path("out").join(ROWS)).ok();
        let message = self.run(selection, false).0.unwrap_err().to_string();
        assert!(before == fs::read(self.path("out").join(ROWS)).ok(), "a refusal changes nothing");
        message
    }
}

fn sweep(
    scenes: &[Scene],
    selection: &Selection,
    folder: &Path,
    fresh: bool,
) -> (Result<Swept, SweepError>, Vec<String>) {
    let said = Said::default();
    let limit = Duration::from_secs(120);
    let swept = Sweep { scenes, selection, folder, fresh, limit, command: "intray report".into() }.run(&said);
    (swept, said.0.into_inner().unwrap())
}

/// All studies of a kernel, on the host.
fn on_host(kernel: &str) -> Selection {
    Selection { quick: true, kernels: vec![kernel.into()], machines: vec![Machine::Host], ..Selection::default() }
}

/// A report without times.
fn timeless(report: &Report) -> Report {
    let timeless = |row: &Row| {
        let mut row = row.clone();
        if let Outcome::Measured(measured) = &mut row.outcome
            && let Cost::Time(time) = &mut measured.cost
        {
            *time = Time { seconds: 0.0, ratio: [0.0; 3], rounds: 0 };
        }
        row
    };
    Report { rows: report.rows.iter().map(timeless).collect(), ..report.clone() }
}

fn measured(row: &Row) -> &Measured {
    match &row.outcome {
        Outcome::Measured(measured) => measured,
        Outcome::Failed(reason) => panic!("{}: {reason}", row.point),
    }
}

/// All files of a folder.
fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries
        .flat_map(|path| if path.is_dir() { contents(&path) } else { [(path.clone(), fs::read(path).unwrap())].into() })
        .collect()
}

#[test]
fn everything_but_times_is_the_same_in_every_run() {
    let (one, other) = (Place::new(), Place::new());
    let [a, b] = [&one, &other].map(|place| place.succeeds(&on_host("exact14")).report);
    let without_paths = |report: &Report| {
        let mut report = timeless(report);
        report.scenes.iter_mut().for_each(|scene| scene.path.clear());
        report
    };
    assert_eq!(without_paths(&a), without_paths(&b));
    assert!(a.rows.len() > 10 && a.rows.iter().all(|row| matches!(row.outcome, Outcome::Measured(_))));
    let pictures = |place: &Place| contents(&place.path("out/pictures")).into_values().collect::<Vec<_>>();
    assert_eq!(pictures(&one), pictures(&other));
}

#[test]
fn figures_are_those_of_the_pictures() {
    let place = Place::new();
    let selection = Selection { studies: vec![Study::Kernels, Study::Grid], ..on_host("exact14") };
    let report = place.succeeds(&selection).report;
    let read = |name: &str| Picture::read_png(&place.path("out").join(name)).unwrap();
    for row in &report.rows {
        let Measured { error, causes, picture, truth, image_crc32, cost, .. } = measured(row);
        let (picture, truth) = (read(picture), read(truth));
        assert_eq!((picture.width(), picture.height()), (24, 18));
        assert_eq!(*error, compare(&picture, &truth).unwrap(), "{}", row.point);
        assert_eq!(*image_crc32, format!("{:08x}", picture.crc32()));
        let all =
            [causes.holes, causes.visibility, causes.secondary, causes.shadow, causes.shading, causes.quantisation];
        let differ = picture.pixels().iter().zip(truth.pixels()).filter(|(a, b)| a != b).count() as u64;
        assert_eq!(all.iter().map(|cause| cause.pixels).sum::<u64>(), differ, "{}", row.point);
        assert_eq!(all.iter().map(|cause| cause.over_4).sum::<u64>(), error.over_4);
        assert_eq!(all.iter().map(|cause| cause.over_64).sum::<u64>(), error.over_64);
        let Cost::Time(Time { seconds, ratio: [least, median, most], rounds }) = cost else { panic!("{cost:?}") };
        assert!(*seconds > 0.0 && 0.0 < *least && least <= median && median <= most && rounds % 2 == 1);
    }
    let coarse = report.rows.iter().find(|row| row.point.grid_bits.is_some()).unwrap();
    assert!(measured(coarse).error.over_4 > measured(&report.rows[0]).error.over_4, "a coarse grid shows");
}

#[test]
fn what_is_written_can_be_read_again() {
    let place = Place::new();
    let report = place.succeeds(&on_host("f32")).report;
    let [json, csv, page] = FILES.map(|name| fs::read_to_string(place.path("out").join(name)));
    assert_eq!(serde_json::from_str::<Report>(&json.unwrap()).unwrap(), report);
    let csv = csv.unwrap();
    assert_eq!(csv.lines().count(), report.rows.len() + 1);
    assert!(csv.lines().all(|line| line.split(',').count() == host_tools::report::csv::COLUMNS.len()));
    assert!(page.unwrap().starts_with("<!DOCTYPE html>"));
    assert_eq!(place.rows().lines().count(), report.rows.len() + 1);
}

#[test]
fn a_sweep_that_is_complete_measures_nothing() {
    let place = Place::new();
    let first = place.succeeds(&on_host("f32"));
    let before = contents(&place.path("out"));
    let (second, said) = place.run(&on_host("f32"), false);
    let second = second.unwrap();
    assert_eq!((second.kept, &second.report), (first.report.rows.len(), &first.report), "times and all");
    assert!(said[0].contains(&format!("going on, {0} of {0} points are there", first.report.rows.len())), "{said:?}");
    assert!(contents(&place.path("out")) == before);
}

#[test]
fn an_interrupted_sweep_goes_on_where_it_stopped() {
    let place = Place::new();
    let whole = place.succeeds(&on_host("exact14")).report;
    let rows = place.rows();
    let lines: Vec<&str> = rows.lines().collect();
    // Killed before a line's last byte, in its middle, after one, and before the first.
    for (there, torn) in [(5, lines[6].len()), (3, 40), (4, 0), (0, 0), (0, 1)] {
        let kept = lines[..=there].join("\n") + "\n" + &lines[there + 1][..torn];
        fs::write(place.path("out").join(ROWS), &kept).unwrap();
        let swept = place.succeeds(&on_host("exact14"));
        assert_eq!((swept.kept, timeless(&swept.report)), (there, timeless(&whole)));
        // Those that were there were not measured again.
        assert!(place.rows().starts_with(&(lines[..=there].join("\n") + "\n")) || there == 0);
        assert_eq!(place.rows().lines().count(), lines.len());
    }
}

#[test]
fn rows_that_do_not_fit_are_refused_and_fresh_begins_anew() {
    let place = Place::new();
    let selection = Selection { studies: vec![Study::Kernels], ..on_host("f32") };
    place.succeeds(&selection);
    let rows = place.rows();
    let changed = |from: &str, to: &str| {
        assert!(rows.contains(from), "{from}");
        fs::write(place.path("out").join(ROWS), rows.replacen(from, to, 1)).unwrap();
        place.refused(&selection)
    };
    let anew = "`--fresh` begins anew, or name another folder";
    for (from, to, what) in [
        (
            "intray-report/1",
            "intray-report/0",
            "its rows are of the schema intray-report/0, and this program writes intray-report/1",
        ),
        ("\"program\":\"intray ", "\"program\":\"intray 0.0.9 ", "its rows were measured by another program"),
        ("\"machine\":\"", "\"machine\":\"Z80 ", "its rows were measured on another computer"),
        ("--study kernels", "--study depth", "its rows were measured with other options"),
        ("{\"point\"", "{\"dot\"", "line 2 is damaged"),
    ] {
        let message = changed(from, to);
        assert!(message.contains(what) && message.ends_with(anew), "{message}");
    }
    for foreign in ["", "not a report\n", "{\"schema\":\"another/1\"}\n"] {
        fs::write(place.path("out").join(ROWS), foreign).unwrap();
        assert!(place.refused(&selection).contains("rows.jsonl: this is not of a report, and is left alone"));
        assert!(place.run(&selection, true).0.is_err(), "nor is it ours to begin anew");
    }
    fs::write(place.path("out").join(ROWS), rows.replacen("intray-report/1", "intray-report/0", 1)).unwrap();
    assert_eq!(place.run(&selection, true).0.unwrap().kept, 0);
    assert_eq!(place.succeeds(&selection).kept, 1);

    place.write("a/mesh.obj", &OBJ.replace("v 0 1 1", "v 0 1 2"));
    assert!(place.refused(&selection).contains("the scene a has changed since its rows were measured"));
}

#[test]
fn files_of_others_are_left_alone() {
    let place = Place::new();
    let selection = Selection { studies: vec![Study::Kernels], ..on_host("f32") };
    fs::create_dir_all(place.path("out/pictures")).unwrap();
    place.write("out/notes.txt", "mine");
    place.write("out/pictures/cat.png", "a cat");
    place.write("out/report.csv", "my report");
    assert!(place.refused(&selection).contains("report.csv: is there already, and the folder has no report"));
    assert_eq!(fs::read(place.path("out/report.csv")).unwrap(), b"my report");
    assert!(!place.path("out/report.json").exists());
    fs::remove_file(place.path("out/report.csv")).unwrap();
    place.succeeds(&selection);
    assert_eq!(fs::read(place.path("out/notes.txt")).unwrap(), b"mine");
    assert_eq!(fs::read(place.path("out/pictures/cat.png")).unwrap(), b"a cat");
}

#[test]
fn a_point_that_fails_is_a_row_and_loses_no_other() {
    let place = Place::new();
    // Nothing of it is left on the grid of exact14.
    place.write("a/mesh.obj", "v 0 0 0\nv 0.001 0 0\nv 0 0.001 0\nf 1 2 3\n");
    place.write(
        "a/scene.toml",
        &TOML.replace("[1, 1, 6]", "[100, 0, 600]").replace("[material.mirror]\nkind = 'mirror'\n", ""),
    );
    let selection = Selection { kernels: Vec::new(), studies: vec![Study::Kernels], ..on_host("") };
    let swept = place.succeeds(&selection);
    let failed = |report: &Report| {
        let rows = report
            .rows
            .iter()
            .filter(|row| matches!(&row.outcome, Outcome::Failed(why) if why.contains("-bit grid of exact14")));
        rows.map(|row| row.point.kernel.clone()).collect::<Vec<_>>()
    };
    assert_eq!((swept.report.rows.len(), failed(&swept.report)), (8, vec!["exact14".to_owned()]));
    assert!(swept.broken.is_empty(), "it is an answer");
    let again = place.succeeds(&selection);
    assert_eq!((again.kept, failed(&again.report)), (8, vec!["exact14".to_owned()]));
}

#[test]
fn a_scene_that_cannot_be_read_loses_no_other() {
    let place = Place::new();
    let paths = ["none.obj", "a/scene.toml"].map(|name| place.path(name));
    let selection = Selection { studies: vec![Study::Kernels], ..on_host("f32") };
    let (swept, _) = sweep(&scene::read(&paths), &selection, &place.path("out"), false);
    let report = swept.unwrap().report;
    assert_eq!((report.scenes.len(), report.rows.len()), (2, 1));
    assert!(report.scenes[0].failed.as_ref().unwrap().contains("none.obj: no such file"));

    // Once it can be read, the rows of the other are still good.
    place.write("none.obj", "v 0 0 0\nv 2 0 0\nv 0 2 2\nf 1 2 3\n");
    let (swept, _) = sweep(&scene::read(&paths), &selection, &place.path("out"), false);
    let swept = swept.unwrap();
    assert_eq!((swept.kept, swept.report.rows.len()), (1, 2));
}

/// Both boards draw the host's picture; a blob that is too large is a row that says so.
#[test]
fn chips_draw_the_same_pictures() {
    let place = Place::new();
    let machines: Vec<Machine> = boards()
        .map(|board| if board.name == "microbit" { Machine::Thumbv6m } else { Machine::Rv32imac })
        .chain([Machine::Host])
        .collect();
    // The built-in scene, by firmware that other tests use too.
    let scenes = scene::read::<&Path>(&[]);
    let selection = Selection {
        quick: true,
        machines: machines.clone(),
        kernels: vec!["exact14".into()],
        studies: vec![Study::Kernels],
        sizes: vec![[32, 24]],
    };
    let (swept, said) = sweep(&scenes, &selection, &place.path("out"), false);
    let swept = swept.unwrap();
    if !said.is_empty() {
        println!("skipped: {said:?}");
        return;
    }
    assert!(swept.broken.is_empty(), "{:?}", swept.broken);
    assert_eq!(swept.report.rows.len(), machines.len());
    let crcs: Vec<&String> = swept.report.rows.iter().map(|row| &measured(row).image_crc32).collect();
    assert!(crcs.iter().all(|crc| *crc == crcs[0]));
    for row in &swept.report.rows {
        match &measured(row).cost {
            Cost::Time(_) => assert_eq!(row.point.machine, Machine::Host),
            Cost::Instructions(cost) => {
                assert!(cost.instructions > 1_000_000 && cost.text_bytes > 10_000 && cost.ram_bytes < 16 << 10);
                assert_eq!(cost.cycles.contains_key("cortex-m0"), row.point.machine == Machine::Thumbv6m);
            }
        }
    }

    if machines.contains(&Machine::Thumbv6m) {
        let selection = Selection { kernels: vec!["f64".into()], machines: vec![Machine::Thumbv6m], ..selection };
        let (swept, _) = sweep(&scenes, &selection, &place.path("large"), false);
        let rows = swept.unwrap().report.rows;
        assert!(
            matches!(&rows[..], [Row { outcome: Outcome::Failed(why), .. }] if why.contains("too many")),
            "{rows:?}"
        );
    }
}
