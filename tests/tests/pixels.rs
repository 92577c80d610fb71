//! Parallel rays, samples and formats, against the f64 reference and against formats made here by other means.

use core_rt::colour::{Colour, Rgb16, Transfer};
use core_rt::format::{Format as Layout, rgb565};
use fixed::types::U16F16;
use glam::DVec3;
use host_tools::compare::compare;
use host_tools::engine::{self, ENGINES};
use host_tools::model::{Format, Model};
use host_tools::picture::Picture;
use host_tools::pixels::rgb888;
use host_tools::prepare::Options;
use host_tools::reference::{Reference, encode};
use tests::scenes;

fn picture(kernel: &str, model: &Model) -> Picture {
    let engine = engine::by_name(kernel).expect("a kernel of this name");
    let blob = engine.prepare(model, &Options::default()).expect("it fits").blob;
    engine.render(blob.bytes(), [32, 32], &|_| {}).expect("a blob just made").picture
}

/// The reference's picture, of pixels made of its light.
fn truth(model: &Model, pixel: impl Fn(DVec3) -> [u8; 3]) -> Picture {
    let reference = Reference::new(model);
    let size @ [width, height] = model.render.size;
    Picture::from_fn(width, height, |x, y| pixel(reference.pixel_colour(size, x, y)))
}

fn named(name: &str) -> Model {
    scenes::pixels().into_iter().find(|(known, _)| *known == name).expect("a scene of this name").1
}

/// The most pixels over 64 and over 4, in thousandths of all, by kernel.
const LIMITS: [(&str, f64, f64); 5] =
    [("exact29", 0.5, 4.0), ("exact20", 0.5, 4.0), ("exact14", 3.0, 60.0), ("f32", 3.0, 20.0), ("f64", 0.5, 4.0)];

#[test]
fn parallel_rays_and_samples_are_the_references() {
    for (scene, samples) in [
        ("parallel", 1),
        ("parallel", 4),
        ("parallel-inside", 1),
        ("parallel-inside", 5),
        ("samples", 4),
        ("samples", 5),
    ] {
        let mut model = named(scene);
        model.render.samples = samples;
        let truth = truth(&model, |light| encode(light, model.render.transfer));
        let count = truth.pixels().len() as f64 / 1000.0;
        for engine in ENGINES {
            let apart = compare(&picture(engine.name(), &model), &truth).expect("one size");
            println!(
                "{scene}, {samples} samples, {}: over 64 {}, over 4 {}, over 1 {}, {:.1} dB",
                engine.name(),
                apart.over_64,
                apart.over_4,
                apart.over_1,
                apart.psnr.unwrap_or(f64::INFINITY)
            );
            let Some((_, over_64, over_4)) = LIMITS.iter().find(|(name, ..)| *name == engine.name()) else { continue };
            let found = (apart.over_64 as f64 / count, apart.over_4 as f64 / count);
            assert!(found.0 <= *over_64 && found.1 <= *over_4, "{scene}, {samples}, {}: {found:?}", engine.name());
        }
    }
}

/// What is behind the plane is not seen, and what is seen does not depend on how far before everything the plane is.
#[test]
fn planes_cut_and_distance_does_not_matter() {
    let near = named("parallel-inside");
    let mut far = near.clone();
    far.camera.position -= 3.0 * (far.camera.look_at - far.camera.position);
    let mut farther = far.clone();
    farther.camera.position -= 1e6 * (farther.camera.look_at - farther.camera.position);
    for kernel in ["exact14", "exact29", "hanika-cd", "f32"] {
        let [near, far, farther] = [&near, &far, &farther].map(|model| picture(kernel, model));
        let differ = |a: &Picture, b: &Picture| compare(a, b).expect("one size").over_4;
        assert!(differ(&near, &far) > 500, "{kernel}: the plane cuts nothing");
        // The middle has come through large numbers.
        assert!(differ(&far, &farther) <= 2, "{kernel}: {}", differ(&far, &farther));
    }
}

/// Bayer's matrix by its definition: from the one of half the side, four times as fine.
fn bayer(side: u32, x: u32, y: u32) -> u32 {
    if side == 1 {
        return 0;
    }
    let half = side / 2;
    4 * bayer(half, x % half, y % half) + [[0, 2], [3, 1]][(y / half) as usize][(x / half) as usize]
}

/// A channel's level by the document's formula.
fn level(byte: u8, most: f64, x: u32, y: u32) -> u16 {
    let threshold = (2.0 * f64::from(bayer(8, x % 8, y % 8)) + 1.0) / 128.0;
    (most * f64::from(byte) / 255.0 + threshold + 1e-9).floor() as u16
}

