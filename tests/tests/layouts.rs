//! What triangles take in flash and in time, by what a chip has less of, and how large a mesh a small chip holds. The README
//! shows it; `INTRAY_BLESS=1` renews that. Skipped, with a line that says so, where chips cannot be emulated, or where the
//! compiler is another than the one that the README names.

use std::fmt::Write;
use std::path::Path;
use std::time::Duration;

use core_rt::profile::Prefer;
use firmware_rt::board::{Board, MICROBIT};
use firmware_rt::hits::Way;
use host_tools::decimate;
use host_tools::emulate::Run;
use host_tools::emulate::firmware::Wanted;
use host_tools::engine::{self, Engine};
use host_tools::import;
use host_tools::model::Model;
use host_tools::prepare::{Blob, Options, tree_for};
use tests::boards::counted;
use tests::documents::{README, check_part, compiler, document, generated, is_blessing, root};

const LIMIT: Duration = Duration::from_secs(600);

/// Bytes a triangle that flat meshes may take by `exact14`: nodes, vertices, indices and ids.
const MOST: [(Prefer, &str, f64); 2] = [(Prefer::Speed, "speed", 40.0), (Prefer::Size, "size", 24.0)];

fn exact14() -> &'static dyn Engine {
    engine::by_name("exact14").expect("a kernel of this name")
}

fn prepared(model: &Model, prefer: Prefer) -> Blob {
    let options = Options { prefer, tree: tree_for(prefer), ..Options::default() };
    exact14().prepare(model, &options).expect("it fits").blob
}

fn bytes_a_triangle(blob: &Blob) -> f64 {
    let (header, sizes) = exact14().inspect(blob.bytes()).expect("a blob just made");
    (sizes.nodes + sizes.triangles + sizes.ids) as f64 / f64::from(header.counts.triangles)
}

#[test]
fn flat_meshes_take_the_bytes_that_are_promised() {
    let model = import::load(&root("scenes/bench-1k/scene.toml")).expect("a scene of ours").model;
    for (prefer, name, most) in MOST {
        let bytes = bytes_a_triangle(&prepared(&model, prefer));
        assert!(bytes <= most && bytes > most / 2.0, "--prefer {name}: {bytes}");
    }
}

/// Bunny, of so many triangles that its blob is the largest which the micro:bit holds, to a few triangles.
fn largest_bunny(whole: &Model) -> (Model, Blob) {
    let room = MICROBIT.blob(exact14().id()).length as usize;
    let (mut low, mut high) = (1000, 20_000);
    let of = |triangles: usize| {
        let mut model = decimate::decimate(whole.clone(), triangles).expect("it can be decimated");
        model.render.size = [80, 64];
        let blob = prepared(&model, Prefer::Size);
        (blob.bytes().len() <= room).then_some((model, blob))
    };
    let mut best = of(low).expect("a thousand triangles fit");
    while high - low > 50 {
        let middle = low.midpoint(high);
        match of(middle) {
            Some(found) => (low, best) = (middle, found),
            None => high = middle,
        }
    }
    best
}

/// A row of the README: how much a blob takes and how long its rays are on the way.
fn row(model: &Model, boards: &[(&'static Board, host_tools::emulate::counter::Counter)]) -> String {
    let mut rows = String::new();
    for (prefer, name, _) in MOST {
        let blob = prepared(model, prefer);
        let rays: u32 = model.render.size.iter().product();
        let _ = write!(rows, "| `{name}` | {:.1} |", bytes_a_triangle(&blob));
        for (board, counter) in boards {
            let wanted = Wanted { board, blob: blob.bytes(), hits: Some(Way::Single), count: false };
            let elf = wanted.provide().expect("it can be built");
            let run = Run { board, elf: &elf, blob: Some(blob.bytes()), counter: Some(counter), limit: LIMIT };
            let counts = run.perform(&mut Vec::new()).expect("it goes well").counts.expect("it was counted");
            let _ = write!(rows, " {} |", counts.instructions / u64::from(rays));
        }
        rows.push('\n');
    }
    rows
}

#[test]
fn the_readme_shows_what_layouts_take() {
    let boards: Vec<_> = counted().collect();
    let is_other = !generated(&document(README), "layouts").expect("the README has the marks").contains(&compiler());
    if boards.len() < 2 || (is_other && !is_blessing()) {
        println!("skipped the layouts' figures: they are those of another compiler, or of chips that are not here");
        return;
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared/scenes/bunny/bunny_smooth.obj");
    if !path.is_file() {
        println!("skipped the layouts' figures: {} is absent", path.display());
        return;
    }
    let bench = import::load(&root("scenes/bench-1k/scene.toml")).expect("a scene of ours").model;
    let names: Vec<&str> = boards.iter().map(|(board, _)| board.name).collect();
    let mut text = format!(
        "| `--prefer` | bytes a triangle | instructions a ray, {} |\n| --- | --- | --- | --- |\n",
        names.join(" | instructions a ray, ")
    );
    text.push_str(&row(&bench, &boards));

    let (bunny, blob) = largest_bunny(&import::load(&path).expect("a shared scene").model);
    let host = exact14().render(blob.bytes(), [16, 16], &|_| {}).expect("a blob just made");
    let elf =
        Wanted { board: &MICROBIT, blob: blob.bytes(), hits: None, count: false }.provide().expect("it can be built");
    let run = Run { board: &MICROBIT, elf: &elf, blob: Some(blob.bytes()), counter: None, limit: LIMIT };
    let chip = run.perform(&mut Vec::new()).expect("it goes well");
    assert!(chip.picture == host.picture, "the chip's picture of bunny is another");
    let _ = write!(
        text,
        "\nBunny (smooth, 69,451 triangles), decimated to {} triangles, takes {} bytes with `--prefer size` and runs on the \
         micro:bit, whose flash has 256 KiB; the picture is the host's, bit for bit. Counted with {}.\n",
        bunny.triangles.len(),
        blob.bytes().len(),
        compiler()
    );
    check_part(README, "layouts", &text, |a, b| a == b);
}
