//! The same picture on three machines: the host, a Cortex-M0 and an rv32imac, bit for bit, and the floats of `f32` too.
//!
//! The checksums stand in `goldens/machines.txt`; `INTRAY_BLESS=1` renews them. A scene that is too large for the smallest
//! flash is decimated, for all machines. One firmware a board and kernel serves all scenes: that of a scene which needs
//! everything. Scenes of cameras and formats have firmware of their own, which has what they need and nothing else. Boards that cannot be emulated here are skipped, with a line that says so; the host's pictures are checked
//! all the same.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use core_rt::exact::{Exact14, Exact29};
use core_rt::kernel::Kernel;
use core_rt::profile::Need;
use firmware_rt::board::{BOARDS, Board};
use float_rt::Float32;
use glam::{DVec2, DVec3};
use host_tools::decimate::decimate;
use host_tools::emulate::Run;
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware::Wanted;
use host_tools::engine;
use host_tools::import;
use host_tools::model::{Lobe, Model, Specular, Texture};
use host_tools::picture::Picture;
use host_tools::prepare::{Blob, Options};
use rayon::prelude::*;
use tests::blobs::Draft;
use tests::boards::boards;
use tests::{scenes, shared};

const SIZE: [u32; 2] = [64, 48];

const KERNELS: [&str; 3] = ["exact14", "exact29", "f32"];

const LIMIT: Duration = Duration::from_secs(120);

/// Real models, which may be absent.
const SHARED: [(&str, &str); 3] =
    [("suzanne", "suzanne/suzanne.obj"), ("teapot", "teapot/teapot.obj"), ("cornell-box", "cornell-box/scene.toml")];

fn root(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name)
}

fn prepared(model: &Model, kernel: &str) -> Blob {
    let engine = engine::by_name(kernel).expect("a kernel of this name");
    engine.prepare(model, &Options::default()).expect("it fits the kernel").blob
}

/// The model with as many triangles as every board's flash has room for, whatever the kernel.
fn fitted(model: Model) -> Model {
    let triangles = model.triangles.len();
    let fitting = |kernel: &str| {
        let bytes = prepared(&model, kernel).bytes().len();
        let id = engine::by_name(kernel).expect("a kernel of this name").id();
        let room = BOARDS.map(|board| board.blob(id).length as usize).into_iter().min().expect("boards");
        // In proportion, a fiftieth less for what does not shrink with the triangles.
        if bytes <= room { triangles } else { triangles * room / bytes * 49 / 50 }
    };
    let fitting = KERNELS.map(fitting).into_iter().min().expect("kernels");
    if fitting == triangles { model } else { decimate(model, fitting).expect("it has few outlines") }
}

/// What firmware for one scene alone has: another one too where chance has a say, whose numbers are of its width.
fn own_kernels(model: &Model) -> &'static [&'static str] {
    let is_rough = model.materials.iter().any(|material| material.roughness > 0.0);
    if model.render.paths || is_rough { &["exact14", "exact29"] } else { &["exact14"] }
}

/// What has looks that the built-in scene lacks: checkers, lights that fade, Phong's law, weights, mirrors in mirrors.
fn gallery() -> Vec<(&'static str, Model)> {
    let folders = [
        ("raystones", "scenes/raystones"),
        ("gallery-spheres", "scenes/gallery/spheres"),
        ("gallery-mirrors", "scenes/gallery/mirrors"),
        ("gallery-glass", "scenes/gallery/glass"),
        ("gallery-materials", "scenes/gallery/materials"),
    ];
    let load = |folder: &str| import::load(&root(folder).join("scene.toml")).expect("a scene of the gallery").model;
    folders.map(|(name, folder)| (name, load(folder))).into()
}

/// All scenes; no model where it is absent.
fn all() -> Vec<(&'static str, Option<Model>)> {
    let bench = import::load(&root("scenes/bench-1k/scene.toml")).expect("the performance scene").model;
    let real =
        SHARED.map(|(name, path)| (name, shared::scene(path).map(|path| import::load(&path).expect("a model").model)));
    let textures = import::load(&root("scenes/gallery/textures/scene.toml")).expect("a scene of the gallery").model;
    // Another transfer is another firmware.
    let own = scenes::all().into_iter().chain(scenes::pixels()).chain(gallery()).filter(|&(name, _)| name != "linear");
    let own = own.map(|(name, model)| (name, Some(model)));
    let mut all: Vec<_> = own.chain([("bench-1k", Some(bench)), ("textures", Some(textures))]).chain(real).collect();
    for (_, model) in &mut all {
        *model = model.take().map(|mut model| {
            model.render.size = SIZE;
            fitted(model)
        });
    }
    all
}

