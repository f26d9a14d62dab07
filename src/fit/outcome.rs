//! What a fit returns: an outcome is a value, also when the data cannot tell.

use super::left_out::LeftOut;

/// Why a fit stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Stop {
    /// The predicted decrease of chi-square fell below the tolerance ([`super::Effort`]).
    Converged,
    /// The same, with roughness or index on the edge of its box: the minimum lies outside, if there is one.
    AtBound,
    /// Only amplitudes were fitted: solved exactly.
    Linear,
    /// A lower chi-square is predicted, and no step reaches it.
    Stalled,
    /// The limit of evaluations was reached.
    EvaluationLimit,
}

impl Stop {
    /// True when the fit ended at a minimum inside the box.
    #[must_use]
    pub const fn is_converged(self) -> bool {
        matches!(self, Self::Converged | Self::Linear)
    }

    /// The reason in words.
    #[must_use]
    pub const fn text(self) -> &'static str {
        match self {
            Self::Converged => "converged",
            Self::AtBound => "stopped on the edge of the parameter box",
            Self::Linear => "solved exactly (linear)",
            Self::Stalled => "stopped where a lower chi-square is predicted and no step reaches it",
            Self::EvaluationLimit => "stopped at the limit of evaluations",
        }
    }
}

/// The fit of one emission value.
#[derive(Debug, Clone, PartialEq)]
pub struct BandFit {
    /// Amplitude of the diffuse term, in the unit of the values; 0 when it was not fitted.
    pub diffuse: f64,
    /// Amplitude of the specular term, in the unit of the values; 0 when it was not fitted or not seen.
    pub intensity: f64,
    /// Weighted sum of squared residuals (of plain squares, where no uncertainty was given).
    pub chi_square: f64,
    /// Number of values used.
    pub count: usize,
    /// Covariance of (diffuse, intensity, roughness, index); NaN where the data cannot tell or the parameter ended on a
    /// bound, 0 where not fitted.
    pub covariance: [[f64; 4]; 4],
}

/// The fit of one or several emission values with a common roughness and index.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Roughness in the unit of the distribution; NaN without a specular term.
    pub roughness: f64,
    /// n - 1; NaN without a specular term.
    pub index_minus_one: f64,
    /// One per emission value.
    pub bands: Vec<BandFit>,
    /// Chi-square over all emission values.
    pub chi_square: f64,
    /// Number of values minus number of fitted parameters.
    pub degrees_of_freedom: f64,
    /// What chi-square would rise by without the specular term, in units of the reduced chi-square where no
    /// uncertainty was given; 0 when it was not fitted.
    pub specular_gain: f64,
    /// Standard uncertainties of ln(roughness) and ln(n - 1); NaN where the data cannot tell.
    pub log_sigma: [f64; 2],
    /// Singular values of the common columns (specular amplitude where it is shared, roughness, index), each scaled to
    /// unit length, beside all other parameters: near 0 is a combination that the data cannot tell. Empty without a
    /// specular term.
    pub singular_values: Vec<f64>,
    /// Why the fit stopped.
    pub stop: Stop,
    /// True for roughness and index where the data ask for a value beyond the searched box: the number is the edge, and
    /// its uncertainty is NaN.
    pub at_bound: [bool; 2],
    /// Number of evaluations after the starting grid.
    pub evaluations: usize,
    /// How many values were not used, by reason.
    pub left_out: LeftOut,
}

impl Fit {
    /// True when a specular term is part of the result.
    #[must_use]
    pub fn has_specular(&self) -> bool {
        self.bands.iter().any(|band| band.intensity > 0.0)
    }

    /// n; NaN without a specular term.
    #[must_use]
    pub fn refractive_index(&self) -> f64 {
        1.0 + self.index_minus_one
    }

    /// Standard uncertainties of (diffuse, intensity, roughness, index) of one emission value.
    #[must_use]
    pub fn standard_uncertainty(&self, band: usize) -> [f64; 4] {
        let covariance = &self.bands[band].covariance;
        std::array::from_fn(|k| covariance[k][k].sqrt())
    }
}
