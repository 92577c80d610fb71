//! The golden model against brute force and against the f64 reference: rays in scene units, as a user gives them.

use core_rt::exact::Exact29;
use core_rt::kernel::Kernel;
use glam::DVec3;
use host_tools::engine::{self, ENGINES};
use host_tools::grid::Grid;
use host_tools::model::Model;
use host_tools::prepare::{Options, Prepared};
use host_tools::reference::{Hit, Reference};
use host_tools::trace::Trace;
use rayon::prelude::*;
use tests::oracle::{Nearest, Oracle, Ray, Triangle};
use tests::random::SplitMix64;
use tests::rays::{Bounds, Rays};
use tests::{scenes, shared};

/// The demo scene, and a shared one of a few thousand triangles where there is one.
fn models() -> Vec<(&'static str, Model)> {
    let (name, demo) = scenes::all().remove(0);
    // The oracle here is of triangles alone; spheres have one of their own.
    let demo = (name, scenes::matt(demo));
    let teapot = shared::scene("teapot/teapot.obj");
    let teapot = teapot.map(|path| ("teapot", host_tools::import::load(&path).expect("a real model").model));
    [demo].into_iter().chain(teapot).collect()
}

fn prepared(kernel: &str, model: &Model) -> Prepared {
    engine::by_name(kernel).expect("a kernel of this name").prepare(model, &Options::default()).expect("it fits")
}

fn tracer<'a>(kernel: &str, prepared: &'a Prepared) -> Box<dyn Trace + 'a> {
    let engine = engine::by_name(kernel).expect("a kernel of this name");
    engine.tracer(prepared.blob.bytes()).expect("a blob just made")
}

/// A ray in whole grid units, and what it is given as: from `back` directions farther back, and `2^exponent` as long.
#[derive(Clone, Copy, Debug)]
struct Given {
    ray: Ray,
    back: i64,
    exponent: i32,
}

impl Given {
    /// Origin and direction, scene units.
    fn scene(&self, grid: &Grid) -> (DVec3, DVec3) {
        let origin = [0, 1, 2].map(|i| self.ray.origin[i] - self.back * self.ray.direction[i]);
        let direction = self.ray.direction.map(|c| libm::ldexp(c as f64, self.exponent));
        (grid.origin + DVec3::from_array(origin.map(|c| c as f64)) / grid.scale, DVec3::from_array(direction))
    }

    /// The `t` of a hit, for that direction.
    fn t(&self, hit: &Nearest, grid: &Grid) -> f64 {
        let steps = hit.numerator as f64 / hit.denominator as f64 + self.back as f64;
        libm::ldexp(steps / grid.scale, -self.exponent)
    }
}

/// Rays of every adversarial kind from the grid; and from outside of what the kernel holds, exactly through vertices.
fn given(triangles: &[Triangle], count: usize) -> Vec<Given> {
    let mut random = SplitMix64(9);
    let coordinates = |axis: usize| triangles.iter().flatten().map(move |v| v[axis]);
    let span = i64::from(Exact29::SPAN);
    let low = [0, 1, 2].map(|axis| coordinates(axis).max().unwrap_or(0) - span);
    let high = [0, 1, 2].map(|axis| coordinates(axis).min().unwrap_or(0) + span);
    let bounds = Bounds {
        grid_bits: Exact29::GRID_BITS,
        origin: [0, (1 << Exact29::GRID_BITS) - 1],
        direction: (1 << Exact29::DIRECTION_BITS) - 1,
    };
    let mut kinds = Rays::new(triangles, bounds, 4);
    (0..count)
        .map(|i| {
            let exponent = random.within([-900, 900]) as i32;
            if i % 4 != 0 {
                let (_, ray) = kinds.next().expect("rays without end");
                return Given { ray: Ray { limit: None, skip: None, ..ray }, back: 0, exponent };
            }
            // A point on a face of the box of origins, from which the way to any vertex leads inwards.
            let mut origin = [0, 1, 2].map(|axis| random.within([low[axis], high[axis]]));
            let axis = random.below(3) as usize;
            origin[axis] = if random.coin() { low[axis] } else { high[axis] };
            let vertex = triangles[random.below(triangles.len() as u64) as usize][random.below(3) as usize];
            let direction = [0, 1, 2].map(|i| vertex[i] - origin[i]);
            Given {
                ray: Ray { origin, direction, limit: None, skip: None },
                back: random.within([1, 1 << 12]),
                exponent,
            }
        })
        .collect()
}

