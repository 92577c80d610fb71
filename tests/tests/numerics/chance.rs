//! Random numbers and directions against what chance would do. Nothing here is drawn anew: the inputs are those of pictures,
//! so a test passes always or never. Bounds are six standard deviations, or for sums of squares the same by Wilson and
//! Hilferty's cube root: chance would pass one in 10^8 of them by.

use core_rt::num::Triple;
use core_rt::random::{Sample, below};
use core_rt::space::{Grid14, Grid29, GridQ31, Space};
use float_rt::FloatSpace;

const SIGMAS: f64 = 6.0;

/// 64 x 64 pixels with 16 samples of 8 surfaces each.
fn samples() -> impl Iterator<Item = (Sample, u32)> {
    let pixels = (0..64u16).flat_map(|y| (0..64u16).map(move |x| [x, y]));
    pixels.flat_map(|pixel| (0..16).flat_map(move |number| (0..8).map(move |event| (Sample { pixel, number }, event))))
}

/// How many standard deviations so many of `of` are from a half.
fn off_half(count: u32, of: u32) -> f64 {
    (2.0 * f64::from(count) - f64::from(of)) / f64::from(of).sqrt()
}

/// How many standard deviations the sum of squares of counts is from what equal chances give.
fn off_equal(counts: &[u32]) -> f64 {
    let total: f64 = counts.iter().copied().map(f64::from).sum();
    let expected = total / counts.len() as f64;
    let square: f64 = counts.iter().map(|&count| (f64::from(count) - expected).powi(2) / expected).sum();
    let freedom = counts.len() as f64 - 1.0;
    let spread = 2.0 / (9.0 * freedom);
    (libm::cbrt(square / freedom) - 1.0 + spread) / spread.sqrt()
}

/// Ones in each bit, and in the bits in which numbers of two neighbours differ.
#[test]
fn bits_are_even_and_neighbours_share_none() {
    type Neighbour = fn(Sample, u32) -> (Sample, u32);
    let neighbours: [(&str, Neighbour); 5] = [
        ("itself", |sample, event| (sample, event)),
        ("to the right", |s, event| (Sample { pixel: [s.pixel[0] + 1, s.pixel[1]], ..s }, event)),
        ("below", |s, event| (Sample { pixel: [s.pixel[0], s.pixel[1] + 1], ..s }, event)),
        ("next sample", |s, event| (Sample { number: s.number + 1, ..s }, event)),
        ("next surface", |sample, event| (sample, event + 1)),
    ];
    for (name, neighbour) in neighbours {
        let (mut ones, mut total) = ([[0u32; 32]; 4], 0);
        let mut pairs = vec![0u32; 4 * 256];
        for (sample, event) in samples() {
            let numbers = sample.numbers(event);
            let (other, next) = neighbour(sample, event);
            let others = if name == "itself" { [0; 4] } else { other.numbers(next) };
            for (word, (number, other)) in numbers.into_iter().zip(others).enumerate() {
                (0..32).for_each(|bit| ones[word][bit] += (number ^ other) >> bit & 1);
                // The next word of the same four, for a number itself.
                let beside = if name == "itself" { numbers[(word + 1) % 4] } else { other };
                pairs[word << 8 | ((number >> 28 << 4) | beside >> 28) as usize] += 1;
            }
            total += 1;
        }
        for (word, ones) in ones.into_iter().enumerate() {
            for (bit, ones) in ones.into_iter().enumerate() {
                let off = off_half(ones, total);
                assert!(off.abs() < SIGMAS, "{name}, bit {bit} of number {word}: {off:.1} standard deviations");
            }
            let off = off_equal(&pairs[word << 8..(word + 1) << 8]);
            assert!(off < SIGMAS, "{name}, pairs of number {word}: {off:.1} standard deviations");
        }
    }
}

/// What takes the pixel for the sample, or leaves a word out, is found by the same sums.
#[test]
fn numbers_that_follow_from_neighbours_are_found() {
    let mut counts = vec![0u32; 256];
    for (sample, event) in samples() {
        // A generator that is seeded by the pixel and steps by one: neighbours are close.
        let seeded = |x: u16| (u32::from(x) * 0x0100_0193 + event) << 8;
        let [a, b] = [sample.pixel[0], sample.pixel[0] + 1].map(seeded);
        counts[((a >> 28 << 4) | b >> 28) as usize] += 1;
    }
    assert!(off_equal(&counts) > 100.0);
    assert!(off_half(600, 1000) > SIGMAS);
}

