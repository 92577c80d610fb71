//! Spheres by every exact kernel, among themselves and among triangles, against an oracle that shares no code with it: the same
//! primitive, and the same t as a fraction, for rays of every adversarial kind. And by the kernels of the 2009 report, whose t
//! is the same but for its rounding.

use core_rt::arithmetic::Arithmetic;
use core_rt::bvh::{Bvh, Intersect};
use core_rt::exact::{Exact, Ray, Width, Width14, Width20, Width29};
use core_rt::hanika::{HanikaC, HanikaCd, HanikaCons};
use core_rt::kernel::{Bounds, Kernel, NONE, Vertices};
use core_rt::mesh::Mesh;
use core_rt::num::Word;
use core_rt::profile::Full;
use core_rt::scene::MAX_DEPTH;
use core_rt::section::Integers;
use core_rt::sphere;
use core_rt::stats::NoStats;
use host_tools::tree::{self, TreeOptions};
use rayon::prelude::*;
use tests::ball_rays::{balls, rays};
use tests::balls::Ball;
use tests::meshes;
use tests::oracle::{self, Nearest, Oracle};
use tests::random::SplitMix64;

/// A tree over triangles and spheres.
struct Built<W: Width> {
    tree: tree::Tree,
    nodes: Vec<<Exact<W> as Kernel>::Node>,
    triangles: Vec<<Exact<W> as Kernel>::Triangle>,
    spheres: Vec<<Exact<W> as Kernel>::Sphere>,
}

impl<W: Width<Word: Into<i64>, Wide: Into<i128>>> Built<W> {
    fn new(corners: &[Vertices], balls: &[Ball], leaf_max: u32) -> Self {
        let options = TreeOptions { leaf_max, leaf_always: leaf_max != 8, ..TreeOptions::default() };
        let on_grid = |ball: &Ball| sphere::Ball { centre: ball.centre.map(|c| c as i32), radius: ball.radius as i32 };
        let boxes = balls.iter().map(|ball| on_grid(ball).bounds());
        let tree = tree::build_mixed(corners.iter().map(Bounds::of), boxes, options);
        let (triangles, spheres) = tree.order.split_at(corners.len());
        let triangle = |&i: &u32| Exact::<W>::triangle((), &corners[i as usize], 0).expect("on the grid, with area");
        let ball = |&i: &u32| Exact::<W>::sphere(&on_grid(&balls[i as usize - corners.len()]), 0).expect("on the grid");
        Self {
            nodes: tree.nodes.iter().map(|n| Exact::<W>::node(n.boxes, n.children)).collect(),
            triangles: triangles.iter().map(triangle).collect(),
            spheres: spheres.iter().map(ball).collect(),
            tree,
        }
    }

    fn view(&self) -> Bvh<'_, Full<Exact<W>>> {
        Bvh {
            root: self.tree.root,
            nodes: &self.nodes,
            triangles: Mesh::whole((), &self.triangles),
            spheres: &self.spheres,
            ids: Integers::Wide(&self.tree.order),
        }
    }

    /// What is found, and t.
    fn nearest(&self, ray: &Ray<W>) -> Option<Nearest> {
        let mut stack = heapless::Vec::<_, MAX_DEPTH>::new();
        let bvh = self.view();
        let hit = bvh.closest(ray, &mut stack, &mut NoStats);
        assert_eq!(bvh.any(ray, &mut stack, &mut NoStats, |_| true), hit != NONE, "{ray:?}");
        if hit == NONE {
            return None;
        }
        let depth = match bvh.sphere(hit) {
            Some(sphere) => Exact::<W>::intersect_sphere(ray, sphere, hit == ray.skip),
            None => Exact::<W>::intersect(ray, &self.triangles[hit as usize]),
        };
        let depth = depth.expect("it was hit");
        let (numerator, denominator) = (depth.numerator.into(), depth.denominator.into());
        Some(Nearest { prim: bvh.id(hit), numerator, denominator })
    }
}

/// The nearest of triangles, and of spheres after them.
fn expected<W: Width<Word: Into<i64>>>(oracle: &Oracle, count: u32, balls: &[Ball], ray: &Ray<W>) -> Option<Nearest> {
    let (origin, direction) = (ray.origin.map(Into::into), ray.direction.map(Into::into));
    let limit = ray.reach.map(|reach| (-reach).unsigned_abs());
    let of_triangles = oracle.nearest(&oracle::Ray { origin, direction, limit, skip: None });
    let of_balls = (count..).zip(balls).filter_map(|(prim, ball)| {
        let (numerator, denominator) = ball.hit(origin, direction, false)?;
        let in_reach = limit.is_none_or(|k| numerator << k < denominator);
        in_reach.then_some(Nearest { prim, numerator, denominator })
    });
    of_balls.chain(of_triangles).min_by(Nearest::order)
}