/// A scene that needs whatever one of the others does: the built-in one with the lights of another.
fn needing_everything(all: &[(&str, Option<Model>)]) -> Model {
    let model = |wanted: &str| all.iter().find(|(name, _)| *name == wanted).and_then(|(_, model)| model.clone());
    let mut everything = model("demo").expect("it is a part of the project");
    everything.lights.extend(model("several-lights").expect("it is made").lights);
    everything.render.ambient = DVec3::ONE;
    everything.colours = vec![DVec3::X; everything.positions.len()];
    everything.uvs = vec![Some([DVec2::ZERO; 3]); everything.triangles.len()];
    for material in &mut everything.materials {
        material.texture = Some(Arc::new(Texture { size: [1, 1], texels: vec![[255; 3]] }));
        material.specular = Some(Specular { lobe: Lobe::BlinnPhong, exponent: 50, colour: DVec3::ONE });
    }
    everything
}

/// Scene, kernel, size, triangles, checksum of the RGB888 bytes.
fn line(scene: &str, kernel: &str, model: &Model, picture: &Picture) -> String {
    let [width, height] = model.render.size;
    format!("{scene} {kernel} {width}x{height} {} {:08x}", model.triangles.len(), picture.crc32())
}

/// What of a line names a picture.
fn key(line: &str) -> Vec<&str> {
    line.split(' ').take(2).collect()
}

/// What is wrong with a file of goldens: lines that are missing, that differ, and that are of nothing. Those of absent
/// scenes cannot be told.
fn complaints(found: &[String], golden: &str, absent: &[&str]) -> Vec<String> {
    let golden: Vec<&str> = golden.lines().collect();
    let missing = found.iter().filter(|line| !golden.contains(&line.as_str())).map(|line| format!("not there: {line}"));
    let is_known = |line: &str| absent.contains(&key(line)[0]) || found.iter().any(|found| key(found) == key(line));
    let stale = golden.iter().filter(|line| !is_known(line)).map(|line| format!("of nothing: {line}"));
    missing.chain(stale).collect()
}

/// One picture to make.
struct Job<'a> {
    title: String,
    board: &'static Board,
    elf: &'a Elf,
    blob: &'a Blob,
    expected: &'a Picture,
}

impl Job<'_> {
    /// What is wrong with the chip's picture, if anything is.
    fn complaint(&self) -> Option<String> {
        let blob = Some(self.blob.bytes());
        let run = Run { board: self.board, elf: self.elf, blob, counter: None, limit: LIMIT };
        let mut log = Vec::new();
        match run.perform(&mut log) {
            Ok(outcome) if outcome.picture == *self.expected => None,
            Ok(outcome) => Some(format!(
                "{}: {:08x} instead of {:08x}",
                self.title,
                outcome.picture.crc32(),
                self.expected.crc32()
            )),
            Err(error) => Some(format!("{}: {error}; {log:?}", self.title)),
        }
    }
}

/// A blob to build firmware for, that takes ids wherever they stand. It is not to be drawn: a scene has them in one place.
fn for_any_ids(blob: &Blob, kernel: &str) -> Blob {
    fn of<K: Kernel>(blob: &Blob) -> Blob {
        let mut draft = Draft::<K>::read(blob.bytes()).expect("a blob just made");
        draft.header.needs = draft.header.needs.with(Need::Ids, true).with(Need::IdsInRecords, true);
        draft.write()
    }
    match kernel {
        "exact14" => of::<Exact14>(blob),
        "exact29" => of::<Exact29>(blob),
        "f32" => of::<Float32>(blob),
        _ => unreachable!("no firmware of {kernel} is built here"),
    }
}

