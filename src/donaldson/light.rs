//! What falls on a surface: a spectrum on an axis of its own.

use super::piecewise::{Line, tents};
use crate::quantity::{QuantityKind, named};

/// The spectral power of a light on its own wavelengths; straight lines between them, and nothing known outside.
#[derive(Debug, Clone, PartialEq)]
pub struct Light {
    name: String,
    kind: QuantityKind,
    line: Line,
    fwhm_nm: Option<Vec<f64>>,
}

named! {
    /// What a light does where its spectrum is not known.
    Extend, "extension" {
        /// There is none.
        Zero = "zero",
        /// It goes on at its first and its last value.
        Flat = "flat",
    }
}

/// Why numbers are not a light.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NoLight {
    /// Another quantity.
    #[error("light `{light}` holds `{found}`; expected relative-spectrum, spectral-irradiance or spectral-radiance")]
    Kind {
        /// The light.
        light: String,
        /// What it holds.
        found: QuantityKind,
    },
    /// Not one value for each of two wavelengths or more.
    #[error("light `{light}`: {wavelengths} wavelengths and {values} values; expected as many, and two or more")]
    Count {
        /// The light.
        light: String,
        /// Wavelengths.
        wavelengths: usize,
        /// Values.
        values: usize,
    },
    /// Not a usable number.
    #[error("light `{light}`: {value} at {nm} nm (index {index}); expected finite values at ascending wavelengths")]
    Number {
        /// The light.
        light: String,
        /// Index in the list.
        index: usize,
        /// The wavelength there, nm.
        nm: f64,
        /// The value there.
        value: f64,
    },
    /// No light.
    #[error("light `{0}` has no value above 0; expected a spectrum that is not dark")]
    Dark(String),
}

impl Light {
    /// A light from its values. Below 0 they are noise and stay.
    ///
    /// # Errors
    /// [`NoLight`].
    pub fn new(
        name: impl Into<String>,
        kind: QuantityKind,
        nm: Vec<f64>,
        values: Vec<f64>,
        fwhm_nm: Option<Vec<f64>>,
    ) -> Result<Self, NoLight> {
        let light: String = name.into();
        use QuantityKind::{RelativeSpectrum, SpectralIrradiance, SpectralRadiance};
        if !matches!(kind, RelativeSpectrum | SpectralIrradiance | SpectralRadiance) {
            return Err(NoLight::Kind { light, found: kind });
        }
        if nm.len() != values.len() || nm.len() < 2 {
            return Err(NoLight::Count { light, wavelengths: nm.len(), values: values.len() });
        }
        let is_wrong = |index: &usize| {
            let ascends = *index == 0 || nm[*index] > nm[*index - 1];
            !(ascends && nm[*index].is_finite() && nm[*index] > 0.0 && values[*index].is_finite())
        };
        if let Some(index) = (0..nm.len()).find(is_wrong) {
            return Err(NoLight::Number { light, index, nm: nm[index], value: values[index] });
        }
        if values.iter().all(|value| *value <= 0.0) {
            return Err(NoLight::Dark(light));
        }
        Ok(Self { name: light, kind, line: Line::new(nm, values), fwhm_nm })
    }

    /// Its name: that of the standard, or where it was read.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What its numbers are.
    #[must_use]
    pub fn kind(&self) -> QuantityKind {
        self.kind
    }

    /// Wavelengths, nm.
    #[must_use]
    pub fn nm(&self) -> &[f64] {
        self.line.nm()
    }

    /// Values, one for each wavelength.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        self.line.values()
    }

    /// Full width at half maximum of the instrument that measured it, nm, where it is stated. The values hold it already.
    #[must_use]
    pub fn fwhm_nm(&self) -> Option<&[f64]> {
        self.fwhm_nm.as_deref()
    }

    /// First and last wavelength, nm.
    #[must_use]
    pub fn range_nm(&self) -> (f64, f64) {
        self.line.range()
    }

    /// The same light times a number.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let values = self.values().iter().map(|value| value * factor).collect();
        Self { line: Line::new(self.nm().to_vec(), values), ..self.clone() }
    }

    /// The same light, going on at its first and last value over this range, nm.
    #[must_use]
    pub fn extended(&self, from: f64, to: f64) -> Self {
        let (mut nm, mut values) = (self.nm().to_vec(), self.values().to_vec());
        if from < nm[0] {
            nm.insert(0, from);
            values.insert(0, values[0]);
        }
        if to > nm[nm.len() - 1] {
            nm.push(to);
            values.push(values[values.len() - 1]);
        }
        Self { line: Line::new(nm, values), ..self.clone() }
    }

    /// What of the light lies in this range, nm; `None` where there is none.
    #[must_use]
    pub fn within(&self, from: f64, to: f64) -> Option<Self> {
        let (low, high) = self.range_nm();
        let (from, to) = (from.max(low), to.min(high));
        if from >= to || from.is_nan() || to.is_nan() {
            return None;
        }
        let inner = self.nm().iter().copied().filter(|nm| *nm > from && *nm < to);
        let nm: Vec<f64> = std::iter::once(from).chain(inner).chain([to]).collect();
        let values = nm.iter().map(|nm| self.line.at(*nm).unwrap_or(0.0)).collect();
        Some(Self { line: Line::new(nm, values), ..self.clone() })
    }

    /// What of it each of these wavelengths (nm, ascending) takes part in: shared out between neighbours by their distance, nothing
    /// lost and nothing twice; what lies outside them is left out.
    #[must_use]
    pub fn shares(&self, nm: &[f64]) -> Vec<f64> {
        tents(nm).iter().map(|tent| self.line.integral_with(tent)).collect()
    }

    /// Its spectrum as a line.
    pub(super) fn line(&self) -> &Line {
        &self.line
    }
}
