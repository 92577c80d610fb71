//! Drawings as inline SVG, in colours that follow the page's light or dark.
//!
//! `plotters` writes colours as attributes. Those here are stand-ins, a number each, which the style sheet replaces by the
//! page's own; so one drawing serves both.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::PageError;

/// Where things are drawn.
pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// What drawing gives.
pub(super) type Drawn<T = ()> = Result<T, DrawingAreaErrorKind<std::io::Error>>;

/// Text and axes.
pub(super) const INK: RGBColor = RGBColor(1, 1, 1);
/// What is less than ink: the names of axes, what is dominated.
pub(super) const FAINT: RGBColor = RGBColor(2, 2, 2);
/// Lines of a grid.
pub(super) const GRID: RGBColor = RGBColor(3, 3, 3);
/// The page behind.
pub(super) const PAPER: RGBColor = RGBColor(4, 4, 4);

/// How many colours there are for lines and bars.
pub(super) const COLOURS: usize = 8;

/// The colour of a line or a bar; they recur.
pub(super) fn colour(index: usize) -> RGBColor {
    RGBColor(5, 5, 10 + (index % COLOURS) as u8)
}

/// Pixels that a line of text takes from the next.
pub(super) const LINE: i32 = 15;

/// `plotters` takes the height of a line and writes the size of the letters, this much less.
const LETTERS_OF_LINE: f64 = 1.24;

/// Text of 12 pixels, held at a point.
pub(super) fn text(colour: RGBColor, horizontal: HPos, vertical: VPos) -> TextStyle<'static> {
    let font = ("sans-serif", 12.0 * LETTERS_OF_LINE).into_font();
    TextStyle { font, color: colour.to_backend_color(), pos: Pos::new(horizontal, vertical) }
}

/// At least how wide [`text`] is, pixels, in any common font.
pub(super) fn width(text: &str) -> i32 {
    let tenths = |c: char| match c {
        'i' | 'j' | 'l' | '.' | ',' | ' ' | '|' | '\'' => 45,
        'm' | 'w' | 'M' | 'W' | '%' | '@' | '&' => 120,
        'A'..='Z' | '<' | '>' | '=' | '+' => 96,
        _ if c.is_ascii() => 77,
        _ => 130,
    };
    text.chars().map(tenths).sum::<i32>() / 10 + 2
}

/// An SVG element of `size` pixels, as wide as its place allows, which says in `label` what it shows.
///
/// # Errors
/// [`PageError::Plot`] where `plotters` cannot draw.
pub(super) fn svg(
    (width, height): (u32, u32),
    label: &str,
    draw: impl FnOnce(&Area<'_>) -> Drawn,
) -> Result<String, PageError> {
    let mut body = String::new();
    {
        let root = SVGBackend::with_string(&mut body, (width, height)).into_drawing_area();
        draw(&root).and_then(|()| root.present()).map_err(|error| PageError::Plot(error.to_string()))?;
    }
    // In HTML, an SVG needs no namespace; and a page without any address is easily seen to load nothing.
    let inner = body.split_once('>').map_or("", |(_, inner)| inner).replace('\n', "");
    let label = maud::html! { (label) }.into_string().replace('"', "&quot;");
    Ok(format!(r#"<svg viewBox="0 0 {width} {height}" width="{width}" role="img" aria-label="{label}">{inner}"#))
}
