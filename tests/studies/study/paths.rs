//! Paths: error against the number of samples a pixel, by every kernel, in linear light.

use host_tools::engine::ENGINES;
use plotters::prelude::*;
use tests::convergence::{ALLOWED, Truth, errors, exponent, scene, truth};

use super::plot::COLOURS;
use super::text::{Verdict, table};

/// How much is measured.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Extent {
    /// Of the pictures, pixels.
    pub(crate) size: [u32; 2],
    /// Samples a pixel, more each time.
    pub(crate) counts: Vec<u32>,
    /// Of the reference's picture, an even number.
    pub(crate) truth_samples: u32,
}

impl Extent {
    /// The document's.
    pub(crate) fn whole() -> Self {
        Self { size: [32, 24], counts: vec![1, 4, 16, 64, 256, 1024], truth_samples: 16_384 }
    }
}

/// How many times a kernel's own error another one is where noise decides it: what the two add up to is 3 % more.
const CLEAR: f64 = 4.0;

/// A kernel's errors.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    /// The kernel.
    pub(crate) kernel: &'static str,
    /// Number of samples, and error.
    pub(crate) errors: Vec<(u32, f64)>,
}

impl Row {
    /// The error that no number of samples takes away: squares of errors add up, and the square of the noise is in proportion
    /// to 1 / n.
    pub(crate) fn own(&self) -> f64 {
        let [.., (few, coarse), (many, fine)] = self.errors[..] else { return 0.0 };
        let ratio = f64::from(many) / f64::from(few);
        libm::sqrt(((ratio * fine * fine - coarse * coarse) / (ratio - 1.0)).max(0.0))
    }

    /// The exponent over the numbers of samples at which noise decides the error.
    pub(crate) fn exponent(&self) -> f64 {
        let own = self.own();
        let clear: Vec<(u32, f64)> = self.errors.iter().copied().filter(|(_, error)| *error >= CLEAR * own).collect();
        exponent(if clear.len() < 2 { &self.errors } else { &clear })
    }
}

/// All figures.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Paths {
    /// How much was measured.
    pub(crate) extent: Extent,
    /// A row a kernel.
    pub(crate) rows: Vec<Row>,
    /// Of the reference's picture.
    pub(crate) noise: f64,
}

