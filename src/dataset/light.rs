//! What shone on the sample.

use serde::{Deserialize, Serialize};

use super::Id;
use crate::quantity::{Quantity, WavelengthAxis};

/// A light source.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Light {
    /// Identifier in the document.
    pub id: Id,
    /// Name, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
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
