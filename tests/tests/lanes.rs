//! `exact29` by vector units beside the plain walk, its twin: the same pictures, and the same hits of rays that look for
//! trouble. Nothing is compared on a machine without the units, and that is said.

use core_rt::bvh::{Bvh, Intersect};
use core_rt::exact::{Exact29, Ray, Width29};
use core_rt::kernel::{Bounds, Kernel, NONE, Vertices};
use core_rt::mesh::Mesh;
use core_rt::profile::{Full, Prefer};
use core_rt::scene::{MAX_DEPTH, Scene};
use core_rt::section::Integers;
use core_rt::sphere;
use core_rt::stats::{Counts, NoStats};
use exact_simd::{Tree, Tree32};
use float_rt::Float32;
use host_tools::engine::{self, Engine};
use host_tools::model::Model;
use host_tools::prepare::{Options, prepare};
use host_tools::stress::cases;
use host_tools::tree::{self, TreeOptions};
use host_tools::{grid::Grid, import};
use rayon::prelude::*;
use tests::balls::Ball;
use tests::random::SplitMix64;
use tests::rays::Rays;
use tests::{ball_rays, meshes, rays, scenes, shared};

fn has_lanes() -> bool {
    let found = exact_simd::unit().is_some();
    if !found {
        println!("skipped: this machine has no vector units that are used");
    }
    found
}

/// A tree over triangles and spheres as the blob has it, and the one that is made of it.
struct Built {
    tree: tree::Tree,
    nodes: Vec<<Exact29 as Kernel>::Node>,
    triangles: Vec<<Exact29 as Kernel>::Triangle>,
    spheres: Vec<<Exact29 as Kernel>::Sphere>,
    /// The place of each triangle.
    places: Vec<u32>,
}

impl Built {
    fn new(corners: &[Vertices], balls: &[Ball], leaf_max: u32) -> Self {
        let options = TreeOptions { leaf_max, leaf_always: leaf_max != 8, ..TreeOptions::default() };
        let on_grid = |ball: &Ball| sphere::Ball { centre: ball.centre.map(|c| c as i32), radius: ball.radius as i32 };
        let boxes = balls.iter().map(|ball| on_grid(ball).bounds());
        let tree = tree::build_mixed(corners.iter().map(Bounds::of), boxes, options);
        let (triangles, spheres) = tree.order.split_at(corners.len());
        let triangle = |&i: &u32| Exact29::triangle((), &corners[i as usize], 0).expect("on the grid, with area");
        let ball = |&i: &u32| Exact29::sphere(&on_grid(&balls[i as usize - corners.len()]), 0).expect("on the grid");
        let mut places = vec![0; tree.order.len()];
        for (place, &id) in (0..).zip(&tree.order) {
            places[id as usize] = place;
        }
        Self {
            nodes: tree.nodes.iter().map(|n| Exact29::node(n.boxes, n.children)).collect(),
            triangles: triangles.iter().map(triangle).collect(),
            spheres: spheres.iter().map(ball).collect(),
            tree,
            places,
        }
    }

    /// The scene, with ids of its own.
    fn view<'a>(&'a self, ids: &'a [u32]) -> Bvh<'a, Full<Exact29>> {
        Bvh {
            root: self.tree.root,
            nodes: &self.nodes,
            triangles: Mesh::whole((), &self.triangles),
            spheres: &self.spheres,
            ids: Integers::Wide(ids),
        }
    }
}

