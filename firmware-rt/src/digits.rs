//! Bytes as text: two hexadecimal digits each, in lower case.
//!
//! A picture leaves by RTT in this form. What runs firmware by a probe (`probe-rs run`) takes every channel but the log's for
//! UTF-8, and replaces what is none.

/// The digits of a byte, the high one first.
#[must_use]
pub const fn of(byte: u8) -> [u8; 2] {
    [digit(byte >> 4), digit(byte & 0xf)]
}

const fn digit(value: u8) -> u8 {
    // value < 16: 'f' is the last.
    if value < 10 { b'0' + value } else { b'a' - 10 + value }
}

/// The value of a digit; `None` where it is none.
#[must_use]
pub const fn value(digit: u8) -> Option<u8> {
    match digit {
        b'0'..=b'9' => Some(digit - b'0'),
        b'a'..=b'f' => Some(digit - b'a' + 10),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_is_what_the_standard_library_writes() {
        for byte in 0..=u8::MAX {
            assert_eq!(of(byte), format!("{byte:02x}").as_bytes());
            assert_eq!(of(byte).map(value), [Some(byte >> 4), Some(byte & 0xf)]);
        }
    }

    #[test]
    fn there_are_16_digits() {
        assert_eq!((0..=u8::MAX).filter(|&digit| value(digit).is_some()).count(), 16);
    }
}
