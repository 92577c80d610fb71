//! Arithmetic a bit at a time against the machine's own, on words that do not lie in a row.

use super::*;

/// Every other place, from one on, downwards.
fn word(from: usize, bits: usize) -> Vec<usize> {
    (0..bits).map(|place| from + 2 * (bits - 1 - place)).collect()
}

/// A value of each processor, of so many bits with a sign; small ones and the ends are among them.
fn values(seed: u64, bits: u32) -> impl Fn(usize) -> i64 {
    move |processor| {
        let most = (1i64 << (bits - 1)) - 1;
        match processor {
            0 => most,
            1 => -most,
            2..10 => processor as i64 - 5,
            _ => {
                let mixed = (processor as u64 + seed).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23);
                ((mixed.wrapping_mul(0xbf58_476d_1ce4_e5b9) >> (64 - bits)) as i64 - most).min(most)
            }
        }
    }
}

fn signed(processors: &Processors, word: &[usize], processor: usize) -> i64 {
    let spare = 64 - word.len();
    ((processors.read(word, processor) << spare) as i64) >> spare
}

#[test]
fn sums_products_and_what_a_word_holds_are_exact() {
    let (a, b) = (values(1, 12), values(7, 12));
    let mut processors = Processors::new(300, 0);
    let (of_a, of_b, sum, product) = (word(0, 12), word(1, 12), word(30, 13), word(60, 25));
    processors.load(&of_a, &a);
    processors.load(&of_b, &b);
    processors.subtract(&sum, Operand::Signed(&of_a), Operand::Signed(&of_b));
    processors.multiply(&product, Operand::Signed(&of_a), (Operand::Signed(&of_b), 12), false);
    processors.multiply(&product, Operand::Signed(&of_a), (Operand::Constant(-77), 8), true);
    for processor in 0..PROCESSORS {
        let (a, b) = (a(processor), b(processor));
        assert_eq!(signed(&processors, &sum, processor), a - b);
        assert_eq!(signed(&processors, &product, processor), a * b + 77 * a);
    }
    let less = processors.less(Operand::Signed(&of_a), Operand::Signed(&of_b), 13);
    processors.saturate(&product, 16);
    for processor in 0..PROCESSORS {
        let (a, b) = (a(processor), b(processor));
        assert_eq!(less.has(processor), a < b);
        assert_eq!(signed(&processors, &product, processor), (a * b + 77 * a).clamp(-32_767, 32_767));
    }
}

#[test]
fn quotients_and_roots_are_rounded_down() {
    let value = |values: &dyn Fn(usize) -> i64, processor: usize| values(processor).abs();
    let (dividend, divisor) = (values(3, 20), values(5, 10));
    let mut processors = Processors::new(400, 0);
    let (of_a, of_b, quotient, rest) = (word(0, 20), word(1, 10), word(80, 22), word(81, 11));
    processors.load(&of_a, |processor| value(&dividend, processor));
    processors.load(&of_b, |processor| value(&divisor, processor));
    processors.divide(&quotient, &rest, Operand::Raised(&of_a, 2), &of_b);
    let (root, rest) = (word(200, 10), word(201, 12));
    processors.root(&root, &rest, &of_a);
    for processor in 0..PROCESSORS {
        let (a, b) = (value(&dividend, processor), value(&divisor, processor));
        let expected = (4 * a).checked_div(b).unwrap_or((1 << 22) - 1);
        assert_eq!(processors.read(&quotient, processor) as i64, expected, "{a} / {b}");
        assert_eq!(processors.read(&root, processor) as i64, a.isqrt());
    }
}

#[test]
fn a_processor_that_is_not_enabled_keeps_what_it_has_and_takes_as_long() {
    let odd = Mask::of(|processor| processor % 2 == 1);
    let mut processors = Processors::new(40, 40);
    let place = word(0, 10);
    processors.copy(&place, Operand::Constant(5));
    processors.under(odd, |processors| processors.add(&place, Operand::Signed(&place), Operand::Constant(-7)));
    assert_eq!(processors.operations, 20);
    let expected = |processor: usize| if odd.has(processor) { -2 } else { 5 };
    assert!((0..PROCESSORS).all(|processor| signed(&processors, &place, processor) == expected(processor)));
    processors.transfer(&place, 3, true);
    processors.copy(&place, Operand::Constant(0));
    processors.transfer(&place, 3, false);
    assert!((0..PROCESSORS).all(|processor| signed(&processors, &place, processor) == expected(processor)));
}
