//! The picture, as it comes from the chip.

use core_rt::format::Format;
use firmware_rt::frame::{Begin, CRC_32, Head, MAGIC, MOST_BYTES, Report, TileHead};
use zerocopy::FromBytes;

use super::EmulateError;
use crate::picture::Picture;
use crate::pixels::rgb888;

/// Puts a picture together.
#[derive(Debug, Default)]
pub struct Frames {
    bytes: Vec<u8>,
    canvas: Option<Canvas>,
    report: Option<Report>,
}

/// A picture, and which pixels it has.
#[derive(Debug)]
struct Canvas {
    picture: Picture,
    format: Format,
    seen: Vec<bool>,
}

impl Frames {
    /// Takes what has come, in pieces of any size; how many pixels were in it.
    ///
    /// # Errors
    /// Where it is not what a chip sends.
    pub fn take(&mut self, bytes: &[u8]) -> Result<u64, EmulateError> {
        self.bytes.extend_from_slice(bytes);
        let mut pixels = 0;
        let mut start = 0;
        let waiting = std::mem::take(&mut self.bytes);
        while let Some(frame) = Frame::first(&waiting[start..])? {
            pixels += self.take_frame(frame.kind, frame.body)?;
            start += frame.length;
        }
        self.bytes.extend_from_slice(&waiting[start..]);
        Ok(pixels)
    }

    /// The picture and the report, if all of both have come.
    ///
    /// # Errors
    /// Where something is missing.
    pub fn finish(self) -> Result<(Picture, Report), EmulateError> {
        let canvas = self.canvas.filter(|canvas| canvas.seen.iter().all(|&seen| seen));
        match (canvas, self.report, self.bytes.is_empty()) {
            (Some(canvas), Some(report), true) => Ok((canvas.picture, report)),
            _ => Err(EmulateError::Damaged("the picture is not whole")),
        }
    }

    fn take_frame(&mut self, kind: u16, body: &[u8]) -> Result<u64, EmulateError> {
        const WRONG: EmulateError = EmulateError::Damaged("a frame that does not belong there");
        match (kind, &mut self.canvas, self.report) {
            (Begin::KIND, canvas @ None, None) => {
                let Begin { width, height, format } = Begin::read_from_bytes(body).map_err(|_| WRONG)?;
                let format = Format::from_number(format).ok_or(WRONG)?;
                let picture = Picture::new(width.into(), height.into());
                *canvas = Some(Canvas { seen: vec![false; picture.pixels().len()], format, picture });
                Ok(0)
            }
            (TileHead::KIND, Some(canvas), None) => {
                let (tile, pixels) = TileHead::read_from_prefix(body).map_err(|_| WRONG)?;
                canvas.put(tile, pixels).ok_or(WRONG)
            }
            (Report::KIND, Some(_), report @ None) => {
                debug_assert!(report.is_none());
                self.report = Some(Report::read_from_bytes(body).map_err(|_| WRONG)?);
                Ok(0)
            }
            _ => Err(WRONG),
        }
    }
}

impl Canvas {
    /// Puts a tile in its place; how many pixels it has. `None` where it does not fit, or lies on another.
    fn put(&mut self, tile: TileHead, pixels: &[u8]) -> Option<u64> {
        let [x, y, width, height] = [tile.x, tile.y, tile.width, tile.height].map(usize::from);
        let across = self.picture.width() as usize;
        if width == 0 || x + width > across || pixels.len() != width * height * self.format.bytes() {
            return None;
        }
        let pixels = rgb888(self.format, pixels);
        for (row, source) in pixels.chunks_exact(width).enumerate() {
            let place = (y + row) * across + x..(y + row) * across + x + width;
            self.picture.pixels_mut().get_mut(place.clone())?.copy_from_slice(source);
            let seen = self.seen.get_mut(place)?;
            if seen.contains(&true) {
                return None;
            }
            seen.fill(true);
        }
        Some(pixels.len() as u64)
    }
}

/// A frame that has come whole.
struct Frame<'a> {
    kind: u16,
    body: &'a [u8],
    /// With head and checksum.
    length: usize,
}

