//! Processors that work on single bits, all on the same instruction, each with its own memory.
//!
//! A word is a list of places in that memory, the lowest bit first: an instruction works on one bit and says where that is. Words
//! with a sign are two's complement. Beside the memory there are a carry, which is a sum's own, and the enable register: what is
//! written to a processor that is not enabled leaves it as it is. The outcome of a comparison is a [`Mask`] until it is used.
//!
//! Every place that is written or compared counts as an operation. How many there are depends on the words' widths alone.

use std::array::from_fn;
use std::ops::{BitAnd, BitOr, BitXor, Not};

/// Processors that are modelled at once.
pub const PROCESSORS: usize = 64 * WORDS;

const WORDS: usize = 8;

/// A bit of every processor.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mask([u64; WORDS]);

impl Mask {
    /// No processor.
    pub const NONE: Self = Self([0; WORDS]);
    /// Every processor.
    pub const ALL: Self = Self([!0; WORDS]);

    /// The processors for which it is so.
    #[must_use]
    pub fn of(is_set: impl Fn(usize) -> bool) -> Self {
        Self(from_fn(|word| (0..64).fold(0, |bits, bit| bits | u64::from(is_set(64 * word + bit)) << bit)))
    }

    /// Whether a processor's bit is set.
    #[must_use]
    pub fn has(self, processor: usize) -> bool {
        self.0.get(processor / 64).is_some_and(|word| word >> (processor % 64) & 1 != 0)
    }

    /// A plain loop, which becomes a few vectors.
    #[inline(always)]
    fn with(mut self, other: Self, of: impl Fn(u64, u64) -> u64) -> Self {
        for (word, other) in self.0.iter_mut().zip(other.0) {
            *word = of(*word, other);
        }
        self
    }

    /// The same bit for every processor.
    #[inline(always)]
    fn same(is_set: bool) -> Self {
        if is_set { Self::ALL } else { Self::NONE }
    }
}

impl BitAnd for Mask {
    type Output = Self;

    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        self.with(other, |a, b| a & b)
    }
}

impl BitOr for Mask {
    type Output = Self;

    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        self.with(other, |a, b| a | b)
    }
}

impl BitXor for Mask {
    type Output = Self;

    #[inline(always)]
    fn bitxor(self, other: Self) -> Self {
        self.with(other, |a, b| a ^ b)
    }
}

impl Not for Mask {
    type Output = Self;

    #[inline(always)]
    fn not(self) -> Self {
        self.with(self, |a, _| !a)
    }
}

