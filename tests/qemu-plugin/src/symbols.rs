//! Named ranges of addresses that are counted apart.

use crate::arguments::address;

/// Symbols by address.
#[derive(Clone, Debug, Default)]
pub(crate) struct Symbols {
    /// In the file's order.
    names: Vec<String>,
    /// Address, size and index into the names; ascending, each address once.
    ranges: Vec<(u64, u64, usize)>,
}

impl Symbols {
    /// From lines `ADDRESS SIZE NAME`.
    ///
    /// # Errors
    /// The first line that is not of that form.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let mut symbols = Self::default();
        for (number, line) in (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty()) {
            let mut words = line.trim().splitn(3, ' ');
            let mut word = || words.next().map(str::trim).filter(|word| !word.is_empty());
            let (Some(start), Some(size), Some(name)) = (word(), word(), word()) else {
                return Err(format!("line {number}: expected ADDRESS SIZE NAME"));
            };
            let value = |word| address(word).map_err(|error| format!("line {number}: {error}"));
            symbols.ranges.push((value(start)? & !1, value(size)?, symbols.names.len()));
            symbols.names.push(name.to_owned());
        }
        symbols.ranges.sort_by_key(|&(start, ..)| start);
        symbols.ranges.dedup_by_key(|&mut (start, ..)| start);
        Ok(symbols)
    }

    /// The symbol that an instruction belongs to.
    pub(crate) fn at(&self, address: u64) -> Option<usize> {
        let after = self.ranges.partition_point(|&(start, ..)| start <= address);
        let &(start, size, index) = self.ranges.get(after.checked_sub(1)?)?;
        (address - start < size).then_some(index)
    }

    /// Whether a symbol's instructions are counted for whoever calls it.
    pub(crate) fn is_shared(&self, index: usize) -> bool {
        self.names.get(index).is_some_and(|name| name == "caller")
    }

    /// All names, in the file's order.
    pub(crate) fn names(&self) -> &[String] {
        &self.names
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_symbol_that_covers_an_address_has_it() {
        let symbols =
            Symbols::parse("0x101 0x10 <a as b>::c\n\n0x40 0x8 d\n0x100 0x10 alias\n0x104 0x4 inner\n").unwrap();
        assert_eq!(symbols.names(), ["<a as b>::c", "d", "alias", "inner"]);
        for (address, index) in [
            (0x3e, None),
            (0x40, Some(1)),
            (0x46, Some(1)),
            (0x48, None),
            (0x100, Some(0)),
            (0x104, Some(3)),
            (0x108, None),
        ] {
            assert_eq!(symbols.at(address), index, "{address:#x}");
        }
    }

    #[test]
    fn other_lines_are_named() {
        for (text, message) in [
            ("0x0 0x1 a\n0x4 0x2\n", "line 2: expected ADDRESS SIZE NAME"),
            ("100 0x1 a", "line 1: \"100\" is not 0x and hexadecimal digits"),
        ] {
            assert_eq!(Symbols::parse(text).unwrap_err(), message);
        }
    }
}
