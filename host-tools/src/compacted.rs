//! Numbers without gaps for those of many things that are used.

/// New numbers for those that are used, in the order of their first use.
#[derive(Default)]
pub(crate) struct Compacted {
    /// The new number of each old one, as far as they are known; [`Compacted::NONE`] where it is not used.
    new: Vec<u32>,
    old: Vec<u32>,
}

impl Compacted {
    const NONE: u32 = u32::MAX;

    /// The new number of one that is used, below 2^32 - 1.
    pub(crate) fn number(&mut self, old: usize) -> u32 {
        if old >= self.new.len() {
            self.new.resize(old + 1, Self::NONE);
        }
        let new = &mut self.new[old];
        if *new == Self::NONE {
            *new = self.old.len() as u32;
            self.old.push(old as u32);
        }
        *new
    }

    /// The new number of one that has one.
    pub(crate) fn get(&self, old: usize) -> u32 {
        self.new[old]
    }

    /// The old numbers, by the new ones.
    pub(crate) fn used(&self) -> impl ExactSizeIterator<Item = usize> {
        self.old.iter().map(|&old| old as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_the_order_of_first_use() {
        let mut compacted = Compacted::default();
        assert_eq!([4, 1, 4, 3].map(|old| compacted.number(old)), [0, 1, 0, 2]);
        assert!(compacted.used().eq([4, 1, 3]));
    }
}
