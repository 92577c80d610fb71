//! Rays and hits as CSV: one line each, under a header line.

use std::fmt::{self, Write};
use std::io::{self, BufRead, Read};

use glam::DVec3;

use crate::reference::Hit;

/// The first line of a file of rays.
pub const RAYS_HEADER: &str = "ox,oy,oz,dx,dy,dz";

/// The first line of a file of hits.
pub const HITS_HEADER: &str = "hit,t,prim,u,v";

/// Bytes: many times what six numbers take. A guard against `/dev/zero` and the like.
const LONGEST_LINE: u64 = 1 << 16;

/// Why rays could not be read.
#[derive(Debug, thiserror::Error)]
pub enum RaysError {
    /// No bytes.
    #[error("{file}: the file is empty; rays stand under the line {RAYS_HEADER}")]
    Empty {
        /// The file.
        file: String,
    },
    /// The operating system refused.
    #[error("{file}: cannot be read: {source}")]
    Read {
        /// The file.
        file: String,
        /// Its reason.
        source: io::Error,
    },
    /// Something wrong in one line.
    #[error("{file}:{line}: {message}")]
    Line {
        /// The file.
        file: String,
        /// The line, from 1.
        line: u64,
        /// What was found and what would be right.
        message: String,
    },
}

/// The rays of a CSV file, each its origin and its direction, one by one.
///
/// UTF-8, with a byte order mark or without; lines end in LF or CRLF, the last one need not. There are no quotes, since
/// numbers need none; spaces around a number are no part of it.
#[derive(Debug)]
pub struct Rays<R> {
    input: R,
    file: String,
    /// Lines read so far.
    line: u64,
    text: Vec<u8>,
}

impl<R: BufRead> Rays<R> {
    /// Reads the header. `file` is the name for messages.
    ///
    /// # Errors
    /// An empty file, another first line, I/O errors.
    pub fn new(input: R, file: String) -> Result<Self, RaysError> {
        let mut rays = Self { input, file, line: 0, text: Vec::new() };
        let Some(header) = rays.next_line()? else {
            return Err(RaysError::Empty { file: rays.file });
        };
        let header = header.strip_prefix('\u{feff}').unwrap_or(header);
        if header.split(',').map(str::trim).eq(RAYS_HEADER.split(',')) {
            return Ok(rays);
        }
        let message = format!("`{}` where the header {RAYS_HEADER} should be", excerpt(header));
        Err(rays.error(message))
    }

    /// The next line without its end; `None` at the end of the file.
    fn next_line(&mut self) -> Result<Option<&str>, RaysError> {
        self.text.clear();
        let read = self.input.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut self.text);
        if let Err(source) = read {
            return Err(RaysError::Read { file: self.file.clone(), source });
        }
        if self.text.is_empty() {
            return Ok(None);
        }
        self.line += 1;
        if self.text.len() as u64 == LONGEST_LINE && !self.text.ends_with(b"\n") {
            return Err(self.error(format!("a line longer than {LONGEST_LINE} bytes; six numbers are not")));
        }
        let line = self.text.strip_suffix(b"\n").unwrap_or(&self.text);
        let line = line.strip_suffix(b"\r").unwrap_or(line);
        match str::from_utf8(line) {
            Ok(line) => Ok(Some(line)),
            Err(_) => Err(self.error("this is not UTF-8 text".into())),
        }
    }

    fn error(&self, message: String) -> RaysError {
        RaysError::Line { file: self.file.clone(), line: self.line, message }
    }
}

impl<R: BufRead> Iterator for Rays<R> {
    type Item = Result<[DVec3; 2], RaysError>;

    fn next(&mut self) -> Option<Self::Item> {
        let parsed = match self.next_line() {
            Ok(line) => parse(line?),
            Err(error) => return Some(Err(error)),
        };
        Some(parsed.map_err(|message| self.error(message)))
    }
}

