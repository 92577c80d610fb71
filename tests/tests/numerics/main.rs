//! The numbers at the ends of their documented ranges: every bound that core-rt states, measured against f64 or wide
//! integers. One table holds all tolerances; an entry that is too generous fails as stale.

mod optics;
mod paint;
mod shading;
mod spheres;

use core_rt::camera::{Camera, CameraHeader, Use};
use core_rt::colour::{Colour, Rgb16, Transfer};
use core_rt::exact::{Exact, Ray, Reciprocal, Reciprocal20, Reciprocal29, Width, Width14, Width20, Width29, Width29In};
use core_rt::kernel::{Bounds, Kernel, NONE};
use core_rt::num::{Word, cross, sub};
use core_rt::samples::Place;
use core_rt::space::{Grid14, Grid29, Space};
use ethnum::U256;
use fixed::types::U16F16;
use tests::meshes;
use tests::octants::enter;
use tests::random::SplitMix64;
use tests::rays::{self, Rays};

/// The largest error of each operation, in the unit that its name gives. What is measured must be at most this, and at
/// least a quarter of it.
const TOLERANCES: [(&str, f64); 76] = [
    ("sample's step, units of a coefficient", 2.0),
    ("exact14 normalise, 2^-14", 3.0),
    ("exact29 normalise, 2^-30", 3.0),
    ("exact14 depth, 2^-13", 8.0),
    ("exact20 depth, 2^-41", 2048.0),
    ("exact29 depth, 2^-31", 4.0),
    ("exact14 fraction, 2^-14", 4.0),
    ("exact20 fraction, 2^-30", 2.0),
    ("exact29 fraction, 2^-30", 2.0),
    ("exact14 point, grid units", 0.28125),
    ("exact20 point, grid units", 0.00390625),
    ("exact29 point, grid units", 0.00390625),
    ("14 altitude, 2^-16", 0.0),
    ("14 cubes, 2^-16", 6.0),
    ("14 faded, 2^-16", 8.0),
    ("14 fresnel, 2^-16", 10.0),
    ("14 halfway, 2^-14", 2.5),
    ("14 lift, units", 2.5),
    ("14 lobe to 1, 2^-16", 20.0),
    ("14 lobe to 10, 2^-16", 20.0),
    ("14 lobe to 100, 2^-16", 20.0),
    ("14 lobe to 1000, 2^-16", 20.0),
    ("14 lobe to 10000, 2^-16", 25.0),
    ("14 reflect, 2^-14", 1.25),
    ("14 refract, 2^-14", 6.0),
    ("29 altitude, 2^-16", 1.0),
    ("29 cubes, 2^-16", 0.0),
    ("29 faded, 2^-16", 4.0),
    ("29 fresnel, 2^-16", 10.0),
    ("29 halfway, 2^-30", 2.0),
    ("29 lift, units", 2.5),
    ("29 lobe to 1, 2^-16", 20.0),
    ("29 lobe to 10, 2^-16", 20.0),
    ("29 lobe to 100, 2^-16", 20.0),
    ("29 lobe to 1000, 2^-16", 20.0),
    ("29 lobe to 10000, 2^-16", 25.0),
    ("29 reflect, 2^-30", 1.25),
    ("29 refract, 2^-30", 3.0),
    ("Q31 altitude, 2^-16", 1.0),
    ("Q31 cubes, 2^-16", 0.0),
    ("Q31 faded, 2^-16", 4.0),
    ("Q31 fresnel, 2^-16", 2.5),
    ("Q31 halfway, 2^-30", 1.5),
    ("Q31 lift, units", 4.0),
    ("Q31 lobe to 1, 2^-16", 1.25),
    ("Q31 lobe to 10, 2^-16", 1.25),
    ("Q31 lobe to 100, 2^-16", 1.25),
    ("Q31 lobe to 1000, 2^-16", 1.25),
    ("Q31 lobe to 10000, 2^-16", 2.5),
    ("Q31 reflect, 2^-30", 8.0),
    ("Q31 refract, 2^-30", 20000.0),
    ("f32 altitude, 2^-16", 0.0025),
    ("f32 cubes, 2^-16", 8.0),
    ("f32 faded, 2^-16", 0.02),
    ("f32 fresnel, 2^-16", 0.0125),
    ("f32 halfway, 2^-24", 2.0),
    ("f32 lift, units", 2.0),
    ("f32 lobe to 1, 2^-16", 0.0125),
    ("f32 lobe to 10, 2^-16", 0.1),
    ("f32 lobe to 100, 2^-16", 1.25),
    ("f32 lobe to 1000, 2^-16", 10.0),
    ("f32 lobe to 10000, 2^-16", 100.0),
    ("f32 reflect, 2^-24", 5.0),
    ("f32 refract, 2^-24", 3.0),
    ("power, 2^-16", 40.0),
    ("Grid14 blend, 0.5 and 2^-15 of the span", 1.0),
    ("Grid29 blend, units", 0.5),
    ("GridQ31 blend, units", 0.5),
    ("exact14 texture coordinate, 2^-14 of the span", 8.0),
    ("bilinear texture, 2^-16", 5.5),
    ("exact14 sphere point, grid units", 0.03174),
    ("exact20 sphere point, grid units", 0.001954),
    ("exact29 sphere point, grid units", 0.001954),
    ("exact14 sphere normal, 2^-14", 5.0),
    // A t that is rounded up to a multiple of 1 / |D|^2 moves the point by 2^-20, with the least radius half of that in the normal.
    ("exact20 sphere normal, 2^-30", 515.0),
    ("exact29 sphere normal, 2^-30", 3.0),
];

