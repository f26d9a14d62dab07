//! Numbers as they are printed: value, and how fine the print is.

/// A decimal mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum DecimalMark {
    /// `.`
    Point,
    /// `,`
    Comma,
}

/// A number with the step of its last printed digit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Printed {
    /// The value.
    pub(crate) value: f64,
    /// One unit of the last printed digit; rounding to it has the standard uncertainty step/sqrt(12).
    pub(crate) step: f64,
    /// Digits after the decimal mark.
    pub(crate) decimals: u32,
    /// Number of digits of the exponent; 0 where there is none.
    pub(crate) exponent_digits: u32,
}

/// Reads `[+-]digits[mark digits][(E|D)[+-]digits]`; `None` for anything else, for `nan`, and beyond the range of f64.
pub(crate) fn printed(text: &str, mark: DecimalMark) -> Option<Printed> {
    let text = text.trim();
    if text.len() > 400 {
        return None;
    }
    let (mantissa, exponent) = match text.find(['e', 'E', 'd', 'D']) {
        Some(at) => (&text[..at], Some(&text[at + 1..])),
        None => (text, None),
    };
    let mark = if mark == DecimalMark::Point { '.' } else { ',' };
    let unsigned = mantissa.strip_prefix(['+', '-']).unwrap_or(mantissa);
    let (whole, fraction) = unsigned.split_once(mark).unwrap_or((unsigned, ""));
    let digits_only = |part: &str| part.bytes().all(|byte| byte.is_ascii_digit());
    if !(digits_only(whole) && digits_only(fraction)) || whole.len() + fraction.len() == 0 {
        return None;
    }
    let (power, exponent_digits) = match exponent {
        Some(exponent) => exponent_of(exponent)?,
        None => (0, 0),
    };
    let sign = if mantissa.starts_with('-') { "-" } else { "" };
    let value: f64 = format!("{sign}{whole}.{fraction}e{power}").replace("..", ".").parse().ok()?;
    let decimals = u32::try_from(fraction.len()).ok()?;
    let step: f64 = format!("1e{}", i64::from(power) - i64::from(decimals)).parse().ok()?;
    value.is_finite().then_some(Printed { value, step, decimals, exponent_digits })
}

fn exponent_of(text: &str) -> Option<(i32, u32)> {
    let digits = text.strip_prefix(['+', '-']).unwrap_or(text);
    let plain = !digits.is_empty() && digits.len() <= 4 && digits.bytes().all(|byte| byte.is_ascii_digit());
    let power: i32 = if plain { text.parse().ok()? } else { return None };
    Some((power, u32::try_from(digits.len()).ok()?))
}

/// The value of a number with a decimal point.
pub(crate) fn value(text: &str) -> Option<f64> {
    printed(text, DecimalMark::Point).map(|printed| printed.value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prints_have_a_value_and_a_step() {
        let cases = [
            ("1.234E-05", 1.234e-5, 1e-8),
            ("1.627e-007", 1.627e-7, 1e-10),
            ("0380.", 380.0, 1.0),
            (".3219", 0.3219, 1e-4),
            ("-1.5D+01", -15.0, 1.0),
            ("0.000025", 0.000_025, 1e-6),
        ];
        for (text, value, step) in cases {
            let found = printed(text, DecimalMark::Point).unwrap();
            assert_eq!((found.value, found.step), (value, step), "{text}");
        }
        assert_eq!(printed("1,5E-07", DecimalMark::Comma).unwrap().value, 1.5e-7);
    }

    #[test]
    fn what_is_no_number_is_none() {
        for text in ["", ".", "NaN", "inf", "1.627e-", "1e99999", "1e999", "1.2.3", "0x10", "1 2", "+-1", "e5", "--1"] {
            assert_eq!(printed(text, DecimalMark::Point), None, "{text}");
        }
    }
}
