//! Numbers as a person reads them.

/// A whole number with a comma between thousands.
pub(super) fn grouped(value: u64) -> String {
    let digits = value.to_string();
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// Three significant digits, none of them dropped before the decimal point: 0.0123, 1.23, 12.3, 1,235. A magnitude that
/// would take more than six zeros is written with a power of ten.
pub(super) fn significant(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".into();
    }
    if !size.is_finite() {
        return value.to_string();
    }
    if !(1e-6..1e15).contains(&size) {
        return format!("{value:.2e}");
    }
    if size >= 999.5 {
        let whole = grouped(size.round() as u64);
        return if value < 0.0 { format!("-{whole}") } else { whole };
    }
    // Of the rounded value, so that 9.999 is 10.0 and not 10.00.
    let rounded: f64 = format!("{size:.2e}").parse().unwrap_or(size);
    let magnitude = libm::floor(libm::log10(rounded)) as i32;
    format!("{value:.*}", (2 - magnitude).max(0) as usize)
}

/// A tick of an axis: a number that is short because it is round.
pub(super) fn tick(value: f64) -> String {
    let size = value.abs();
    if size >= 1e9 {
        format!("{}G", value / 1e9)
    } else if size >= 1e6 {
        format!("{}M", value / 1e6)
    } else if size >= 1e4 {
        format!("{}k", value / 1e3)
    } else if size >= 1e-4 || value == 0.0 {
        // Six digits hide what adding up ticks leaves behind.
        format!("{value:.6}").trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{value:.0e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_grouped_and_rounded() {
        assert_eq!([0, 999, 1000, 1_234_567].map(grouped), ["0", "999", "1,000", "1,234,567"]);
        let cases = [
            (0.0, "0"),
            (0.01234, "0.0123"),
            (0.1, "0.100"),
            (9.999, "10.0"),
            (99.96, "100"),
            (999.7, "1,000"),
            (123_456.7, "123,457"),
            (-12.34, "-12.3"),
            (-4321.0, "-4,321"),
            (1e-9, "1.00e-9"),
        ];
        for (value, text) in cases {
            assert_eq!(significant(value), text);
        }
        assert_eq!([0.0, 0.3, 0.001, 20_000.0, 5e6, 1e-7].map(tick), ["0", "0.3", "0.001", "20k", "5M", "1e-7"]);
    }
}
