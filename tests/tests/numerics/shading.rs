//! The error of shading alone: hits are given exactly, so that all that is left is the arithmetic of normals, directions,
//! powers, light and the way to bytes. A table of it stands in `docs/SHADING.md`.

use core_rt::colour::{Colour, Radiance, Transfer};
use core_rt::space::{Grid14, Grid29, GridQ31, Space};
use float_rt::FloatSpace;
use glam::DVec3;
use tests::documents::check_part;
use tests::random::SplitMix64;

/// A law of highlights; `None` for matt.
#[derive(Clone, Copy)]
enum Law {
    Matt,
    Blinn(u16),
    Phong(u16),
}

const LAWS: [(&str, Law); 5] = [
    ("Lambert", Law::Matt),
    ("Blinn-Phong, 50", Law::Blinn(50)),
    ("Blinn-Phong, 1000", Law::Blinn(1000)),
    ("Phong, 50", Law::Phong(50)),
    ("Phong, 1000", Law::Phong(1000)),
];

/// A hit: normals at the corners and where between them, the way that the ray came, the ways to two lights.
struct Hit {
    normals: [DVec3; 3],
    weights: [f64; 2],
    along: DVec3,
    towards: [DVec3; 2],
}

const ALBEDO: [u16; 3] = [50_000, 30_000, 9_000];
const SPECULAR: [u16; 3] = [40_000; 3];
/// Mantissa and exponent of the lights: 0.9 and 0.4 of white.
const LIGHTS: [Radiance; 2] =
    [Radiance { mantissa: [58_982; 3], exponent: 0 }, Radiance { mantissa: [52_429, 50_000, 45_000], exponent: -1 }];

fn unit(random: &mut SplitMix64) -> DVec3 {
    let mut component = || random.within([-1_000_000, 1_000_000]) as f64;
    DVec3::new(component(), component(), component()).try_normalize().unwrap_or(DVec3::Z)
}

/// A hit that a highlight may be seen in: lights are often near the mirrored view.
fn hit(random: &mut SplitMix64) -> Hit {
    let normal = unit(random);
    let near = |random: &mut SplitMix64| (normal + unit(random) * 0.3).normalize();
    let normals = [near(random), near(random), near(random)];
    let u = random.within([0, 1000]) as f64 / 1000.0;
    let v = (1.0 - u) * random.within([0, 1000]) as f64 / 1000.0;
    let mut along = unit(random);
    if along.dot(normal) > 0.0 {
        along = -along;
    }
    let mirrored = along - normal * (2.0 * along.dot(normal));
    let light =
        |random: &mut SplitMix64| (mirrored + unit(random) * (random.within([0, 1000]) as f64 / 700.0)).normalize();
    Hit { normals, weights: [u, v], along, towards: [light(random), light(random)] }
}

impl Hit {
    fn normal(&self) -> DVec3 {
        let [u, v] = self.weights;
        (self.normals[0] * (1.0 - u - v) + self.normals[1] * u + self.normals[2] * v).normalize()
    }

    /// Whether a light is so nearly behind the surface that it may or may not be: a decision, and no error of shading.
    fn grazes(&self) -> bool {
        self.towards.iter().any(|l| self.normal().dot(*l).abs() < 1e-3)
    }
}

/// What the pixel is, before it is rounded: 0 to 255 for each channel.
fn exact(hit: &Hit, law: Law) -> [f64; 3] {
    let n = hit.normal();
    let mut sums = [[0.0; 3]; 2];
    for (light, l) in LIGHTS.iter().zip(hit.towards) {
        let cosine = n.dot(l);
        if cosine <= 0.0 {
            continue;
        }
        let lobe = match law {
            Law::Matt => 0.0,
            Law::Blinn(exponent) => libm::pow((l - hit.along).normalize().dot(n).max(0.0), exponent.into()),
            Law::Phong(exponent) => {
                libm::pow((hit.along - n * (2.0 * hit.along.dot(n))).dot(l).max(0.0), exponent.into())
            }
        };
        for (channel, mantissa) in light.mantissa.into_iter().enumerate() {
            let strength = f64::from(mantissa) * libm::exp2(f64::from(light.exponent) - 16.0);
            sums[0][channel] += strength * cosine;
            sums[1][channel] += strength * lobe;
        }
    }
    [0, 1, 2].map(|channel| {
        let part = |albedo: [u16; 3]| f64::from(albedo[channel]) / 65_535.0;
        let light = (sums[0][channel] * part(ALBEDO) + sums[1][channel] * part(SPECULAR)).clamp(0.0, 1.0);
        let encoded = if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * libm::pow(light, 1.0 / 2.4) - 0.055 };
        encoded * 255.0
    })
}

