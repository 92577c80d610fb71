//! Where in a pixel its samples are: Hammersley's points, the same in every pixel and on every machine.
//!
//! Of n samples, number i is at ((2i + 1) / 2n, (2 rev(i) + 1) / 2m), with m the least power of two that is not below n and
//! rev(i) the log2(m) bits of i reversed; both rounded down to a 65536th (J. M. Hammersley, "Monte Carlo Methods for Solving
//! Multivariable Problems", 1960).

/// Samples a pixel at most: their sum, each at most 1, fits light in Q16.16.
pub const MAX_SAMPLES: u16 = 1024;

/// Fractional bits of a [`Place`].
pub const PLACE_BITS: u32 = 16;

const MIDDLE: u32 = 1 << (PLACE_BITS - 1);

/// A place in a pixel: from its left and from its top, below 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// In Q16.
    pub right_q16: u16,
    /// In Q16.
    pub down_q16: u16,
}

impl Place {
    /// How far right and down of the middle, Q16 in [-2^15, 2^15).
    #[inline]
    #[must_use]
    pub fn off_middle(self) -> [i32; 2] {
        [self.right_q16, self.down_q16].map(|c| i32::from(c) - MIDDLE as i32)
    }
}

/// The places of a pixel's samples, in order.
#[derive(Clone, Copy, Debug)]
pub struct Places {
    samples: u32,
    /// log2(m).
    row_bits: u32,
    next: u32,
    /// (2i + 1) 2^15 divided by the samples: quotient and remainder.
    column: [u32; 2],
    /// 2^16 divided by the samples, likewise: what the next sample adds. So only the first of a pixel takes a division.
    step: [u32; 2],
}

impl Places {
    /// Of so many samples: at least one, at most [`MAX_SAMPLES`].
    #[inline]
    #[must_use]
    pub fn of(samples: u16) -> Self {
        let samples = u32::from(samples.clamp(1, MAX_SAMPLES));
        // Never by 0, but that is for the compiler to see.
        let divided = |value: u32| {
            let quotient = value.checked_div(samples).unwrap_or_default();
            [quotient, value - quotient * samples]
        };
        Self {
            samples,
            row_bits: samples.next_power_of_two().trailing_zeros(),
            next: 0,
            column: divided(MIDDLE),
            step: divided(2 * MIDDLE),
        }
    }
}

impl Iterator for Places {
    type Item = Place;

    #[inline]
    fn next(&mut self) -> Option<Place> {
        if self.next >= self.samples {
            return None;
        }
        // In two steps: a shift by all bits, where there is one row, is none.
        let row = (self.next.reverse_bits() >> 1) >> (u32::BITS - 1 - self.row_bits);
        // (2 row + 1) < 2^11, so below 2^26.
        let down = ((2 * row + 1) * MIDDLE) >> self.row_bits;
        let place = Place { right_q16: self.column[0] as u16, down_q16: down as u16 };
        self.next += 1;
        self.column = [self.column[0] + self.step[0], self.column[1] + self.step[1]];
        if self.column[1] >= self.samples {
            self.column = [self.column[0] + 1, self.column[1] - self.samples];
        }
        Some(place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the formula, with a division a number and bits reversed one by one.
    fn formula(samples: u64, i: u64) -> Place {
        let mut rows = 1;
        while rows < samples {
            rows *= 2;
        }
        let (mut row, mut rest, mut weight) = (0, i, rows);
        while weight > 1 {
            weight /= 2;
            row += rest % 2 * weight;
            rest /= 2;
        }
        let place = |number: u64, of: u64| u16::try_from((2 * number + 1) * 32_768 / of).unwrap();
        Place { right_q16: place(i, samples), down_q16: place(row, rows) }
    }

    #[test]
    fn places_are_those_of_the_formula() {
        for samples in 1..=MAX_SAMPLES {
            let mut places = Places::of(samples);
            for i in 0..samples {
                assert_eq!(places.next(), Some(formula(samples.into(), i.into())), "{i} of {samples}");
            }
            assert_eq!(places.next(), None, "{samples}");
        }
    }

    #[test]
    fn one_sample_is_in_the_middle() {
        let mut places = Places::of(1);
        assert_eq!(places.next().map(Place::off_middle), Some([0, 0]));
    }
}
