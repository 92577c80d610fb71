//! The kernels of the 2009 report: how far their pictures are from the reference, what their knobs do, and that the
//! conservative one's tree loses no hit.

use core_rt::arithmetic::Knobs;
use core_rt::blob::Header;
use core_rt::bvh::Intersect;
use core_rt::hanika::{Conservative, Hanika, HanikaCd, PlainC, RefinedCd, Variant};
use core_rt::kernel::{Kernel, NONE};
use core_rt::profile::Full;
use core_rt::scene::{MAX_DEPTH, Scene};
use core_rt::stats::NoStats;
use host_tools::compare::compare;
use host_tools::engine::{self, Engine};
use host_tools::model::Model;
use host_tools::picture::Picture;
use host_tools::prepare::{Options, PrepareError, Prepared, prepare};
use host_tools::reference::{Hit, Reference};
use host_tools::tree::TreeOptions;
use rayon::prelude::*;
use tests::scenes;

const KERNELS: [&str; 4] = ["hanika-c", "hanika-cd", "hanika-cons", "exact29"];

fn engine(name: &str) -> &'static dyn Engine {
    engine::by_name(name).expect("a kernel of this name")
}

fn prepared(name: &str, model: &Model, knobs: Knobs) -> Result<Prepared, PrepareError> {
    engine(name).prepare(model, &Options { knobs, ..Options::default() })
}