/// What a space makes of it, by the operations that its shaders use.
fn shaded<S: Space>(hit: &Hit, law: Law, fraction: impl Fn(f64) -> S::Fraction) -> [u8; 3] {
    let read = |v: DVec3| S::unit_from_q30(v.to_array().map(|c| (c * libm::ldexp(1.0, 30)).round() as i32));
    let [u, v] = hit.weights.map(fraction);
    let along = read(hit.along);
    let n = S::interpolate(hit.normals.map(read), u, v).expect("they do not cancel");
    let (mut diffuse, mut shining) = (S::Colour::default(), S::Colour::default());
    for (light, towards) in LIGHTS.iter().zip(hit.towards.map(read)) {
        let Some(cosine) = S::cosine(n, towards) else { continue };
        let light = S::Colour::light(light);
        diffuse = diffuse.plus(Colour::lit(&light, cosine));
        let lobe = match law {
            Law::Matt => continue,
            Law::Blinn(exponent) => {
                let view = S::negate(along);
                S::lobe(S::halfway(towards, view).unwrap_or(view), n, exponent * 4)
            }
            Law::Phong(exponent) => S::lobe(S::reflect(along, n), towards, exponent * 4),
        };
        shining = shining.plus(Colour::lit(&light, lobe));
    }
    diffuse.reflected(&ALBEDO).plus(shining.reflected(&SPECULAR)).encode(Transfer::Srgb)
}

/// The largest error beyond the half that rounding may take, in gray levels, and how many channels of a thousand are not the
/// nearest byte.
fn measured<S: Space>(law: Law, fraction: impl Fn(f64) -> S::Fraction + Copy) -> (f64, f64) {
    let mut random = SplitMix64(11);
    let (mut worst, mut other, count) = (0_f64, 0_u32, 100_000);
    for _ in 0..count {
        let hit = hit(&mut random);
        if hit.grazes() {
            continue;
        }
        for (found, exact) in shaded::<S>(&hit, law, fraction).into_iter().zip(exact(&hit, law)) {
            worst = worst.max((f64::from(found) - exact).abs() - 0.5);
            other += u32::from((f64::from(found) - exact).abs() > 0.5);
        }
    }
    (worst, f64::from(other) * 1000.0 / f64::from(3 * count))
}

fn table() -> (String, Vec<[(f64, f64); 4]>) {
    let mut text = "| law | 14 bits | 29 bits | 2009 report | f32 |\n| --- | --- | --- | --- | --- |\n".to_owned();
    let mut rows = Vec::new();
    for (name, law) in LAWS {
        let row = [
            measured::<Grid14>(law, |w| <Grid14 as Space>::Fraction::from_num(w.min(0.999_9))),
            measured::<Grid29>(law, |w| <Grid29 as Space>::Fraction::from_num(w)),
            measured::<GridQ31>(law, |w| <GridQ31 as Space>::Fraction::from_num(w.min(0.999_999_9))),
            measured::<FloatSpace<f32>>(law, |w| w as f32),
        ];
        let cells = row.map(|(worst, other)| format!("{worst:.3}, {other:.2}")).join(" | ");
        text += &format!("| {name} | {cells} |\n");
        rows.push(row);
    }
    (text, rows)
}

/// The document has the table; and with 29 bits no pixel is off by a level.
#[test]
fn with_hits_given_exactly() {
    let (text, rows) = table();
    println!("{text}");
    check_part(super::SHADING, "shading", &text, |a, b| a == b);
    for [narrow, wide, report, single] in rows {
        assert!(wide.0 < 0.5 && report.0 < 0.5 && single.0 < 0.5 && narrow.0 < 8.0, "{narrow:?} {wide:?}");
        assert!(wide.1 < 10.0 && narrow.1 > wide.1, "14 bits are fewer: {narrow:?} {wide:?}");
    }
}