#[test]
fn pictures_are_the_same_on_three_machines() {
    let all = all();
    let everything = needing_everything(&all);
    let begin = Instant::now();
    let firmware = |model: &Model, kernels: &[&'static str]| -> Vec<(&Board, &str, Elf)> {
        boards()
            .flat_map(|board| kernels.iter().map(move |&kernel| (board, kernel)))
            .map(|(board, kernel)| {
                let blob = for_any_ids(&prepared(model, kernel), kernel);
                let wanted = Wanted { board, blob: blob.bytes(), hits: None, count: false };
                (board, kernel, wanted.provide().expect("it can be built"))
            })
            .collect()
    };
    let shared = firmware(&everything, &KERNELS);
    let alone = scenes::pixels().into_iter().chain(gallery());
    let own: Vec<_> = alone.map(|(name, model)| (name, firmware(&model, own_kernels(&model)))).collect();
    let built = begin.elapsed();

    let mut found = Vec::new();
    let mut pictures = Vec::new();
    for (name, model) in &all {
        let Some(model) = model else { continue };
        for kernel in KERNELS {
            let blob = prepared(model, kernel);
            let engine = engine::by_name(kernel).expect("a kernel of this name");
            let picture = engine.render(blob.bytes(), [16, 16], &|_| ()).expect("a blob just made").picture;
            found.push(line(name, kernel, model, &picture));
            pictures.push((*name, kernel, blob, picture));
        }
    }
    let jobs: Vec<Job<'_>> = pictures
        .iter()
        .flat_map(|(name, kernel, blob, expected)| {
            let own = own.iter().find(|(scene, _)| scene == name).map(|(_, firmware)| firmware);
            own.unwrap_or(&shared).iter().filter(move |(_, of, _)| of == kernel).map(move |(board, _, elf)| Job {
                title: format!("{name}, {kernel} on {}", board.name),
                board,
                elf,
                blob,
                expected,
            })
        })
        .collect();
    let pool = rayon::ThreadPoolBuilder::new().num_threads(2).build().expect("threads");
    let wrong: Vec<String> = pool.install(|| jobs.par_iter().filter_map(Job::complaint).collect());
    let run = begin.elapsed() - built;
    println!(
        "{} pictures by chips in {:.1} s, their firmware in {:.1} s",
        jobs.len(),
        run.as_secs_f64(),
        built.as_secs_f64()
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));

    let path = root("tests/goldens/machines.txt");
    let absent: Vec<&str> = all.iter().filter(|(_, model)| model.is_none()).map(|&(name, _)| name).collect();
    if std::env::var_os("INTRAY_BLESS").is_some() {
        let old = std::fs::read_to_string(&path).unwrap_or_default();
        let kept = old.lines().filter(|line| absent.contains(&key(line)[0])).map(String::from);
        let lines: Vec<String> = found.iter().cloned().chain(kept).collect();
        std::fs::write(&path, lines.join("\n") + "\n").expect("a golden can be written");
    }
    let golden = std::fs::read_to_string(&path).expect("a golden");
    let wrong = complaints(&found, &golden, &absent);
    assert!(wrong.is_empty(), "tests/goldens/machines.txt, INTRAY_BLESS=1 renews it\n{}", wrong.join("\n"));
}

#[test]
fn missing_wrong_and_stale_lines_are_seen() {
    let found: Vec<String> = ["a exact14 1x1 5 00000001", "b exact14 1x1 7 00000002"].map(String::from).into();
    let golden = "a exact14 1x1 5 00000001\nb exact14 1x1 7 00000002\n";
    assert_eq!(complaints(&found, golden, &[]), [""; 0]);
    let other = golden.replace("00000002", "00000003");
    assert_eq!(complaints(&found, &other, &[]), ["not there: b exact14 1x1 7 00000002"]);
    assert_eq!(complaints(&found, &other.replace("b ", "c "), &[]).len(), 2);
    let more = format!("{golden}c exact14 1x1 9 00000004\n");
    assert_eq!(complaints(&found, &more, &[]), ["of nothing: c exact14 1x1 9 00000004"]);
    assert_eq!(complaints(&found, &more, &["c"]), [""; 0]);
}

#[test]
fn another_picture_is_noticed() {
    for board in boards().take(1) {
        let scenes: Vec<_> = scenes::all().into_iter().map(|(name, model)| (name, Some(model))).collect();
        let mut model = needing_everything(&scenes);
        model.render.size = [16, 16];
        let blob = prepared(&model, "exact14");
        let elf = Wanted { board, blob: blob.bytes(), hits: None, count: false }.provide().expect("it can be built");
        let expected = &Picture::new(16, 16);
        let job = Job { title: "a scene".into(), board, elf: &elf, blob: &blob, expected };
        let complaint = job.complaint().expect("it is not black");
        assert!(complaint.contains("instead of"), "{complaint}");
    }
}
