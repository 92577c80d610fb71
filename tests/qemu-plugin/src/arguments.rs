//! The plugin's arguments, `name=value` each.

use std::path::{Path, PathBuf};

/// What is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Arguments {
    /// Where counting starts.
    pub(crate) begin: u64,
    /// Where it ends.
    pub(crate) end: u64,
    /// The list of symbols.
    pub(crate) symbols: Option<PathBuf>,
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
        for word in words {
            match word.split_once('=') {
                Some(("begin", value)) => begin = Some(address(value)? & !1),
                Some(("end", value)) => end = Some(address(value)? & !1),
                Some(("symbols", value)) => symbols = Some(Path::new(value).to_owned()),
                Some(("out", value)) => out = Some(Path::new(value).to_owned()),
                _ => return Err(format!("{word:?} is none of begin=, end=, symbols= and out=")),
            }
        }
        let missing = |name| format!("{name}= is missing");
        let begin = begin.ok_or_else(|| missing("begin"))?;
        let end = end.ok_or_else(|| missing("end"))?;
        if begin == end {
            return Err(format!("begin and end are the same address, {begin:#x}"));
        }
        Ok(Self { begin, end, symbols, out: out.ok_or_else(|| missing("out"))? })
    }
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
        let expected = Arguments { begin: 0x100, end: 0x2001_0008, symbols: None, out: "a=b.json".into() };
        assert_eq!(arguments, expected);
        let arguments = Arguments::parse(["begin=0x0", "symbols=s", "out=o", "end=0x2"]).unwrap();
        assert_eq!(arguments.symbols.unwrap(), Path::new("s"));
    }

    #[test]
    fn what_is_wrong_is_said() {
        let cases: [(&[&str], &str); 7] = [
            (&["end=0x2", "out=o"], "begin= is missing"),
            (&["begin=0x2", "out=o"], "end= is missing"),
            (&["begin=0x2", "end=0x4"], "out= is missing"),
            (&["begin=0x2", "end=0x3", "out=o"], "begin and end are the same address, 0x2"),
            (&["start=0x2"], "\"start=0x2\" is none of begin=, end=, symbols= and out="),
            (&["begin=1000"], "\"1000\" is not 0x and hexadecimal digits"),
            (&["begin=0x+1"], "\"0x+1\" is not 0x and hexadecimal digits"),
        ];
        for (words, message) in cases {
            assert_eq!(Arguments::parse(words.iter().copied()).unwrap_err(), message);
        }
    }
}
