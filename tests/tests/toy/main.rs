//! The code of the exact kernels in a space so small that everything in it can be tried: every ray and every segment from
//! every point of a grid of 4 x 4 x 4 against every triangle of it, and every ray of a finer format against every box.
//!
//! The kernel computes with differences to the origin alone, so of those scenes that are one another moved along the axes only
//! one is tried. Mirrored and rotated ones are all tried: floors are not symmetric.

mod truth;
mod width;

use core_rt::exact::{Depth, Exact, Ray, Slopes, Width};
use core_rt::kernel::{Bounds, Kernel, NONE};
use num::{BigInt, BigRational};
use rayon::prelude::*;
use tests::octants;
use truth::{Determinants, VECTORS, Vector, difference, index, meets, vector};
use width::{DEPTH, FILTER, GRID_BITS, NOTHING, RECIPROCAL, SLACK, Toy};

const SIDE: i32 = 1 << GRID_BITS;
const POINTS: usize = (SIDE * SIDE * SIDE) as usize;

fn point(index: usize) -> Vector {
    [0, 1, 2].map(|axis| index as i32 >> (axis * GRID_BITS) & (SIDE - 1))
}

/// Whether no copy of these points, moved along an axis, comes before them.
fn is_first_of_its_copies(points: &[Vector]) -> bool {
    (0..3).all(|axis| points.iter().any(|point| point[axis] == 0))
}

/// A width with everything hot in one word.
trait ToyWidth: Width<Word = i32, Wide = i64, Slopes: Slopes<Distance = i32>> {}
impl<W: Width<Word = i32, Wide = i64, Slopes: Slopes<Distance = i32>>> ToyWidth for W {}

/// Entering a box, which both children of a node have.
fn enter<W: ToyWidth>(slopes: &W::Slopes, node: &<Exact<W> as Kernel>::Node, limit: i32) -> Option<i32> {
    let [first, second] = octants::enter::<Exact<W>>(slopes, node, limit);
    assert_eq!(first, second, "{slopes:?}");
    first
}

/// A ray and the segment from its origin to where it is at t = 1.
struct Cast<W: Width> {
    ray: Ray<W>,
    segment: Ray<W>,
    /// The direction's number, before it was scaled.
    direction: usize,
    /// By what it was scaled.
    scale: i64,
}

/// All rays and segments from a point.
fn casts<W: ToyWidth>(origin: Vector) -> Vec<Cast<W>> {
    let cast = |direction: usize| {
        let d = vector(direction);
        let to = [0, 1, 2].map(|axis| origin[axis] + d[axis]);
        let (ray, segment) = (Ray::new(origin, d, NONE)?, Ray::segment(origin, to, NONE)?);
        let largest = |v: Vector| v.map(i32::abs).into_iter().max().unwrap_or(0);
        let scale = largest(ray.direction) / largest(d);
        assert_eq!([ray.direction, segment.direction], [d.map(|c| c * scale); 2], "scaled by a whole number");
        Some(Cast { ray, segment, direction, scale: scale.into() })
    };
    let casts: Vec<_> = (0..VECTORS).filter_map(cast).collect();
    assert_eq!(casts.len(), VECTORS - 1, "every direction but zero");
    casts
}

/// What was tried, and what of it was wrong.
#[derive(Debug)]
struct Tally<W: Width> {
    cases: u64,
    hits: u64,
    wrong_hits: u64,
    wrong_t: u64,
    missed_boxes: u64,
    /// Every t that was found, by its fraction.
    depths: Vec<Option<Depth<W>>>,
}

/// Numerators are at most six times the volume of a tetrahedron in a cube of side 3, and denominators at most the sum of three
/// products of a direction and a normal.
const NUMERATORS: usize = 2 * 27 + 1;
const DENOMINATORS: usize = 3 * 3 * 9 + 1;

impl<W: Width> Default for Tally<W> {
    fn default() -> Self {
        Self {
            cases: 0,
            hits: 0,
            wrong_hits: 0,
            wrong_t: 0,
            missed_boxes: 0,
            depths: vec![None; NUMERATORS * DENOMINATORS],
        }
    }
}

impl<W: ToyWidth> Tally<W> {
    fn plus(mut self, other: Self) -> Self {
        self.cases += other.cases;
        self.hits += other.hits;
        self.wrong_hits += other.wrong_hits;
        self.wrong_t += other.wrong_t;
        self.missed_boxes += other.missed_boxes;
        for (depth, other) in self.depths.iter_mut().zip(other.depths) {
            *depth = depth.or(other);
        }
        self
    }

