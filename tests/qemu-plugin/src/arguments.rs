//! The plugin's arguments, `name=value` each.

use std::path::{Path, PathBuf};

use crate::rays::{MARKS, Mark};

/// What is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Arguments {
    /// Where counting starts.
    pub(crate) begin: u64,
    /// Where it ends.
    pub(crate) end: u64,
    /// The list of symbols.
    pub(crate) symbols: Option<PathBuf>,
    /// The marks of rays, none or all.
    pub(crate) marks: Vec<(u64, Mark)>,
    /// Where the counts go.
    pub(crate) out: PathBuf,
}

impl Arguments {
    /// From the words that QEMU passes on.
    ///
    /// # Errors
    /// What is missing, unknown or malformed.
    pub(crate) fn parse<'a>(words: impl IntoIterator<Item = &'a str>) -> Result<Self, String> {
        let (mut begin, mut end, mut symbols, mut out) = (None, None, None, None);
        let mut marks = Vec::new();
        for word in words {
            match word.split_once('=') {
                Some(("begin", value)) => begin = Some(address(value)? & !1),
                Some(("end", value)) => end = Some(address(value)? & !1),
                Some(("symbols", value)) => symbols = Some(Path::new(value).to_owned()),
                Some(("out", value)) => out = Some(Path::new(value).to_owned()),
                other => {
                    let mark = other.and_then(|(name, value)| Some((mark(name)?, value)));
                    let unknown = || format!("{word:?} is none of begin=, end=, symbols=, out= and the marks of rays");
                    let (mark, value) = mark.ok_or_else(unknown)?;
                    marks.push((address(value)? & !1, mark));
                }
            }
        }
        let missing = |name| format!("{name}= is missing");
        let begin = begin.ok_or_else(|| missing("begin"))?;
        let end = end.ok_or_else(|| missing("end"))?;
        if begin == end {
            return Err(format!("begin and end are the same address, {begin:#x}"));
        }
        if !marks.is_empty() && MARKS.iter().any(|mark| !marks.iter().any(|(_, given)| given == mark)) {
            return Err("some marks of rays are missing".into());
        }
        Ok(Self { begin, end, symbols, marks, out: out.ok_or_else(|| missing("out"))? })
    }
}

/// The mark of a name.
fn mark(name: &str) -> Option<Mark> {
    let names = ["shadow", "lit", "reflection", "refraction", "next"];
    names.into_iter().zip(MARKS).find_map(|(known, mark)| (known == name).then_some(mark))
}

/// A number of up to 64 bits. Without its prefix it could be decimal as well, so that the prefix is required.
///
/// # Errors
/// Where it is of another form.
pub(crate) fn address(word: &str) -> Result<u64, String> {
    word.strip_prefix("0x")
        .filter(|digits| digits.bytes().all(|byte| byte.is_ascii_hexdigit()))
        .and_then(|digits| u64::from_str_radix(digits, 16).ok())
        .ok_or_else(|| format!("{word:?} is not 0x and hexadecimal digits"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_come_in_any_order() {
        let arguments = Arguments::parse(["out=a=b.json", "end=0x20010008", "begin=0x101"]).unwrap();
        let expected =
            Arguments { begin: 0x100, end: 0x2001_0008, symbols: None, marks: vec![], out: "a=b.json".into() };
        assert_eq!(arguments, expected);
        let arguments = Arguments::parse(["begin=0x0", "symbols=s", "out=o", "end=0x2"]).unwrap();
        assert_eq!(arguments.symbols.unwrap(), Path::new("s"));
        let marks = ["next=0x11", "shadow=0x20", "lit=0x30", "refraction=0x40", "reflection=0x50"];
        let arguments = Arguments::parse(["begin=0x0", "out=o", "end=0x2"].into_iter().chain(marks)).unwrap();
        assert_eq!(arguments.marks[..2], [(0x10, Mark::Next), (0x20, Mark::Shadow)]);
    }

    #[test]
    fn what_is_wrong_is_said() {
        let cases: [(&[&str], &str); 8] = [
            (&["end=0x2", "out=o"], "begin= is missing"),
            (&["begin=0x2", "out=o"], "end= is missing"),
            (&["begin=0x2", "end=0x4"], "out= is missing"),
            (&["begin=0x2", "end=0x3", "out=o"], "begin and end are the same address, 0x2"),
            (&["start=0x2"], "\"start=0x2\" is none of begin=, end=, symbols=, out= and the marks of rays"),
            (&["begin=0x2", "end=0x4", "out=o", "lit=0x6"], "some marks of rays are missing"),
            (&["begin=1000"], "\"1000\" is not 0x and hexadecimal digits"),
            (&["begin=0x+1"], "\"0x+1\" is not 0x and hexadecimal digits"),
        ];
        for (words, message) in cases {
            assert_eq!(Arguments::parse(words.iter().copied()).unwrap_err(), message);
        }
    }
}
