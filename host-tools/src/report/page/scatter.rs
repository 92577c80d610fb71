//! Error against what it costs: a named point each, and the Pareto front.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::PageError;
use super::axis::Axis;
use super::canvas::{self, Drawn, FAINT, GRID, INK, LINE, PAPER};
use super::labels::{Rect, place};
use super::pareto;

/// A point of the plot.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Mark {
    /// Its name.
    pub(super) name: String,
    /// Its [`canvas::colour`].
    pub(super) colour: usize,
    /// What it costs, and the least and the greatest that was measured.
    pub(super) cost: (f64, Option<[f64; 2]>),
    /// Its error, as the axis has it.
    pub(super) error: f64,
}

/// A plot of error against cost; less of both is better.
#[derive(Clone, Debug)]
pub(super) struct Scatter<'a> {
    /// What it shows, for those who do not see it.
    pub(super) label: &'a str,
    /// What stands along its axes: cost, error.
    pub(super) axes: (&'a str, &'a str),
    /// Whether errors are better where they are more.
    pub(super) more_is_better: bool,
    /// The points.
    pub(super) marks: &'a [Mark],
}

/// A drawing, and whether a value had to be drawn at the place of what its scale cannot show.
#[derive(Clone, Debug)]
pub(super) struct Plot {
    /// The SVG element.
    pub(super) svg: String,
    /// Whether an error is drawn off the scale, at "0" or "equal".
    pub(super) has_place_beyond: bool,
    /// Names that found no place.
    pub(super) unnamed: Vec<String>,
}

/// Width and height of a plot, pixels.
pub(super) const SIZE: (u32, u32) = (520, 360);

impl Scatter<'_> {
    /// The drawing.
    ///
    /// # Errors
    /// [`PageError::Plot`] where `plotters` cannot draw.
    pub(super) fn plot(&self) -> Result<Plot, PageError> {
        let costs =
            || self.marks.iter().flat_map(|mark| [mark.cost.0].into_iter().chain(mark.cost.1.into_iter().flatten()));
        let errors = || self.marks.iter().map(|mark| mark.error);
        let x = Axis::upwards(costs());
        let y = if self.more_is_better { Axis::downwards(errors()) } else { Axis::upwards(errors()) };
        let has_place_beyond = y.has_place_beyond();
        let mut unnamed = Vec::new();
        let svg = canvas::svg(SIZE, self.label, |root| self.draw(root, x, y, &mut unnamed))?;
        Ok(Plot { svg, has_place_beyond, unnamed })
    }

    fn draw(&self, root: &canvas::Area<'_>, x: Axis, y: Axis, unnamed: &mut Vec<String>) -> Drawn {
        let at: Vec<(f64, f64)> =
            self.marks.iter().map(|mark| (x.position(mark.cost.0), y.position(mark.error))).collect();
        let spreads: Vec<_> =
            self.marks.iter().map(|mark| mark.cost.1.map(|spread| spread.map(|cost| x.position(cost)))).collect();
        let badness = |mark: &Mark| if self.more_is_better { -mark.error } else { mark.error };
        let stays = pareto::front(&self.marks.iter().map(|mark| (mark.cost.0, badness(mark))).collect::<Vec<_>>());

        let chart = frame(root, x, y, self.axes, 16)?;
        let plane = chart.plotting_area();
        let pixel = |at: (f64, f64)| plane.map_coordinate(&at);
        let steps = steps(&at, &stays);
        let steps: Vec<(i32, i32)> = steps.into_iter().map(pixel).collect();
        root.draw(&PathElement::new(steps.clone(), FAINT.stroke_width(1)))?;

        // What is on the front lies on what is not.
        let mut order: Vec<usize> = (0..self.marks.len()).collect();
        order.sort_by_key(|&index| stays[index]);
        for index in order {
            let mark = &self.marks[index];
            let point = pixel(at[index]);
            let colour = if stays[index] { canvas::colour(mark.colour) } else { FAINT };
            if let Some([least, most]) = spreads[index] {
                let ends = [least, most].map(|cost| pixel((cost, at[index].1)));
                root.draw(&PathElement::new(ends, colour.stroke_width(1)))?;
            }
            root.draw(&Circle::new(point, 5, PAPER.filled()))?;
            if stays[index] {
                root.draw(&Circle::new(point, 5, colour.filled()))?;
            } else {
                root.draw(&Circle::new(point, 4, colour.stroke_width(2)))?;
            }
        }

        let named: Vec<_> =
            self.marks.iter().zip(&at).map(|(mark, &at)| (pixel(at), canvas::width(&mark.name))).collect();
        let (xs, ys) = plane.get_pixel_range();
        let area = Rect { x: (xs.start + 1, xs.end + 12), y: (ys.start - 6, ys.end - 1) };
        let places = place(&named, area, &along(&steps));
        for ((mark, &(point, _)), (place, stays)) in self.marks.iter().zip(&named).zip(places.iter().zip(&stays)) {
            let Some(place) = place else {
                unnamed.push(mark.name.clone());
                continue;
            };
            let edge = place.nearest(point);
            let far = (edge.0 - point.0).abs().max((edge.1 - point.1).abs()) > 10;
            if far {
                root.draw(&PathElement::new([point, edge], GRID.stroke_width(1)))?;
            }
            let style = canvas::text(if *stays { INK } else { FAINT }, HPos::Center, VPos::Center);
            let middle = ((place.x.0 + place.x.1) / 2, (place.y.0 + place.y.1) / 2);
            root.draw(&Text::new(mark.name.clone(), middle, style))?;
        }
        Ok(())
    }
}

