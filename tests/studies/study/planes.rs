//! The tracer of 1994: what the fractional bits of t do to reflections, and what its outline does when taken by the word.
//!
//! L. Kesteloot, "Real Time Ray Tracing on Pixel-Planes 5" (University of North Carolina, 1994).

use std::path::Path;

use glam::DVec3;
use host_tools::import;
use host_tools::picture::Picture;
use host_tools::planes::scene::Options;
use planes_rt::camera::{Camera, FRACTION_BITS, Linear};
use planes_rt::colour::Surface;
use planes_rt::pixel;
use planes_rt::scene::{Outline, Sample, Scene, Settings, Sphere};
use planes_rt::widths::Widths;
use tests::planes::way;

use super::plot::Plot;
use super::text::{Verdict, table};

/// Of the pictures of the document.
pub(crate) const SIZE: [u16; 2] = [320, 256];
/// The text's.
const T_BITS: u32 = 6;
/// Lengths of directions: the text's normals, and its integers "on the order of 500".
const LENGTHS: [u16; 2] = [200, 500];
const RADIUS: i16 = 200;
/// Spheres of that radius, gaps of about twice that between them, in no order.
const CENTRES: [[i16; 3]; 7] =
    [[0, 0, -380], [-560, 0, 0], [0, 540, 40], [560, 0, 20], [0, -540, 0], [390, 400, -560], [-400, -390, -540]];
const BACKGROUND: [u16; 3] = [700, 900, 1300];

/// Reflections with so many bits of t below the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Row {
    /// The length of directions.
    pub(crate) length: u16,
    /// The bits.
    pub(crate) bits: u32,
    /// How far the points of reflection are from those of real numbers, in the mean, units.
    pub(crate) point: f64,
    /// How far the reflected directions are off, in the mean, degrees.
    pub(crate) angle: f64,
    /// Rays whose reflection meets another sphere than it should, or none, or one where there is none.
    pub(crate) wrong: usize,
    /// All rays that are reflected.
    pub(crate) rays: usize,
    /// Reflections that meet a sphere.
    pub(crate) met: usize,
    /// Those of them whose t is 0, 1 or 2, without its fraction.
    pub(crate) up_to_2: usize,
}

/// All figures.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Planes {
    /// For each length, for 0 to 10 bits.
    pub(crate) rows: Vec<Row>,
    /// Pixels that the literal outline shows otherwise.
    pub(crate) otherwise: usize,
    /// Pixels in which there is a sphere.
    pub(crate) covered: usize,
    /// The literal picture, and the corrected one.
    pub(crate) pictures: [Picture; 2],
}

fn spheres() -> Vec<Sphere> {
    let colours = [[3, 3, 3], [4, 1, 1], [1, 4, 1], [1, 1, 4], [4, 4, 1], [1, 4, 4], [4, 1, 4]];
    let sphere = |(centre, colour): ([i16; 3], [u16; 3])| Sphere {
        centre,
        radius: RADIUS,
        surface: Surface {
            lit: colour.map(|c| c * 560),
            own: colour.map(|c| c * 100),
            mirror: [1024; 3],
            roughness: 0,
            matt: [0; 3],
        },
    };
    CENTRES.into_iter().zip(colours).map(sphere).collect()
}

/// From in front of the spheres, with directions of a length in the corners.
fn camera(size: [u16; 2], length: u16) -> Camera {
    let half = size.map(|side| f64::from(side) / 2.0);
    let across = 1.0 / half[0];
    let corner = (2.0 + half[1] * across * half[1] * across).sqrt();
    let unit = f64::from(length) / corner * f64::from(1 << FRACTION_BITS);
    let direction = |x: f64, y: f64, z: f64| [x, y, z].map(|c| (c * unit).round() as i32);
    Camera {
        origin: Linear::constant([0, 0, 950]),
        direction: Linear {
            first: direction((0.5 - half[0]) * across, (half[1] - 0.5) * across, -1.0),
            right: direction(across, 0.0, 0.0),
            down: direction(0.0, -across, 0.0),
        },
    }
}

