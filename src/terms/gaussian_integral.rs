//! N(w): the integral of exp(-phi^2 / w^2) cos(phi) over the hemisphere, by which a Gaussian of the angle is normalised.
//!
//! N(w) = pi times the integral of exp(-phi^2 / w^2) sin(2 phi) over phi from 0 to pi/2. Where the Gaussian has ended
//! before pi/2 the upper limit may be infinity, and N(w) = pi w F(w) with Dawson's function F(w) = w (1 - 2 w^2/3 +
//! 4 w^4/15 - ...). For a wider one Gauss's rule over the fixed interval sums positive numbers alone. Both keep N / w^2,
//! which has a limit (pi) at w = 0 where N has none of its digits left.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::LazyLock;

use super::quadrature::gauss;

/// Up to this width, rad, what lies beyond pi/2 is below 1e-17 of N.
const WIDEST_DAWSON: f64 = 0.25;
/// Terms of the series: the next one is below 1e-17 at the width above.
const SERIES: u32 = 10;
/// Points of Gauss's rule: exp(-39 u^2) needs them all on [0, 1].
const POINTS: usize = 36;

/// N with its derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GaussianIntegral {
    /// N(w), sr; 0 where it underflows.
    pub value: f64,
    /// N(w) / w^2, which keeps its digits where N underflows.
    pub over_square: f64,
    /// d(ln N) / d(ln w): 2 for a narrow Gaussian, 0 for a wide one.
    pub by_log_width: f64,
}

/// phi^2, and pi sin(2 phi) times the weight of the rule.
static RULE: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    gauss::<POINTS>(&[0.0, FRAC_PI_2]).map(|(phi, weight)| (phi * phi, PI * weight * (2.0 * phi).sin())).collect()
});

/// N(w) for a positive width in rad. Relative error of N below 2e-15.
#[must_use]
pub fn gaussian_integral(width: f64) -> GaussianIntegral {
    if width <= WIDEST_DAWSON { narrow(width) } else { wide(width) }
}

/// pi w F(w). With F = w S(w): F' = 1 - 2 w F, so that d(ln N)/d(ln w) = 1 + w F'/F = 1 + 1/S - 2 w^2.
fn narrow(width: f64) -> GaussianIntegral {
    let square = width * width;
    let ratio = |k: u32| -2.0 * square / f64::from(2 * k + 1);
    // From the last term inwards: 1 + ratio(1) (1 + ratio(2) (1 + ...)).
    let series = (1..=SERIES).rev().fold(1.0, |sum, k| 1.0 + ratio(k) * sum);
    let over_square = PI * series;
    GaussianIntegral { value: over_square * square, over_square, by_log_width: 1.0 + series.recip() - 2.0 * square }
}

fn wide(width: f64) -> GaussianIntegral {
    let (mut value, mut slope) = (0.0, 0.0);
    for &(phi_square, weight) in RULE.iter() {
        let exponent = phi_square / width / width;
        let part = weight * (-exponent).exp();
        value += part;
        slope += 2.0 * exponent * part;
    }
    GaussianIntegral { value, over_square: value / width / width, by_log_width: slope / value }
}
