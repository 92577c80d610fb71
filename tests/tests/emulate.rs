//! Firmware in QEMU: the picture is the host's, bit for bit, what is counted is right, and what does not fit is refused.
//! `machines` has more pictures, `firmware_output` what firmware says, whatever goes wrong.
//!
//! Boards for which QEMU or the compiler's library is absent are skipped, with a line that says so.

use std::time::Duration;

use core_rt::exact::{Exact14, Exact20, Exact29};
use core_rt::hanika::HanikaCd;
use core_rt::profile::Full;
use core_rt::render::Tile;
use core_rt::scene::{MAX_DEPTH, Scene};
use core_rt::stats::Counts;
use firmware_rt::board::{Board, HIFIVE1, MICROBIT};
use firmware_rt::build::{DEFAULT_BLOB, Traits};
use firmware_rt::hits::{self, Way};
use firmware_rt::status::Status;
use float_rt::Float64;
use host_tools::builtin;
use host_tools::emulate::counter::Counter;
use host_tools::emulate::elf::Elf;
use host_tools::emulate::firmware::{self, Wanted};
use host_tools::emulate::{EmulateError, Observer, Outcome, Run, room};
use host_tools::engine;
use host_tools::import::{Embedded, load_from};
use host_tools::model::Model;
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::render::Rendered;
use tests::blobs;
use tests::boards::{boards, counted};

const LIMIT: Duration = Duration::from_secs(120);

/// Keeps the log.
#[derive(Default)]
struct Heard {
    log: Vec<String>,
    pixels: u64,
}

impl Observer for Heard {
    fn log(&mut self, line: &str) {
        self.log.push(line.into());
    }

    fn pixels(&mut self, count: u64) {
        self.pixels += count;
    }
}

/// The built-in scene, small: smooth and flat triangles, a lamp, ambient light.
fn built_in() -> Model {
    let mut model = load_from(&Embedded(builtin::FILES), "scene.toml").unwrap().model;
    model.render.size = [32, 24];
    model
}

fn prepared(model: &Model, kernel: &str) -> Vec<u8> {
    let engine = engine::by_name(kernel).unwrap();
    engine.prepare(model, &Options::default()).unwrap().blob.bytes().to_vec()
}

fn host(blob: &[u8], kernel: &str) -> Rendered {
    let blob = host_tools::prepare::Blob::from_bytes(blob);
    engine::by_name(kernel).unwrap().render(blob.bytes(), [8, 8], &|_| ()).unwrap()
}

fn wanted<'a>(board: &'static Board, blob: &'a [u8]) -> Wanted<'a> {
    Wanted { board, blob, hits: None, count: false }
}

fn run(elf: &Elf, board: &Board, blob: &[u8], counter: Option<&Counter>) -> Result<(Outcome, Heard), EmulateError> {
    let mut heard = Heard::default();
    let outcome = Run { board, elf, blob: Some(blob), counter, limit: LIMIT }.perform(&mut heard)?;
    Ok((outcome, heard))
}

#[test]
fn pictures_are_the_hosts() {
    for board in boards() {
        let five_triangles = [
            ("exact14", blobs::sample::<Exact14>(false)),
            ("exact20", blobs::sample::<Exact20>(false)),
            ("exact29", blobs::sample::<Exact29>(false)),
            ("hanika-cd", blobs::sample::<HanikaCd>(false)),
            ("f64", blobs::sample::<Float64>(false)),
        ];
        for (kernel, five_triangles) in &five_triangles {
            // `machines` has larger scenes, for the kernels that are meant for chips.
            let built_in = (*kernel == "exact14").then(|| prepared(&built_in(), kernel));
            for blob in [five_triangles.bytes().to_vec()].into_iter().chain(built_in) {
                let elf = wanted(board, &blob).provide().unwrap();
                let (outcome, heard) = run(&elf, board, &blob, None).unwrap();
                let picture = host(&blob, kernel).picture;
                assert_eq!(outcome.picture, picture, "{} {kernel}", board.name);
                assert_eq!(heard.pixels, picture.pixels().len() as u64);
                assert!(
                    heard.log[0].ends_with(&format!("a blob of {} bytes for {kernel}", blob.len())),
                    "{:?}",
                    heard.log
                );
            }
        }
    }
}

/// Where rays may not go on, the background shows in mirrors and glass, and what draws it is linked.
#[test]
fn without_depth_the_picture_is_the_hosts() {
    let mut model = built_in();
    model.render.max_depth = 0;
    for board in boards() {
        let blob = prepared(&model, "exact14");
        let elf = wanted(board, &blob).provide().unwrap();
        let (outcome, _) = run(&elf, board, &blob, None).unwrap();
        assert_eq!(outcome.picture, host(&blob, "exact14").picture, "{}", board.name);
    }
}

#[test]
fn rays_and_tests_are_counted_as_on_the_host() {
    for board in boards() {
        let blob = prepared(&built_in(), "exact14");
        let elf = Wanted { count: true, ..wanted(board, &blob) }.provide().unwrap();
        let (outcome, _) = run(&elf, board, &blob, None).unwrap();
        let Rendered { picture, counts } = host(&blob, "exact14");
        let report = outcome.report;
        let found = Counts {
            box_tests: report.box_tests,
            triangle_tests: report.triangle_tests,
            primary_rays: report.primary_rays,
            shadow_rays: report.shadow_rays,
            reflection_rays: report.reflection_rays,
            refraction_rays: report.refraction_rays,
        };
        assert_eq!((outcome.picture, found), (picture, counts), "{}", board.name);
        assert!(counts.shadow_rays > 0 && counts.primary_rays == 32 * 24);
    }
}