fn settings(size: [u16; 2], t_bits: u32) -> Settings {
    let widths = Widths::new(12, 24, 36, t_bits).expect("bits in range");
    Settings { widths, size, generations: 2, outline: Outline::Nearest, samples: 1, paths: false }
}

fn scene(spheres: &[Sphere], camera: Camera, settings: Settings) -> Scene<'_> {
    Scene::new_checked(spheres, [900, 1500, 1100], BACKGROUND, camera, settings).expect("a scene in range")
}

fn pixels(size: [u16; 2]) -> impl Iterator<Item = [u16; 2]> {
    (0..size[1]).flat_map(move |y| (0..size[0]).map(move |x| [x, y]))
}

/// The angle between two directions.
fn degrees(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b)).to_degrees()
}

fn row(size: [u16; 2], length: u16, bits: u32) -> Row {
    let spheres = spheres();
    let scene = scene(&spheres, camera(size, length), settings(size, bits));
    let mut row = Row { length, bits, point: 0.0, angle: 0.0, wrong: 0, rays: 0, met: 0, up_to_2: 0 };
    for pixel in pixels(size) {
        let (origin, direction) = scene.ray(pixel);
        let real = way(&spheres, origin, direction, 2);
        let mut met = Vec::new();
        pixel::trace_telling(&scene, pixel, Sample::numbered(0), |one| met.push(one));
        let (Some(real_first), Some(first)) = (real.first(), met.first()) else { continue };
        if first.sphere != real_first.sphere {
            continue;
        }
        let triple = |c: [i16; 3]| DVec3::from_array(c.map(f64::from));
        row.rays += 1;
        row.point += triple(first.point).distance(real_first.point);
        row.angle += degrees(triple(first.direction), real_first.direction);
        row.wrong += usize::from(met.get(1).map(|met| met.sphere) != real.get(1).map(|met| met.sphere));
        row.met += usize::from(met.len() > 1);
        row.up_to_2 += usize::from(met.get(1).is_some_and(|met| met.t >> bits <= 2));
    }
    (row.point, row.angle) = (row.point / row.rays as f64, row.angle / row.rays as f64);
    row
}

/// The picture of a scene in which spheres hide others.
fn outlined(size: [u16; 2], outline: Outline) -> Picture {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/planes/scene.toml");
    let mut model = import::load(&path).expect("one of the project's scenes").model;
    model.render.size = size.map(u32::from);
    let planes = host_tools::planes::scene::Planes::new(&model, &Options { outline, ..Options::default() });
    let planes = planes.expect("spheres alone");
    let scene = planes.scene().expect("in range, since it was made");
    let light: Vec<_> = pixels(size).map(|pixel| pixel::trace(&scene, pixel)).collect();
    host_tools::planes::picture(&scene, &light, model.render.transfer)
}

impl Planes {
    /// Measures in pictures of a size.
    pub(crate) fn measure(size: [u16; 2]) -> Self {
        let rows = LENGTHS.into_iter().flat_map(|length| Widths::T_FRACTION.map(move |bits| row(size, length, bits)));
        let pictures = [Outline::Literal, Outline::Nearest].map(|outline| outlined(size, outline));
        let [literal, nearest] = &pictures;
        let otherwise = literal.pixels().iter().zip(nearest.pixels()).filter(|(a, b)| a != b).count();
        let behind = nearest.pixels()[0];
        let covered = nearest.pixels().iter().filter(|&&pixel| pixel != behind).count();
        Self { rows: rows.collect(), otherwise, covered, pictures }
    }

    fn of(&self, length: u16, bits: u32) -> Option<&Row> {
        self.rows.iter().find(|row| row.length == length && row.bits == bits)
    }

    /// Wrong reflections over the bits.
    pub(crate) fn plot(&self) -> String {
        let marks: Vec<f64> = Widths::T_FRACTION.map(f64::from).collect();
        let lines = LENGTHS.map(|length| {
            let rows = self.rows.iter().filter(|row| row.length == length);
            (format!("directions of {length}"), rows.map(|row| row.wrong as f64).collect())
        });
        let title = "Pixels in which a reflection shows the wrong thing";
        Plot { title, x: ("fractional bits of t", &marks), lines: &lines }.svg()
    }

