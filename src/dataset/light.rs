//! What shone on the sample.

use serde::{Deserialize, Serialize};

use super::{Calibration, Id};
use crate::quantity::{Finite, Quantity, WavelengthAxis};

/// A light source.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Light {
    /// Identifier in the document.
    pub id: Id,
    /// Name, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// Make, model and lamp, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub make: Option<String>,
    /// Distance from the surface, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distance_mm: Option<Finite>,
    /// Diameter of the beam across its direction, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub beam_diameter_mm: Option<Finite>,
    /// Solid angle of the source seen from the surface, sr.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solid_angle_sr: Option<Finite>,
    /// Polarisation, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub polarisation: Option<String>,
    /// Chain of calibrations.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub calibration: Vec<Calibration>,
    /// Its spectrum, if the source has one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spectrum: Option<LightSpectrum>,
}

/// The spectrum of a light.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct LightSpectrum {
    /// What the numbers are.
    pub quantity: Quantity,
    /// Wavelengths with bandpass.
    pub axis: WavelengthAxis,
    /// One value per wavelength, in the unit of the quantity.
    pub values: Vec<f64>,
    /// One flag mask per wavelength.
    pub flags: Vec<u16>,
}
