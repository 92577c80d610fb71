//! OBJ and MTL are lines of text: this reads the lines, and hands the good ones on.
//!
//! `tobj` has no line numbers, and panics on a colour of one number. So it never sees an MTL file: it reads from a [`Checked`]
//! stream, which passes each statement through our own check on the way and holds back what fails. One pass, no copy of the text.

use std::borrow::Cow;
use std::io::{self, BufRead, Read};

use super::error::{ImportError, excerpt};
use super::source::Source;

/// Bytes: more than any face has, and no more than memory is to be taken for. A guard against `/dev/zero` and the like.
const LONGEST_LINE: u64 = 1 << 24;

/// The statements of a text file, one by one: comments and blank lines left out, lines that end in
/// a backslash joined to the next.
pub(super) struct Lines<'a> {
    /// The file, for messages.
    pub file: String,
    input: Box<dyn BufRead + 'a>,
    text: Vec<u8>,
    /// Lines read so far.
    read: u64,
}

/// A statement: a keyword and what follows it.
pub(super) struct Statement<'a> {
    /// The line on which it starts, from 1.
    pub line: u64,
    text: Cow<'a, str>,
}

impl<'a> Lines<'a> {
    /// Opens a file.
    pub(super) fn open(source: &'a dyn Source, name: &str) -> io::Result<Self> {
        let input = source.open(name)?;
        Ok(Self { file: source.describe(name), input, text: Vec::new(), read: 0 })
    }

    /// Whether the file had no byte, once [`next`](Self::next) has returned `None`.
    pub(super) fn is_empty(&self) -> bool {
        self.read == 0
    }

    /// The next statement, or `None` at the end.
    ///
    /// # Errors
    /// Text that is UTF-16 or binary, and I/O errors. Bytes that are not UTF-8 are no error: names
    /// and comments in an old encoding are common, and numbers are ASCII.
    pub(super) fn next(&mut self) -> Result<Option<Statement<'_>>, ImportError> {
        let line = loop {
            self.text.clear();
            if !self.append()? {
                return Ok(None);
            }
            let line = self.read;
            let text = self.text.trim_ascii_start();
            if text.is_empty() || text.starts_with(b"#") {
                continue;
            }
            while self.text.ends_with(b"\\") {
                self.text.pop();
                self.text.push(b' ');
                if !self.append()? {
                    break;
                }
            }
            break line;
        };
        Ok(Some(Statement { line, text: String::from_utf8_lossy(&self.text) }))
    }

    /// Appends one line of the file, without its end, to the text; false at the end of the file.
    fn append(&mut self) -> Result<bool, ImportError> {
        let start = self.text.len();
        let read = self.input.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut self.text);
        let read = read.map_err(|error| ImportError::unreadable(&self.file, error))?;
        if read == 0 {
            return Ok(false);
        }
        self.read += 1;
        if self.read == 1 {
            if self.text.starts_with(b"\xff\xfe") || self.text.starts_with(b"\xfe\xff") {
                return Err(ImportError::Utf16 { file: self.file.clone() });
            }
            if self.text.starts_with(b"\xef\xbb\xbf") {
                self.text.drain(..3);
            }
        }
        let line = self.text.get(start..).unwrap_or_default();
        if line.contains(&0) {
            let message = "a zero byte; this is a binary file or UTF-16, not UTF-8 text";
            return Err(ImportError::line(&self.file, self.read, message));
        }
        if read as u64 == LONGEST_LINE && !line.ends_with(b"\n") {
            return Err(ImportError::line(&self.file, self.read, "a line of more than 16 MiB; this is no text file"));
        }
        self.text.truncate(start + line.trim_ascii_end().len());
        Ok(true)
    }
}

impl Statement<'_> {
    /// The keyword.
    pub(super) fn keyword(&self) -> &str {
        self.text.split_whitespace().next().unwrap_or_default()
    }

    /// All that follows the keyword: a name, which may hold spaces and `#`.
    pub(super) fn name(&self) -> &str {
        self.text.trim_start().get(self.keyword().len()..).unwrap_or_default().trim()
    }

    /// The words after the keyword, up to a comment.
    pub(super) fn words(&self) -> impl Iterator<Item = &str> {
        let words = match self.text.split_once('#') {
            Some((words, _)) => words,
            None => &self.text,
        };
        words.split_whitespace().skip(1)
    }
}