/// A ray.
fn parse(line: &str) -> Result<[DVec3; 2], String> {
    let mut numbers = [0.0; 6];
    let columns = line.split(',').count();
    if columns != numbers.len() {
        return Err(format!(
            "{columns} columns where {} should be ({RAYS_HEADER}): `{}`",
            numbers.len(),
            excerpt(line)
        ));
    }
    for ((number, text), name) in numbers.iter_mut().zip(line.split(',')).zip(RAYS_HEADER.split(',')) {
        let text = text.trim();
        *number = match text.parse::<f64>() {
            Ok(number) if number.is_finite() => number,
            Ok(_) => return Err(format!("{name}: `{}` is not a finite number", excerpt(text))),
            Err(_) => return Err(format!("{name}: `{}` is not a number", excerpt(text))),
        };
    }
    let [ox, oy, oz, dx, dy, dz] = numbers;
    let direction = DVec3::new(dx, dy, dz);
    if direction == DVec3::ZERO {
        return Err("the direction is zero".into());
    }
    Ok([DVec3::new(ox, oy, oz), direction])
}

/// The start of a foreign text, made printable.
fn excerpt(text: &str) -> String {
    const LENGTH: usize = 40;
    let shown: String = text.chars().take(LENGTH).flat_map(char::escape_debug).collect();
    if text.chars().nth(LENGTH).is_some() { shown + "…" } else { shown }
}

/// Appends a line of [`HITS_HEADER`]'s columns. Its numbers read back as the same f64.
///
/// # Errors
/// Where the text takes no more.
pub fn write_hit(text: &mut impl Write, hit: Option<&Hit>) -> fmt::Result {
    match hit {
        Some(Hit { t, prim, u, v }) => writeln!(text, "1,{t},{prim},{u},{v}"),
        None => writeln!(text, "0,,,,"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &[u8]) -> Result<Vec<[f64; 6]>, String> {
        let rays = Rays::new(text, "rays.csv".into()).map_err(|error| error.to_string())?;
        let flat = |[o, d]: [DVec3; 2]| [o.x, o.y, o.z, d.x, d.y, d.z];
        rays.map(|ray| ray.map(flat).map_err(|error| error.to_string())).collect()
    }

    #[test]
    fn lines_may_end_and_begin_as_editors_like() {
        let expected = Ok(vec![[1.0, -2.5, 0.0, 0.0, 1e-320, 4.0], [0.0, 0.0, 0.0, 1e300, 0.5, 5.0]]);
        for text in [
            "ox,oy,oz,dx,dy,dz\n1,-2.5,0,0,1e-320,4\n0,0,-0,1E300,.5,5.\n",
            "ox,oy,oz,dx,dy,dz\n1,-2.5,0,0,1e-320,4\n0,0,0,1e300,.5,5",
            "\u{feff}ox,oy,oz,dx,dy,dz\r\n1,-2.5,0,0,1e-320,4\r\n+0,0,0,1e300,.5,5\r\n",
            "ox, oy, oz, dx, dy, dz\n1, -2.5 ,\t0, 0, 1e-320, 4\n0, 0, 0, 1e300, 0.5, 5\n",
        ] {
            assert_eq!(read(text.as_bytes()), expected, "{text:?}");
        }
        assert_eq!(read(b"ox,oy,oz,dx,dy,dz"), Ok(Vec::new()));
    }

    #[test]
    fn a_line_may_be_long_but_not_endless() {
        let header = format!("{RAYS_HEADER}\n");
        let line = |zeros: usize| format!("{header}{}1,0,0,0,0,1\n", "0".repeat(zeros));
        let most = LONGEST_LINE as usize - "1,0,0,0,0,1\n".len();
        assert_eq!(read(line(most).as_bytes()).map(|rays| rays.len()), Ok(1));
        let refused = Err("rays.csv:2: a line longer than 65536 bytes; six numbers are not".into());
        assert_eq!(read(line(most + 1).as_bytes()), refused);
        assert_eq!(read(line(1 << 20).as_bytes()), refused);
    }

    #[test]
    fn hits_read_back_as_they_were() {
        let third = Hit { t: 1.0 / 3.0, prim: u32::MAX, u: 0.1 + 0.2, v: f64::from_bits(1) };
        let mut text = String::new();
        write_hit(&mut text, Some(&third)).unwrap();
        write_hit(&mut text, None).unwrap();
        let mut lines = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let [hit, t, prim, u, v] = lines.next().unwrap()[..] else { panic!("{text}") };
        assert_eq!((hit, prim), ("1", "4294967295"));
        assert_eq!([t, u, v].map(|c| c.parse::<f64>().unwrap()), [third.t, third.u, third.v]);
        assert_eq!(lines.next().unwrap(), ["0", "", "", "", ""]);
        assert_eq!(HITS_HEADER.split(',').count(), 5);
    }
}
