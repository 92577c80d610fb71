//! A value over another, a named line each.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::PageError;
use super::axis::Axis;
use super::canvas::{self, Drawn, FAINT, INK, LINE};
use super::labels::stack;
use super::scatter::{Plot, SIZE, frame};

/// A line of the plot.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Line {
    /// Its name.
    pub(super) name: String,
    /// Its [`canvas::colour`].
    pub(super) colour: usize,
    /// Its points, by x. A point without a value leaves a gap.
    pub(super) points: Vec<(f64, Option<f64>)>,
}

/// A plot of lines.
#[derive(Clone, Debug)]
pub(super) struct Lines<'a> {
    /// What it shows, for those who do not see it.
    pub(super) label: &'a str,
    /// What stands along its axes: x, value.
    pub(super) axes: (&'a str, &'a str),
    /// The names of x = 0, 1, 2, …; where there are none, x is a number.
    pub(super) categories: Option<&'a [String]>,
    /// Whether values are better where they are more; those of PSNR.
    pub(super) more_is_better: bool,
    /// The lines.
    pub(super) lines: &'a [Line],
}

impl Lines<'_> {
    /// The drawing.
    ///
    /// # Errors
    /// [`PageError::Plot`] where `plotters` cannot draw.
    pub(super) fn plot(&self) -> Result<Plot, PageError> {
        let values = || self.lines.iter().flat_map(|line| line.points.iter().filter_map(|point| point.1));
        let x = match self.categories {
            Some(names) => Axis::of_categories(names),
            None => Axis::upwards(self.lines.iter().flat_map(|line| line.points.iter().map(|point| point.0))),
        };
        let y = if self.more_is_better { Axis::downwards(values()) } else { Axis::upwards(values()) };
        let has_place_beyond = y.has_place_beyond();
        // As many names as there are lines need room for as many.
        let height = SIZE.1.max((LINE as u32) * self.lines.len() as u32 + 70);
        let svg = canvas::svg((SIZE.0, height), self.label, |root| self.draw(root, x, y))?;
        Ok(Plot { svg, has_place_beyond, unnamed: Vec::new() })
    }

    fn draw(&self, root: &canvas::Area<'_>, x: Axis, y: Axis) -> Drawn {
        let widest = self.lines.iter().map(|line| canvas::width(&line.name)).max().unwrap_or(0);
        let lines: Vec<Vec<Option<(f64, f64)>>> = self
            .lines
            .iter()
            .map(|line| {
                let at = |&(key, value): &(f64, Option<f64>)| value.map(|value| (x.position(key), y.position(value)));
                line.points.iter().map(at).collect()
            })
            .collect();
        let chart = frame(root, x, y, self.axes, widest + 34)?;
        let plane = chart.plotting_area();
        let (xs, ys) = plane.get_pixel_range();
        let mut ends = Vec::new();
        for (line, points) in self.lines.iter().zip(&lines) {
            let colour = canvas::colour(line.colour);
            for run in points.split(|point| point.is_none()) {
                let run: Vec<(i32, i32)> = run.iter().flatten().map(|at| plane.map_coordinate(at)).collect();
                root.draw(&PathElement::new(run.clone(), colour.stroke_width(2)))?;
                for &point in &run {
                    root.draw(&Circle::new(point, 3, colour.filled()))?;
                }
            }
            let last = points.iter().rev().flatten().next();
            ends.push(last.map(|at| plane.map_coordinate(at)));
        }
        let wanted: Vec<i32> = ends.iter().map(|end| end.map_or(ys.end, |end| end.1)).collect();
        let heights = stack(&wanted, LINE, (ys.start, ys.end));
        for ((line, end), &height) in self.lines.iter().zip(&ends).zip(&heights) {
            let Some(end) = end else { continue };
            let left = xs.end + 20;
            root.draw(&PathElement::new([*end, (xs.end + 4, end.1), (left - 3, height)], FAINT.stroke_width(1)))?;
            let style = canvas::text(INK, HPos::Left, VPos::Center);
            root.draw(&Circle::new((left + 1, height), 3, canvas::colour(line.colour).filled()))?;
            root.draw(&Text::new(line.name.clone(), (left + 8, height), style))?;
        }
        Ok(())
    }
}