fn agree<W>(seed: u64, rays_each: usize)
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    let mut random = SplitMix64(seed);
    let (mut hits, mut on_balls, mut count) = (0, 0, 0);
    for (ball_count, with_triangles, leaf_max) in
        [(1, false, 8), (40, false, 1), (40, false, 8), (30, true, 8), (9, true, 64)]
    {
        let mesh = if with_triangles { meshes::sphere(W::GRID_BITS, 4) } else { Vec::new() };
        let last = (1i64 << W::GRID_BITS) - 1 - i64::from(W::MARGIN);
        let mesh: Vec<_> = mesh.iter().map(|t| t.map(|v| v.map(|c| c.clamp(W::MARGIN.into(), last)))).collect();
        let corners: Vec<Vertices> = mesh.iter().map(|t| t.map(|v| v.map(|c| c as i32))).collect();
        let balls = balls::<Exact<W>>(&mut random, ball_count);
        let built = Built::<W>::new(&corners, &balls, leaf_max);
        let oracle = Oracle::new(&mesh);
        let word = |v: [i64; 3]| v.map(|c| W::Word::from_i64(c).expect("rays fit the kernel"));
        let prepared = |i: usize, origin: [i64; 3], direction: [i64; 3]| match i % 4 {
            3 => Ray::segment(word(origin), word([0, 1, 2].map(|i| origin[i] + direction[i])), NONE),
            _ => Ray::new(word(origin), word(direction), NONE),
        };
        let rays = rays::<Exact<W>>(&mut random, &balls, rays_each);
        let outcomes: Vec<_> = rays
            .par_iter()
            .enumerate()
            .filter_map(|(i, &(origin, direction))| {
                let ray = prepared(i, origin, direction).filter(|ray| ray.reach.is_none_or(|reach| reach <= 0))?;
                let found = built.nearest(&ray);
                assert_eq!(found, expected(&oracle, corners.len() as u32, &balls, &ray), "{}: {ray:?}", W::NAME);
                Some(found)
            })
            .collect();
        for found in &outcomes {
            hits += usize::from(found.is_some());
            on_balls += usize::from(found.is_some_and(|hit| hit.prim as usize >= corners.len()));
        }
        count += outcomes.len();
    }
    println!("{}: {count} rays, {hits} hits, {on_balls} of spheres", W::NAME);
    assert!(on_balls * 3 > count, "only {on_balls} of {count} rays hit a sphere, so little was compared");
}

#[test]
fn exact14_agrees_with_big_integers() {
    agree::<Width14>(1, 20_000);
}

#[test]
fn exact20_agrees_with_big_integers() {
    agree::<Width20>(2, 20_000);
}

#[test]
fn exact29_agrees_with_big_integers() {
    agree::<Width29>(3, 20_000);
}

/// Every single sphere, with the ray on it or not; the largest, the smallest and those at the ends of the grid among them.
fn one_by_one<K: Kernel>(
    settings: K::Settings,
    seed: u64,
    parts: impl Fn(&K::Ray) -> [[i64; 3]; 2],
    t: impl Fn(K::Depth, [i64; 3]) -> i128,
    exactly: impl Fn((i128, i128), [i64; 3]) -> i128,
) {
    let mut random = SplitMix64(seed);
    let (low, high) = (i64::from(K::MARGIN), (1i64 << K::GRID_BITS) - 1 - i64::from(K::MARGIN));
    let (least, most) = (i64::from(K::RADIUS_MIN), (high - low) / 2);
    let ends = [low + most, high - most];
    let mut all: Vec<Ball> =
        (0..8).map(|i| Ball { centre: [0, 1, 2].map(|axis| ends[i >> axis & 1]), radius: most }).collect();
    all.extend((0..8).map(|i| Ball {
        centre: [0, 1, 2].map(|axis| if i >> axis & 1 == 0 { low + least } else { high - least }),
        radius: least,
    }));
    all.extend(balls::<K>(&mut random, 200));
    let mut tally = [0; 4];
    for ball in all {
        let record = sphere::Ball { centre: ball.centre.map(|c| c as i32), radius: ball.radius as i32 };
        let record = K::sphere(&record, 0).expect("it fits");
        for (origin, direction) in rays::<K>(&mut random, &[ball], 300) {
            let word = |v: [i64; 3]| v.map(|c| K::Word::from_i64(c).expect("rays fit the kernel"));
            let Some(ray) = K::ray(settings, word(origin), word(direction), NONE) else { continue };
            let [origin, direction] = parts(&ray);
            for leaves in [false, true] {
                let expected = ball.hit(origin, direction, leaves);
                let found = K::intersect_sphere(&ray, &record, leaves);
                assert_eq!(
                    found.map(|depth| t(depth, direction)),
                    expected.map(|hit| exactly(hit, direction)),
                    "{}: {ball:?} {ray:?} {leaves}",
                    K::NAME
                );
                tally[usize::from(expected.is_some()) + 2 * usize::from(leaves)] += 1;
            }
        }
    }
    println!("{}: misses and hits {:?}, of rays that leave {:?}", K::NAME, &tally[..2], &tally[2..]);
    assert!(tally.iter().all(|&count| count > 2000), "{tally:?}");
}

fn exact_one_by_one<W: Width<Word: Into<i64>, Wide: Into<i128>>>() {
    one_by_one::<Exact<W>>(
        (),
        u64::from(W::ID),
        |ray| [ray.origin.map(Into::into), ray.direction.map(Into::into)],
        |depth, _| depth.numerator.into(),
        |(numerator, _), _| numerator,
    );
}

#[test]
fn single_spheres() {
    exact_one_by_one::<Width14>();
    exact_one_by_one::<Width20>();
    exact_one_by_one::<Width29>();
}

/// t is rounded up to whole grid units.
#[test]
fn single_spheres_in_the_report() {
    let rounded_up = |(numerator, denominator): (i128, i128), _| ((numerator << 31) + denominator - 1) / denominator;
    macro_rules! check {
        ($kernel:ty, $c:expr, $d:expr) => {
            one_by_one::<$kernel>(
                Arithmetic { c_bits: $c, d_bits: $d, edge_shift: 0, epsilon: 4 },
                5,
                |ray| [ray.origin, ray.direction],
                |t, _| t.into(),
                rounded_up,
            )
        };
    }
    check!(HanikaC, 12, 12);
    check!(HanikaCd, 15, 9);
    check!(HanikaCons, 0, 0);
}
