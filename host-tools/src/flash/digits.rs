//! From [digits](firmware_rt::digits) back to bytes, as they come.

use firmware_rt::digits::value;

use crate::emulate::EmulateError;

/// Puts bytes together.
#[derive(Clone, Copy, Debug, Default)]
pub struct Digits {
    /// A digit whose other one has not come.
    high: Option<u8>,
}

impl Digits {
    /// Takes what has come, in pieces of any size; the bytes that are whole.
    ///
    /// # Errors
    /// Where it is no digit.
    pub fn take(&mut self, text: &[u8]) -> Result<Vec<u8>, EmulateError> {
        let mut bytes = Vec::with_capacity(text.len() / 2 + 1);
        for &digit in text {
            let value = value(digit).ok_or(EmulateError::Damaged("no hexadecimal digit where one should be"))?;
            match self.high.take() {
                None => self.high = Some(value),
                Some(high) => bytes.push(high << 4 | value),
            }
        }
        Ok(bytes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bytes_come_back_in_pieces_of_any_size() {
        let bytes: Vec<u8> = (0..=u8::MAX).collect();
        let text: Vec<u8> = bytes.iter().flat_map(|&byte| firmware_rt::digits::of(byte)).collect();
        for size in [1, 2, 3, 7, 512] {
            let mut digits = Digits::default();
            let found: Vec<u8> = text.chunks(size).flat_map(|piece| digits.take(piece).unwrap()).collect();
            assert_eq!(found, bytes, "{size}");
        }
        // What probe-rs puts in a byte's place that is no UTF-8.
        assert!(Digits::default().take("\u{fffd}".as_bytes()).is_err());
    }
}