/// What an instruction reads.
#[derive(Clone, Copy, Debug)]
pub enum Operand<'a> {
    /// A word with a sign.
    Signed(&'a [usize]),
    /// A word without.
    Unsigned(&'a [usize]),
    /// What is sent to all processors with the instruction.
    Constant(i64),
    /// `4 w + 1` of a word w without a sign: what the next digit of a root takes.
    Taken(&'a [usize]),
    /// A word without a sign, so many places higher.
    Raised(&'a [usize], usize),
}

/// The processors.
#[derive(Clone, Debug)]
pub struct Processors {
    memory: Vec<Mask>,
    backing: Vec<Mask>,
    /// Those whose memory is written to.
    pub enabled: Mask,
    /// Operations on single bits so far.
    pub operations: u64,
}

impl Processors {
    /// With so many bits of memory, and of the store behind it, all zero.
    #[must_use]
    pub fn new(local_bits: usize, backing_bits: usize) -> Self {
        Self {
            memory: vec![Mask::NONE; local_bits],
            backing: vec![Mask::NONE; backing_bits],
            enabled: Mask::ALL,
            operations: 0,
        }
    }

    /// A bit of what is read; a word goes on with its sign.
    #[inline(always)]
    fn bit(&self, operand: Operand<'_>, place: usize) -> Mask {
        let at = |word: &[usize], place: usize| word.get(place).map_or(Mask::NONE, |&address| self.memory[address]);
        match operand {
            Operand::Signed(word) => at(word, place.min(word.len().saturating_sub(1))),
            Operand::Unsigned(word) => at(word, place),
            Operand::Constant(value) => Mask::same(value >> place.min(63) & 1 != 0),
            Operand::Taken(word) => place.checked_sub(2).map_or(Mask::same(place == 0), |place| at(word, place)),
            Operand::Raised(word, by) => place.checked_sub(by).map_or(Mask::NONE, |place| at(word, place)),
        }
    }

    /// Writes one bit of the enabled processors.
    #[inline(always)]
    pub fn write(&mut self, place: usize, bit: Mask) {
        self.operations += 1;
        self.memory[place] = (bit & self.enabled) | (self.memory[place] & !self.enabled);
    }

    /// Runs something for those of the enabled processors that are in a mask.
    pub fn under(&mut self, mask: Mask, run: impl FnOnce(&mut Self)) {
        let enabled = self.enabled;
        self.enabled = enabled & mask;
        run(self);
        self.enabled = enabled;
    }

    /// Copies what is read.
    pub fn copy(&mut self, to: &[usize], from: Operand<'_>) {
        for (place, &address) in to.iter().enumerate() {
            let bit = self.bit(from, place);
            self.write(address, bit);
        }
    }

    /// `to = a + b`. The word may be that of a or b.
    pub fn add(&mut self, to: &[usize], a: Operand<'_>, b: Operand<'_>) {
        self.sum(to, a, b, false);
    }

    /// `to = a - b`.
    pub fn subtract(&mut self, to: &[usize], a: Operand<'_>, b: Operand<'_>) {
        self.sum(to, a, b, true);
    }

    fn sum(&mut self, to: &[usize], a: Operand<'_>, b: Operand<'_>, is_difference: bool) {
        let inverted = Mask::same(is_difference);
        let mut carry = inverted;
        for (place, &address) in to.iter().enumerate() {
            let (a, b) = (self.bit(a, place), self.bit(b, place) ^ inverted);
            self.write(address, a ^ b ^ carry);
            carry = (a & b) | (carry & (a ^ b));
        }
    }

    /// Where `a < b`, both below 2^(bits - 1): the sign of their difference, which is not kept.
    #[must_use]
    pub fn less(&mut self, a: Operand<'_>, b: Operand<'_>, bits: usize) -> Mask {
        let (mut carry, mut sign) = (Mask::ALL, Mask::NONE);
        for place in 0..bits {
            let (a, b) = (self.bit(a, place), !self.bit(b, place));
            sign = a ^ b ^ carry;
            carry = (a & b) | (carry & (a ^ b));
        }
        self.operations += bits as u64;
        sign
    }

    /// Where a word with a sign is negative.
    #[must_use]
    pub fn negative(&self, word: &[usize]) -> Mask {
        self.bit(Operand::Signed(word), word.len().saturating_sub(1))
    }

    /// Where every bit of a word is that of a number.
    #[must_use]
    pub fn equal(&mut self, word: &[usize], number: i64) -> Mask {
        self.operations += word.len() as u64;
        word.iter().enumerate().fold(Mask::ALL, |equal, (place, &address)| {
            equal & !(self.memory[address] ^ self.bit(Operand::Constant(number), place))
        })
    }

    /// Where some bit of a word is set.
    #[must_use]
    pub fn any(&mut self, word: &[usize]) -> Mask {
        self.operations += word.len() as u64;
        word.iter().fold(Mask::NONE, |any, &address| any | self.memory[address])
    }

    /// `to += a b`, or less that where it `is_taken`, with b in so many bits: one addition for each. A b with a sign, or a constant,
    /// has it in the last.
    pub fn multiply(&mut self, to: &[usize], a: Operand<'_>, (b, bits): (Operand<'_>, usize), is_taken: bool) {
        for place in 0..bits.min(to.len()) {
            let is_sign = place + 1 == bits && matches!(b, Operand::Signed(_) | Operand::Constant(_));
            let bit = self.bit(b, place);
            let part = &to[place..];
            self.under(bit, |processors| processors.sum(part, Operand::Signed(part), a, is_sign != is_taken));
        }
    }

    /// The nearest value of magnitude `2^(bits - 1) - 1` or less, in the same word with a sign.
    pub fn saturate(&mut self, word: &[usize], bits: usize) {
        let most = (1 << (bits - 1)) - 1;
        let (value, width) = (Operand::Signed(word), word.len().max(bits) + 1);
        let above = self.less(Operand::Constant(most), value, width);
        self.under(above, |processors| processors.copy(word, Operand::Constant(most)));
        let below = self.less(value, Operand::Constant(-most), width);
        self.under(below, |processors| processors.copy(word, Operand::Constant(-most)));
    }

    /// The smaller of a word and a constant, in the same word; neither is negative.
    pub fn at_most(&mut self, word: &[usize], most: i64) {
        let width = word.len().max(64 - most.leading_zeros() as usize) + 1;
        let beyond = self.less(Operand::Constant(most), Operand::Unsigned(word), width);
        self.under(beyond, |processors| processors.copy(word, Operand::Constant(most)));
    }

    /// `quotient = dividend / divisor`, rounded down, neither of them negative; `rest` has a bit more than the divisor, whose
    /// places are signed. Of a divisor of zero all digits are ones.
    pub fn divide(&mut self, quotient: &[usize], rest: &[usize], dividend: Operand<'_>, divisor: &[usize]) {
        self.copy(rest, Operand::Constant(0));
        let divisor = Operand::Unsigned(divisor);
        for (place, &digit) in quotient.iter().enumerate().rev() {
            self.raise(rest, 1);
            let brought = self.bit(dividend, place);
            if let Some(&lowest) = rest.first() {
                self.write(lowest, brought);
            }
            let fits = !self.less(Operand::Unsigned(rest), divisor, rest.len() + 1);
            self.under(fits, |processors| processors.subtract(rest, Operand::Unsigned(rest), divisor));
            self.write(digit, fits);
        }
    }

    /// `root = floor(sqrt(value))`, a digit at a time; `rest` has two bits more than the root.
    pub fn root(&mut self, root: &[usize], rest: &[usize], value: &[usize]) {
        self.copy(rest, Operand::Constant(0));
        for (place, &digit) in root.iter().enumerate().rev() {
            self.raise(rest, 2);
            for (below, &address) in rest.iter().take(2).enumerate() {
                let brought = self.bit(Operand::Unsigned(value), 2 * place + below);
                self.write(address, brought);
            }
            let taken = Operand::Taken(&root[place + 1..]);
            let fits = !self.less(Operand::Unsigned(rest), taken, rest.len() + 1);
            self.under(fits, |processors| processors.subtract(rest, Operand::Unsigned(rest), taken));
            self.write(digit, fits);
        }
    }

    /// Moves a word's bits upwards; the lowest stay to be written.
    fn raise(&mut self, word: &[usize], by: usize) {
        for place in (by..word.len()).rev() {
            let bit = self.memory[word[place - by]];
            self.write(word[place], bit);
        }
    }

    /// What the tree that spans all processors leaves in a word: a value each, whatever is enabled.
    pub fn load(&mut self, word: &[usize], values: impl Fn(usize) -> i64) {
        for (place, &address) in word.iter().enumerate() {
            self.operations += 1;
            self.memory[address] = Mask::of(|processor| values(processor) >> place.min(63) & 1 != 0);
        }
    }

    /// A processor's word without a sign.
    #[must_use]
    pub fn read(&self, word: &[usize], processor: usize) -> u64 {
        let bit = |(place, &address): (usize, &usize)| u64::from(self.memory[address].has(processor)) << place;
        word.iter().take(64).enumerate().map(bit).sum()
    }

    /// Copies between memory and the store behind it, of all processors.
    pub fn transfer(&mut self, local: &[usize], first: usize, is_outward: bool) {
        for (&address, place) in local.iter().zip(first..) {
            if is_outward {
                self.backing[place] = self.memory[address];
            } else {
                self.memory[address] = self.backing[place];
            }
        }
    }
}

#[cfg(test)]
mod tests;