#[track_caller]
fn within_tolerance(name: &str, measured: f64) {
    let (_, tolerance) = TOLERANCES.iter().find(|(entry, _)| *entry == name).expect("an entry of the table");
    println!("{name}: {measured:.3} of {tolerance}");
    assert!(measured <= *tolerance, "{name}: {measured} exceeds {tolerance}");
    assert!(measured * 4.0 >= *tolerance, "{name}: {measured}, so the tolerance {tolerance} is stale");
}

/// A row an operation of shading, a column a space.
fn errors() -> String {
    const SPACES: [&str; 4] = ["14", "29", "Q31", "f32"];
    let mut rows: Vec<(&str, [String; 4])> = Vec::new();
    for (entry, tolerance) in TOLERANCES {
        let Some((space, operation)) = entry.split_once(' ') else { continue };
        let Some(column) = SPACES.iter().position(|known| *known == space) else { continue };
        let (operation, unit) = operation.rsplit_once(", ").expect("an operation and its unit");
        let cell = if unit == "units" { tolerance.to_string() } else { format!("{tolerance} x {unit}") };
        let row = rows.iter().position(|(known, _)| *known == operation).unwrap_or_else(|| {
            rows.push((operation, Default::default()));
            rows.len() - 1
        });
        rows[row].1[column] = cell;
    }
    let head = "| operation | 14 bits | 29 bits | 2009 report | f32 |\n| --- | --- | --- | --- | --- |\n".to_owned();
    rows.iter().fold(head, |text, (operation, cells)| text + &format!("| {operation} | {} |\n", cells.join(" | ")))
}

/// Checks that a generated part of `docs/SHADING.md` is this; `INTRAY_BLESS=1` renews it.
fn in_the_document(part: &str, meant: &str) {
    /// It is written by one test at a time.
    static DOCUMENT: std::sync::Mutex<()> = std::sync::Mutex::new(());
    let _turn = DOCUMENT.lock();
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/SHADING.md");
    let text = std::fs::read_to_string(&path).expect("the document");
    let (begin, end) = (format!("<!-- generated: {part} -->\n"), "<!-- end of generated -->\n");
    let (before, rest) = text.split_once(&begin).expect("a generated part");
    let (found, after) = rest.split_once(end).expect("its end");
    if std::env::var_os("INTRAY_BLESS").is_some() {
        std::fs::write(&path, format!("{before}{begin}{meant}{end}{after}")).expect("the document");
    } else {
        assert_eq!(found, meant, "INTRAY_BLESS=1 renews it");
    }
}

#[test]
fn the_document_has_these_bounds() {
    in_the_document("errors", &errors());
}

/// A vector with components of any magnitude up to `2^bits`, often at the ends.
fn vector(random: &mut SplitMix64, bits: u32) -> [i64; 3] {
    [0; 3].map(|_| {
        let size = random.within([0, bits.into()]) as u32;
        match random.below(4) {
            0 => (1i64 << size) - 1,
            1 => -(1i64 << size) + 1,
            _ => random.within([-(1i64 << size) + 1, (1i64 << size) - 1]),
        }
    })
}

