//! Words of a CGATS line, and which of them name wavelengths.

use super::super::number::{DecimalMark, printed};

/// The parts of a line that look like numbers.
pub(super) fn spectral_text(text: &str) -> impl Iterator<Item = &str> {
    tokens(text).filter(|token| token.bytes().all(|b| b.is_ascii_digit() || b",.+-eE".contains(&b)))
}

/// Words divided by blanks; quotes hold words together.
pub(super) fn tokens(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        rest = rest.trim_start();
        let (token, after) = match rest.strip_prefix('"') {
            Some(quoted) => quoted.split_once('"').unwrap_or((quoted, "")),
            None if rest.is_empty() => return None,
            None => rest.split_at(rest.find(char::is_whitespace).unwrap_or(rest.len())),
        };
        rest = after;
        Some(token)
    })
}

/// The wavelength that a field is named after, nm.
pub(super) fn wavelength(field: &str) -> Option<f64> {
    let name = field.to_ascii_uppercase();
    let mut bare = name.as_str();
    for prefix in ["SPECTRAL_", "SPEC_", "NM_", "NM"] {
        bare = bare.strip_prefix(prefix).unwrap_or(bare);
    }
    for suffix in ["_NM", "NM"] {
        bare = bare.strip_suffix(suffix).unwrap_or(bare);
    }
    let plain = bare.len() < name.len() && bare.bytes().all(|byte| byte.is_ascii_digit() || byte == b'.');
    printed(bare, DecimalMark::Point).map(|nm| nm.value).filter(|nm| plain && (100.0..10_000.0).contains(nm))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_are_named_after_wavelengths_in_many_ways() {
        for name in ["SPECTRAL_NM380", "SPECTRAL_380", "SPEC_380", "nm380", "380_NM", "NM_380", "SPECTRAL_NM_380"] {
            assert_eq!(wavelength(name), Some(380.0), "{name}");
        }
        assert_eq!(wavelength("SPECTRAL_NM382.5"), Some(382.5));
        for name in ["380", "LAB_L", "XYZ_X", "SPECTRAL_NM", "NM7", "RGB_R", "SPECTRAL_DEC"] {
            assert_eq!(wavelength(name), None, "{name}");
        }
        let words: Vec<&str> = tokens("1 \"dark red\"\t0.1  \"\" x").collect();
        assert_eq!(words, ["1", "dark red", "0.1", "", "x"]);
    }
}
