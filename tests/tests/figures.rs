//! How far each kernel's pictures are from the f64 reference, scene by scene: pixels over 64 of 255, and holes, where the
//! background is seen and the reference sees a surface. With `INTRAY_LONG`, at 1024x1024.
//!
//! Elsewhere are: that every pixel of `exact29` that is far off on real models has a reason (`error`), and that `hanika-cons`
//! has no hole which its triangles alone do not have (`hanika`).

use host_tools::compare::compare;
use host_tools::engine;
use host_tools::model::Model;
use host_tools::picture::Picture;
use host_tools::prepare::Options;
use host_tools::reference::{Hit, Reference, encode};
use tests::scenes;

const KERNELS: [&str; 6] = ["hanika-c", "hanika-cd", "hanika-cons", "exact20", "exact29", "f32"];

/// The background, of no surface's colour.
const MAGENTA: [u8; 3] = [255, 0, 255];

/// Scenes in which surfaces lie in one plane: which of them is seen is decided by rounding, in the reference too.
const TIES: [&str; 1] = ["cornell-box/scene.toml"];

/// How much farther than the nearest hit another may be for the two to be a tie: about what the 29-bit grid resolves.
const TIE: f64 = 1.0 / (1 << 26) as f64;

/// How many pixels beside a pixel's middle an edge may pass for the pixel to be on it: 32 of the 29-bit grid's steps in a
/// picture 1024 wide.
const EDGE: f64 = 1.0 / (1 << 14) as f64;

/// What a kernel makes of a scene.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Figure {
    over_64: u64,
    holes: usize,
}

struct Truth {
    picture: Picture,
    hits: Vec<Option<Hit>>,
}

/// The scene at the size of this run, before a background that no surface has.
fn staged(mut model: Model) -> Model {
    model.render.size = if tests::effort() > 1 { [1024, 1024] } else { [256, 256] };
    model.background = glam::DVec3::new(1.0, 0.0, 1.0).into();
    model
}

fn truth(model: &Model) -> Truth {
    let [width, height] = model.render.size;
    let (pixels, hits) = Reference::new(model).render([width, height], &|_| {});
    Truth { picture: Picture::from_fn(width, height, |x, y| pixels[(y * width + x) as usize]), hits }
}

fn picture(kernel: &str, model: &Model) -> Picture {
    let engine = engine::by_name(kernel).expect("a kernel of this name");
    let prepared = engine.prepare(model, &Options::default()).expect("it fits");
    engine.render(prepared.blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture
}

fn figure(ours: &Picture, truth: &Truth) -> Figure {
    let over_64 = compare(ours, &truth.picture).expect("one size").over_64;
    let holes =
        ours.pixels().iter().zip(&truth.hits).filter(|(pixel, hit)| **pixel == MAGENTA && hit.is_some()).count();
    Figure { over_64, holes }
}

/// A row of the table, in which no refinement is worse than what it refines. Returns the figures of `exact29`.
fn row(name: &str, model: &Model, truth: &Truth) -> Figure {
    let figures = KERNELS.map(|kernel| figure(&picture(kernel, model), truth));
    println!("| {name} | {} |", figures.map(|f| format!("{} / {}", f.over_64, f.holes)).join(" | "));
    let [c, cd, cons, _, exact, _] = figures;
    assert!(cd.over_64 <= c.over_64 && cd.holes <= c.holes, "{name}: hanika-cd {cd:?}, hanika-c {c:?}");
    assert!(cons.over_64 <= cd.over_64 && cons.holes <= cd.holes, "{name}: hanika-cons {cons:?}, hanika-cd {cd:?}");
    exact
}

fn over_64(a: [u8; 3], b: [u8; 3]) -> bool {
    a.iter().zip(b).map(|(a, b)| u32::from(a.abs_diff(b))).sum::<u32>() > 64
}

/// How many pixels over 64 are ties, how many are on an edge, and how many are neither.
fn reasons(model: &Model, ours: &Picture, truth: &Truth) -> [usize; 3] {
    let reference = Reference::new(model);
    let [width, _] = model.render.size;
    let mut counts = [0; 3];
    let pixels = (0u32..).zip(ours.pixels().iter().zip(truth.picture.pixels()));
    for (i, _) in pixels.filter(|(_, (a, b))| over_64(**a, **b)) {
        let ray = |dx: f64, dy: f64| {
            let (x, y) = (f64::from(i % width) + 0.5 + dx, f64::from(i / width) + 0.5 + dy);
            reference.camera_ray(model.render.size, x, y)
        };
        let seen = |(origin, direction)| encode(reference.sample(origin, direction).colour, model.render.transfer);
        let (origin, direction) = ray(0.0, 0.0);
        let reason = if reference.candidates(origin, direction, TIE).len() > 1 {
            0
        } else {
            let beside = [(EDGE, 0.0), (-EDGE, 0.0), (0.0, EDGE), (0.0, -EDGE)];
            let is_edge = beside.iter().any(|&(dx, dy)| over_64(seen(ray(dx, dy)), seen((origin, direction))));
            if is_edge { 1 } else { 2 }
        };
        counts[reason] += 1;
    }
    counts
}

#[test]
fn pixels_over_64_and_holes() {
    println!("pixels over 64 / holes\n| scene | {} |\n|{}", KERNELS.join(" | "), " --- |".repeat(KERNELS.len() + 1));
    let closed = scenes::closed();
    let closed_names: Vec<_> = closed.iter().map(|(name, _)| *name).collect();
    for (name, model) in scenes::with_shared([1, 1]).into_iter().chain(closed) {
        let model = staged(model);
        let truth = truth(&model);
        let exact = row(name, &model, &truth);
        assert!(exact.holes == 0 || !closed_names.contains(&name), "{name}: {exact:?}");
        if TIES.contains(&name) {
            let [ties, edges, others] = reasons(&model, &picture("exact29", &model), &truth);
            println!("of exact29's in {name} {ties} are ties, and {edges} on an edge");
            assert!(ties > 0 && others == 0, "{name}: {others} are neither a tie nor on an edge");
        } else {
            assert_eq!(exact.over_64, 0, "{name}");
        }
    }
}

/// Few steps of the grid are left for what stands on a ground that is 1e4 times larger.
#[test]
fn everyday_objects_on_a_vast_ground() {
    let model = staged(scenes::vast_ground(1e4));
    let exact = row("everyday objects, ground 1e4 larger", &model, &truth(&model));
    assert!(exact.over_64 <= 15 && exact.holes == 0, "{exact:?}");
}

/// A figure that cannot be wrong would show nothing: a sphere that lacks a triangle has a hole, and nothing explains its
/// pixels.
#[test]
fn a_hole_is_noticed() {
    let whole = staged(scenes::inside(17));
    let mut open = whole.clone();
    let truth = truth(&whole);
    let middle = truth.hits[truth.hits.len() / 2 + truth.picture.width() as usize / 2].expect("it is closed");
    open.triangles.remove(middle.prim as usize);
    let ours = picture("exact29", &open);
    let found = figure(&ours, &truth);
    assert!(found.holes > 0 && found.over_64 >= found.holes as u64, "{found:?}");
    assert!(reasons(&whole, &ours, &truth)[2] >= found.holes - found.holes / 4, "most are far from any edge");
}
