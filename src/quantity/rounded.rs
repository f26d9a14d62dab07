//! A value with its standard uncertainty for people: both to the same decimal place.

/// From this size on, and below its inverse's last places, powers of ten are written out apart.
const PLAIN: std::ops::RangeInclusive<i32> = -9..=5;

/// `0.96827 ± 0.00018`: the uncertainty to two significant digits, the value to the same place. Very large and very small
/// ones share a power of ten, `(1.2345 ± 0.0012)e-12`. `None` where either is no finite number or the uncertainty is 0.
#[must_use]
pub fn rounded_with_uncertainty(value: f64, sigma: f64) -> Option<String> {
    if !(value.is_finite() && sigma.is_finite() && sigma > 0.0) {
        return None;
    }
    let last = last_place(sigma);
    if PLAIN.contains(&last) {
        let (value, sigma, decimals) = (to_place(value, last), to_place(sigma, last), (-last).max(0) as usize);
        return Some(format!("{value:.decimals$} ± {sigma:.decimals$}"));
    }
    let exponent = value.abs().max(sigma).log10().floor() as i32;
    let decimals = (exponent - last).clamp(0, 17) as usize;
    let scaled = |number: f64| number / 10f64.powi(exponent);
    Some(format!("({:.decimals$} ± {:.decimals$})e{exponent}", scaled(value), scaled(sigma)))
}

/// The power of ten of the second digit of a positive number, as it is after rounding: 9.96 becomes 10, not 10.0.
fn last_place(sigma: f64) -> i32 {
    let last = sigma.log10().floor() as i32 - 1;
    let digits = (sigma / 10f64.powi(last)).round();
    if digits >= 100.0 { last + 1 } else { last }
}

/// A number rounded to a power of ten above 1; smaller ones are left to the formatting.
fn to_place(number: f64, last: i32) -> f64 {
    if last <= 0 { number } else { (number / 10f64.powi(last)).round() * 10f64.powi(last) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn value_and_uncertainty_end_at_the_same_place() {
        for (value, sigma, text) in [
            (0.968_268, 1.76e-4, "0.96827 ± 0.00018"),
            (1.995_608, 4.28e-3, "1.9956 ± 0.0043"),
            (-12.3, 2.5, "-12.3 ± 2.5"),
            (1234.5, 120.0, "1230 ± 120"),
            (0.5, 0.0996, "0.50 ± 0.10"),
            (0.0, 0.3, "0.00 ± 0.30"),
            (1.2345e-12, 1.2e-15, "(1.2345 ± 0.0012)e-12"),
            (4.0e12, 3.0e9, "(4.0000 ± 0.0030)e12"),
        ] {
            assert_eq!(rounded_with_uncertainty(value, sigma).as_deref(), Some(text));
        }
    }

    #[test]
    fn what_is_not_known_is_not_rounded() {
        for (value, sigma) in [(1.0, f64::NAN), (1.0, 0.0), (f64::NAN, 1.0), (1.0, f64::INFINITY)] {
            assert_eq!(rounded_with_uncertainty(value, sigma), None);
        }
        assert!(rounded_with_uncertainty(1e308, 5e-324).is_some() && rounded_with_uncertainty(5e-324, 1e308).is_some());
    }
}
