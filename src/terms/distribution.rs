//! D: the distribution of microfacet slopes, in the five forms that the literature calls by that letter.

use crate::quantity::HalfAngles;
use crate::quantity::named;

named! {
    /// The form of D and with it the meaning of `roughness`, which grows with roughness in all of them.
    Distribution, "distribution" {
        /// exp(-ln2 phi^2 / r^2); r is the half width at half height, rad.
        GaussianHalfHeight = "gaussian-half-height",
        /// exp(-phi^2 / r^2); r in rad.
        Gaussian = "gaussian",
        /// exp(-(phi_deg / r)^2); r = 1/c of Torrance and Sparrow 1967, degrees.
        TorranceSparrow1967 = "torrance-sparrow-1967",
        /// exp(-tan^2 phi / r^2) / (pi r^2 cos^4 phi); r = m, the r.m.s. slope times sqrt(2).
        Beckmann = "beckmann",
        /// r^2 / (pi (sin^2 phi + r^2 cos^2 phi)^2), "GGX"; r = alpha.
        TrowbridgeReitz = "trowbridge-reitz",
    }
}

/// A value of D with its derivative in the logarithm of the roughness (finite where that in r overflows).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistributionValue {
    /// D, sr-1 for the normalised forms, dimensionless for the three Gaussians.
    pub value: f64,
    /// dD / d(ln r).
    pub by_log_roughness: f64,
}

impl Distribution {
    /// The unit of `roughness`.
    #[must_use]
    pub const fn roughness_unit(self) -> &'static str {
        match self {
            Self::GaussianHalfHeight | Self::Gaussian => "rad",
            Self::TorranceSparrow1967 => "degree",
            Self::Beckmann | Self::TrowbridgeReitz => "1",
        }
    }

    /// The roughness of this form whose lobe is as wide as the Gaussian of half width `half_width` (rad) at half
    /// height, near its centre. Used to place starting grids; it converts no fitted value.
    #[must_use]
    pub fn roughness_from_half_width(self, half_width: f64) -> f64 {
        let width = half_width / std::f64::consts::LN_2.sqrt();
        match self {
            Self::GaussianHalfHeight => half_width,
            Self::Gaussian | Self::Beckmann => width,
            Self::TorranceSparrow1967 => width.to_degrees(),
            // 1/(1 + x^2/r^2)^2 is one half at x = 0.6436 r.
            Self::TrowbridgeReitz => half_width / 0.643_594_252_905_582_6,
        }
    }

    /// D and its derivative at a half-vector angle, for a positive `roughness` in this form's unit.
    ///
    /// Relative error of a few 1e-15 times 1 + |ln D|; where D underflows both are exactly 0, never NaN.
    #[must_use]
    pub fn evaluate(self, half: &HalfAngles, roughness: f64) -> DistributionValue {
        match self {
            Self::GaussianHalfHeight => gaussian(half.phi / roughness, std::f64::consts::LN_2),
            Self::Gaussian => gaussian(half.phi / roughness, 1.0),
            Self::TorranceSparrow1967 => gaussian(half.phi.to_degrees() / roughness, 1.0),
            Self::Beckmann => beckmann(half, roughness),
            Self::TrowbridgeReitz => trowbridge_reitz(half, roughness),
        }
    }
}

fn gaussian(ratio: f64, factor: f64) -> DistributionValue {
    let exponent = factor * ratio * ratio;
    let value = (-exponent).exp();
    // An infinite exponent times an underflown exponential is 0, not NaN.
    let by_log_roughness = if value == 0.0 { 0.0 } else { 2.0 * exponent * value };
    DistributionValue { value, by_log_roughness }
}

fn beckmann(half: &HalfAngles, roughness: f64) -> DistributionValue {
    if half.cos_phi <= 0.0 {
        return DistributionValue { value: 0.0, by_log_roughness: 0.0 };
    }
    let slope = half.sin_phi / half.cos_phi / roughness;
    let exponent = slope * slope;
    // The square root of D: neither the exponential nor 1/(r^2 cos^4) leaves the range before D itself does.
    let root = (-exponent / 2.0).exp() / roughness / (half.cos_phi * half.cos_phi);
    if root == 0.0 || root.is_nan() {
        return DistributionValue { value: 0.0, by_log_roughness: 0.0 };
    }
    let value = root * root / std::f64::consts::PI;
    DistributionValue { value, by_log_roughness: value * (2.0 * exponent - 2.0) }
}

fn trowbridge_reitz(half: &HalfAngles, roughness: f64) -> DistributionValue {
    let along = roughness * half.cos_phi;
    let radius = half.sin_phi.hypot(along);
    if radius == 0.0 {
        return DistributionValue { value: 0.0, by_log_roughness: 0.0 };
    }
    let root = roughness / radius / radius;
    let value = root * root / std::f64::consts::PI;
    let share = along / radius;
    DistributionValue { value, by_log_roughness: value * (2.0 - 4.0 * share * share) }
}