impl<'a> Frame<'a> {
    /// The first one; `None` where not all of it has come.
    fn first(bytes: &'a [u8]) -> Result<Option<Self>, EmulateError> {
        let Ok((head, rest)) = Head::read_from_prefix(bytes) else { return Ok(None) };
        if head.magic != MAGIC || head.length > MOST_BYTES {
            return Err(EmulateError::Damaged("no frame where one should begin"));
        }
        let length = head.length as usize;
        let (Some(body), Some(sum)) = (rest.get(..length), rest.get(length..length + 4)) else { return Ok(None) };
        let end = size_of::<Head>() + length;
        if CRC_32.checksum(&bytes[..end]).to_le_bytes() != sum {
            return Err(EmulateError::Damaged("the checksum of a frame is wrong"));
        }
        Ok(Some(Self { kind: head.kind, body, length: end + 4 }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zerocopy::IntoBytes;

    fn sent(kind: u16, parts: &[&[u8]]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let done: Result<(), ()> = firmware_rt::frame::write(kind, parts, |part| {
            bytes.extend_from_slice(part);
            Ok(())
        });
        done.unwrap();
        bytes
    }

    fn tile(x: u16, y: u16, width: u16, height: u16) -> Vec<u8> {
        let pixels: Vec<u8> = (0..3 * width * height).map(|i| i as u8).collect();
        sent(TileHead::KIND, &[TileHead { x, y, width, height }.as_bytes(), &pixels])
    }

    fn begin() -> Vec<u8> {
        sent(Begin::KIND, &[Begin { width: 3, height: 2, format: 0 }.as_bytes()])
    }

    fn report() -> Vec<u8> {
        sent(Report::KIND, &[Report { stack_bytes: 7, ..Report::default() }.as_bytes()])
    }

    fn message(bytes: &[u8]) -> String {
        let mut frames = Frames::default();
        let result = frames.take(bytes).and_then(|_| frames.finish());
        result.map_or_else(|error| error.to_string(), |_| "none".into())
    }

    #[test]
    fn a_picture_comes_in_pieces_of_any_size() {
        let whole = [begin(), tile(0, 0, 2, 2), tile(2, 0, 1, 2), report()].concat();
        for size in 1..whole.len() {
            let mut frames = Frames::default();
            let pixels: u64 = whole.chunks(size).map(|piece| frames.take(piece).unwrap()).sum();
            let (picture, report) = frames.finish().unwrap();
            assert_eq!((pixels, report.stack_bytes, picture.width()), (6, 7, 3));
            assert_eq!(picture.pixels()[3..5], [[6, 7, 8], [9, 10, 11]]);
        }
    }

    #[test]
    fn every_flipped_bit_is_seen() {
        let whole = [begin(), tile(0, 0, 2, 2), tile(2, 0, 1, 2), report()].concat();
        assert_eq!(message(&whole), "none");
        for bit in 0..8 * whole.len() {
            let mut other = whole.clone();
            other[bit / 8] ^= 1 << (bit % 8);
            assert_ne!(message(&other), "none", "bit {bit}");
        }
    }

    #[test]
    fn what_does_not_belong_is_refused() {
        let tiles = [tile(0, 0, 2, 2), tile(2, 0, 1, 2)].concat();
        let unknown = Begin { width: 3, height: 2, format: Format::ALL.len() as u16 };
        let gray = Begin { format: Format::Gray8.number(), ..unknown };
        let wrong = [
            vec![sent(Begin::KIND, &[unknown.as_bytes()]), tiles.clone(), report()],
            vec![sent(Begin::KIND, &[gray.as_bytes()]), tiles.clone(), report()],
            vec![begin(), tile(0, 0, 2, 2), report()],
            vec![begin(), tiles.clone()],
            vec![tiles.clone(), report()],
            vec![begin(), begin(), tiles.clone(), report()],
            vec![begin(), tiles.clone(), tile(0, 0, 1, 1), report()],
            vec![begin(), tile(2, 1, 2, 1), report()],
            vec![begin(), tile(0, 1, 1, 2), report()],
            vec![begin(), tiles.clone(), report(), vec![0]],
            vec![begin(), tiles, report(), report()],
        ];
        for frames in wrong {
            assert_ne!(message(&frames.concat()), "none", "{frames:?}");
        }
    }
}