/// The rays of which lanes say something else than the walk in place does, with what both say of the first few; and how
/// many hit.
fn compare(
    (tree, lanes): (&Tree, &Bvh<'_, Full<Exact29>>),
    plain: &Bvh<'_, Full<Exact29>>,
    rays: &[Ray<Width29>],
) -> (Vec<String>, usize) {
    let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
    let (mut wrong, mut hits) = (Vec::new(), 0);
    for ray in rays {
        let expected = plain.closest(ray, &mut stack, &mut NoStats);
        let found = tree.closest(lanes, ray, &mut stack, &mut NoStats);
        // All that is hit is asked about, once.
        let asked = |any: &dyn Fn(&mut dyn FnMut(u32) -> bool) -> bool| {
            let mut asked = Vec::new();
            let is_blocked = any(&mut |index| {
                asked.push(index);
                false
            });
            asked.sort_unstable();
            (is_blocked, asked)
        };
        let all = asked(&|blocks| plain.any(ray, &mut heapless::Vec::<_, MAX_DEPTH>::new(), &mut NoStats, blocks));
        let all_found =
            asked(&|blocks| tree.any(lanes, ray, &mut heapless::Vec::<_, MAX_DEPTH>::new(), &mut NoStats, blocks));
        hits += usize::from(expected != NONE);
        if found != expected || all != all_found {
            wrong.push(format!("{ray:?}: {found} {all_found:?}, and not {expected} {all:?}"));
        }
    }
    (wrong, hits)
}

/// The same, by all threads, and it must be nothing.
fn agree(name: &str, built: &Built, rays: &[Ray<Width29>]) {
    let bvh = built.view(&built.tree.order);
    let tree = Tree::new(&bvh).expect("there are vector units");
    let parts: Vec<_> = rays.par_chunks(4096).map(|rays| compare((&tree, &bvh), &bvh, rays)).collect();
    let wrong: Vec<&String> = parts.iter().flat_map(|(wrong, _)| wrong).collect();
    let hits: usize = parts.iter().map(|&(_, hits)| hits).sum();
    println!("{name}: {} rays, {hits} hits, {} differ", rays.len(), wrong.len());
    assert!(wrong.is_empty(), "{name}: {} differ\n{:#?}", wrong.len(), &wrong[..wrong.len().min(5)]);
    assert!(hits * 20 > rays.len(), "{name}: only {hits} of {} rays hit anything", rays.len());
}

/// Triangles as the kernel may hold them: moved off the margins, and without those that lose their area thereby.
fn on_grid(triangles: &[[[i64; 3]; 3]]) -> (Vec<Vertices>, Vec<[[i64; 3]; 3]>) {
    let last = (1i64 << Exact29::GRID_BITS) - 1 - i64::from(Exact29::MARGIN);
    let moved = triangles.iter().map(|t| t.map(|v| v.map(|c| c.clamp(Exact29::MARGIN.into(), last))));
    let both = moved.map(|t| (t.map(|v| v.map(|c| c as i32)), t));
    both.filter(|(corners, _)| Exact29::triangle((), corners, 0).is_some()).unzip()
}

/// Rays of every adversarial kind at triangles.
fn adversarial(built: &Built, triangles: &[[[i64; 3]; 3]], count: usize, seed: u64) -> Vec<Ray<Width29>> {
    let coordinates = || triangles.iter().flatten().flatten().copied();
    let (low, high) = (coordinates().min().unwrap_or(0), coordinates().max().unwrap_or(0));
    let span = i64::from(Exact29::SPAN);
    let bounds = rays::Bounds {
        grid_bits: Exact29::GRID_BITS,
        origin: [(high - span).min(0), (low + span).max((1 << Exact29::GRID_BITS) - 1)],
        direction: (1 << Exact29::DIRECTION_BITS) - 1,
    };
    let ray = |(_, ray): (_, tests::oracle::Ray)| {
        let skip = ray.skip.map_or(NONE, |id| built.places[id as usize]);
        match ray.limit {
            None => Ray::new(ray.origin, ray.direction, skip),
            Some(_) => Ray::segment(ray.origin, [0, 1, 2].map(|i| ray.origin[i] + ray.direction[i]), skip),
        }
    };
    Rays::new(triangles, bounds, seed).filter_map(ray).take(count).collect()
}

/// How many rays all meshes get together.
fn effort(rays: usize) -> usize {
    if tests::effort() > 1 { 10_000_000 } else { rays }
}

#[test]
fn rays_at_small_meshes_have_the_hits_of_the_plain_walk() {
    if !has_lanes() {
        return;
    }
    let meshes = meshes::all(Exact29::GRID_BITS);
    let count = effort(100_000) / (3 * meshes.len()) + 1;
    for (seed, (name, triangles)) in (1..).zip(&meshes) {
        let (corners, triangles) = on_grid(triangles);
        for leaf_max in [1, 8, 64] {
            let built = Built::new(&corners, &[], leaf_max);
            let rays = adversarial(&built, &triangles, count, 100 * seed + u64::from(leaf_max));
            agree(&format!("{name}, leaves to {leaf_max}"), &built, &rays);
        }
    }
}

#[test]
fn rays_at_large_meshes_have_the_hits_of_the_plain_walk() {
    if !has_lanes() {
        return;
    }
    let count = if tests::effort() > 1 { 1_000_000 } else { 20_000 };
    let (corners, triangles) = on_grid(&meshes::heightfield(29, 200, 5));
    let built = Built::new(&corners, &[], 8);
    agree("heightfield of 80,000", &built, &adversarial(&built, &triangles, count, 5));
    for scene in ["bunny/bunny_smooth.obj", "sponza-dabrovic/scene.toml", "coffee/coffee.obj"] {
        let Some(path) = shared::scene(scene) else { continue };
        let model = import::load(&path).expect("a real model").model;
        let snapped = Grid::fit::<Exact29>(&model).expect("it has extent").snap(&model);
        let (corners, triangles) = on_grid(&snapped.iter().map(|t| t.map(|v| v.map(i64::from))).collect::<Vec<_>>());
        let built = Built::new(&corners, &[], 8);
        agree(scene, &built, &adversarial(&built, &triangles, count, 7));
    }
}

#[test]
fn rays_at_spheres_among_triangles_have_the_hits_of_the_plain_walk() {
    if !has_lanes() {
        return;
    }
    let (corners, _) = on_grid(&meshes::soup(29, 300, 3));
    for (seed, leaf_max) in [(1, 1), (2, 8), (3, 64)] {
        let mut random = SplitMix64(seed);
        let balls = ball_rays::balls::<Exact29>(&mut random, 200);
        let built = Built::new(&corners, &balls, leaf_max);
        let count = effort(30_000) / 3;
        let rays = ball_rays::rays::<Exact29>(&mut random, &balls, count).into_iter();
        let skip = |random: &mut SplitMix64| {
            if random.coin() { random.below(built.tree.order.len() as u64) as u32 } else { NONE }
        };
        let rays: Vec<_> = rays.filter_map(|(o, d)| Ray::new(o, d, skip(&mut random))).collect();
        agree(&format!("spheres and triangles, leaves to {leaf_max}"), &built, &rays);
    }
}

/// Meshes in the corners of the grid, which rays meet from as far off it as the kernel holds.
#[test]
fn rays_from_off_the_grid_have_the_hits_of_the_plain_walk() {
    if !has_lanes() {
        return;
    }
    let last = (1 << Exact29::GRID_BITS) - 1 - i64::from(Exact29::MARGIN);
    for (seed, offset) in [(1, 0), (2, last - (1 << 20))] {
        let moved: Vec<_> =
            meshes::sphere(20, 8).iter().map(|triangle| triangle.map(|v| v.map(|c| c + offset))).collect();
        let (corners, triangles) = on_grid(&moved);
        let built = Built::new(&corners, &[], 8);
        let rays = adversarial(&built, &triangles, 5000, seed);
        assert!(
            rays.iter().any(|ray| ray.origin.iter().any(|c| !(0..1 << 29).contains(c))),
            "none is from off the grid"
        );
        agree("a corner of the grid", &built, &rays);
    }
}

/// The picture by lanes and the plain one.
fn pictures_agree(name: &str, engine: &dyn Engine, model: &Model) {
    for (prefer, what) in [(Prefer::Speed, "records"), (Prefer::Size, "shared vertices")] {
        let Ok(prepared) = engine.prepare(model, &Options { prefer, ..Options::default() }) else { continue };
        let blob = prepared.blob.bytes();
        let plain = engine.render(blob, [32, 32], &|_| {}).expect("a blob just made");
        for tile in [[32, 32], [7, 64]] {
            let lanes = engine.render_in_lanes(blob, tile, &|_| {}).expect("a blob just made");
            assert!(lanes.picture == plain.picture, "{name}, {what}, tiles of {tile:?}: pictures differ");
            assert_eq!(lanes.counts.rays(), plain.counts.rays(), "{name}, {what}");
        }
    }
}

fn exact29() -> &'static dyn Engine {
    engine::by_name("exact29").expect("a kernel of this name")
}

