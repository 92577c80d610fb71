//! The square root of an integer, a bit of the root at a time: compare, subtract, shift (C. Woo, "Square Root by Abacus
//! Algorithm", 1985). It is what a processor that works on single bits does, and all lanes of a tile take the same steps.

/// `floor(sqrt(value))`, for a value in [0, 2^bits) and bits up to 62.
#[inline(always)]
#[must_use]
pub fn root(value: i64, bits: u32) -> i32 {
    let (mut rest, mut root) = (value, 0);
    let mut place = bits.div_ceil(2);
    while place > 0 {
        place -= 1;
        (rest, root) = digit(rest, root, place);
    }
    root as i32
}

/// One bit of the root: what is left of the value, and the root's leading bits, both at the weight of `place`.
///
/// Let the root so far be R, a multiple of 2^(place + 1), and `rest = value - R^2`. Then `root` is `R 2^(place + 1)`: adding
/// the bit 2^place takes `2 R 2^place + 4^place = root + 4^place` from the rest. All stay below 2^62.
#[inline(always)]
pub(crate) fn digit(rest: i64, root: i64, place: u32) -> (i64, i64) {
    let bit = 1 << (2 * place);
    let taken = root + bit;
    let fits = -i64::from(rest >= taken);
    (rest - (taken & fits), (root >> 1) + (bit & fits))
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
        for bits in 1..=62 {
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