/// The largest error of a component, in units of the last place.
fn normalise_error<W: Width>(bits: u32, unit: impl Fn(<W::Space as Space>::Unit) -> [f64; 3], ulp: f64) -> f64 {
    let mut random = SplitMix64(7);
    let mut worst = 0f64;
    for _ in 0..1_000_000 {
        let v = vector(&mut random, bits);
        let word = v.map(|c| W::Word::from_i64(c).expect("in range"));
        let found = W::normalise(word);
        assert_eq!(found.is_none(), v == [0; 3]);
        let Some(found) = found else { continue };
        let length = v.map(|c| (c as f64) * (c as f64)).iter().sum::<f64>().sqrt();
        for (found, v) in unit(found).iter().zip(v) {
            worst = worst.max((found - v as f64 / length).abs() / ulp);
        }
    }
    worst
}

#[test]
fn unit_vectors() {
    let worst = normalise_error::<Width14>(30, |unit| unit.map(|c| c.to_num::<f64>()), (2f64).powi(-14));
    within_tolerance("exact14 normalise, 2^-14", worst);
    let worst = normalise_error::<Width29>(61, |unit| unit.map(|c| c.to_num::<f64>()), (2f64).powi(-30));
    within_tolerance("exact29 normalise, 2^-30", worst);
    assert_eq!(Grid14::towards([5; 3], [5; 3]), None);
    assert_eq!(Grid29::towards([5; 3], [5; 3]), None);
}

/// Real hits, through the kernel's own rays: what `depth`, `fraction` and `point` may be given.
fn hits<W>(count: usize, mut visit: impl FnMut(&Ray<W>, [[i64; 3]; 3], &<Exact<W> as Kernel>::Triangle))
where
    W: Width<Word: Into<i64>>,
{
    for (seed, (_, mesh)) in (1..).zip(meshes::all(W::GRID_BITS)) {
        let last = (1i64 << W::GRID_BITS) - 1 - i64::from(W::MARGIN);
        let mesh: Vec<_> = mesh.iter().map(|t| t.map(|v| v.map(|c| c.clamp(W::MARGIN.into(), last)))).collect();
        let bounds = rays::Bounds {
            grid_bits: W::GRID_BITS,
            origin: [0, (1 << W::GRID_BITS) - 1],
            direction: (1 << W::DIRECTION_BITS) - 1,
        };
        let mut random = SplitMix64(seed);
        for (_, ray) in Rays::new(&mesh, bounds, seed).take(count) {
            // Few triangles are hit by a given ray: take one that the ray was aimed near by trying several.
            for _ in 0..4 {
                let corners = mesh[random.below(mesh.len() as u64) as usize];
                let word = |v: [i64; 3]| v.map(|c| W::Word::from_i64(c).expect("in range"));
                let (Some(triangle), Some(ray)) = (
                    Exact::<W>::triangle((), &corners.map(|v| v.map(|c| c as i32)), 0),
                    Ray::<W>::new(word(ray.origin), word(ray.direction), NONE),
                ) else {
                    continue;
                };
                if Exact::<W>::intersect(&ray, &triangle).is_some() {
                    visit(&ray, corners, &triangle);
                }
            }
        }
    }
}

