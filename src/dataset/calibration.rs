//! How a number was made traceable.

use serde::{Deserialize, Serialize};

use crate::quantity::{Finite, Statement};

/// One link of a calibration chain: what was calibrated against which artefact, by whom, and until when it holds.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default)]
pub struct Calibration {
    /// What was calibrated, as in `spectral radiance`, `wavelength`, `linearity`, `angles`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub subject: Option<String>,
    /// The reference artefact and its serial number.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub artefact: Option<String>,
    /// Number of the certificate.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub certificate: Option<String>,
    /// Who issued it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub laboratory: Option<String>,
    /// Day of the calibration, YYYY-MM-DD.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// Last day on which it holds, YYYY-MM-DD.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub expires: Option<String>,
    /// Relative standard uncertainty (k = 1) of what was calibrated.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relative_standard_uncertainty: Option<Finite>,
    /// How the source states that uncertainty.
    #[serde(flatten)]
    pub statement: Statement,
}
