//! The number of bits of a value: by table where counting leading zeros is no instruction, and a routine of 25 or more.

/// Whether the processor counts leading zeros, or the routine is preferred as the smaller one.
const HAS_INSTRUCTION: bool = cfg!(any(prefer_size, not(any(target_arch = "arm", target_arch = "riscv32"))));

/// The number of bits of each byte.
const LENGTHS: [u8; 256] = {
    let mut table = [0; 256];
    let mut byte = 0;
    while byte < table.len() {
        table[byte] = (u32::BITS - (byte as u32).leading_zeros()) as u8;
        byte += 1;
    }
    table
};

/// Unsigned words that know their length.
pub trait BitLength {
    /// 0 for 0, n for 2^(n-1) <= value < 2^n.
    fn bit_length(self) -> u32;
}

impl BitLength for u32 {
    #[inline(always)]
    fn bit_length(self) -> u32 {
        if HAS_INSTRUCTION { Self::BITS - self.leading_zeros() } else { by_table(self) }
    }
}

impl BitLength for u64 {
    #[inline(always)]
    fn bit_length(self) -> u32 {
        let high = (self >> 32) as u32;
        if HAS_INSTRUCTION {
            Self::BITS - self.leading_zeros()
        } else if high != 0 {
            32 + high.bit_length()
        } else {
            (self as u32).bit_length()
        }
    }
}

impl BitLength for u128 {
    #[inline(always)]
    fn bit_length(self) -> u32 {
        let high = (self >> 64) as u64;
        if HAS_INSTRUCTION {
            Self::BITS - self.leading_zeros()
        } else if high != 0 {
            64 + high.bit_length()
        } else {
            (self as u64).bit_length()
        }
    }
}

#[inline(always)]
fn by_table(value: u32) -> u32 {
    let (value, above) = if value >> 16 == 0 { (value, 0) } else { (value >> 16, 16) };
    let (byte, above) = if value >> 8 == 0 { (value, above) } else { (value >> 8, above + 8) };
    above + byte_length(byte)
}

/// The number of bits of a value below 2^8; others are cut.
#[inline(always)]
pub fn byte_length(byte: u32) -> u32 {
    if HAS_INSTRUCTION { u32::BITS - (byte & 0xff).leading_zeros() } else { LENGTHS[byte as usize & 0xff].into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_counts_as_the_instruction_does() {
        for shift in 0..32 {
            for value in [1u32 << shift, (1 << shift) - 1, (1 << shift) + 1, u32::MAX >> shift] {
                assert_eq!(by_table(value), u32::BITS - value.leading_zeros(), "{value:#x}");
                let wide = u64::from(value) << 29;
                assert_eq!(wide.bit_length(), u64::BITS - wide.leading_zeros(), "{wide:#x}");
            }
        }
    }
}