impl Paths {
    /// Measures, telling of each step.
    pub(crate) fn measure(extent: Extent, say: &dyn Fn(&str)) -> Self {
        let model = scene(extent.size);
        say("the reference");
        let Truth { picture, noise } = truth(&model, extent.truth_samples);
        let row = |engine: &'static dyn host_tools::engine::Engine| {
            say(engine.name());
            Row { kernel: engine.name(), errors: errors(engine, &model, &picture, &extent.counts, |range| vec![range]) }
        };
        Self { rows: ENGINES.into_iter().map(row).collect(), noise, extent }
    }

    pub(crate) fn verdict(&self) -> Verdict {
        let exponents: Vec<f64> = self.rows.iter().map(Row::exponent).collect();
        let [least, most] = [f64::min, f64::max].map(|f| exponents.iter().copied().reduce(f).unwrap_or_default());
        Verdict {
            claim: "the error falls as the inverse square root of the samples, by every kernel",
            holds: exponents.iter().all(|exponent| ALLOWED.contains(exponent)),
            because: format!(
                "exponents from {least:.3} to {most:.3}; {} to {} count as -0.5",
                ALLOWED.start(),
                ALLOWED.end()
            ),
        }
    }

    /// The document.
    pub(crate) fn document(&self) -> String {
        let Extent { size: [width, height], counts, truth_samples } = &self.extent;
        let [.., few, many] = counts[..] else { return String::new() };
        let head = ["kernel".to_owned()].into_iter().chain(counts.iter().map(u32::to_string));
        let head: Vec<String> = head.chain(["exponent".into(), "own error".into()]).collect();
        let rows = self.rows.iter().map(|row| {
            let errors = row.errors.iter().map(|(_, error)| format!("{error:.5}"));
            let name = format!("`{}`", row.kernel);
            [name]
                .into_iter()
                .chain(errors)
                .chain([format!("{:.3}", row.exponent()), format!("{:.5}", row.own())])
                .collect()
        });
        format!(
            "# Paths: error against samples\n\n\
             Written whole by `cargo xtask paths`; edit `tests/studies/study/paths.rs` instead. The meaning of paths and of roughness is in \
             `docs/SHADING.md`; `intray report` has the same of any scene with `paths`, in bytes.\n\n\
             The built-in scene by paths in {width}x{height} pixels, the mirror ball of roughness 0.1 and the metal of 0.4, by \
             every kernel, against the f64 reference, which is written from the text and has random numbers of its own. Errors \
             are root mean squares over all pixels and channels, of light, of which white is 1: the means of samples are unbiased \
             in light, and bytes of sRGB would bend the noise and add their own rounding. Each sample is clamped to 1, in the reference \
             too.\n\n\
             The reference has {truth_samples} samples a pixel. Its own noise is {:.5}, by half the difference of two pictures \
             of half as many; in squares that is {:.0} % of the least error here.\n\n{}\
             **Exponent** is that of the power of the number of samples that is nearest to the errors, by least squares in their \
             logarithms, over those that are at least {CLEAR:.0} times the kernel's own. **Own error** is what is left by {few} and {many} \
             samples where the square of the noise is in proportion to 1 / n: the kernel's bias, with what the reference's noise adds \
             to it, and nothing where that is less than chance.\n\n\
             ![Error against samples](studies/paths.svg)\n\n- {}\n",
            self.noise,
            100.0 * self.share_of_noise(),
            table(&head, rows),
            self.verdict(),
        )
    }

    /// The square of the reference's noise over that of the least error.
    fn share_of_noise(&self) -> f64 {
        let errors = self.rows.iter().flat_map(|row| &row.errors).map(|(_, error)| *error);
        let least = errors.fold(f64::INFINITY, f64::min);
        (self.noise / least) * (self.noise / least)
    }

    /// Errors over samples, both logarithmic, with the slope of -1/2.
    pub(crate) fn plot(&self) -> String {
        let mut text = String::new();
        self.draw(SVGBackend::with_string(&mut text, (760, 420))).expect("a string takes whatever is drawn");
        text
    }

    fn draw<B: DrawingBackend>(&self, backend: B) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        let root = backend.into_drawing_area();
        root.fill(&WHITE)?;
        let first = self.rows.first().and_then(|row| row.errors.first()).map_or(1.0, |(_, error)| *error);
        let mut chart = ChartBuilder::on(&root)
            .caption("Error against samples a pixel", ("sans-serif", 17))
            .margin(10)
            .margin_right(170)
            .x_label_area_size(42)
            .y_label_area_size(60)
            .build_cartesian_2d((0.8f64..1300.0).log_scale(), (first / 64.0..first * 1.6).log_scale())?;
        chart
            .configure_mesh()
            .x_desc("samples a pixel")
            .y_desc("root mean square error, light")
            .x_label_formatter(&|x| format!("{x:.0}"))
            .y_label_formatter(&|y| format!("{y:.3}"))
            .light_line_style(WHITE)
            .bold_line_style(RGBColor(220, 220, 220))
            .label_style(("sans-serif", 13))
            .draw()?;
        let slope = self.extent.counts.iter().map(|&count| (f64::from(count), first / libm::sqrt(f64::from(count))));
        chart.draw_series(DashedLineSeries::new(slope, 5, 4, BLACK.stroke_width(1)))?;
        root.draw(&Text::new("n^-1/2, dashed", (600, 38), ("sans-serif", 13)))?;
        for (number, row) in self.rows.iter().enumerate() {
            let style = COLOURS[number % COLOURS.len()].stroke_width(2);
            let points = row.errors.iter().map(|&(count, error)| (f64::from(count), error));
            chart.draw_series(LineSeries::new(points.clone(), style))?;
            chart.draw_series(points.map(|point| Circle::new(point, 3, style.filled())))?;
            let (x, y) = (600, 65 + 18 * number as i32);
            root.draw(&PathElement::new([(x, y), (x + 20, y)], style))?;
            root.draw(&Text::new(row.kernel, (x + 26, y - 7), ("sans-serif", 13)))?;
        }
        root.present()
    }
}