    /// What holds of the text, by the figures.
    pub(crate) fn verdicts(&self) -> Vec<Verdict> {
        let all = |test: &dyn Fn(&Row, &Row) -> bool| {
            let pairs = LENGTHS.iter().filter_map(|&length| Some((self.of(length, 0)?, self.of(length, T_BITS)?)));
            pairs.into_iter().all(|(none, six)| test(none, six))
        };
        let of = |bits: u32| {
            let shares = LENGTHS.iter().filter_map(|&length| self.of(length, bits));
            let shares = shares.map(|row| format!("{:.1} %", 100.0 * row.wrong as f64 / row.rays as f64));
            shares.collect::<Vec<_>>().join(" and ")
        };
        let (whole, met) = self.of(LENGTHS[0], 0).map_or((0, 0), |row| (row.up_to_2, row.met));
        vec![
            Verdict {
                claim: "t of a ray that is as long as a normal truncates to 0, 1 or 2",
                holds: 2 * whole > met,
                because: format!("it does in {whole} of {met} reflections that meet a sphere"),
            },
            Verdict {
                claim: "6 bits help reflections significantly",
                holds: all(&|none, six| 2 * six.wrong < none.wrong),
                because: format!(
                    "{} of them show the wrong thing without a fraction, {} with 6 bits",
                    of(0),
                    of(T_BITS)
                ),
            },
        ]
    }

    /// The document.
    pub(crate) fn document(&self) -> String {
        let [width, height] = [self.pictures[0].width(), self.pictures[0].height()];
        let mut text = format!(
            "# The tracer of Pixel-Planes 5\n\n\
             Written whole by `cargo xtask planes`; edit `tests/studies/study/planes.rs` instead.\n\n\
             L. Kesteloot's tracer of 1994 keeps positions and directions in 12 bits, their products in 24 and the determinant \
             in 36; normals are as long as the radius, here {RADIUS}, and spheres are some 400 units apart. Pictures have \
             {width}x{height} pixels.\n\n\
             ## The fraction of t\n\n\
             A ray is compared with the same ray in real numbers, up to the sphere that its reflection meets. **Point** is how \
             far the point of reflection is off in the mean, in units, **angle** how far the reflected direction is, in degrees, \
             and **wrong** the share of reflections that show another sphere, or none, or one where there is none. **t below 3** is the share of reflections that meet a sphere with \
             0, 1 or 2 before the point.\n\n"
        );
        for length in LENGTHS {
            text += &format!("Directions of {length} units:\n\n");
            let rows = self.rows.iter().filter(|row| row.length == length).map(|row| {
                let wrong = 100.0 * row.wrong as f64 / row.rays as f64;
                let whole = 100.0 * row.up_to_2 as f64 / row.met as f64;
                vec![
                    row.bits.to_string(),
                    format!("{:.2}", row.point),
                    format!("{:.2}", row.angle),
                    format!("{:.2} %", wrong),
                    format!("{whole:.0} %"),
                ]
            });
            text += &table(&["bits", "point", "angle", "wrong", "t below 3"], rows);
        }
        text += "![Pixels in which a reflection shows the wrong thing](studies/planes.svg)\n\n";
        for verdict in self.verdicts() {
            text += &format!("- {verdict}\n");
        }
        text += &format!(
            "\n## The outline, literal and corrected\n\n\
             The text's outline shades a pixel at the first sphere of the list that its ray meets, and disables it for the rest of the \
             generation; `min-t` never sees a second sphere. Corrected, shading waits for the last sphere. {} of {} pixels \
             with a sphere in them differ.\n\n\
             | literal | corrected |\n| --- | --- |\n\
             | ![literal](studies/planes-literal.png) | ![corrected](studies/planes-nearest.png) |\n",
            self.otherwise, self.covered
        );
        text
    }
}