/// By how much a `t` may be off: a few roundings of f64, and those of the scene's coordinates.
const T_ERROR: f64 = 1.0 / (1u64 << 48) as f64;

/// What differs between `exact29` and brute force over the same grid, and how many rays hit.
fn differences(model: &Model, tracer: &dyn Trace, grid: &Grid, count: usize) -> (Vec<String>, usize) {
    // What has no area is never hit, by the oracle either.
    let triangles: Vec<Triangle> = grid.snap(model).iter().map(|t| t.map(|v| v.map(i64::from))).collect();
    let given = given(&triangles, count);
    let plain: Vec<Ray> = given.iter().map(|given| given.ray).collect();
    let expected = Oracle::new(&triangles).nearest_batch(&plain);
    let differ = |(given, expected): (&Given, &Option<Nearest>)| {
        let (origin, direction) = given.scene(grid);
        let found = tracer.nearest(origin, direction);
        let same = match (&found, expected) {
            (None, None) => true,
            (Some(found), Some(expected)) => {
                let t = given.t(expected, grid);
                found.prim == expected.prim && (found.t - t).abs() <= T_ERROR * t
            }
            _ => false,
        };
        (!same).then(|| format!("{given:?}: {found:?}, and not {expected:?}"))
    };
    let wrong = given.par_iter().zip(&expected).filter_map(differ).collect();
    (wrong, expected.iter().flatten().count())
}

#[test]
fn exact29_is_brute_force_to_the_last_ray() {
    let count = 20_000 * tests::effort();
    for (name, model) in models() {
        let prepared = prepared("exact29", &model);
        let (wrong, hits) = differences(&model, tracer("exact29", &prepared).as_ref(), &prepared.grid, count);
        println!("{name}: {count} rays, {hits} hits, {} differ", wrong.len());
        assert!(wrong.is_empty(), "{name}: {} differ\n{}", wrong.len(), wrong[..wrong.len().min(5)].join("\n"));
        assert!(hits * 2 > count, "{name}: only {hits} of {count} rays hit anything");
    }
}

/// The check above must be able to fail: where a vertex has moved by two units, and where `t` is of another direction.
#[test]
fn a_moved_vertex_and_another_t_are_noticed() {
    struct Slower<'a>(Box<dyn Trace + 'a>);
    impl Trace for Slower<'_> {
        fn nearest(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
            self.0.nearest(origin, direction).map(|hit| Hit { t: hit.t * (1.0 + 1e-13), ..hit })
        }
    }
    let model = scenes::matt(scenes::all().remove(0).1);
    let prepared = prepared("exact29", &model);
    let moved = {
        let mut model = model.clone();
        let vertex = model.triangles[0].vertices[0];
        model.positions[vertex as usize] += DVec3::splat(2.0 / prepared.grid.scale);
        differences(&model, tracer("exact29", &prepared).as_ref(), &prepared.grid, 4_000).0
    };
    assert!(!moved.is_empty());
    let (slower, hits) = differences(&model, &Slower(tracer("exact29", &prepared)), &prepared.grid, 1_000);
    assert!(slower.len() * 2 > hits, "{} of {hits}", slower.len());
}

/// Rays as people give them: from anywhere near the scene or far from it, to points on and near it, of any length.
fn arbitrary(model: &Model, count: usize, farthest: f64) -> Vec<(DVec3, DVec3)> {
    let mut random = SplitMix64(77);
    let mut unit = move || random.below(1 << 53) as f64 / (1u64 << 53) as f64;
    let (low, high) =
        model.positions.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
    (0..count)
        .map(|i| {
            let mut inside = || low + (high - low) * DVec3::new(unit(), unit(), unit());
            let (target, mut origin) = (inside(), inside());
            if i % 2 == 0 {
                origin = target + (origin - target) * (farthest * unit());
            }
            (origin, (target - origin) * libm::exp2(40.0 * unit() - 20.0))
        })
        .collect()
}

