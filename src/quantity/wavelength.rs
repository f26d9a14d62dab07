//! Wavelength axes with their bandpass, and bands.

use serde::{Deserialize, Serialize};

use super::named;

named! {
    /// The shape of a slit function.
    BandpassShape, "bandpass shape" {
        /// Triangular.
        Triangular = "triangular",
        /// Rectangular.
        Rectangular = "rectangular",
        /// Gaussian.
        Gaussian = "gaussian",
        /// The source does not say.
        Unstated = "unstated",
    }
}

named! {
    /// Whether values are corrected for the width of the bandpass.
    BandpassCorrection, "bandpass correction" {
        /// They are, as by ASTM E2729 or a deconvolution.
        Corrected = "corrected",
        /// They are as the instrument gave them.
        Uncorrected = "uncorrected",
        /// The source does not say.
        Unstated = "unstated",
    }
}

/// How wide the instrument looks at each wavelength. Bandpass and step are two different numbers.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(tag = "status", rename_all = "kebab-case")]
pub enum Bandpass {
    /// The source does not say.
    Unstated,
    /// Stated by the source.
    Stated {
        /// Full width at half maximum, nm: one number for all wavelengths, or one for each.
        fwhm_nm: Vec<f64>,
        /// Shape of the slit function.
        shape: BandpassShape,
        /// Whether the values are corrected for it.
        correction: BandpassCorrection,
    },
}

/// Ascending nominal wavelengths with their bandpass.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WavelengthAxis {
    /// Nominal centre wavelengths in air, nm, strictly ascending.
    pub nm: Vec<f64>,
    /// Bandpass of the instrument on this axis.
    pub bandpass: Bandpass,
    /// The centres as calibrated, nm: one for each nominal wavelength, or none where the source does not say.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub actual_nm: Vec<f64>,
}

/// Why a list of numbers is not a wavelength axis.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WavelengthError {
    /// A wavelength is not a positive number.
    #[error("wavelength {value} nm at index {index}; expected a positive finite number")]
    NotPositive {
        /// Index in the list.
        index: usize,
        /// The number found, nm.
        value: f64,
    },
    /// The list does not ascend.
    #[error("wavelength {value} nm at index {index} follows {previous} nm; expected strictly ascending wavelengths")]
    NotAscending {
        /// Index in the list.
        index: usize,
        /// The number before it, nm.
        previous: f64,
        /// The number found, nm.
        value: f64,
    },
}

impl WavelengthAxis {
    /// An axis from nominal wavelengths in nm.
    ///
    /// # Errors
    /// [`WavelengthError`] unless the wavelengths are positive, finite and strictly ascending.
    pub fn new(nm: Vec<f64>, bandpass: Bandpass) -> Result<Self, WavelengthError> {
        for (index, &value) in nm.iter().enumerate() {
            if !(value.is_finite() && value > 0.0) {
                return Err(WavelengthError::NotPositive { index, value });
            }
            if index > 0 && value <= nm[index - 1] {
                return Err(WavelengthError::NotAscending { index, previous: nm[index - 1], value });
            }
        }
        Ok(Self { nm, bandpass, actual_nm: Vec::new() })
    }
}

/// A band of emission wavelengths, both ends included.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Band {
    /// Lower end, nm.
    pub from_nm: f64,
    /// Upper end, nm.
    pub to_nm: f64,
}

impl Band {
    /// True where the wavelength lies in the band.
    #[must_use]
    pub fn contains(&self, nm: f64) -> bool {
        (self.from_nm..=self.to_nm).contains(&nm)
    }
}

impl std::fmt::Display for Band {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}-{}", self.from_nm, self.to_nm)
    }
}

/// The emission axis of a measurement: wavelengths, or one band whose spectrum was summed.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum EmissionAxis {
    /// One value per wavelength.
    Wavelengths(WavelengthAxis),
    /// One value for a band; `None` where the source does not say which.
    Band {
        /// The band, if stated.
        band: Option<Band>,
    },
}

impl EmissionAxis {
    /// How many values an acquisition has on this axis.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Wavelengths(axis) => axis.nm.len(),
            Self::Band { .. } => 1,
        }
    }

    /// True for an axis without a single wavelength.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The axis of some of its values, by ascending index; a band is one value.
    #[must_use]
    pub fn selection(&self, indices: &[usize]) -> Self {
        let Self::Wavelengths(axis) = self else { return self.clone() };
        let of = |list: &[f64]| indices.iter().filter_map(|index| list.get(*index)).copied().collect::<Vec<f64>>();
        let bandpass = match &axis.bandpass {
            Bandpass::Stated { fwhm_nm, shape, correction } if fwhm_nm.len() == axis.nm.len() && fwhm_nm.len() > 1 => {
                Bandpass::Stated { fwhm_nm: of(fwhm_nm), shape: *shape, correction: *correction }
            }
            same => same.clone(),
        };
        Self::Wavelengths(WavelengthAxis { nm: of(&axis.nm), bandpass, actual_nm: of(&axis.actual_nm) })
    }

    /// The wavelengths in nm, if the axis has any.
    #[must_use]
    pub fn wavelengths(&self) -> Option<&[f64]> {
        match self {
            Self::Wavelengths(axis) => Some(&axis.nm),
            Self::Band { .. } => None,
        }
    }
}
