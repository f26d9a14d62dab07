//! Sines and cosines of angles in degrees, reduced *in degrees*.
//!
//! `cos(90 - 1e-12 degrees)` in radians loses four digits to the rounding of pi/2; here it keeps them all, because
//! `90 - x` is exact and the sine of a small angle has a small relative error.

const RADIANS_PER_DEGREE: f64 = std::f64::consts::PI / 180.0;

/// Sine of an angle in degrees; relative error a few units in the last place for every finite angle.
///
/// Exact at multiples of 30 degrees where the result is 0, 1/2 or 1. NaN for an infinite or NaN angle.
#[must_use]
pub fn sin_deg(degrees: f64) -> f64 {
    let turn = degrees % 360.0;
    let magnitude = turn.abs();
    let (folded, sign) = if magnitude > 180.0 { (360.0 - magnitude, -1.0) } else { (magnitude, 1.0) };
    let value = if folded <= 90.0 { sin_first_quadrant(folded) } else { sin_first_quadrant(180.0 - folded) };
    sign * value * 1.0_f64.copysign(turn)
}

/// Cosine of an angle in degrees; relative error a few units in the last place for every finite angle.
#[must_use]
pub fn cos_deg(degrees: f64) -> f64 {
    let magnitude = (degrees % 360.0).abs();
    let folded = if magnitude > 180.0 { 360.0 - magnitude } else { magnitude };
    if folded <= 90.0 { sin_complement(folded) } else { -sin_first_quadrant(folded - 90.0) }
}

/// cos(x) = sin(90 - x): beyond 45 degrees the subtraction is exact.
fn sin_complement(degrees: f64) -> f64 {
    if degrees > 45.0 { sin_first_quadrant(90.0 - degrees) } else { cos_small(degrees) }
}

fn sin_first_quadrant(degrees: f64) -> f64 {
    if degrees == 30.0 {
        0.5
    } else if degrees <= 45.0 {
        (degrees * RADIANS_PER_DEGREE).sin()
    } else {
        cos_small(90.0 - degrees)
    }
}

fn cos_small(degrees: f64) -> f64 {
    (degrees * RADIANS_PER_DEGREE).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_its_digits_next_to_ninety_degrees() {
        // 90 - 1e-12 as a double is 90 - 9.94759830064140260219573974609375e-13; its cosine by mpmath, 60 digits.
        let theta = 90.0 - 1e-12;
        let reference = 1.736_183_430_119_852_3e-14;
        assert!((cos_deg(theta) / reference - 1.0).abs() < 4e-16, "{:e}", cos_deg(theta));
    }

    #[test]
    fn is_exact_where_the_result_is_simple() {
        for (angle, sine, cosine) in
            [(0.0, 0.0, 1.0), (90.0, 1.0, 0.0), (180.0, 0.0, -1.0), (270.0, -1.0, 0.0), (360.0, 0.0, 1.0)]
        {
            assert_eq!((sin_deg(angle), cos_deg(angle)), (sine, cosine), "{angle}");
        }
        assert_eq!(sin_deg(30.0), 0.5);
        assert_eq!(cos_deg(60.0), 0.5);
        assert_eq!(cos_deg(120.0), -0.5);
        assert_eq!(sin_deg(-30.0), -0.5);
    }
}
