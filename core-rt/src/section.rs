//! Sections of a blob: runs of records, 8-aligned, and integers in the narrower of two widths.

use zerocopy::FromBytes;

use crate::record::Record;

/// Every section begins at a multiple of this.
pub const ALIGN: usize = 8;

/// Integers of one of two widths, as the scene needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Integers<'a> {
    /// All below 2^16.
    Narrow(&'a [u16]),
    /// Any.
    Wide(&'a [u32]),
}

impl Integers<'_> {
    /// No integers.
    pub const NONE: Self = Self::Narrow(&[]);

    /// The integer at `index`; past the end the largest one, so that no access fails.
    #[inline]
    #[must_use]
    pub fn get(&self, index: u32) -> u32 {
        match self {
            Self::Narrow(values) => values.get(index as usize).map_or(u32::MAX, |&v| v.into()),
            Self::Wide(values) => values.get(index as usize).map_or(u32::MAX, |&v| v),
        }
    }

    /// Three in a row, from `3 * index`.
    #[inline]
    #[must_use]
    pub fn triple(&self, index: u32) -> [u32; 3] {
        let first = index.wrapping_mul(3);
        [self.get(first), self.get(first.wrapping_add(1)), self.get(first.wrapping_add(2))]
    }

    /// Whether three in a row stand for nothing: they are the largest of their width.
    #[inline]
    #[must_use]
    pub fn is_none(&self, index: u32) -> bool {
        let none = match self {
            Self::Narrow(_) => u16::MAX.into(),
            Self::Wide(_) => u32::MAX,
        };
        self.triple(index) == [none; 3]
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Narrow(values) => values.len(),
            Self::Wide(values) => values.len(),
        }
    }

    /// How many bytes they take.
    #[must_use]
    pub fn size(&self) -> usize {
        match self {
            Self::Narrow(values) => size_of_val(*values),
            Self::Wide(values) => size_of_val(*values),
        }
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// Takes sections off a blob's body, one after the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reader<'a> {
    pub(crate) bytes: &'a [u8],
}

impl<'a> Reader<'a> {
    /// The next `count` records, and the padding behind them. `None` where the body is too short, the padding is not
    /// zero, or the memory is not aligned for the record.
    pub(crate) fn records<T: Record>(&mut self, count: u32) -> Option<&'a [T]> {
        let records = self.section(count, size_of::<T>())?;
        // The count is known: from the bytes it would take a division.
        <[T]>::ref_from_bytes_with_elems(records, count as usize).ok()
    }

    /// The bytes of the next `count` records of a size. Apart, since it is the same for all types.
    #[inline(never)]
    fn section(&mut self, count: u32, size: usize) -> Option<&'a [u8]> {
        let size = (count as usize).checked_mul(size)?;
        let (records, rest) = self.bytes.split_at_checked(size)?;
        let (padding, rest) = rest.split_at_checked(size.wrapping_neg() % ALIGN)?;
        self.bytes = rest;
        padding.iter().all(|&b| b == 0).then_some(records)
    }

    /// The next `count` integers.
    pub(crate) fn integers(&mut self, count: u32, wide: bool) -> Option<Integers<'a>> {
        if wide { self.records(count).map(Integers::Wide) } else { self.records(count).map(Integers::Narrow) }
    }
}
