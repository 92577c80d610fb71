//! Every exact kernel's nearest hit against a brute force that shares no code with it: the same triangle, and the same t
//! as a fraction, for rays of every adversarial kind.

use core_rt::bvh::{Bvh, Intersect};
use core_rt::exact::{Exact, Ray, Width, Width14, Width20, Width29, Width29In};
use core_rt::kernel::{Kernel, NONE, Vertices};
use core_rt::mesh::Mesh;
use core_rt::num::Word;
use core_rt::profile::Full;
use core_rt::scene::MAX_DEPTH;
use core_rt::section::Integers;
use core_rt::stats::NoStats;
use host_tools::tree::{self, TreeOptions};
use rayon::prelude::*;
use tests::oracle::{Nearest, Oracle, Triangle};
use tests::rays::{Bounds, Kind, Rays};
use tests::{meshes, shared};

/// A tree over triangles, kept beside what the oracle knows them by.
struct Built<W: Width> {
    root: u32,
    nodes: Vec<<Exact<W> as Kernel>::Node>,
    triangles: Vec<<Exact<W> as Kernel>::Triangle>,
    /// The triangle that stands at each place.
    ids: Vec<u32>,
    /// The place of each triangle.
    places: Vec<u32>,
}

impl<W> Built<W>
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    fn new(corners: &[Vertices], leaf_max: u32) -> Self {
        let options = TreeOptions { leaf_max, leaf_always: leaf_max != 8, ..TreeOptions::default() };
        let flat = tree::build(corners.iter().map(core_rt::kernel::Bounds::of), options);
        let triangle = |&i: &u32| Exact::<W>::triangle((), &corners[i as usize], 0).expect("on the grid, with area");
        let mut places = vec![0; corners.len()];
        for (place, &id) in (0..).zip(&flat.order) {
            places[id as usize] = place;
        }
        Self {
            root: flat.root,
            nodes: flat.nodes.iter().map(|n| Exact::<W>::node(n.boxes, n.children)).collect(),
            triangles: flat.order.iter().map(triangle).collect(),
            ids: flat.order,
            places,
        }
    }

    fn view(&self) -> Bvh<'_, Full<Exact<W>>> {
        Bvh {
            root: self.root,
            nodes: &self.nodes,
            triangles: Mesh::whole((), &self.triangles),
            spheres: &[],
            ids: Integers::Wide(&self.ids),
        }
    }

    /// The kernel's ray for an oracle's.
    fn ray(&self, ray: &tests::oracle::Ray) -> Option<Ray<W>> {
        let word = |v: [i64; 3]| v.map(|c| W::Word::from_i64(c).expect("rays fit the kernel"));
        let skip = ray.skip.map_or(NONE, |id| self.places[id as usize]);
        match ray.limit {
            None => Ray::new(word(ray.origin), word(ray.direction), skip),
            Some(0) => {
                let to = [0, 1, 2].map(|i| ray.origin[i] + ray.direction[i]);
                Ray::segment(word(ray.origin), word(to), skip)
            }
            Some(limit) => panic!("no ray is made with limit {limit}"),
        }
    }

    /// What the kernel says, in the oracle's terms: the triangle, and whether `t` is the oracle's fraction.
    fn agrees(&self, ray: &tests::oracle::Ray, expected: Option<&Nearest>) -> Result<(), String> {
        let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
        let Some(prepared) = self.ray(ray) else { return Err("the kernel takes the direction for zero".into()) };
        let bvh = self.view();
        let hit = bvh.closest(&prepared, &mut stack, &mut NoStats);
        let any = bvh.any(&prepared, &mut stack, &mut NoStats, |_| true);
        if any != expected.is_some() {
            return Err(format!("any is {any}"));
        }
        let Some(expected) = expected else {
            return if hit == NONE { Ok(()) } else { Err(format!("hit {}", self.ids[hit as usize])) };
        };
        if hit == NONE {
            return Err("missed".into());
        }
        if self.ids[hit as usize] != expected.prim {
            return Err(format!("hit {}", self.ids[hit as usize]));
        }
        let depth = Exact::<W>::intersect(&prepared, &self.triangles[hit as usize]).expect("it was hit");
        // The kernel's direction is the oracle's, shifted: so is the denominator.
        let largest = |v: [i64; 3]| v.map(i64::abs).into_iter().max().unwrap_or(0);
        let scale = largest(prepared.direction.map(|c| c.into())) / largest(ray.direction);
        let (numerator, denominator): (i128, i128) = (depth.numerator.into(), depth.denominator.into());
        if numerator != expected.numerator || denominator != expected.denominator * i128::from(scale) {
            return Err(format!("t is {numerator} / {denominator}"));
        }
        Ok(())
    }
}

/// Triangles as the kernel may hold them: moved off the margins, and without those that lose their area thereby.
fn on_grid<W: Width>(triangles: &[Triangle]) -> (Vec<Vertices>, Vec<Triangle>) {
    let last = (1i64 << W::GRID_BITS) - 1 - i64::from(W::MARGIN);
    triangles
        .iter()
        .map(|t| t.map(|v| v.map(|c| c.clamp(W::MARGIN.into(), last))))
        .map(|t| (t.map(|v| v.map(|c| c as i32)), t))
        .filter(|(corners, _)| Exact::<W>::triangle((), corners, 0).is_some())
        .unzip()
}

