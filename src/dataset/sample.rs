//! What was measured, and against what.

use serde::{Deserialize, Serialize};

use super::{Calibration, Id};
use crate::quantity::{Finite, named};

named! {
    /// How the sample looks after a turn about its normal, or in a mirror.
    Symmetry, "symmetry" {
        /// Turning it about its normal changes nothing.
        Isotropic = "isotropic",
        /// The plane through the normal and the mark is a plane of symmetry.
        Mirror = "mirror",
        /// It has neither.
        None = "none",
    }
}

/// A sample.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
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
    /// Holder and backing, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub holder: Option<String>,
    /// Extent along x, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_mm: Option<Finite>,
    /// Extent along y, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub height_mm: Option<Finite>,
    /// Thickness, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thickness_mm: Option<Finite>,
    /// Symmetry of the surface that whoever measured declares.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symmetry: Option<Symmetry>,
    /// True when the numbers were computed and not measured.
    #[serde(default, deserialize_with = "truth")]
    pub simulated: bool,
}

/// The diffuser that a factor is relative to.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct WhiteReference {
    /// Identifier in the document.
    pub id: Id,
    /// Name, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Material and make, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
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
    pub certified_relative_uncertainty: Option<Finite>,
    /// Chain of calibrations that the certified factor rests on.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub calibration: Vec<Calibration>,
}

/// A truth value: `true` and `false` in JSON, 1 and 0 in HDF5, which has no such type.
fn truth<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<bool, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Truth {
        Word(bool),
        Number(f64),
    }
    match Truth::deserialize(deserializer)? {
        Truth::Word(word) => Ok(word),
        Truth::Number(0.0) => Ok(false),
        Truth::Number(1.0) => Ok(true),
        Truth::Number(other) => Err(serde::de::Error::custom(format!("{other}; expected 0 or 1"))),
    }
}