/// A finite number.
///
/// # Errors
/// Says what the word is instead.
pub(super) fn number(word: &str) -> Result<f64, String> {
    match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        Ok(_) => Err(format!("`{}` is not a finite number", excerpt(word))),
        Err(_) => Err(format!("`{}` is not a number", excerpt(word))),
    }
}

/// What decides which statements a parser gets to see.
pub(super) trait Check {
    /// Appends the next good statement, with its line end, to `out`; nothing at the end of the file.
    fn next(&mut self, out: &mut String) -> Result<(), ImportError>;
}

/// A stream of checked statements. It ends in an I/O error where the check fails; what was wrong
/// then stands in `failure`.
pub(super) struct Checked<C> {
    pub check: C,
    pub failure: Option<ImportError>,
    text: String,
    /// Bytes of `text` already taken.
    taken: usize,
}

impl<C: Check> Checked<C> {
    pub(super) fn new(check: C) -> Self {
        Self { check, failure: None, text: String::new(), taken: 0 }
    }
}

impl<C: Check> BufRead for Checked<C> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.taken == self.text.len() {
            self.text.clear();
            self.taken = 0;
            if let Err(error) = self.check.next(&mut self.text) {
                self.failure = Some(error);
                return Err(io::ErrorKind::InvalidData.into());
            }
        }
        Ok(&self.text.as_bytes()[self.taken..])
    }

    fn consume(&mut self, amount: usize) {
        self.taken += amount;
    }
}

impl<C: Check> Read for Checked<C> {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(out)?;
        self.consume(count);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::Embedded;

    /// Every statement as (line, keyword, name, words), or the error.
    fn all(text: &[u8]) -> Result<Vec<String>, String> {
        let files = [("x", text)];
        let source = Embedded(&files);
        let mut lines = Lines::open(&source, "x").map_err(|e| e.to_string())?;
        let mut out = Vec::new();
        while let Some(s) = lines.next().map_err(|e| e.to_string())? {
            let words: Vec<&str> = s.words().collect();
            out.push(format!("{} {}|{}|{}", s.line, s.keyword(), s.name(), words.join(",")));
        }
        Ok(out)
    }

    #[test]
    fn statements_are_joined_stripped_and_numbered() {
        let text = b"\xef\xbb\xbf# head \\\nv\t1 2 \\\r\n  3 # end\r\n\n  usemtl  a #1 b\r\n#v 9\nf \\";
        let statements = all(text).unwrap();
        assert_eq!(statements[0], "2 v|1 2    3 # end|1,2,3");
        assert_eq!(statements[1], "5 usemtl|a #1 b|a");
        assert_eq!(statements[2], "7 f||");
        assert_eq!(statements.len(), 3);
    }

    #[test]
    fn what_is_not_text_is_refused() {
        let utf16 = "built-in x: the file is UTF-16; save it as UTF-8 text";
        assert_eq!(all(b"\xff\xfev\0 \0").unwrap_err(), utf16);
        assert_eq!(all(b"\xfe\xff\0v\0 ").unwrap_err(), utf16);
        let endless = all(&vec![b'1'; (1 << 24) + 1]).unwrap_err();
        assert_eq!(endless, "built-in x:1: a line of more than 16 MiB; this is no text file");
        assert!(all(&[b'1'; 1 << 20]).is_ok());
        let binary = all(b"v 1 2 3\n\0\x01").unwrap_err();
        assert_eq!(binary, "built-in x:2: a zero byte; this is a binary file or UTF-16, not UTF-8 text");
        assert_eq!(all(b"o caf\xe9").unwrap(), ["1 o|caf\u{fffd}|caf\u{fffd}"]);
    }

    #[test]
    fn numbers_are_finite() {
        assert_eq!(number("-1.5e3"), Ok(-1500.0));
        assert_eq!(number("1e400").unwrap_err(), "`1e400` is not a finite number");
        assert_eq!(number("NaN").unwrap_err(), "`NaN` is not a finite number");
        assert_eq!(number("1,5").unwrap_err(), "`1,5` is not a number");
    }
}