#[test]
fn whole_numbers_are_below_their_end_and_equally_likely() {
    for end in [1, 2, 3, 65_535, 65_536, 3 * 65_535] {
        assert_eq!([0, u32::MAX].map(|number| below(number, end)), [0, end - 1]);
    }
    for end in [3, 7, 100] {
        let mut counts = vec![0u32; end as usize];
        samples().for_each(|(sample, event)| counts[below(sample.numbers(event)[0], end) as usize] += 1);
        assert!(off_equal(&counts) < SIGMAS, "{end}");
    }
}

/// A space's direction as floats.
trait Direction: Space {
    fn floats(unit: Self::Unit) -> Triple<f64>;
}

macro_rules! fixed_space {
    ($($space:ty)*) => {$(
        impl Direction for $space {
            fn floats(unit: Self::Unit) -> Triple<f64> {
                unit.map(|c| c.to_num())
            }
        }
    )*};
}
fixed_space!(Grid14 Grid29 GridQ31);

impl Direction for FloatSpace<f32> {
    fn floats(unit: Triple<f32>) -> Triple<f64> {
        unit.map(f64::from)
    }
}

/// First and second moments of all directions, cells of equal area, and the mean cosine of those about a normal.
fn directions<S: Direction>(name: &str, about: S::Unit) {
    let (mut sum, mut products, mut cells, mut total) = ([0.0; 3], [[0.0; 3]; 3], vec![0u32; 16 * 16], 0.0);
    let (mut cosines, mut squares) = (0.0, 0.0);
    let axis = S::floats(about);
    for (sample, event) in samples() {
        let [_, height, turn, _] = sample.numbers(event);
        let unit = S::anywhere([height, turn]);
        let d = S::floats(unit);
        for i in 0..3 {
            sum[i] += d[i];
            (0..3).for_each(|j| products[i][j] += d[i] * d[j]);
        }
        // Along x, so that neither the height nor the turn is looked at again.
        let slice = ((d[0] + 1.0) * 8.0).clamp(0.0, 15.0) as usize;
        let sector = ((libm::atan2(d[1], d[2]) / std::f64::consts::PI + 1.0) * 8.0).clamp(0.0, 15.0) as usize;
        cells[slice * 16 + sector] += 1;
        let Some(strewn) = S::strewn(about, unit, u16::MAX) else { continue };
        let cosine: f64 = S::floats(strewn).iter().zip(axis).map(|(a, b)| a * b).sum();
        (cosines, squares, total) = (cosines + cosine, squares + cosine * cosine, total + 1.0);
    }
    // A component is uniform, of variance 1/3; its square has 4/45, a product of two 1/15.
    let within = |what: &str, mean: f64, expected: f64, variance: f64| {
        let off = (mean - expected) / (variance / total).sqrt();
        assert!(off.abs() < SIGMAS, "{name}, {what}: {off:.1} standard deviations");
    };
    for i in 0..3 {
        within("mean", sum[i] / total, 0.0, 1.0 / 3.0);
        for j in 0..3 {
            let (expected, variance) = if i == j { (1.0 / 3.0, 4.0 / 45.0) } else { (0.0, 1.0 / 15.0) };
            within("products", products[i][j] / total, expected, variance);
        }
    }
    let off = off_equal(&cells);
    assert!(off < SIGMAS, "{name}, cells: {off:.1} standard deviations");
    // The density of a cosine c is 2 c: means 2/3 and 1/2, variances 1/18 and 1/12.
    within("cosine", cosines / total, 2.0 / 3.0, 1.0 / 18.0);
    within("square of the cosine", squares / total, 0.5, 1.0 / 12.0);
}

#[test]
fn directions_are_uniform_and_about_a_normal_as_likely_as_their_cosine() {
    let tilted = [1 << 29, -(1 << 29), 759_250_125]; // (1, -1, 2^(1/2)) / 2
    directions::<Grid14>("14", Grid14::unit_from_q30(tilted));
    directions::<Grid29>("29", Grid29::unit_from_q30(tilted));
    directions::<GridQ31>("Q31", GridQ31::unit_from_q30(tilted));
    directions::<FloatSpace<f32>>("f32", FloatSpace::unit_from_q30(tilted));
}
