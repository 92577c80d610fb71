//! The square root of an integer, a bit of the root at a time: bring down two bits, compare, subtract (C. Woo, "Square Root by
//! Abacus Algorithm", 1985). It is what a processor that works on single bits does, and all lanes of a tile take the same
//! steps.

/// The widest value that there is a root of, bits: what is left of it, and its root, stay in 32.
pub const BITS_MAX: u32 = 58;

/// Digits that the lower of two words has.
const LOW_DIGITS: u32 = 14;

/// `floor(sqrt(value))`, for a value in [0, 2^bits) and bits up to [`BITS_MAX`].
#[inline(always)]
#[must_use]
pub fn root(value: i64, bits: u32) -> i32 {
    let words = split(value);
    let (mut rest, mut root) = (0, 0);
    for place in (0..bits.div_ceil(2)).rev() {
        (rest, root) = digit(rest, root, pair(words, place));
    }
    root
}

/// The value's lower 28 bits and its upper 30.
#[inline(always)]
pub(crate) fn split(value: i64) -> [i32; 2] {
    [(value & ((1 << (2 * LOW_DIGITS)) - 1)) as i32, (value >> (2 * LOW_DIGITS)) as i32]
}

/// The two bits of a value at the place of a digit of the root, 0 the lowest, up to 28.
#[inline(always)]
pub(crate) fn pair([low, high]: [i32; 2], place: u32) -> i32 {
    if place < LOW_DIGITS { (low >> (2 * place)) & 3 } else { (high >> (2 * (place - LOW_DIGITS))) & 3 }
}

/// One more digit of the root: what is left of the value down to this place, and the root.
///
/// `rest = value - root^2` of the digits so far is at most twice the root, which has at most 28 bits before the last digit: so
/// `4 rest + 3` is below 2^31.
#[inline(always)]
pub(crate) fn digit(rest: i32, root: i32, pair: i32) -> (i32, i32) {
    let brought = rest << 2 | pair;
    // (2 root + 1)^2 - (2 root)^2.
    let taken = root << 2 | 1;
    let fits = -i32::from(brought >= taken);
    (brought - (taken & fits), (root << 1) - fits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_are_rounded_down() {
        for value in 0..70_000i64 {
            let root = i64::from(root(value, 18));
            assert!(root * root <= value && (root + 1) * (root + 1) > value, "{value}");
        }
    }

    #[test]
    fn the_ends_of_every_width_have_their_roots() {
        for bits in 1..=BITS_MAX {
            let most = (1i64 << bits) - 1;
            for value in [0, 1, most / 2, most - 1, most] {
                assert_eq!(i64::from(root(value, bits)), value.isqrt(), "{value} in {bits}");
            }
            // On both sides of the largest square.
            let side = most.isqrt();
            assert_eq!(i64::from(root(side * side, bits)), side);
            assert_eq!(i64::from(root(side * side - 1, bits)), side - 1);
        }
    }
}
