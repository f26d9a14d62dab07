//! D: the distribution of microfacet slopes, in the six forms that the literature calls by that letter.

use super::gaussian_integral::{GaussianIntegral, gaussian_integral};
use crate::quantity::{HalfAngles, named};

named! {
    /// The form of D and with it the meaning of `roughness`, which grows with roughness in all of them.
    Distribution, "distribution" {
        /// exp(-ln2 phi^2 / r^2); r is the half width at half height, rad.
        GaussianHalfHeight = "gaussian-half-height",
        /// exp(-phi^2 / r^2); r in rad.
        Gaussian = "gaussian",
        /// exp(-(phi_deg / r)^2); r = 1/c of Torrance and Sparrow 1967, degrees.
        TorranceSparrow1967 = "torrance-sparrow-1967",
        /// exp(-phi^2 / r^2) / N(r), N(r) the integral of exp(-phi^2 / r^2) cos(phi) over the hemisphere; r in rad.
        GaussianNormalised = "gaussian-normalised",
        /// exp(-tan^2 phi / r^2) / (pi r^2 cos^4 phi); r = m, the r.m.s. slope times sqrt(2).
        Beckmann = "beckmann",
        /// r^2 / (pi (sin^2 phi + r^2 cos^2 phi)^2), "GGX"; r = alpha.
        TrowbridgeReitz = "trowbridge-reitz",
    }
}

/// A value of D with its derivative in the logarithm of the roughness (finite where that in r overflows).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DistributionValue {
    /// D, sr-1 for the normalised forms, dimensionless for the three Gaussians without a norm.
    pub value: f64,
    /// dD / d(ln r).
    pub by_log_roughness: f64,
}

impl Distribution {
    /// The unit of `roughness`.
    #[must_use]
    pub const fn roughness_unit(self) -> &'static str {
        match self {
            Self::GaussianHalfHeight | Self::Gaussian | Self::GaussianNormalised => "rad",
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
            Self::Gaussian | Self::GaussianNormalised | Self::Beckmann => width,
            Self::TorranceSparrow1967 => width.to_degrees(),
            // 1/(1 + x^2/r^2)^2 is one half at x = 0.6436 r.
            Self::TrowbridgeReitz => half_width / 0.643_594_252_905_582_6,
        }
    }

    /// The width w, rad, of the Gaussian exp(-phi^2 / w^2) that this form is at a roughness, up to a factor; `None` for a
    /// form that is no Gaussian of the angle.
    #[must_use]
    pub fn gaussian_width(self, roughness: f64) -> Option<f64> {
        match self {
            Self::GaussianHalfHeight => Some(roughness / std::f64::consts::LN_2.sqrt()),
            Self::Gaussian | Self::GaussianNormalised => Some(roughness),
            Self::TorranceSparrow1967 => Some(roughness.to_radians()),
            Self::Beckmann | Self::TrowbridgeReitz => None,
        }
    }

    /// This form at one roughness, in its unit.
    #[must_use]
    pub fn lobe(self, roughness: f64) -> Lobe {
        let norm = (self == Self::GaussianNormalised).then(|| gaussian_integral(roughness));
        Lobe { distribution: self, roughness, norm }
    }

    /// D and its derivative at a half-vector angle, for a positive `roughness` in this form's unit; as
    /// [`Lobe::evaluate`].
    #[must_use]
    pub fn evaluate(self, half: &HalfAngles, roughness: f64) -> DistributionValue {
        self.lobe(roughness).evaluate(half)
    }
}

/// A form of D at one roughness, with what depends on the roughness alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    distribution: Distribution,
    roughness: f64,
    norm: Option<GaussianIntegral>,
}

impl Lobe {
    /// D and its derivative at a half-vector angle.
    ///
    /// Relative error of a few 1e-15 times 1 + |ln D|; where D underflows both are exactly 0, never NaN.
    #[must_use]
    pub fn evaluate(&self, half: &HalfAngles) -> DistributionValue {
        let roughness = self.roughness;
        match (self.distribution, self.norm) {
            (Distribution::GaussianHalfHeight, _) => gaussian(half.phi / roughness, std::f64::consts::LN_2),
            (Distribution::GaussianNormalised, Some(norm)) => normalised(half.phi / roughness, roughness, &norm),
            (Distribution::Gaussian | Distribution::GaussianNormalised, _) => gaussian(half.phi / roughness, 1.0),
            (Distribution::TorranceSparrow1967, _) => gaussian(half.phi.to_degrees() / roughness, 1.0),
            (Distribution::Beckmann, _) => beckmann(half, roughness),
            (Distribution::TrowbridgeReitz, _) => trowbridge_reitz(half, roughness),
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

fn normalised(ratio: f64, roughness: f64, norm: &GaussianIntegral) -> DistributionValue {
    let exponent = ratio * ratio;
    // The square root of D, as below; N is r^2 times `over_square`, whose square r^2 leaves the range before D does.
    let root = (-exponent / 2.0).exp() / roughness / norm.over_square.sqrt();
    if root == 0.0 || root.is_nan() {
        return DistributionValue { value: 0.0, by_log_roughness: 0.0 };
    }
    let value = root * root;
    DistributionValue { value, by_log_roughness: value * (2.0 * exponent - norm.by_log_width) }
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