/// What f64 makes of t, u, v; exact enough beside 14 bits, and beside 29 because the sums are exact in i128.
fn exactly(ray: [[i64; 3]; 2], [v0, v1, v2]: [[i64; 3]; 3]) -> (f64, f64, f64) {
    let sub = |a: [i64; 3], b: [i64; 3]| [0, 1, 2].map(|i| i128::from(a[i] - b[i]));
    let cross =
        |a: [i128; 3], b: [i128; 3]| [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
    let dot = |a: [i128; 3], b: [i128; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (e1, e2, s) = (sub(v1, v0), sub(v2, v0), sub(ray[0], v0));
    let d = ray[1].map(i128::from);
    let (n, r) = (cross(e1, e2), cross(s, d));
    let det = -dot(d, n);
    let over = |a: i128| a as f64 / det as f64;
    (over(dot(s, n)), over(dot(e2, r)), over(-dot(e1, r)))
}

/// The worst errors of depth (in 2^-T_BITS), of fractions (in 2^-bits), of points (in grid units), and whether every origin
/// that stands off is on the side of the surface that the ray came from.
fn resolved<W>(
    fraction: impl Fn(<W::Space as Space>::Fraction) -> f64,
    fraction_bits: i32,
    point: impl Fn(<W::Space as Space>::Point) -> [f64; 3],
) -> [f64; 3]
where
    W: Width<Word: Into<i64>, Wide: Into<i128>>,
{
    let mut worst = [0f64; 3];
    let mut count = 0;
    hits::<W>(60_000, |ray, corners, triangle| {
        count += 1;
        let (origin, direction) = (ray.origin.map(Into::into), ray.direction.map(Into::into));
        let (t, u, v) = exactly([origin, direction], corners);
        let depth = Exact::<W>::intersect(ray, triangle).expect("a hit");
        let approximate: i64 = W::depth(depth.numerator, depth.denominator).into();
        worst[0] = worst[0].max((approximate as f64 - t * (2f64).powi(W::T_BITS as i32)).abs());

        let surface = Exact::<W>::resolve(ray, triangle);
        for (found, exact) in [(fraction(surface.u), u), (fraction(surface.v), v)] {
            assert!((0.0..=1.0).contains(&found));
            worst[1] = worst[1].max((found - exact).abs() * (2f64).powi(fraction_bits));
        }
        let found = point(surface.point);
        for axis in 0..3 {
            let exact = origin[axis] as f64 + t * direction[axis] as f64;
            worst[2] = worst[2].max((found[axis] - exact).abs());
        }

        // N . (o' - v0) has the sign of N . (o - v0), or of -N . D where the ray starts in the plane.
        let start: [i64; 3] = W::stand_off(&surface).map(Into::into);
        let side = |from: [i64; 3]| -> i128 {
            let sub = |a: [i64; 3], b: [i64; 3]| [0, 1, 2].map(|i| i128::from(a[i]) - i128::from(b[i]));
            let (e1, e2, s) = (sub(corners[1], corners[0]), sub(corners[2], corners[0]), sub(from, corners[0]));
            (e1[1] * e2[2] - e1[2] * e2[1]) * s[0]
                + (e1[2] * e2[0] - e1[0] * e2[2]) * s[1]
                + (e1[0] * e2[1] - e1[1] * e2[0]) * s[2]
        };
        assert!(side(start).signum() == side(origin).signum(), "{start:?} is not in front of {corners:?}");
    });
    assert!(count > 20_000, "only {count} hits were looked at");
    worst
}

#[test]
fn resolved_hits_of_exact14() {
    let q4 = |p: [i32; 3]| p.map(|c| f64::from(c) / 16.0);
    let [depth, fraction, point] = resolved::<Width14>(|f| f.to_num(), 14, q4);
    within_tolerance("exact14 depth, 2^-13", depth);
    within_tolerance("exact14 fraction, 2^-14", fraction);
    within_tolerance("exact14 point, grid units", point);
}

#[test]
fn resolved_hits_of_exact29() {
    let q8 = |p: [i64; 3]| p.map(|c| c as f64 / 256.0);
    let [depth, fraction, point] = resolved::<Width29>(|f| f.to_num(), 30, q8);
    within_tolerance("exact29 depth, 2^-31", depth);
    within_tolerance("exact29 fraction, 2^-30", fraction);
    within_tolerance("exact29 point, grid units", point);
}

#[test]
fn resolved_hits_of_exact20() {
    let q8 = |p: [i64; 3]| p.map(|c| c as f64 / 256.0);
    let [depth, fraction, point] = resolved::<Width20>(|f| f.to_num(), 30, q8);
    within_tolerance("exact20 depth, 2^-41", depth);
    within_tolerance("exact20 fraction, 2^-30", fraction);
    within_tolerance("exact20 point, grid units", point);
}

/// A hit's box is always entered, even with the hit itself as the limit.
fn no_false_miss<W>()
where
    W: Width<Word: Into<i64>>,
{
    let mut count = 0u64;
    hits::<W>(60_000, |ray, corners, triangle| {
        let bounds = Bounds::of(&corners.map(|v| v.map(|c| c as i32)));
        let node = Exact::<W>::node([bounds; 2], [0; 2]);
        let depth = Exact::<W>::intersect(ray, triangle).expect("a hit");
        let path = Exact::<W>::path(ray);
        for limit in [Exact::<W>::limit(&path, &depth), Exact::<W>::reach(ray, &path)] {
            let [first, second] = enter::<Exact<W>>(&path, &node, limit);
            assert!(first.is_some() && first == second, "{ray:?} misses {bounds:?}");
            assert!(Exact::<W>::within(first.expect("entered"), limit));
        }
        count += 1;
    });
    println!("{}: {count} boxes that were hit were entered", W::NAME);
}

#[test]
fn no_box_that_is_hit_is_missed() {
    no_false_miss::<Width14>();
    no_false_miss::<Width20>();
    no_false_miss::<Width29In<false>>();
    no_false_miss::<Width29In<true>>();
}

/// `along` is never high, negative where the difference is, and low by at most the slack.
fn reciprocal_bounds<W, R>(deltas: &[i64])
where
    W: Width<Word: Into<i64>>,
    R: Reciprocal<Word = W::Word>,
{
    let mut random = SplitMix64(3);
    let top = 1i64 << W::DIRECTION_BITS;
    let ends = [1, 2, 3, 5, top / 2 - 1, top / 2, top / 2 + 1, top - 2, top - 1];
    let magnitudes = ends.into_iter().chain((0..200_000).map(|_| {
        let bits = random.within([1, W::DIRECTION_BITS.into()]);
        random.within([1, (1i64 << bits) - 1])
    }));
    let t_max: i64 = W::T_MAX.into();
    for magnitude in magnitudes {
        let word = |value: i64| W::Word::from_i64(value).expect("in range");
        let (reciprocal, opposite) = (R::new(word(magnitude)), R::new(word(-magnitude)));
        for &delta in deltas {
            let found: i64 = reciprocal.along(word(delta)).into();
            assert_eq!(found, opposite.along(word(-delta)).into(), "{delta} / {magnitude}: the sign matters");
            let exact = (i128::from(delta) << W::T_BITS).div_euclid(magnitude.into());
            if delta < 0 {
                assert!(found < 0, "{delta} / {magnitude}: {found}");
            } else {
                assert!(i128::from(found) <= exact, "{delta} / {magnitude}: {found} is over {exact}");
                let needed = exact.min(t_max.into());
                assert!(i128::from(found + R::SLACK.into()) >= needed, "{delta} / {magnitude}: {found}, {exact}");
            }
        }
    }
    // No movement along the axis: everything on the far side is out of reach, and the plane itself is not.
    let still = R::new(W::Word::ZERO);
    assert!(Into::<i64>::into(still.along(W::Word::ONE)) + Into::<i64>::into(R::SLACK) >= t_max);
    assert_eq!(still.along(W::Word::ZERO), W::Word::ZERO);
}

#[test]
fn reciprocals_are_low_by_less_than_the_slack() {
    reciprocal_bounds::<Width20, Reciprocal20>(&[
        -(1 << 20),
        -1,
        0,
        1,
        2,
        (1 << 19) - 1,
        1 << 19,
        (1 << 20) - 1,
        1 << 20,
    ]);
    reciprocal_bounds::<Width29, Reciprocal29>(&[
        -(1 << 29),
        -1,
        0,
        1,
        2,
        (1 << 28) - 1,
        1 << 28,
        (1 << 29) - 1,
        1 << 29,
    ]);
}

#[test]
fn exact_sums_at_the_ends() {
    let ends14 = [-(1i64 << 15) + 1, -1, 0, 1, (1 << 15) - 1];
    let normals14 = [-(1i64 << 30), -(1 << 30) + 1, -(1 << 15), -1, 0, 0x7fff, 1 << 15, (1 << 30) - 1, 1 << 30];
    for a in ends14 {
        for b in normals14 {
            for c in normals14 {
                let found = Width14::dot([a, -a, a].map(|c| c as i32), [b, c, b].map(|c| c as i32));
                assert_eq!(i128::from(found), i128::from(a) * i128::from(b - c + b), "{a} {b} {c}");
            }
        }
    }
    // Corners of the cube that the budget allows, and directions to the corners of theirs: the largest U, det and tn.
    let corner = |i: usize| [0, 1, 2].map(|axis| i64::from(Width20::SPAN) * (i >> axis & 1) as i64);
    let largest_direction = (1i64 << Width20::DIRECTION_BITS) - 1;
    let mut most = 0;
    for (i, j, k) in (0..512).map(|n| (n & 7, n >> 3 & 7, n >> 6)) {
        let (edge, s) = (sub(corner(j), corner(i)), sub(corner(k), corner(i)));
        for d in 0..8 {
            let d = [0, 1, 2].map(|axis| if d >> axis & 1 == 0 { largest_direction } else { -largest_direction });
            let wide = |a: [i64; 3], b: [i64; 3]| (0..3).map(|i| i128::from(a[i]) * i128::from(b[i])).sum::<i128>();
            for (a, b) in [(edge, cross(s, d)), (d, cross(edge, s)), (s, cross(edge, corner(d[0] as usize & 7)))] {
                assert_eq!(i128::from(Width20::dot(a, b)), wide(a, b), "{a:?} . {b:?}");
                most = most.max(wide(a, b).abs());
            }
        }
    }
    assert!(most > 1 << 62, "the ends were not reached: {most}");
    let largest = 1i64 << 61;
    assert_eq!(Width29::dot([1 << 29; 3], [largest; 3]), 3 * (1i128 << 90));
    assert_eq!(Width29::dot([-(1 << 29); 3], [largest; 3]), -3 * (1i128 << 90));
}

#[test]
fn fractions_are_ordered_as_256_bits_order_them() {
    let mut random = SplitMix64(11);
    let mut term = |bits: u32| -> i128 {
        let size = random.within([1, bits.into()]) as u32;
        (i128::from(random.bits()) << 64 | i128::from(random.bits())) & ((1i128 << size) - 1) | 1
    };
    for i in 0..1_000_000 {
        let (a, b, c) = (term(92), term(92), term(92));
        // Every third pair is equal, or unequal by one in one term.
        let pair = if i % 3 == 0 { (a + i128::from(i % 2), b) } else { (c, term(92)) };
        let wide = |x: i128| U256::new(x as u128);
        let expected = (wide(a) * wide(pair.1)).cmp(&(wide(pair.0) * wide(b)));
        assert_eq!(Width29::order((a, b), pair), expected, "{a} / {b}, {pair:?}");
    }
}

/// Where a sample's direction is from where it should be: low, by two products that are rounded down.
#[test]
fn samples_move_steps_down_by_less_than_two_units() {
    let mut random = SplitMix64(5);
    let mut worst = 0f64;
    for _ in 0..100_000 {
        let [first, right, down] = [[-2000, 2000], [-900, 900], [-900, 900]].map(|ends| random.within(ends));
        let header = CameraHeader {
            eye: [0; 3],
            along: [0; 3],
            first: [first; 3],
            right: [right; 3],
            down: [down; 3],
            fraction_bits: 0,
        };
        let used = Use { size: [4, 3], parallel: false, sampled: true };
        let camera = Camera::<i32>::new::<Exact<Width14>>(&header, used).expect("in range");
        let mut place = || random.within([0, 65_535]) as u16;
        let place = Place { right_q16: place(), down_q16: place() };
        let (x, y) = (random.below(4), random.below(3));
        let along = |pixel: u64, place: u16| pixel as f64 + f64::from(place) / 65_536.0 - 0.5;
        let exact = first as f64 + right as f64 * along(x, place.right_q16) + down as f64 * along(y, place.down_q16);
        let [found, ..] = camera.through(place).direction(x as u16, y as u16);
        assert!(f64::from(found) <= exact, "{header:?} {place:?}: {found} is over {exact}");
        worst = worst.max(exact - f64::from(found));
    }
    within_tolerance("sample's step, units of a coefficient", worst);
}

/// IEC 61966-2-1, every value of Q16.
#[test]
fn srgb_rounds_every_value_to_nearest() {
    for light in 0..=1u32 << 16 {
        let linear = f64::from(light) / f64::from(1u32 << 16);
        let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
        let expected = (255.0 * encoded).round() as u8;
        let [found, ..] = Rgb16([U16F16::from_bits(light); 3]).encode(Transfer::Srgb);
        assert_eq!(found, expected, "{light}");
    }
}
