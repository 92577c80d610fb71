//! The numbers at the ends of their documented ranges: every bound that core-rt states, measured against f64 or wide
//! integers. One table holds all tolerances; an entry that is too generous fails as stale.

mod boxes;
mod chance;
mod hits;
mod optics;
mod paint;
mod shading;
mod spheres;
mod sums;

use core_rt::camera::{Camera, CameraHeader, Use};
use core_rt::colour::{Colour, Rgb16, Transfer};
use core_rt::exact::{Exact, Width, Width14, Width29};
use core_rt::num::Word;
use core_rt::samples::Place;
use core_rt::space::{Grid14, Grid29, Space};
use fixed::types::U16F16;
use tests::documents::check_part;
use tests::random::SplitMix64;

/// The largest error of each operation, in the unit that its name gives. What is measured must be at most this, and at
/// least a quarter of it.
const TOLERANCES: [(&str, f64); 84] = [
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
    ("14 anywhere, 2^-14", 4.0),
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
    ("14 strewn, 2^-14", 4.0),
    ("29 altitude, 2^-16", 1.0),
    ("29 anywhere, 2^-30", 4.0),
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
    ("29 strewn, 2^-30", 4.0),
    ("Q31 altitude, 2^-16", 1.0),
    ("Q31 anywhere, 2^-30", 4.0),
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
    ("Q31 strewn, 2^-30", 4.0),
    ("f32 altitude, 2^-16", 0.0025),
    ("f32 anywhere, 2^-24", 10.0),
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
    ("f32 strewn, 2^-24", 4.0),
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

/// The document that states errors.
const SHADING: &str = "docs/SHADING.md";

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

#[test]
fn the_document_has_these_bounds() {
    check_part(SHADING, "errors", &errors(), |a, b| a == b);
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