#[test]
fn dither_is_the_documents_exact_at_the_ends_and_right_in_the_mean() {
    for byte in 0..=255u8 {
        let mut sums = [0u32; 2];
        for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
            let pixel = rgb565([byte, 255 - byte, 0], [8 + x as u16, 65_528 + y as u16]);
            assert_eq!(pixel >> 11, level(byte, 31.0, x, y), "{byte} {x} {y}");
            assert_eq!(pixel >> 5 & 63, level(255 - byte, 63.0, x, y), "{byte} {x} {y}");
            assert_eq!((pixel & 31, rgb565([255; 3], [x as u16, y as u16])), (0, u16::MAX));
            sums = [sums[0] + u32::from(pixel >> 11), sums[1] + u32::from(pixel >> 5 & 63)];
        }
        for (sum, value, most) in [(sums[0], byte, 31.0), (sums[1], 255 - byte, 63.0)] {
            let off = f64::from(sum) / 64.0 - most * f64::from(value) / 255.0;
            assert!(off.abs() <= 1.0 / 128.0 + 1e-9, "{value}: {off} levels");
        }
    }
}

/// Level by level, from the same kernel's bytes.
#[test]
fn rgb565_pictures_are_the_bytes_dithered() {
    let dithered = named("dithered");
    let mut plain = dithered.clone();
    plain.render.format = Format::Rgb888;
    for kernel in ["exact14", "exact29", "f32"] {
        let bytes = picture(kernel, &plain);
        let width = bytes.width();
        let expected = Picture::from_fn(width, bytes.height(), |x, y| {
            let [r, g, b] = bytes.pixels()[(y * width + x) as usize];
            let wide = |level: u16, bits: u32| (level << (8 - bits) | level >> (2 * bits - 8)) as u8;
            [wide(level(r, 31.0, x, y), 5), wide(level(g, 63.0, x, y), 6), wide(level(b, 31.0, x, y), 5)]
        });
        assert_eq!(picture(kernel, &dithered), expected, "{kernel}");
    }
}

/// Luminance in linear light, in f64.
fn luminance(light: DVec3) -> f64 {
    light.clamp(DVec3::ZERO, DVec3::ONE).dot(DVec3::new(0.2126, 0.7152, 0.0722))
}

#[test]
fn gray_pictures_are_the_references_luminance() {
    for transfer in [host_tools::model::Transfer::Srgb, host_tools::model::Transfer::Linear] {
        let mut model = named("dithered");
        (model.render.format, model.render.transfer) = (Format::Gray8, transfer);
        let truth = truth(&model, |light| encode(DVec3::splat(luminance(light)), transfer));
        for (kernel, over_4, over_64) in [("exact29", 20, 4), ("f64", 20, 4), ("exact14", 600, 60)] {
            let found = picture(kernel, &model);
            assert!(found.pixels().iter().all(|[r, g, b]| r == g && g == b));
            let apart = compare(&found, &truth).expect("one size");
            println!("{kernel}: over 64 {}, over 4 {}, over 1 {}", apart.over_64, apart.over_4, apart.over_1);
            assert!(apart.over_4 <= over_4 && apart.over_64 <= over_64, "{kernel}: {apart:?}");
        }
    }
}

#[test]
fn grays_stay_what_they_are_and_weights_sum_to_one() {
    for light in 0..=1u32 << 16 {
        let gray = Rgb16([U16F16::from_bits(light); 3]);
        for transfer in [Transfer::Srgb, Transfer::Linear] {
            assert_eq!([gray.encode_gray(transfer); 3], gray.encode(transfer), "{light}");
        }
    }
    let bright = Rgb16([U16F16::MAX; 3]);
    assert_eq!((bright.encode_gray(Transfer::Linear), bright.clamped()), (255, Rgb16([U16F16::ONE; 3])));
}

/// The mean of the largest number of samples, and of each number of white ones.
#[test]
fn means_are_rounded_to_nearest_and_white_stays_white() {
    for samples in 1..=1024u16 {
        let (mut white, mut mixed, mut exact) = (Rgb16::default(), Rgb16::default(), 0u64);
        for i in 0..samples {
            let light = u32::from(i) * 40_503 % 65_537;
            exact += u64::from(light);
            white = white.plus(Rgb16([U16F16::ONE; 3]));
            mixed = mixed.plus(Rgb16([U16F16::from_bits(light); 3]));
        }
        assert_eq!(white.mean(samples), Rgb16([U16F16::ONE; 3]), "{samples}");
        let found = f64::from(mixed.mean(samples).0[0].to_bits());
        let off = found - exact as f64 / f64::from(samples);
        assert!(off > -0.5 && off <= 0.5, "{samples}: {off}");
    }
}

#[test]
fn a_format_has_as_many_bytes_as_its_colours_take() {
    for format in Layout::ALL {
        assert_eq!(rgb888(format, &vec![0; 7 * format.bytes()]).len(), 7);
        assert_eq!(Layout::from_number(format.number()), Some(format));
    }
    assert_eq!(Layout::from_number(3), None);
}