    /// A triangle and all that is cast from all points.
    fn triangle(&mut self, determinants: &Determinants, casts: &[Vec<Cast<W>>], corners: [Vector; 3]) {
        let record = Exact::<W>::triangle((), &corners, 0);
        let node = Exact::<W>::node([Bounds::of(&corners); 2], [0; 2]);
        for (origin, casts) in casts.iter().enumerate() {
            let origin = point(origin);
            let [a, b, c] = corners;
            if !is_first_of_its_copies(&[origin, a, b, c]) {
                continue;
            }
            let [p0, p1, p2] = corners.map(|corner| difference(corner, origin));
            let edges = [determinants.of(p1, p2), determinants.of(p2, p0), determinants.of(p0, p1)];
            let volume = edges[0][index(p0)];
            self.cases += casts.len() as u64;
            for cast in casts {
                let t = meets(edges.map(|row| row[cast.direction]), volume);
                let found = record.as_ref().and_then(|record| Exact::<W>::intersect(&cast.ray, record));
                match (t, found) {
                    (Some(t), Some(depth)) => {
                        self.hit(cast, &cast.ray, &node, t, depth);
                        // The reach is asked for after everything else.
                        let found = record.as_ref().and_then(|record| Exact::<W>::intersect(&cast.segment, record));
                        self.wrong_hits += u64::from(found.is_some() != (t.0 < t.1));
                        if let Some(depth) = found {
                            self.hit(cast, &cast.segment, &node, t, depth);
                        }
                    }
                    (None, None) => {}
                    _ => self.wrong_hits += 1,
                }
            }
        }
    }

    /// A hit at t, in the unscaled direction.
    fn hit(&mut self, cast: &Cast<W>, ray: &Ray<W>, node: &<Exact<W> as Kernel>::Node, t: (i64, i64), depth: Depth<W>) {
        self.hits += 1;
        let t = (t.0, t.1 * cast.scale);
        self.wrong_t += u64::from((depth.numerator, depth.denominator) != t);
        let path = Exact::<W>::path(ray);
        let limit = Exact::<W>::limit(&path, &Exact::<W>::span(&depth));
        let entered = enter::<W>(&path, node, limit).is_some_and(|entry| {
            // Not after the hit, and not given up where the limit is the hit itself.
            i64::from(entry) * t.1 <= t.0 << W::T_BITS && Exact::<W>::within(entry, limit)
        });
        self.missed_boxes += u64::from(!entered);
        self.depths[t.0 as usize * DENOMINATORS + t.1 as usize] = Some(depth);
    }

    /// How many pairs of depths are not in the order of their fractions.
    fn wrong_orders(&self) -> u64 {
        let fraction = |i: usize| BigRational::new(BigInt::from(i / DENOMINATORS), BigInt::from(i % DENOMINATORS));
        let found = self.depths.iter().enumerate();
        let depths: Vec<_> = found.filter_map(|(i, depth)| depth.as_ref().map(|depth| (fraction(i), depth))).collect();
        let wrong = |(t, depth): &(BigRational, &Depth<W>)| {
            depths.iter().filter(|(other, b)| Exact::<W>::order(depth, b) != t.cmp(other)).count() as u64
        };
        depths.par_iter().map(wrong).sum()
    }
}

/// Every `step`th triangle against everything.
fn enumerate<W>(determinants: &Determinants, step: usize) -> Tally<W>
where
    W: ToyWidth,
{
    let casts: Vec<_> = (0..POINTS).map(|origin| casts::<W>(point(origin))).collect();
    (0..POINTS.pow(3))
        .into_par_iter()
        .step_by(step)
        .fold(Tally::default, |mut tally, i| {
            let corners = [i / POINTS / POINTS, i / POINTS % POINTS, i % POINTS].map(point);
            tally.triangle(determinants, &casts, corners);
            tally
        })
        .reduce(Tally::default, Tally::plus)
}

#[test]
fn every_ray_against_every_triangle() {
    let determinants = Determinants::new();
    // All in the long run; every fifth triangle, which has no factor in common with the grid, in the short one.
    let long = tests::effort() > 1;
    let tally = enumerate::<Toy<2, NOTHING>>(&determinants, if long { 1 } else { 5 });
    let Tally { cases, hits, wrong_hits, wrong_t, missed_boxes, ref depths } = tally;
    let pairs = depths.iter().flatten().count().pow(2);
    println!("{cases} rays against triangles, {hits} hits by them and their segments, {pairs} pairs of t");
    // 4 points in a cube of side 3, up to shifts: 4^4 - 3^4 along an axis; 7^3 - 1 directions.
    let all = 175u64.pow(3) * 342;
    assert!(if long { cases == all } else { cases > all / 6 }, "{cases} of {all}");
    assert_eq!((wrong_hits, wrong_t, missed_boxes), (0, 0, 0));
    assert_eq!(tally.wrong_orders(), 0);
}

