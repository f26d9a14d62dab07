//! What measured.

use serde::{Deserialize, Serialize};

use super::{Calibration, Id};
use crate::quantity::Finite;

/// An instrument.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
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
    pub distance_mm: Option<Finite>,
    /// Full angle of the visual field, degrees.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub visual_field_deg: Option<Finite>,
    /// Solid angle of the collected beam, sr.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solid_angle_sr: Option<Finite>,
    /// Stray light over the whole signal, dimensionless.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stray_light_relative: Option<Finite>,
    /// Chain of calibrations.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub calibration: Vec<Calibration>,
}

impl Instrument {
    /// Diameter of the measured spot seen along the normal, mm: 2 d tan(field / 2). 0.3 degrees from 800 mm is 4.19 mm.
    #[must_use]
    pub fn spot_mm(&self) -> Option<f64> {
        let (distance, field) = (self.distance_mm?.get(), self.visual_field_deg?.get());
        Some(2.0 * distance * (field.to_radians() / 2.0).tan())
    }
}
