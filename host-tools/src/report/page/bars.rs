//! Shares of a whole as stacked bars.

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, VPos};

use super::PageError;
use super::canvas::{self, GRID, INK, LINE, PAPER};

/// A bar.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Bar {
    /// What stands before it.
    pub(super) name: String,
    /// Its parts, in the order of the colours.
    pub(super) parts: Vec<u64>,
    /// What stands behind it.
    pub(super) total: String,
}

/// Pixels from one bar to the next.
const STEP: i32 = LINE + 11;

/// Draws bars of equal length, split as their parts are; an empty one where all parts are 0.
///
/// # Errors
/// [`PageError::Plot`] where `plotters` cannot draw.
pub(super) fn plot(label: &str, bars: &[Bar]) -> Result<String, PageError> {
    const WIDTH: i32 = 520;
    let widest = |text: fn(&Bar) -> &String| bars.iter().map(|bar| canvas::width(text(bar))).max().unwrap_or(0);
    let (from, to) = (widest(|bar| &bar.name) + 8, WIDTH - widest(|bar| &bar.total) - 8);
    let height = STEP * bars.len() as i32 + 6;
    canvas::svg((WIDTH as u32, height as u32), label, |root| {
        for (index, bar) in bars.iter().enumerate() {
            let top = STEP * index as i32 + 4;
            let (bottom, middle) = (top + LINE + 3, top + (LINE + 3) / 2);
            let style = |side| canvas::text(INK, side, VPos::Center);
            root.draw(&Text::new(bar.name.clone(), (from - 8, middle), style(HPos::Right)))?;
            root.draw(&Text::new(bar.total.clone(), (to + 8, middle), style(HPos::Left)))?;
            root.draw(&Rectangle::new([(from, top), (to, bottom)], GRID.stroke_width(1)))?;
            let whole: u64 = bar.parts.iter().sum();
            // Without any part, nothing is divided by.
            let place = |sum: u64| from + (i128::from(sum) * i128::from(to - from) / i128::from(whole.max(1))) as i32;
            let mut sum = 0;
            for (part, &pixels) in bar.parts.iter().enumerate() {
                let (left, right) = (place(sum), place(sum + pixels));
                sum += pixels;
                if right > left {
                    root.draw(&Rectangle::new([(left, top), (right, bottom)], canvas::colour(part).filled()))?;
                    root.draw(&PathElement::new([(right, top), (right, bottom)], PAPER.stroke_width(1)))?;
                }
            }
        }
        Ok(())
    })
}
