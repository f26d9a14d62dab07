//! Under what conditions a measurement was made.

use serde::{Deserialize, Serialize};

use crate::quantity::Finite;

/// Who measured, where, and in what surroundings. Names of people stand here and in `contact` of the document only, so
/// that a file can be made anonymous.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default)]
pub struct Conditions {
    /// Who measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub operator: Option<String>,
    /// Where.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub laboratory: Option<String>,
    /// Temperature of the air at the sample, degree Celsius.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub temperature_celsius: Option<Finite>,
    /// Relative humidity, per cent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub humidity_percent: Option<Finite>,
    /// Room light, baffles, anything else of the surroundings.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub environment: Option<String>,
    /// Polarisation that the detector takes.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub viewing_polarisation: Option<String>,
    /// Relative drift of lamp and instrument over the measurement, as found from repeated geometries or a monitor.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relative_drift: Option<Finite>,
    /// What was done against drift and bleaching.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drift_handling: Option<String>,
}

impl Conditions {
    /// Takes the names of people out.
    pub fn anonymise(&mut self) {
        self.operator = None;
    }
}