/// The checks see what is wrong with a width; a part of the triangles is enough.
#[test]
fn what_is_wrong_is_seen() {
    let determinants = Determinants::new();
    let slack = enumerate::<Toy<2, SLACK>>(&determinants, 97);
    assert!(slack.missed_boxes > 0 && slack.wrong_hits == 0 && slack.wrong_t == 0);
    let reciprocal = enumerate::<Toy<2, RECIPROCAL>>(&determinants, 97);
    assert!(reciprocal.missed_boxes > 0 && reciprocal.wrong_hits == 0 && reciprocal.wrong_t == 0);
    let filter = enumerate::<Toy<2, FILTER>>(&determinants, 97);
    assert!(filter.wrong_hits > 0 && filter.missed_boxes == 0);
    let depth = enumerate::<Toy<2, DEPTH>>(&determinants, 97);
    assert!(depth.wrong_orders() > 0 && depth.wrong_hits == 0 && depth.wrong_t == 0);
    println!(
        "seen: {} boxes missed with too little slack, {} with a wrong reciprocal, {} wrong hits with a wrong filter, {} pairs \
         in a wrong order with a wrong depth",
        slack.missed_boxes,
        reciprocal.missed_boxes,
        filter.wrong_hits,
        depth.wrong_orders()
    );
}

/// Where a ray is in a box: from and to which t, in units that every direction divides; `None` where it never is.
fn inside(origin: Vector, direction: Vector, bounds: &Bounds) -> Option<(i64, i64)> {
    let mut whole = (0, i64::MAX);
    for axis in 0..3 {
        let [low, high] = [bounds.low, bounds.high].map(|corner| i64::from(corner[axis] - origin[axis]));
        // 420 is a multiple of 1 to 7.
        match i64::from(direction[axis]) {
            0 if low <= 0 && high >= 0 => {}
            0 => return None,
            d => {
                let (a, b) = (low * 420 / d, high * 420 / d);
                whole = (whole.0.max(a.min(b)), whole.1.min(a.max(b)));
            }
        }
    }
    (whole.0 <= whole.1).then_some(whole)
}

/// Boxes that a ray is in at some t and that are not entered with that t as the limit, and how many rays were tried.
fn boxes<W: ToyWidth>() -> [u64; 2] {
    let most: i32 = (1 << W::DIRECTION_BITS) - 1;
    let components = || -most..=most;
    let directions: Vec<Vector> = components()
        .flat_map(|x| components().flat_map(move |y| components().map(move |z| [x, y, z])))
        .filter(|d| d.iter().any(|c| 2 * c.abs() > most))
        .collect();
    let of_box = |low: usize, high: usize| {
        let bounds = Bounds { low: point(low), high: point(high) };
        if bounds.low.iter().zip(&bounds.high).any(|(low, high)| low > high) {
            return [0; 2];
        }
        let node = Exact::<W>::node([bounds; 2], [0; 2]);
        let mut counts = [0; 2];
        for origin in (0..POINTS).map(point).filter(|&origin| is_first_of_its_copies(&[origin, bounds.low])) {
            for &direction in &directions {
                let Some(ray) = Ray::<W>::new(origin, direction, NONE) else { continue };
                counts[1] += 1;
                let Some((from, to)) = inside(origin, direction, &bounds) else { continue };
                // A hit is at a t above 0; its depth is at least the floor of it.
                for t in [from, to] {
                    let path = Exact::<W>::path(&ray);
                    let limit = path.limit(((t << W::T_BITS) / 420) as i32);
                    counts[0] += u64::from(enter::<W>(&path, &node, limit).is_none());
                }
            }
        }
        counts
    };
    (0..POINTS * POINTS)
        .into_par_iter()
        .map(|pair| of_box(pair / POINTS, pair % POINTS))
        .reduce(|| [0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}

#[test]
fn every_ray_against_every_box() {
    let [missed, cases] = boxes::<Toy<3, NOTHING>>();
    println!("{cases} rays against boxes");
    // Origins and boxes up to shifts: 22 along an axis; directions of three bits.
    assert_eq!((missed, cases), (0, 22u64.pow(3) * 3032));
    assert!(boxes::<Toy<3, SLACK>>()[0] > 0, "too little slack is seen");
    assert!(boxes::<Toy<3, RECIPROCAL>>()[0] > 0, "a wrong reciprocal is seen");
}