#[test]
fn goldens_are_the_plain_pictures() {
    for (name, model) in scenes::all().into_iter().chain(scenes::pixels()) {
        pictures_agree(name, exact29(), &model);
    }
}

#[test]
fn the_gallery_is_the_plain_pictures() {
    for name in
        ["gallery/materials", "gallery/spheres", "gallery/mirrors", "gallery/glass", "gallery/textures", "raystones"]
    {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes").join(name).join("scene.toml");
        let mut model = import::load(&path).expect("a scene of ours").model;
        model.render.size = [96, 64];
        pictures_agree(name, exact29(), &model);
    }
}

#[test]
fn stress_cases_are_the_plain_pictures() {
    // Without the million triangles in the normal run, as in the test of the cases themselves.
    let is_wanted = |name: &str| tests::effort() > 1 || name != "million-in-one-place";
    cases::all().par_iter().filter(|case| is_wanted(case.name)).for_each(|case| {
        pictures_agree(case.name, exact29(), &(case.subject)().model);
    });
}

/// By boxes that are all entered the picture would be right, and take its time.
#[test]
fn lanes_test_few_boxes_and_triangles() {
    if !has_lanes() {
        return;
    }
    let (corners, triangles) = on_grid(&meshes::heightfield(29, 200, 5));
    let built = Built::new(&corners, &[], 8);
    let bvh = built.view(&built.tree.order);
    let tree = Tree::new(&bvh).expect("there are vector units");
    let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
    let (mut lanes, mut plain) = (Counts::default(), Counts::default());
    for ray in adversarial(&built, &triangles, 20_000, 9) {
        tree.closest(&bvh, &ray, &mut stack, &mut lanes);
        bvh.closest(&ray, &mut stack, &mut plain);
    }
    println!("{lanes:?} {plain:?}");
    assert!(lanes.box_tests < 2 * plain.box_tests, "{lanes:?} {plain:?}");
    assert!(lanes.triangle_tests < 6 * plain.triangle_tests, "{lanes:?} {plain:?}");
}

