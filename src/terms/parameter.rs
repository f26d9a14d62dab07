//! Each parameter of a term, declared once: name, unit, bounds, source.

use super::{Distribution, TermKind};

/// What the standard says of a parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parameter {
    /// Name in files, JSON, CSV and on the command line.
    pub name: &'static str,
    /// Symbol in the literature.
    pub symbol: &'static str,
    /// Smallest value allowed, excluded where `lower_excluded`.
    pub lower: f64,
    /// True where the lower bound itself is not allowed.
    pub lower_excluded: bool,
    /// True where the term is proportional to the parameter.
    pub linear: bool,
    /// What it is, with its source.
    pub meaning: &'static str,
}

/// Lambertian reflectance.
pub const ALBEDO: Parameter = Parameter {
    name: "albedo",
    symbol: "S_r",
    lower: 0.0,
    lower_excluded: false,
    linear: true,
    meaning: "reflected radiance factor of the diffuse term (Tominaga et al., eq. 3)",
};

/// Luminescent amplitude under one light.
pub const LUMINESCENT_FACTOR: Parameter = Parameter {
    name: "factor",
    symbol: "beta_L",
    lower: 0.0,
    lower_excluded: false,
    linear: true,
    meaning: "luminescent radiance factor under the light of the measurement: the integral of S_l E over excitation, \
              over E at the emission wavelength (eq. 2; CIE S 017 term 17-24-065)",
};

/// Specular intensity.
pub const INTENSITY: Parameter = Parameter {
    name: "intensity",
    symbol: "c_s",
    lower: 0.0,
    lower_excluded: false,
    linear: true,
    meaning: "specular intensity coefficient (eq. 4); not comparable across roughness for the three Gaussian \
              distributions without a norm",
};

/// Roughness of the named distribution.
pub const ROUGHNESS: Parameter = Parameter {
    name: "roughness",
    symbol: "r",
    lower: 0.0,
    lower_excluded: true,
    linear: false,
    meaning: "width parameter of the named distribution, in its unit; grows with roughness",
};

/// Refractive index.
pub const REFRACTIVE_INDEX: Parameter = Parameter {
    name: "refractive_index",
    symbol: "n",
    lower: 1.0,
    lower_excluded: true,
    linear: false,
    meaning: "refractive index of the dielectric against air (eq. 4)",
};

impl Parameter {
    /// The unit, given the distribution (the roughness has the distribution's).
    #[must_use]
    pub fn unit(&self, distribution: Option<Distribution>) -> &'static str {
        if self.name == ROUGHNESS.name { distribution.map_or("1", Distribution::roughness_unit) } else { "1" }
    }

    /// True where the standard allows the value.
    #[must_use]
    pub fn allows(&self, value: f64) -> bool {
        value.is_finite() && (value > self.lower || (value == self.lower && !self.lower_excluded))
    }
}

impl TermKind {
    /// The parameters of a term, in their order in files and covariances.
    #[must_use]
    pub const fn parameters(self) -> &'static [Parameter] {
        match self {
            Self::Lambertian => &[ALBEDO],
            Self::Luminescent => &[LUMINESCENT_FACTOR],
            Self::TorranceSparrow => &[INTENSITY, ROUGHNESS, REFRACTIVE_INDEX],
        }
    }
}