/// The boundary between what the front beats and what beats it.
fn steps(at: &[(f64, f64)], stays: &[bool]) -> Vec<(f64, f64)> {
    let mut front: Vec<(f64, f64)> = at.iter().zip(stays).filter(|(_, stays)| **stays).map(|(at, _)| *at).collect();
    front.sort_by(|a, b| a.0.total_cmp(&b.0).then(b.1.total_cmp(&a.1)));
    let corners = front.windows(2).flat_map(|pair| [pair[0], (pair[1].0, pair[0].1)]);
    corners.chain(front.last().copied()).collect()
}

/// Points along a path, a few pixels apart.
fn along(path: &[(i32, i32)]) -> Vec<(i32, i32)> {
    let between = |pair: &[(i32, i32)]| {
        let (a, b) = (pair[0], pair[1]);
        let count = ((b.0 - a.0).abs() + (b.1 - a.1).abs()) / 4 + 1;
        (0..=count).map(move |i| (a.0 + (b.0 - a.0) * i / count, a.1 + (b.1 - a.1) * i / count)).collect::<Vec<_>>()
    };
    path.windows(2).flat_map(between).collect()
}

/// A chart on a drawing.
pub(super) type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

/// Draws axes with what they are called, leaving `right` pixels beside them.
pub(super) fn frame<'a, 'b>(
    root: &canvas::Area<'b>,
    x: Axis,
    y: Axis,
    (below, beside): (&str, &str),
    right: i32,
) -> Drawn<Chart<'a, 'b>> {
    let mut chart = ChartBuilder::on(root)
        .margin_left(LINE + 4)
        .margin_top(10)
        .margin_right(right)
        .margin_bottom(LINE + 4)
        .x_label_area_size(LINE + 8)
        .y_label_area_size(46)
        .build_cartesian_2d(x, y)?;
    let none = TRANSPARENT.stroke_width(0);
    chart
        .configure_mesh()
        .axis_style(FAINT)
        .bold_line_style(GRID)
        .light_line_style(none)
        .label_style(canvas::text(INK, HPos::Center, VPos::Center))
        .draw()?;
    let (xs, ys) = chart.plotting_area().get_pixel_range();
    let height = root.dim_in_pixel().1 as i32;
    let style = canvas::text(FAINT, HPos::Center, VPos::Bottom);
    root.draw(&Text::new(below.to_owned(), ((xs.start + xs.end) / 2, height - 1), style.clone()))?;
    let upright = style.transform(plotters::style::FontTransform::Rotate270);
    root.draw(&Text::new(beside.to_owned(), (LINE, (ys.start + ys.end) / 2), upright))?;
    Ok(chart)
}
