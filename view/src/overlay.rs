//! What is written over the picture.

use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::FONT_6X13;
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics::prelude::{Drawable, Point, Size};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::text::{Baseline, Text};

use crate::frame::Frame;

/// Pixels from the window's edge to the text, and around it.
const GAP: u32 = 4;

/// Writes lines to the upper left corner. What does not fit is cut off; what is not ASCII is shown as `?`.
pub fn write(frame: &mut Frame<'_>, lines: &[String]) {
    let cell = FONT_6X13.character_size;
    let longest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(0) as u32;
    if longest == 0 {
        return;
    }
    let size = Size::new(longest * cell.width + 2 * GAP, lines.len() as u32 * cell.height + 2 * GAP);
    let corner = Point::new(GAP as i32, GAP as i32);
    frame.darken(Rectangle::new(corner, size));
    let style = MonoTextStyle::new(&FONT_6X13, Rgb888::WHITE);
    for (number, line) in (0..).zip(lines) {
        let place = corner + Size::new(GAP, GAP + number * cell.height);
        // Nothing that can fail: the frame takes every pixel.
        let Ok(_) = Text::with_baseline(line, place, style, Baseline::Top).draw(frame);
    }
}

/// What the keys do, for those who ask.
pub const HELP: [&str; 9] = [
    "W A S D, Q E      go; down and up",
    "arrows, or drag   look around",
    "wheel, + -        narrow or widen the view",
    "shift, ctrl       faster, slower",
    "1 to 9            kernel",
    "C, B              as a chip's panel; next board",
    "P                 save the picture",
    "O                 write the camera to the scene",
    "R, H, Esc         back to the scene's camera; this text; end",
];

#[cfg(test)]
mod tests {
    use super::*;

    /// The window's pixels as text: `#` for white, `.` for darkened, blank for what is left as it was.
    fn written(size: [u32; 2], lines: &[&str]) -> String {
        const BEFORE: u32 = 0x40_40_40;
        let mut pixels = vec![BEFORE; (size[0] * size[1]) as usize];
        let lines: Vec<String> = lines.iter().map(|&line| line.to_owned()).collect();
        write(&mut Frame::new(&mut pixels, size).unwrap(), &lines);
        let sign = |pixel: &u32| match *pixel {
            BEFORE => ' ',
            0xff_ff_ff => '#',
            _ => '.',
        };
        let rows = pixels.chunks(size[0].max(1) as usize).map(|row| row.iter().map(sign).collect::<String>());
        rows.collect::<Vec<_>>().join("\n")
    }

    #[test]
    fn a_letter_is_where_it_should_be() {
        let expected = [
            "                    ",
            "                    ",
            "                    ",
            "                    ",
            "    ..............  ",
            "    ..............  ",
            "    ..............  ",
            "    ..............  ",
            "    ..............  ",
            "    ..............  ",
            "    ....#.........  ",
            "    ....#.........  ",
        ];
        let found = written([20, 12], &["L"]);
        assert_eq!(found, expected.join("\n"), "\n{found}");
    }

    #[test]
    fn windows_of_any_size_can_be_written_on() {
        for size in [[0, 0], [1, 1], [3, 9], [40, 0], [0, 40], [5, 500]] {
            let found = written(size, &["a long line, much longer than the window", "", "and \u{e9} more"]);
            assert_eq!(found.chars().filter(|&sign| sign != '\n').count(), (size[0] * size[1]) as usize);
        }
        assert_eq!(written([30, 9], &[]).trim(), "");
    }

    #[test]
    fn the_help_is_in_the_fonts_letters() {
        assert!(HELP.iter().all(|line| line.is_ascii() && line.len() < 80));
    }
}
