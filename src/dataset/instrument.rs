//! What measured.

use serde::{Deserialize, Serialize};

use super::Id;

/// An instrument.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Instrument {
    /// Identifier in the document.
    pub id: Id,
    /// Make and model, as in `PR-650`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<String>,
    /// Serial number.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub serial: Option<String>,
    /// Measuring aperture as the instrument names it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub aperture: Option<String>,
    /// Lenses and filters as the instrument names them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub accessories: Option<String>,
    /// Distance from the surface, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance_mm: Option<f64>,
}
