//! The window's pixels.

use std::convert::Infallible;

use embedded_graphics::draw_target::DrawTarget;
use embedded_graphics::geometry::{OriginDimensions, Size};
use embedded_graphics::pixelcolor::{Rgb888, RgbColor};
use embedded_graphics::primitives::Rectangle;
use embedded_graphics::{Pixel, prelude::PointsIter};
use host_tools::picture::Picture;

/// What is around a picture that is smaller than the window.
const AROUND: u32 = 0x20_20_20;

/// Pixels of `0x00RRGGBB`, row by row.
#[derive(Debug)]
pub struct Frame<'a> {
    pixels: &'a mut [u32],
    size: [u32; 2],
}

impl<'a> Frame<'a> {
    /// A window's pixels, as many as the size says; `None` where they are fewer.
    pub fn new(pixels: &'a mut [u32], size: [u32; 2]) -> Option<Self> {
        let count = size[0] as usize * size[1] as usize;
        Some(Self { pixels: pixels.get_mut(..count)?, size })
    }

    /// Puts a picture in the middle, each of its pixels `scale` pixels wide and high; what does not fit is cut off.
    pub fn show(&mut self, picture: &Picture, scale: u32) {
        let scale = scale.max(1);
        let sides = [picture.width(), picture.height()];
        // In pixels of the window: where the picture begins, negative where it is cut off.
        let start = [0, 1].map(|axis| (i64::from(self.size[axis]) - i64::from(sides[axis]) * i64::from(scale)) / 2);
        let place = |axis: usize, at: usize| {
            let within = at as i64 - start[axis];
            let source = within.div_euclid(i64::from(scale));
            (0..i64::from(sides[axis])).contains(&source).then_some(source as usize)
        };
        let width = self.size[0] as usize;
        if width == 0 {
            return;
        }
        let columns: Vec<Option<usize>> = (0..width).map(|x| place(0, x)).collect();
        for (y, row) in self.pixels.chunks_exact_mut(width).enumerate() {
            let source =
                place(1, y).and_then(|y| picture.pixels().get(y * sides[0] as usize..(y + 1) * sides[0] as usize));
            let Some(source) = source else {
                row.fill(AROUND);
                continue;
            };
            for (pixel, column) in row.iter_mut().zip(&columns) {
                *pixel = column.map_or(AROUND, |column| packed(source[column]));
            }
        }
    }

    /// Darkens a rectangle, for what is written on it.
    pub fn darken(&mut self, area: Rectangle) {
        for point in area.points() {
            if let Some(pixel) = self.pixel(point.x, point.y) {
                // A quarter of each channel.
                *pixel = *pixel >> 2 & 0x3f_3f_3f;
            }
        }
    }

    fn pixel(&mut self, x: i32, y: i32) -> Option<&mut u32> {
        let (x, y) = (u32::try_from(x).ok()?, u32::try_from(y).ok()?);
        let is_inside = x < self.size[0] && y < self.size[1];
        is_inside.then(|| &mut self.pixels[y as usize * self.size[0] as usize + x as usize])
    }
}

fn packed([red, green, blue]: [u8; 3]) -> u32 {
    u32::from_be_bytes([0, red, green, blue])
}

impl OriginDimensions for Frame<'_> {
    fn size(&self) -> Size {
        Size::new(self.size[0], self.size[1])
    }
}

impl DrawTarget for Frame<'_> {
    type Color = Rgb888;
    type Error = Infallible;

    fn draw_iter<I: IntoIterator<Item = Pixel<Rgb888>>>(&mut self, pixels: I) -> Result<(), Infallible> {
        for Pixel(point, colour) in pixels {
            if let Some(pixel) = self.pixel(point.x, point.y) {
                *pixel = packed([colour.r(), colour.g(), colour.b()]);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use embedded_graphics::prelude::Point;

    fn shown(size: [u32; 2], picture: &Picture, scale: u32) -> Vec<u32> {
        let mut pixels = vec![0; (size[0] * size[1]) as usize];
        Frame::new(&mut pixels, size).unwrap().show(picture, scale);
        pixels
    }

    #[test]
    fn a_picture_lies_in_the_middle() {
        let picture = Picture::from_fn(2, 1, |x, _| [x as u8 + 1, 2, 3]);
        assert_eq!(shown([2, 1], &picture, 1), [0x01_0203, 0x02_0203]);
        let wide = shown([6, 4], &picture, 2);
        let row = [AROUND, 0x01_0203, 0x01_0203, 0x02_0203, 0x02_0203, AROUND];
        assert_eq!(wide, [[AROUND; 6], row, row, [AROUND; 6]].concat());
    }

    #[test]
    fn what_does_not_fit_is_cut_off() {
        let picture = Picture::from_fn(5, 5, |x, y| [x as u8, y as u8, 0]);
        assert_eq!(shown([1, 1], &picture, 1), [0x02_0200]);
        assert!(shown([0, 3], &picture, 1).is_empty());
        assert!(shown([3, 0], &picture, 0).is_empty());
        let mut few = [0; 3];
        assert!(Frame::new(&mut few, [2, 2]).is_none());
    }

    #[test]
    fn darkening_stays_inside() {
        let mut pixels = [0xff_80_04; 4];
        let mut frame = Frame::new(&mut pixels, [2, 2]).unwrap();
        frame.darken(Rectangle::new(Point::new(-5, 1), Size::new(6, 9)));
        assert_eq!(pixels, [0xff_80_04, 0xff_80_04, 0x3f_20_01, 0xff_80_04]);
    }
}