/// Rays start anywhere on the grid; where a mesh leaves the span for it, also outside.
fn bounds<W: Width>(triangles: &[Triangle]) -> Bounds {
    let coordinates = || triangles.iter().flatten().flatten().copied();
    let (low, high) = (coordinates().min().unwrap_or(0), coordinates().max().unwrap_or(0));
    // What stand-off adds to the margin is still within the span's budget.
    let span = i64::from(W::SPAN);
    Bounds {
        grid_bits: W::GRID_BITS,
        origin: [(high - span).min(0), (low + span).max((1 << W::GRID_BITS) - 1)],
        direction: (1 << W::DIRECTION_BITS) - 1,
    }
}

/// Compares `count` rays of all kinds, and fails with the first few that differ.
fn compare<W>(name: &str, triangles: &[Triangle], leaf_max: u32, count: usize, seed: u64)
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    let (corners, triangles) = on_grid::<W>(triangles);
    let built = Built::<W>::new(&corners, leaf_max);
    let oracle = Oracle::new(&triangles);
    let rays: Vec<(Kind, tests::oracle::Ray)> =
        Rays::new(&triangles, bounds::<W>(&triangles), seed).take(count).collect();
    let plain: Vec<tests::oracle::Ray> = rays.iter().map(|(_, ray)| *ray).collect();
    let expected = oracle.nearest_batch(&plain);
    let hits = expected.iter().flatten().count();
    let wrong: Vec<String> = rays
        .par_iter()
        .zip(&expected)
        .filter_map(|((kind, ray), expected)| {
            let found = built.agrees(ray, expected.as_ref()).err()?;
            Some(format!("{kind:?} {ray:?}: {found}, and not {expected:?}"))
        })
        .collect();
    println!("{} on {name}, leaves to {leaf_max}: {count} rays, {hits} hits, {} differ", W::NAME, wrong.len());
    assert!(
        wrong.is_empty(),
        "{} on {name}: {} differ\n{}",
        W::NAME,
        wrong.len(),
        wrong[..wrong.len().min(5)].join("\n")
    );
    assert!(hits * 20 > count, "{name}: only {hits} of {count} rays hit anything, so little was compared");
}

fn small<W>(rays: usize)
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    let meshes = meshes::all(W::GRID_BITS);
    // Over all meshes and leaf sizes; the long run takes ten million.
    let rays = if tests::effort() > 1 { 10_000_000 } else { rays };
    let count = rays / (3 * meshes.len()) + 1;
    for (seed, (name, triangles)) in (1..).zip(&meshes) {
        for leaf_max in [1, 8, 64] {
            compare::<W>(name, triangles, leaf_max, count, seed * 100 + u64::from(leaf_max));
        }
    }
}

#[test]
fn exact14_over_small_scenes() {
    small::<Width14>(300_000);
}

#[test]
fn exact20_over_small_scenes() {
    small::<Width20>(100_000);
}

#[test]
fn exact29_over_small_scenes() {
    small::<Width29>(300_000);
}

/// The form that chips of 32 bits have, on any machine: every one of its narrow products is checked to be of narrow factors.
#[test]
fn exact29_as_on_chips() {
    small::<Width29In<true>>(500_000);
    let count = if tests::effort() > 1 { 100_000 } else { 5000 };
    compare::<Width29In<true>>("heightfield of 80,000", &meshes::heightfield(29, 200, 5), 8, count, 5);
}

/// The long run takes 100,000 rays.
fn large<W>(rays: usize)
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    let count = if tests::effort() > 1 { 100_000 } else { rays };
    compare::<W>("heightfield of 80,000", &meshes::heightfield(W::GRID_BITS, 200, 5), 8, count, 5);
    for scene in ["bunny/bunny_smooth.obj", "sponza-dabrovic/scene.toml", "coffee/coffee.obj"] {
        let Some(path) = shared::scene(scene) else { continue };
        let model = host_tools::import::load(&path).expect("a real model").model;
        let grid = host_tools::grid::Grid::fit::<Exact<W>>(&model).expect("it has extent");
        let corners: Vec<Triangle> = grid.snap(&model).iter().map(|t| t.map(|v| v.map(i64::from))).collect();
        compare::<W>(scene, &corners, 8, count, 7);
    }
}

#[test]
fn exact14_over_large_scenes() {
    large::<Width14>(3_000);
}

#[test]
fn exact20_over_large_scenes() {
    large::<Width20>(1_000);
}

#[test]
fn exact29_over_large_scenes() {
    large::<Width29>(3_000);
}

/// A comparison that cannot fail would prove nothing: with one triangle's vertex moved by one unit it must fail.
#[test]
#[should_panic(expected = "differ")]
fn a_wrong_triangle_is_noticed() {
    let triangles = meshes::sphere(29, 8);
    let (corners, known) = on_grid::<Width29>(&triangles);
    let mut moved = corners;
    moved[3][0][1] += 1;
    let built = Built::<Width29>::new(&moved, 8);
    let oracle = Oracle::new(&known);
    let wrong = Rays::new(&known, bounds::<Width29>(&known), 1)
        .take(20_000)
        .filter(|(_, ray)| built.agrees(ray, oracle.nearest(ray).as_ref()).is_err())
        .count();
    assert_eq!(wrong, 0, "rays differ");
}
