//! Line plots as SVG.

use plotters::prelude::*;

/// Counts over marks that stand at equal distances. The vertical axis is logarithmic; counts below 1 are drawn at 1.
pub(crate) struct Plot<'a> {
    /// What stands above it.
    pub(crate) title: &'a str,
    /// What stands along the horizontal axis, and at which values there are marks.
    pub(crate) x: (&'a str, &'a [f64]),
    /// Lines by name: a value for each mark.
    pub(crate) lines: &'a [(String, Vec<f64>)],
}

const SIZE: (u32, u32) = (760, 420);

/// Told apart by those who see few colours (Okabe & Ito, "Color Universal Design", 2008).
pub(crate) const COLOURS: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
    RGBColor(0, 0, 0),
    RGBColor(150, 150, 60),
];

impl Plot<'_> {
    /// The file's text. The same on every machine.
    pub(crate) fn svg(&self) -> String {
        let mut text = String::new();
        self.draw(SVGBackend::with_string(&mut text, SIZE)).expect("a string takes whatever is drawn");
        text
    }

    fn draw<B: DrawingBackend>(&self, backend: B) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
        let root = backend.into_drawing_area();
        root.fill(&WHITE)?;
        let marks = self.x.1;
        let last = marks.len() - 1;
        let room = last as f64 / 40.0;
        let most = self.lines.iter().flat_map(|(_, values)| values).fold(10.0, |a: f64, &b| a.max(b));
        let mut chart = ChartBuilder::on(&root)
            .caption(self.title, ("sans-serif", 17))
            .margin(10)
            .margin_right(170)
            .x_label_area_size(42)
            .y_label_area_size(60)
            .build_cartesian_2d(-room..last as f64 + room, (1.0..most * 1.5).log_scale())?;
        // Labels stand at whole numbers, and between them.
        let label = |x: &f64| marks.get(*x as usize).filter(|_| x.fract() == 0.0).map_or(String::new(), f64::to_string);
        chart
            .configure_mesh()
            .x_desc(self.x.0)
            .x_labels(2 * last + 1)
            .disable_x_mesh()
            .x_label_formatter(&label)
            .y_label_formatter(&|y| if *y > 1.0 { y.to_string() } else { "0, 1".into() })
            .light_line_style(WHITE)
            .bold_line_style(RGBColor(220, 220, 220))
            .label_style(("sans-serif", 13))
            .draw()?;
        for (number, (name, values)) in self.lines.iter().enumerate() {
            let colour = COLOURS[number % COLOURS.len()];
            let points = || values.iter().enumerate().map(|(index, y)| (index as f64, y.max(1.0)));
            // Beyond the colours, lines are thin.
            let style = colour.stroke_width(if number < COLOURS.len() { 2 } else { 1 });
            chart.draw_series(LineSeries::new(points(), style))?;
            chart.draw_series(points().map(|point| Circle::new(point, 3, colour.filled())))?;
            let (x, y) = (SIZE.0 as i32 - 160, 45 + 18 * number as i32);
            root.draw(&PathElement::new([(x, y), (x + 20, y)], style))?;
            root.draw(&Text::new(name.clone(), (x + 26, y - 7), ("sans-serif", 13)))?;
        }
        root.present()
    }
}