/// The three corners of a triangle, scene units.
fn corners(model: &Model, prim: u32) -> [DVec3; 3] {
    model.triangles[prim as usize].vertices.map(|v| model.positions[v as usize])
}

/// How far `o + t d` is from `(1 - u - v) v0 + u v1 + v v2` in the scene as it was given.
fn apart(model: &Model, (origin, direction): (DVec3, DVec3), hit: &Hit) -> f64 {
    let [v0, v1, v2] = corners(model, hit.prim);
    let on_triangle = v0 + (v1 - v0) * hit.u + (v2 - v0) * hit.v;
    (origin + direction * hit.t).distance(on_triangle)
}

/// The rounding of the origin (1/2 an axis), of the direction (1 an axis, times a `t` of at most
/// SPAN / 2^(DIRECTION_BITS - 1) = 1/2), and of the vertices (1/2 an axis): 3/2 grid units an axis in all.
#[test]
fn the_point_is_on_the_triangle() {
    for (name, model) in models() {
        let prepared = prepared("exact29", &model);
        let tracer = tracer("exact29", &prepared);
        let unit = 1.0 / prepared.grid.scale;
        let mut hits = 0;
        let mut worst = 0.0_f64;
        for ray in arbitrary(&model, 20_000, 1000.0) {
            let Some(hit) = tracer.nearest(ray.0, ray.1) else { continue };
            let weights = [hit.u, hit.v, 1.0 - hit.u - hit.v];
            assert!(hit.t > 0.0 && weights.iter().all(|w| (-1e-15..=1.0).contains(w)), "{name} {ray:?}: {hit:?}");
            worst = worst.max(apart(&model, ray, &hit) / unit);
            hits += 1;
        }
        println!("{name}: {hits} hits, at most {worst:.3} grid units off");
        assert!(worst <= 1.5 * libm::sqrt(3.0), "{name}: {worst}");
        // The bound is not far from what happens, so a unit more would be noticed.
        assert!(hits > 5_000 && worst > 0.5, "{name}: {hits} {worst}");
    }
}

/// The distance between a ray's line and a segment.
fn distance_to_segment((origin, direction): (DVec3, DVec3), a: DVec3, b: DVec3) -> f64 {
    let across = |p: DVec3| (p - origin).reject_from_normalized(direction.normalize());
    let (a, b) = (across(a), across(b));
    let along = b - a;
    let place = if along == DVec3::ZERO { 0.0 } else { (-a.dot(along) / along.length_squared()).clamp(0.0, 1.0) };
    (a + along * place).length()
}

/// Whether two tracers that know the ray and the scene to within `error`, scene units, may say `a` and `b`.
fn may_differ(model: &Model, ray: (DVec3, DVec3), a: Option<Hit>, b: Option<Hit>, error: f64) -> bool {
    let near_edge = |hit: &Hit| {
        let [v0, v1, v2] = corners(model, hit.prim);
        [(v0, v1), (v1, v2), (v2, v0)].iter().any(|&(a, b)| distance_to_segment(ray, a, b) <= error)
    };
    match (a, b) {
        (None, None) => true,
        (Some(a), Some(b)) if a.prim == b.prim => true,
        // One t, or the nearer of the two is passed by the other.
        (Some(a), Some(b)) => (a.t - b.t).abs() * ray.1.length() <= error || near_edge(if a.t < b.t { &a } else { &b }),
        (Some(hit), None) | (None, Some(hit)) => near_edge(&hit),
    }
}

