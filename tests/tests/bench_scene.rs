//! The performance scene's work, exactly: whoever changes the tree, the traversal or the scene sees by how much, and
//! figures of different days stand for the same rays. `INTRAY_BLESS=1` renews them.

use std::path::Path;

use core_rt::bvh::{Intersect, Waiting};
use core_rt::exact::{Exact14, Exact20, Exact29};
use core_rt::kernel::Kernel;
use core_rt::profile::Full;
use core_rt::scene::{MAX_DEPTH, Scene};
use core_rt::stats::Counts;
use host_tools::import;
use host_tools::model::Model;
use host_tools::prepare::{self, Options};

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

fn bench() -> Model {
    import::load(&root().join("scenes/bench-1k/scene.toml")).expect("the performance scene").model
}

/// What the nearest hits of all camera rays take, and how many there are.
fn counts<K: Kernel>(model: &Model) -> (Counts, u64) {
    let prepared = prepare::prepare::<K>(model, &Options::default()).expect("it fits");
    let scene = Scene::<Full<K>>::new_checked(prepared.blob.bytes()).expect("a blob just made");
    let mut stack = heapless::Vec::<Waiting<K>, MAX_DEPTH>::new();
    let (mut counts, mut hits) = (Counts::default(), 0);
    let [width, height] = scene.frame.size;
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let Some(ray) = K::primary(scene.settings, &scene.camera, x, y) else { continue };
        let hit = scene.bvh.closest(&ray, &mut stack, &mut counts);
        hits += u64::from(scene.bvh.triangles.material(hit).is_some());
    }
    (counts, hits)
}

fn line<K: Kernel>(model: &Model) -> String {
    let rays = model.render.size.map(u64::from).iter().product::<u64>() as f64;
    let (Counts { box_tests, triangle_tests, .. }, hits) = counts::<K>(model);
    format!(
        "{}: {box_tests} box tests ({:.2} a ray), {triangle_tests} triangle tests ({:.2} a ray), {hits} hits\n",
        K::NAME,
        box_tests as f64 / rays,
        triangle_tests as f64 / rays,
    )
}

#[test]
fn camera_rays_take_the_tests_that_were_written_down() {
    let model = bench();
    let found = line::<Exact14>(&model) + &line::<Exact20>(&model) + &line::<Exact29>(&model);
    let path = root().join("tests/goldens/bench-1k.txt");
    if std::env::var_os("INTRAY_BLESS").is_some() {
        std::fs::write(&path, &found).expect("a golden can be written");
    }
    let expected = std::fs::read_to_string(&path).expect("a golden");
    assert_eq!(found, expected, "the tree, the traversal or the scene has changed; INTRAY_BLESS=1 renews this");
}

/// What the scene is for: a common amount of work a ray, between a scene seen small and one that fills the picture.
#[test]
fn camera_rays_take_about_twenty_boxes_and_three_triangles() {
    let model = bench();
    assert!((900..=1000).contains(&model.triangles.len()));
    assert!(model.normals.is_empty());
    let rays = model.render.size.iter().product::<u32>() as f64;
    let (counts, _) = counts::<Exact14>(&model);
    let (boxes, triangles) = (counts.box_tests as f64 / rays, counts.triangle_tests as f64 / rays);
    assert!((18.0..22.0).contains(&boxes) && (2.0..4.0).contains(&triangles), "{boxes} and {triangles}");
}

#[test]
fn another_scene_has_other_counts() {
    let model = bench();
    let mut moved = model.clone();
    moved.camera.position.x += 1e-3;
    assert_ne!(line::<Exact14>(&model), line::<Exact14>(&moved));
}
