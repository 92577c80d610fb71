//! What a camera ray takes as a mesh is divided ever finer: from about a hundred triangles to a million.
//!
//! On chips in exact instructions, as far as a mesh fits; on the host in box and triangle tests, which are exact too, and in
//! time as a ratio to that of the coarsest mesh, the meshes taking turns.

use std::time::Instant;

use core_rt::exact::{Exact14, Exact29};
use core_rt::kernel::Kernel;
use core_rt::profile::Full;
use core_rt::scene::Scene;
use core_rt::stats::{Counts, NoStats};
use firmware_rt::board::Board;
use firmware_rt::hits::Way;
use host_tools::emulate::counter::Counter;
use host_tools::model::{Model, RenderSettings};
use host_tools::prepare::{Blob, Options, prepare};
use plotters::prelude::*;
use tests::chips::Job;
use tests::growth::{Line, SIDES, find, mesh};

use crate::table::{table, thousands};

/// Pixels on a chip, and on the host.
const SIZES: [[u32; 2]; 2] = [[64, 48], [320, 240]];

/// All of them.
pub(crate) struct Growth {
    lines: Vec<Line>,
}

pub(crate) fn measure(boards: &[(&'static Board, Counter)], quick: bool) -> Growth {
    let sides = if quick { &SIDES[..8] } else { &SIDES };
    let models: Vec<Model> = sides.iter().map(|&side| mesh(side)).collect();
    let mut lines = Vec::new();
    for (board, counter) in boards {
        for (way, how) in [(Way::Single, "one by one"), (Way::Tile, "by tiles")] {
            let cost = |model: &Model| {
                let [width, height] = SIZES[0];
                let model = Model { render: RenderSettings { size: SIZES[0], ..model.render }, ..model.clone() };
                let job = Job::new(board, &model, "exact14", Some(way));
                let fits = job.bytes() as u64 <= u64::from(board.blob(Exact14::ID).length);
                fits.then(|| job.counts(counter).instructions as f64 / f64::from(width * height))
            };
            // Finer meshes than this are lost on the grid of 14 bits.
            let kept = models.iter().filter(|model| model.triangles.len() <= 20_000);
            let points = kept.map_while(|model| Some((model.triangles.len(), cost(model)?))).collect();
            lines.push(Line { name: format!("{}, exact14, {how}", board.name), points });
        }
    }
    lines.extend(host(&models, if quick { 3 } else { 9 }));
    Growth { lines }
}

/// The host's lines, by `exact29`.
fn host(models: &[Model], rounds: usize) -> [Line; 2] {
    let blob = |model: &Model| {
        let model = Model { render: RenderSettings { size: SIZES[1], ..model.render }, ..model.clone() };
        prepare::<Exact29>(&model, &Options::default()).expect("it fits").blob
    };
    let blobs: Vec<Blob> = models.iter().map(blob).collect();
    let rays = SIZES[1].map(f64::from).iter().product::<f64>();
    // What is checked is not timed.
    let checked = |blob| Scene::<Full<Exact29>>::new_checked(Blob::bytes(blob)).expect("a blob just made");
    let scenes: Vec<_> = blobs.iter().map(checked).collect();
    let tests = scenes.iter().map(|scene| {
        let mut counts = Counts::default();
        find(scene, &mut counts);
        (counts.box_tests + counts.triangle_tests) as f64 / rays
    });
    let tests: Vec<f64> = tests.collect();
    let mut ratios = vec![Vec::new(); blobs.len()];
    for _ in 0..rounds {
        let seconds: Vec<f64> = scenes
            .iter()
            .map(|scene| {
                let begin = Instant::now();
                find(scene, &mut NoStats);
                begin.elapsed().as_secs_f64()
            })
            .collect();
        for (ratios, time) in ratios.iter_mut().zip(&seconds) {
            ratios.push(time / seconds[0]);
        }
    }
    let times = ratios.iter_mut().map(|ratios| {
        ratios.sort_by(f64::total_cmp);
        ratios[ratios.len() / 2]
    });
    let line = |name: &str, costs: Vec<f64>| Line {
        name: name.into(),
        points: models.iter().map(|model| model.triangles.len()).zip(costs).collect(),
    };
    [line("host, exact29, tests", tests), line("host, exact29, time", times.collect())]
}

impl Growth {
    pub(crate) fn text(&self) -> String {
        let mut text = String::from(
            "## Growth with the number of triangles\n\nA ball of bumps, divided ever finer: what the nearest hit of a camera ray \
             takes, in multiples of what it takes at 968 triangles. A cost that grows as the logarithm is a straight line.\n\n\
             ![growth](speed/growth.svg)\n\n",
        );
        let mut head = vec!["triangles".to_owned()];
        head.extend(self.lines.iter().map(|line| line.name.clone()));
        let mut sizes: Vec<usize> = self.lines.iter().flat_map(|line| line.points.iter().map(|&(n, _)| n)).collect();
        sizes.sort_unstable();
        sizes.dedup();
        let cell = |line: &Line, size: usize| match line.points.iter().find(|&&(triangles, _)| triangles == size) {
            None => String::new(),
            Some(&(_, cost)) if cost >= 100.0 => thousands(cost as u64),
            Some(&(_, cost)) => format!("{cost:.2}"),
        };
        text += &table(
            &head,
            sizes.into_iter().map(|size| {
                let mut row = vec![thousands(size as u64)];
                row.extend(self.lines.iter().map(|line| cell(line, size)));
                row
            }),
        );
        text += "Instructions, tests, and time over that at 128 triangles. What each doubling adds, of the cost at 968 triangles, in \
                 the coarser and in the finer half:\n\n";
        let rows = self.lines.iter().map(|line| {
            let [coarse, fine] = line.steps();
            vec![
                line.name.clone(),
                format!("{coarse:.3}"),
                format!("{fine:.3}"),
                if line.is_logarithmic() { "no" } else { "yes" }.into(),
            ]
        });
        text += &table(&["", "coarser half", "finer half", "grows faster than the logarithm"].map(String::from), rows);
        text
    }

    pub(crate) fn plot(&self) -> String {
        let mut text = String::new();
        self.draw(SVGBackend::with_string(&mut text, (760, 420))).expect("a string takes whatever is drawn");
        text
    }

    fn draw<B: DrawingBackend>(&self, backend: B) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        // Told apart by those who see few colours (Okabe & Ito, "Color Universal Design", 2008).
        let colours = [(0, 114, 178), (86, 180, 233), (213, 94, 0), (230, 159, 0), (0, 158, 115), (204, 121, 167)];
        let root = backend.into_drawing_area();
        root.fill(&WHITE)?;
        let relative: Vec<_> = self.lines.iter().map(Line::relative).collect();
        let most = relative.iter().flatten().fold(1.0, |most: f64, &(_, cost)| most.max(cost));
        let mut chart = ChartBuilder::on(&root)
            .margin(10)
            .x_label_area_size(42)
            .y_label_area_size(60)
            .build_cartesian_2d((100.0..1_200_000.0).log_scale(), 0.0..most * 1.05)?;
        chart
            .configure_mesh()
            .x_desc("triangles")
            .y_desc("cost of a ray over that at 968 triangles")
            .x_label_formatter(&|x| thousands((*x + 0.5) as u64))
            .light_line_style(WHITE)
            .bold_line_style(RGBColor(220, 220, 220))
            .label_style(("sans-serif", 13))
            .draw()?;
        for ((line, points), (r, g, b)) in self.lines.iter().zip(relative).zip(colours.into_iter().cycle()) {
            let colour = RGBColor(r, g, b);
            let points = points.into_iter().map(|(triangles, cost)| (triangles as f64, cost));
            chart.draw_series(points.clone().map(|point| Circle::new(point, 3, colour.filled())))?;
            chart
                .draw_series(LineSeries::new(points, colour.stroke_width(2)))?
                .label(line.name.clone())
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 20, y)], colour.stroke_width(2)));
        }
        chart
            .configure_series_labels()
            .position(SeriesLabelPosition::UpperLeft)
            .background_style(WHITE.mix(0.8))
            .label_font(("sans-serif", 13))
            .draw()?;
        root.present()
    }
}