/// A comparison that cannot fail would prove nothing: ties that go to the largest id are noticed.
#[test]
fn a_wrong_rule_for_ties_is_noticed() {
    if !has_lanes() {
        return;
    }
    let (corners, triangles) = on_grid(&meshes::duplicates(29, 100, 4));
    let built = Built::new(&corners, &[], 8);
    let reversed: Vec<u32> = built.tree.order.iter().map(|id| u32::MAX - id).collect();
    let (plain, lanes) = (built.view(&built.tree.order), built.view(&reversed));
    let tree = Tree::new(&plain).expect("there are vector units");
    let rays = adversarial(&built, &triangles, 5000, 1);
    assert_eq!(compare((&tree, &plain), &plain, &rays).0, [""; 0]);
    let (wrong, hits) = compare((&tree, &lanes), &plain, &rays);
    assert!(wrong.len() * 4 > hits, "{} of {hits} hits differ", wrong.len());
}

/// And so is a box or a triangle of the lanes that is somewhere else by little.
#[test]
fn a_moved_vertex_is_noticed() {
    if !has_lanes() {
        return;
    }
    let (corners, triangles) = on_grid(&meshes::sphere(29, 8));
    let mut moved = corners.clone();
    for corner in &mut moved[3] {
        corner[1] += 1 << 12;
    }
    let (built, other) = (Built::new(&corners, &[], 8), Built::new(&moved, &[], 8));
    assert_eq!(built.tree.order, other.tree.order, "they are in the same places");
    let (bvh, moved) = (built.view(&built.tree.order), other.view(&other.tree.order));
    let tree = Tree::new(&moved).expect("there are vector units");
    let (wrong, _) = compare((&tree, &bvh), &bvh, &adversarial(&built, &triangles, 20_000, 2));
    assert!(!wrong.is_empty(), "nothing differs");
}

/// What `exact29` is measured beside finds what the scalar `f32` finds, but for what that prunes by its rounding.
#[test]
fn f32_in_lanes_has_the_hits_of_the_scalar_kernel() {
    if !has_lanes() {
        return;
    }
    for (name, model) in scenes::all() {
        let prepared = prepare::<Float32>(&model, &Options::default()).expect("goldens fit every kernel");
        let scene = Scene::<Full<Float32>>::new_checked(prepared.blob.bytes()).expect("just made");
        let tree = Tree32::new(&scene.bvh).expect("there are vector units");
        let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
        let [width, height] = scene.frame.size;
        let (mut rays, mut wrong) = (0, 0);
        for [x, y] in (0..height).flat_map(|y| (0..width).map(move |x| [x, y])) {
            let Some(ray) = scene.primary(&scene.camera, x, y) else { continue };
            let found = tree.closest(&scene.bvh, &ray, &mut NoStats);
            wrong += u32::from(found != scene.bvh.closest(&ray, &mut stack, &mut NoStats));
            rays += 1;
        }
        assert!(wrong * 10_000 <= rays, "{name}: {wrong} of {rays} rays differ");
    }
}
