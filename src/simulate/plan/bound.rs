//! What a picture may change by when something is left out of it.

/// What no pixel changes by more than; infinite where nothing bounds it.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, schemars::JsonSchema)]
pub struct Bound {
    /// Radiance at any wavelength over the largest that a perfect diffuser facing all lights has.
    #[schemars(with = "Option<f64>")]
    pub radiance: f64,
    /// Luminance over that of white.
    #[schemars(with = "Option<f64>")]
    pub luminance: f64,
    /// CIELAB distance of 1976.
    #[schemars(with = "Option<f64>")]
    pub delta_e: f64,
    /// CIEDE2000 where the largest distance occurs that was met in the proof: reported, and no bound, for its formula has jumps.
    pub ciede2000_there: Option<f64>,
}

impl Bound {
    /// Nothing at all.
    pub const ZERO: Self = Self { radiance: 0.0, luminance: 0.0, delta_e: 0.0, ciede2000_there: None };

    pub(super) fn larger(self, other: Self) -> Self {
        let which = if other.delta_e > self.delta_e { other.ciede2000_there } else { self.ciede2000_there };
        Self {
            radiance: self.radiance.max(other.radiance),
            luminance: self.luminance.max(other.luminance),
            delta_e: self.delta_e.max(other.delta_e),
            ciede2000_there: which,
        }
    }

    /// Nothing bounds it.
    pub(super) const UNKNOWN: Self =
        Self { radiance: f64::INFINITY, luminance: f64::INFINITY, delta_e: f64::INFINITY, ciede2000_there: None };

    /// True where no pixel changes.
    #[must_use]
    pub fn is_zero(&self) -> bool {
        self.radiance == 0.0 && self.delta_e == 0.0
    }
}