#[test]
fn instructions_are_the_same_on_every_run() {
    for (board, counter) in counted() {
        let counts = |model: &Model| {
            let blob = prepared(model, "exact14");
            let elf = wanted(board, &blob).provide().unwrap();
            run(&elf, board, &blob, Some(&counter)).unwrap().0.counts.unwrap()
        };
        let once = counts(&built_in());
        assert_eq!(once, counts(&built_in()), "{}", board.name);
        // More pixels of the same firmware are more work, and within the marks.
        let mut larger = built_in();
        larger.render.size = [32, 32];
        let more = counts(&larger);
        assert!(more.instructions > once.instructions * 11 / 10, "{once:?} {more:?}");
        assert!(more.instructions < more.run.instructions);
    }
}

#[test]
fn the_memory_that_a_small_chip_has_is_enough() {
    for board in boards() {
        let blob = blobs::sample::<Exact14>(false).bytes().to_vec();
        let elf = wanted(board, &blob).provide().unwrap();
        let (outcome, _) = run(&elf, board, &blob, None).unwrap();
        let stack = u64::from(outcome.report.stack_bytes);
        // The hits and the pixels of a 16x16 tile alone are 1792.
        assert!((1792..2048).contains(&elf.static_bytes), "{}: {}", board.name, elf.static_bytes);
        assert!(stack > 512 && elf.static_bytes + stack <= 4096, "{}: {} {stack}", board.name, elf.static_bytes);
        assert!((10_000..u64::from(board.code(14).length)).contains(&elf.text_bytes), "{}", elf.text_bytes);
        assert_eq!(elf.blob_bytes, 0);
    }
}

/// The nearest hits by the host.
fn hits_of(blob: &[u8]) -> Picture {
    let blob = host_tools::prepare::Blob::from_bytes(blob);
    let scene = Scene::<Full<Exact14>>::new_checked(blob.bytes()).unwrap();
    let [width, height] = scene.frame.size;
    let tile = Tile { x: 0, y: 0, width, height };
    let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
    let mut hits = vec![0; tile.pixels()];
    let mut picture = Picture::new(width.into(), height.into());
    hits::find(&scene, tile, Way::Single, &mut hits, &mut [], &mut stack, &mut Counts::default());
    hits::paint(&scene, &hits, picture.pixels_mut().as_flattened_mut());
    picture
}

#[test]
fn the_nearest_hits_are_the_hosts() {
    for board in boards() {
        let blob = prepared(&built_in(), "exact14");
        let expected = hits_of(&blob);
        assert_ne!(expected, host(&blob, "exact14").picture);
        for way in [Way::Single, Way::Tile] {
            let elf = Wanted { hits: Some(way), ..wanted(board, &blob) }.provide().unwrap();
            let (outcome, _) = run(&elf, board, &blob, None).unwrap();
            assert_eq!(outcome.picture, expected, "{} {way:?}", board.name);
        }
    }
}

#[test]
fn a_foreign_blob_and_one_with_other_needs_are_refused_by_the_chip() {
    for board in boards() {
        let blob = prepared(&built_in(), "exact14");
        let elf = wanted(board, &blob).provide().unwrap();
        let refusal = |blob: &[u8]| {
            let mut heard = Heard::default();
            let run = Run { board, elf: &elf, blob: Some(blob), counter: None, limit: LIMIT };
            let error = run.perform(&mut heard).unwrap_err();
            assert!(matches!(error, EmulateError::Firmware { status: Status::Refused, .. }), "{error}");
            heard.log.last().unwrap().clone()
        };
        assert!(refusal(&blob[8..]).contains("there is none"));
        let mut model = built_in();
        model.render.transfer = host_tools::model::Transfer::Linear;
        assert!(refusal(&prepared(&model, "exact14")).contains("it needs linear output"));
    }
}

#[test]
fn what_does_not_fit_is_said_before_anything_is_built() {
    assert!(room(&MICROBIT, MICROBIT.blob(14), 180_224, || unreachable!()).is_ok());
    let error = room(&MICROBIT, MICROBIT.blob(14), 200_000, || "fewer triangles".into()).unwrap_err().to_string();
    assert_eq!(
        error,
        "the blob has 200000 bytes, and microbit has 180224 for it in its flash: 19776 too many. What would help: fewer \
         triangles"
    );
    assert!(room(&HIFIVE1, HIFIVE1.blob(29), 200_000, || unreachable!()).is_ok());
}

#[test]
fn a_kernel_without_firmware_is_named() {
    let traits = Traits { kernel: 0xffff, ..Traits::of(&prepared(&built_in(), "exact14")).unwrap() };
    let error = firmware::check(&MICROBIT, &traits).unwrap_err().to_string();
    assert!(error.contains("the kernel of this blob") && error.contains("exact14"), "{error}");
}

#[test]
fn the_default_blob_is_what_the_built_in_scene_becomes() {
    let mut model = built_in();
    model.render.size = [160, 120];
    let committed = std::fs::read(DEFAULT_BLOB).unwrap();
    assert!(
        committed == prepared(&model, "exact14"),
        "firmware-rt/default.blob is stale: `cargo run --release -- prep scenes/demo/scene.toml --kernel exact14 \
         --size 160x120 -o firmware-rt/default.blob`"
    );
}
