//! What a residual costs: squares, a robust loss, or one side only.
//!
//! Each is fitted by least squares of *working* values and weights that are formed anew until they stand still (iteratively
//! reweighted least squares): the same start-free fit serves them all.

use libm::erfc;

use crate::dataset::Side;

/// What a residual costs.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Loss {
    /// Its square: right where the uncertainties are.
    #[default]
    Squares,
    /// Its square up to 1.345 standard deviations, then linear (Huber 1964): 95 % efficient, and an outlier has a bounded
    /// pull.
    Huber,
    /// Tukey's biweight (Beaton and Tukey 1974), 0 weight beyond 4.685 standard deviations, started from Huber's fit: an
    /// outlier has no pull at all.
    Tukey,
}

/// Huber's and Tukey's constants for 95 % efficiency at the normal distribution.
const HUBER: f64 = 1.345;
const TUKEY: f64 = 4.685;
/// The least weight: an outlier is kept, to be seen, with no pull.
const LEAST_WEIGHT: f64 = 1e-12;

impl Loss {
    /// The name on the command line and in a model's method.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Squares => "squares",
            Self::Huber => "huber",
            Self::Tukey => "tukey",
        }
    }

    /// psi(u)/u, the weight of a residual of u standard deviations.
    pub(super) fn weight(self, u: f64) -> f64 {
        let weight = match self {
            Self::Squares => 1.0,
            Self::Huber => (HUBER / u.abs()).min(1.0),
            Self::Tukey => (1.0 - (u / TUKEY).powi(2)).max(0.0).powi(2),
        };
        weight.max(LEAST_WEIGHT)
    }

    /// psi'(u), by which the loss is curved.
    pub(super) fn curvature(self, u: f64) -> f64 {
        match self {
            Self::Squares => 1.0,
            Self::Huber => f64::from(u8::from(u.abs() <= HUBER)),
            Self::Tukey => {
                let square = (u / TUKEY).powi(2);
                if square < 1.0 { (1.0 - square) * (1.0 - 5.0 * square) } else { 0.0 }
            }
        }
    }
}

/// The normal density over the normal distribution function at z, and ln of the latter: finite and accurate for every
/// finite z.
pub(super) fn inverse_mills(z: f64) -> (f64, f64) {
    let log_density = -0.5 * z * z - 0.918_938_533_204_672_8;
    if z > -8.0 {
        let below = 0.5 * erfc(-z / std::f64::consts::SQRT_2);
        // Near 1 the logarithm of 1 minus a small number.
        let log_below = if z > 1.0 { (-0.5 * erfc(z / std::f64::consts::SQRT_2)).ln_1p() } else { below.ln() };
        return (log_density.exp() / below, log_below);
    }
    // Laplace's continued fraction of the tail: no two numbers that nearly cancel, nothing that underflows.
    let ratio = (1..=60).rev().fold(-z, |tail, k| -z + f64::from(k) / tail);
    (ratio, log_density - ratio.ln())
}

/// A working value and weight for a prediction and a bound, both in standard uncertainties: the parabola that has the
/// slope and the curvature of -2 ln of the probability.
pub(super) fn one_sided(side: Side, prediction: f64, bound: f64) -> Working {
    let sign = if side == Side::AtMost { 1.0 } else { -1.0 };
    let z = sign * (bound - prediction);
    let (h, log_probability) = inverse_mills(z);
    // h + z = 0 to rounding where the bound is far exceeded: there the loss is a square, whose minimum is the bound.
    let slope = (h + z).max(-1.0 / z.min(-1.0) / 2.0);
    let weight = (h * slope).min(1.0);
    if weight < LEAST_WEIGHT {
        return Working { value: prediction, weight: LEAST_WEIGHT, cost: -2.0 * log_probability };
    }
    Working { value: prediction - sign / slope, weight, cost: -2.0 * log_probability }
}

/// The same with weight 1, which never overshoots: the expected reading (Dempster, Laird and Rubin 1977).
pub(super) fn expected(side: Side, prediction: f64, bound: f64) -> f64 {
    let sign = if side == Side::AtMost { 1.0 } else { -1.0 };
    prediction - sign * inverse_mills(sign * (bound - prediction)).0
}

/// What stands for a value in one pass of least squares, in standard uncertainties.
#[derive(Debug, Clone, Copy)]
pub(super) struct Working {
    pub(super) value: f64,
    pub(super) weight: f64,
    /// What the value costs now.
    pub(super) cost: f64,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// mpmath 1.3 in 60 digits: `exp(-z*z/2)/sqrt(2*pi)/c` and `log(c)` of `c = erfc(-z/sqrt(2))/2`.
    #[test]
    #[allow(clippy::excessive_precision, clippy::approx_constant, reason = "as the reference prints them")]
    fn the_tail_of_the_normal_distribution_keeps_its_digits() {
        for (z, ratio, log) in [
            (-1e6, 1_000_000.000_001, -500_000_000_014.734_449),
            (-40.0, 40.024_968_847_207_264, -804.608_442_013_753_8),
            (-8.5, 8.614_595_320_165_173, -39.197_396_428_217_67),
            (-7.5, 7.628_966_391_103_766, -31.075_890_902_890_001),
            (-1.0, 1.525_135_276_160_981_2, -1.841_021_645_009_264),
            (0.0, 0.797_884_560_802_865_4, -0.693_147_180_559_945_3),
            (2.0, 0.055_247_862_678_989_0, -0.023_012_909_328_963_49),
            (10.0, 7.694_598_626_706_419e-23, -7.619_853_024_160_526e-24),
        ] {
            let (found, found_log) = inverse_mills(z);
            assert!((found / ratio - 1.0_f64).abs() < 1e-13, "{z}: {found} {ratio}");
            assert!((found_log / log - 1.0_f64).abs() < 1e-13, "{z}: {found_log} {log}");
        }
    }
}