fn picture(name: &str, model: &Model, knobs: Knobs) -> Picture {
    let prepared = prepared(name, model, knobs).expect("it fits");
    engine(name).render(prepared.blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture
}

fn header(name: &str, model: &Model, knobs: Knobs) -> Header {
    let prepared = prepared(name, model, knobs).expect("it fits");
    engine(name).inspect(prepared.blob.bytes()).expect("a blob just made").0
}

/// The reference's picture, and what each pixel of it sees.
fn truth(model: &Model) -> (Picture, Vec<Option<Hit>>) {
    let [width, height] = model.render.size;
    let (pixels, hits) = Reference::new(model).render([width, height], &|_| {});
    (Picture::from_fn(width, height, |x, y| pixels[(y * width + x) as usize]), hits)
}

/// What the report's refinement buys, and what a conservative box buys on top. With `INTRAY_LONG`, at the report's size.
#[test]
fn the_refinement_is_never_worse_and_the_conservative_box_neither() {
    let size = if tests::effort() > 1 { [1024, 1024] } else { [256, 256] };
    for (name, model) in scenes::with_shared(size) {
        let (truth, _) = truth(&model);
        let over_64 = KERNELS
            .map(|kernel| compare(&picture(kernel, &model, Knobs::default()), &truth).expect("one size").over_64);
        println!("{name}: over 64 by {KERNELS:?}: {over_64:?}");
        let [c, cd, cons, exact] = over_64;
        assert!(cd <= c, "{name}: hanika-cd has {cd}, and hanika-c {c}");
        assert!(cons <= cd, "{name}: hanika-cons has {cons}, and hanika-cd {cd}");
        assert!(exact <= cons, "{name}: exact29 has {exact}, and hanika-cons {cons}");
    }
}

/// The nearest hit over all triangles and spheres, by the kernel's own tests and in its own order.
fn brute<K: Kernel>(scene: &Scene<'_, Full<K>>, ray: &K::Ray) -> u32 {
    let (bvh, skip) = (&scene.bvh, K::skip(ray));
    let triangles = (0..).zip(bvh.triangles.records).filter(|(index, _)| *index != skip);
    let triangles = triangles.map(|(index, triangle)| (index, K::intersect(ray, triangle)));
    let spheres = (bvh.triangles.len()..).zip(bvh.spheres);
    let spheres = spheres.map(|(index, sphere)| (index, K::intersect_sphere(ray, sphere, index == skip)));
    let hits = triangles.chain(spheres).filter_map(|(index, depth)| Some((index, depth?)));
    let nearest = hits.min_by(|(i, a), (j, b)| K::order(a, b).then(bvh.id(*i).cmp(&bvh.id(*j))));
    nearest.map_or(NONE, |(index, _)| index)
}

fn closest<K: Kernel>(scene: &Scene<'_, Full<K>>, ray: &K::Ray) -> u32 {
    let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
    scene.bvh.closest(ray, &mut stack, &mut NoStats)
}

/// The ray through a pixel, by its number.
fn primary<K: Kernel>(scene: &Scene<'_, Full<K>>, pixel: u32) -> Option<K::Ray> {
    let width = u32::from(scene.frame.size[0]);
    K::primary(scene.settings, &scene.camera, (pixel % width) as u16, (pixel / width) as u16)
}

/// Of every `step`th pixel, how many see something else through the tree than over all primitives.
fn lost<V: Variant>(model: &Model, leaf_max: u32, step: usize) -> usize {
    let tree = TreeOptions { leaf_max, leaf_always: true, ..TreeOptions::default() };
    let blob = prepare::<Hanika<V>>(model, &Options { tree, ..Options::default() }).expect("it fits").blob;
    let scene = Scene::<Full<Hanika<V>>>::new_checked(blob.bytes()).expect("a blob just made");
    let pixels: u32 = model.render.size.iter().product();
    let differs = |&pixel: &u32| {
        let Some(ray) = primary(&scene, pixel) else { return false };
        closest(&scene, &ray) != brute(&scene, &ray)
    };
    (0..pixels).into_par_iter().step_by(step).filter(differs).count()
}

/// With conservative boxes the tree changes nothing at all, whatever its leaves; with the report's it does, so the
/// comparison can fail.
#[test]
fn the_conservative_tree_is_brute_force() {
    let mut lost_by_refined = 0;
    for (name, model) in scenes::with_shared([256, 256]) {
        // About a second a scene.
        let step = (model.triangles.len() / 256).max(1);
        for leaf_max in [1, 8, 64] {
            assert_eq!(lost::<Conservative>(&model, leaf_max, step), 0, "{name}, leaves to {leaf_max}");
        }
        let plain = lost::<PlainC>(&model, 1, step);
        let refined = lost::<RefinedCd>(&model, 1, step);
        println!("{name}: of every {step}th pixel hanika-c loses {plain} and hanika-cd {refined} to its boxes");
        lost_by_refined += plain + refined;
    }
    assert!(lost_by_refined > 0, "the report's boxes lose nothing here: the test has no teeth");
}

/// Pixels in which the reference sees a triangle and the kernel none, and how many of them the triangles of `hanika-cd`
/// have alone, without any box.
fn holes<V: Variant>(model: &Model, knobs: Knobs) -> [usize; 2] {
    let options = |knobs| Options { knobs, ..Options::default() };
    let blob = prepare::<Hanika<V>>(model, &options(knobs)).expect("it fits").blob;
    let scene = Scene::<Full<Hanika<V>>>::new_checked(blob.bytes()).expect("a blob just made");
    let triangles = Knobs { edge_shift: knobs.edge_shift, ..Knobs::default() };
    let blob = prepare::<HanikaCd>(model, &options(triangles)).expect("it fits").blob;
    let alone = Scene::<Full<HanikaCd>>::new_checked(blob.bytes()).expect("a blob just made");
    let (_, truth) = truth(model);
    let seen = (0..).zip(&truth).filter(|(_, hit)| hit.is_some()).map(|(pixel, _)| pixel);
    let rays = seen.filter_map(|pixel: u32| Some((primary(&scene, pixel)?, primary(&alone, pixel)?)));
    let holes: Vec<_> = rays.filter(|(ray, _)| closest(&scene, ray) == NONE).map(|(_, ray)| ray).collect();
    [holes.len(), holes.par_iter().filter(|ray| brute(&alone, ray) == NONE).count()]
}

/// Where `hanika-cons` has a hole, it is one of the triangles alone. With C = 5 the report's boxes have others, and with
/// E = 0 the triangles have many, so both figures can be wrong.
#[test]
fn the_conservative_box_makes_no_hole() {
    let coarse = Knobs { edge_shift: Some(0), ..Knobs::default() };
    let mut inside = scenes::inside(64);
    inside.render.size = [256, 256];
    let scenes = scenes::with_shared([256, 256]).into_iter();
    let mut cases: Vec<_> = scenes.map(|(name, model)| (name, model, Knobs::default())).collect();
    cases.push(("inside, E = 0", inside.clone(), coarse));
    let mut most = 0;
    for (name, model, knobs) in cases {
        let [all, own] = holes::<Conservative>(&model, knobs);
        println!("{name}: {all} holes, {own} of them of the triangles alone");
        assert_eq!(all, own, "{name}");
        most = most.max(own);
    }
    let [all, own] = holes::<PlainC>(&inside, Knobs { c_bits: Some(5), ..Knobs::default() });
    println!("inside, C = 5: {all} holes, {own} of them of the triangles alone");
    assert!(all > 100 && own == 0 && most > 50, "{all} {own} {most}: the test has no teeth");
}

/// The report's edge shift is the scene's; one that is asked for is taken as it is.
#[test]
fn the_edge_shift_is_the_scenes_or_the_users() {
    let ten = Knobs { edge_shift: Some(10), ..Knobs::default() };
    let mut found = Vec::new();
    for (name, model) in scenes::with_shared([16, 16]) {
        let shift = header("hanika-cd", &model, Knobs::default()).arithmetic.edge_shift;
        for kernel in ["hanika-c", "hanika-cons"] {
            assert_eq!(header(kernel, &model, Knobs::default()).arithmetic.edge_shift, shift, "{name}");
        }
        assert_eq!(header("hanika-cd", &model, ten).arithmetic.edge_shift, 10, "{name}");
        println!("{name}: E = {shift}");
        found.push(shift);
    }
    found.sort_unstable();
    found.dedup();
    assert!(found.len() > 2, "{found:?}: scenes differ");
    assert_eq!(header("exact29", &scenes::inside(3), Knobs::default()).arithmetic.edge_shift, 0);
}

#[test]
fn knobs_out_of_range_are_refused_with_the_range() {
    let model = scenes::inside(3);
    let refused = |kernel: &str, knobs: Knobs, message: &str| {
        let error = prepared(kernel, &model, knobs).expect_err("out of range");
        assert_eq!(error.to_string(), format!("{kernel} cannot be set so: {message}"));
    };
    let c_bits = |c| Knobs { c_bits: Some(c), ..Knobs::default() };
    let d_bits = |d| Knobs { d_bits: Some(d), ..Knobs::default() };
    let edge_shift = |e| Knobs { edge_shift: Some(e), ..Knobs::default() };
    let epsilon = |epsilon| Knobs { epsilon: Some(epsilon), ..Knobs::default() };
    let ranges = "--c-bits is 0 to 28, and --d-bits the same; --edge-shift is 0 to 29, and --epsilon 1 to 64";
    for knobs in [c_bits(29), c_bits(255), d_bits(11), edge_shift(30), epsilon(0), epsilon(65)] {
        refused("hanika-c", knobs, ranges);
    }
    let ranges =
        "--c-bits is 0 to 28, and --d-bits that or up to 6 less; --edge-shift is 0 to 29, and --epsilon 1 to 64";
    for knobs in [c_bits(29), d_bits(8), d_bits(16), edge_shift(30), epsilon(0)] {
        refused("hanika-cd", knobs, ranges);
    }
    let ranges = "--edge-shift is 0 to 29, and --epsilon 1 to 64; it has no --c-bits and no --d-bits";
    for knobs in [c_bits(12), d_bits(0), edge_shift(255), epsilon(0)] {
        refused("hanika-cons", knobs, ranges);
    }
    refused("exact29", edge_shift(10), "it has no knobs");
}

/// Without bits for reciprocals every component over 1/2 has the same one, as the report says.
#[test]
fn c_acts() {
    let mut model = scenes::inside(32);
    model.render.size = [256, 256];
    let (truth, _) = truth(&model);
    let over_64 = |c_bits| {
        let knobs = Knobs { c_bits: Some(c_bits), ..Knobs::default() };
        compare(&picture("hanika-c", &model, knobs), &truth).expect("one size").over_64
    };
    let [naive, chosen, vanishing] = [0, 12, 28].map(over_64);
    println!("over 64 with C = 0: {naive}, 12: {chosen}, 28: {vanishing}");
    assert!(naive > 20 * chosen.max(100) && vanishing > 20 * chosen.max(100));
}

/// An E that is too large clamps edges, and small triangles grow over their neighbours; one that is too small leaves few bits.
#[test]
fn the_edge_shift_acts() {
    let mut model = scenes::inside(32);
    model.render.size = [256, 256];
    let (truth, _) = truth(&model);
    let over_1 = |edge_shift| {
        let knobs = Knobs { edge_shift, ..Knobs::default() };
        compare(&picture("hanika-cons", &model, knobs), &truth).expect("one size").over_1
    };
    let [own, none, most] = [None, Some(0), Some(29)].map(over_1);
    println!("over 1 with the scene's E: {own}, 0: {none}, 29: {most}");
    assert!(none > 2 * own && most > 100 * own.max(10));
}

#[test]
fn pictures_depend_on_neither_threads_nor_tiles() {
    let model = &scenes::all()[0].1;
    for kernel in &KERNELS[..3] {
        let prepared = prepared(kernel, model, Knobs::default()).expect("it fits");
        let crc = |threads: usize, tile: [u16; 2]| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            let render = || engine(kernel).render(prepared.blob.bytes(), tile, &|_| {});
            pool.install(render).expect("a blob just made").picture.crc32()
        };
        let one = crc(1, [64, 64]);
        assert_eq!([crc(2, [64, 64]), crc(1, [7, 5]), crc(2, [16, 1])], [one; 3], "{kernel}");
    }
}
