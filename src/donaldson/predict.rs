//! What a surface radiates under a light: spectrum, radiance factors, colour, and what of the light was missing.
//!
//! Numbers are pi times the radiance, so that they compare with the irradiance: of the perfect diffuser they are equal. Elastic
//! light is a line at each wavelength that falls in, `elastic(em) E(em)`; luminescence is a density, the integral over the
//! excitation of `S_l(em, ex) E(ex)` (CIE ILV 17-21-101).

use super::colour::{Colour, Observer};
use super::steps;
use super::unlit::Unlit;
use crate::quantity::QuantityKind;

/// A prediction under one light.
#[derive(Debug, Clone, PartialEq)]
pub struct Prediction {
    /// The light.
    pub light: String,
    /// What its numbers are: where that is spectral-irradiance, all here are W m-2 nm-1; elsewhere they are relative.
    pub kind: QuantityKind,
    /// Centres of the emission, nm.
    pub emission_nm: Vec<f64>,
    /// What falls in, seen through the bandpass of the emission; 0 where the light has none.
    pub irradiance: Vec<f64>,
    /// Pi times the elastic radiance; NaN where the surface is not known.
    pub elastic: Vec<f64>,
    /// Its standard uncertainty.
    pub elastic_sigma: Vec<f64>,
    /// Pi times the luminescent radiance.
    pub luminescent: Vec<f64>,
    /// Its standard uncertainty.
    pub luminescent_sigma: Vec<f64>,
    /// That of their sum: what was measured together is better known than its parts.
    pub total_sigma: Vec<f64>,
    /// The same at every nanometre that an observer sees.
    pub visible: Visible,
    /// Where the light has no value and the matrix or the eye would have had a use for it.
    pub unlit: Vec<Unlit>,
    /// What each observer sees.
    pub(super) sums: Vec<(Observer, Option<Sums>)>,
}

/// Spectra at whole nanometres from 380 to 780: what colours are sums of.
#[derive(Debug, Clone, PartialEq)]
pub struct Visible {
    /// Wavelengths, nm.
    pub nm: Vec<f64>,
    /// What falls in.
    pub irradiance: Vec<f64>,
    /// Pi times the elastic radiance.
    pub elastic: Vec<f64>,
    /// Pi times the luminescent radiance.
    pub luminescent: Vec<f64>,
}

/// A colour with its covariance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sums {
    pub(super) colour: Colour,
    pub(super) covariance: [[f64; 3]; 3],
}

impl Prediction {
    /// Pi times the radiance of one emission.
    #[must_use]
    pub fn total(&self, emission: usize) -> f64 {
        self.elastic[emission] + self.luminescent[emission]
    }

    /// The total radiance factor with its standard uncertainty; `None` where no light falls in: there is radiance, but no ratio.
    #[must_use]
    pub fn factor(&self, emission: usize) -> Option<(f64, f64)> {
        self.over_light(emission, self.total(emission), self.total_sigma[emission])
    }

    /// Its elastic part.
    #[must_use]
    pub fn elastic_factor(&self, emission: usize) -> Option<(f64, f64)> {
        self.over_light(emission, self.elastic[emission], self.elastic_sigma[emission])
    }

    /// Its luminescent part.
    #[must_use]
    pub fn luminescent_factor(&self, emission: usize) -> Option<(f64, f64)> {
        self.over_light(emission, self.luminescent[emission], self.luminescent_sigma[emission])
    }

    fn over_light(&self, emission: usize, value: f64, sigma: f64) -> Option<(f64, f64)> {
        let light = self.irradiance[emission];
        (light > 0.0 && value.is_finite()).then(|| (value / light, sigma / light))
    }

    /// The luminescence summed over the emission axis.
    #[must_use]
    pub fn luminescent_sum(&self) -> f64 {
        steps(&self.emission_nm).iter().zip(&self.luminescent).map(|(step, value)| step * value).sum()
    }

    /// The colour that an observer sees; `None` under a light that nobody sees, and of a surface without elastic values.
    #[must_use]
    pub fn colour(&self, observer: Observer) -> Option<Colour> {
        self.sums(observer).map(|sums| sums.colour)
    }

    /// Standard uncertainties of X, Y and Z.
    #[must_use]
    pub fn xyz_sigma(&self, observer: Observer) -> Option<[f64; 3]> {
        let covariance = self.sums(observer)?.covariance;
        Some([0, 1, 2].map(|k| covariance[k][k].max(0.0).sqrt()))
    }

    /// Standard uncertainties of L*, a* and b*, to first order.
    #[must_use]
    pub fn lab_sigma(&self, observer: Observer) -> Option<[f64; 3]> {
        let Sums { colour, covariance } = *self.sums(observer)?;
        let shifted = |k: usize, by: f64| {
            let mut other = colour;
            other.xyz[k] += by;
            other.lab()
        };
        // Central differences of a smooth function: exact to ten digits, and uncertainties have two.
        let slope = |k: usize| {
            let step = 1e-4 * colour.white[k];
            let (high, low) = (shifted(k, step)?, shifted(k, -step)?);
            Some([0, 1, 2].map(|c| (high[c] - low[c]) / (2.0 * step)))
        };
        let slope = [slope(0)?, slope(1)?, slope(2)?];
        let pairs = || (0..3).flat_map(|k| (0..3).map(move |l| (k, l)));
        let variance = |c: usize| pairs().map(|(k, l)| slope[k][c] * covariance[k][l] * slope[l][c]).sum::<f64>();
        Some([0, 1, 2].map(|c| variance(c).max(0.0).sqrt()))
    }

    fn sums(&self, observer: Observer) -> Option<&Sums> {
        self.sums.iter().find(|(one, _)| *one == observer)?.1.as_ref()
    }
}
