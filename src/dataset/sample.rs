//! What was measured, and against what.

use serde::{Deserialize, Serialize};

use super::Id;

/// A sample.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Sample {
    /// Identifier in the document.
    pub id: Id,
    /// Name, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Material, make and lot, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Where the mark (+x, azimuth zero) is on the sample, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mark: Option<String>,
    /// True when the numbers were computed and not measured.
    #[serde(default)]
    pub simulated: bool,
}

/// The diffuser that a factor is relative to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WhiteReference {
    /// Identifier in the document.
    pub id: Id,
    /// Name, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Number of the certificate.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certificate: Option<String>,
    /// Wavelengths of the certified factor, nm; empty where one number serves all.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub certified_nm: Vec<f64>,
    /// Certified radiance factor, dimensionless: none, one number, or one per `certified_nm`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub certified_factor: Vec<f64>,
    /// Relative standard uncertainty of the certified factor, common to all wavelengths.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub certified_relative_uncertainty: Option<f64>,
}