#[test]
fn f64_and_the_reference_differ_at_ties_and_edges_alone() {
    for (name, model) in models() {
        let prepared = prepared("f64", &model);
        let tracer = tracer("f64", &prepared);
        let reference = Reference::new(&model);
        // As in `the_point_is_on_the_triangle`.
        let error = 1.5 * libm::sqrt(3.0) / prepared.grid.scale;
        let rays = arbitrary(&model, 50_000 * tests::effort(), 30.0);
        let outcomes: Vec<(bool, bool)> = rays
            .par_iter()
            .map(|&ray| {
                let (a, b) = (tracer.nearest(ray.0, ray.1), Trace::nearest(&reference, ray.0, ray.1));
                (a.map(|hit| hit.prim) != b.map(|hit| hit.prim), !may_differ(&model, ray, a, b, error))
            })
            .collect();
        let differ = outcomes.iter().filter(|(differ, _)| *differ).count();
        let unexplained = outcomes.iter().filter(|(_, unexplained)| *unexplained).count();
        println!("{name}: {} rays, {differ} differ, {unexplained} unexplained", rays.len());
        assert_eq!(unexplained, 0, "{name}");

        // What explains must be able to refuse: another triangle, and a hit where there is none.
        let told = |change: fn(Option<Hit>) -> Option<Hit>| {
            let refused = |ray: &&(DVec3, DVec3)| {
                let hit = Trace::nearest(&reference, ray.0, ray.1);
                hit.is_some() && !may_differ(&model, **ray, hit, change(hit), error)
            };
            rays.iter().take(1000).filter(refused).count()
        };
        let farther = |hit: Option<Hit>| hit.map(|hit| Hit { t: hit.t * 1.01, prim: hit.prim ^ 1, ..hit });
        assert!(told(|_| None) > 200 && told(farther) > 200, "{name}");
    }
}

/// Each kernel sees nearly what the reference does, at nearly its distance.
#[test]
fn every_kernel_traces() {
    let model = scenes::matt(scenes::all().remove(0).1);
    let reference = Reference::new(&model);
    let rays = arbitrary(&model, 5_000, 3.0);
    for engine in ENGINES {
        let prepared = prepared(engine.name(), &model);
        let tracer = tracer(engine.name(), &prepared);
        let agrees =
            |ray: &&(DVec3, DVec3)| match (tracer.nearest(ray.0, ray.1), Trace::nearest(&reference, ray.0, ray.1)) {
                (None, None) => true,
                (Some(found), Some(truth)) => {
                    let off = (found.t - truth.t).abs() / truth.t;
                    let weights = [found.u - truth.u, found.v - truth.v].map(f64::abs);
                    found.prim == truth.prim && off < 0.01 && weights.iter().all(|&w| w < 0.1)
                }
                _ => false,
            };
        let agreeing = rays.iter().filter(agrees).count();
        println!("{}: {agreeing} of {} agree with the reference", engine.name(), rays.len());
        assert!(agreeing * 100 >= rays.len() * 99, "{}: {agreeing}", engine.name());
        let (origin, direction) = rays[0];
        for (o, d) in [(origin, DVec3::ZERO), (origin, DVec3::NAN), (DVec3::NAN, direction)] {
            assert!(tracer.nearest(o, d).is_none() && Trace::nearest(&reference, o, d).is_none());
        }
    }
}

/// Rays that start far outside, or have the least or the greatest of lengths.
#[test]
fn extremes_of_f64_are_traced() {
    let model = scenes::matt(scenes::all().remove(0).1);
    let prepared = prepared("exact29", &model);
    let tracer = tracer("exact29", &prepared);
    let eye = DVec3::new(0.3, 20.0, 0.4);
    let down = |origin: DVec3, length: f64| tracer.nearest(origin, DVec3::new(0.0, -length, 0.0));
    let near = down(eye, 1.0).expect("the scene is below");
    for length in [1e-300, 1e-100, 1e100, f64::MAX] {
        let hit = down(eye, length).expect("the scene is below, at any pace");
        assert_eq!(hit.prim, near.prim);
        assert!((hit.t * length / near.t - 1.0).abs() < 1e-12, "{length:e}: {hit:?}");
    }
    assert_eq!(down(eye, f64::from_bits(1)).map(|hit| hit.t), Some(f64::INFINITY));
    for height in [1e3, 1e15, 1e300] {
        let hit = down(eye + DVec3::Y * height, 1.0).expect("the scene is below, however far");
        assert_eq!(hit.prim, near.prim);
        assert!((hit.t / (height + near.t) - 1.0).abs() < 1e-9, "{height:e}: {hit:?}");
    }
}
