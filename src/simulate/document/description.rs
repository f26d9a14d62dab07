//! What stands in a scene: film, camera, wavelengths, and the lists of materials, lights and objects.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::lights::LightSection;
use super::materials::MaterialSection;
use super::objects::ObjectSection;
use super::words;
use crate::donaldson::Observer;
use crate::quantity::named;
use crate::simulate::picture::Kept;
use crate::simulate::scene::Bounces;

/// A scene: what is there, what lights it, from where it is seen.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneDocument {
    /// The image.
    pub film: FilmSection,
    /// From where the scene is seen.
    pub camera: CameraSection,
    /// The wavelengths that it is simulated at.
    #[serde(default)]
    pub wavelengths: Wavelengths,
    /// The CIE observer: 2 (1931) or 10 (1964) degrees.
    #[serde(default = "two", deserialize_with = "words::observer", serialize_with = "words::observer_degrees")]
    #[schemars(with = "u8", extend("enum" = [2, 10]))]
    pub observer: Observer,
    /// How often light goes from body to body: `"all"`, or at most so often.
    #[serde(default = "all", deserialize_with = "words::bounces")]
    pub bounces: Bounces,
    /// What bodies are made of.
    #[serde(rename = "material")]
    pub materials: Vec<MaterialSection>,
    /// What lights them.
    #[serde(rename = "light")]
    pub lights: Vec<LightSection>,
    /// The bodies.
    #[serde(rename = "object")]
    pub objects: Vec<ObjectSection>,
}

/// The image.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FilmSection {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Samples of each pixel for what has no closed form.
    #[serde(default = "sixteen")]
    pub samples: u32,
    /// Where random numbers begin: the same seed gives the same image.
    #[serde(default = "one_seed")]
    pub seed: u64,
    /// What the PNG multiplies the light with: at 1 a perfect diffuser that faces all lights is white.
    #[serde(default = "one")]
    pub exposure: f64,
    /// What the EXR holds of each pixel.
    #[serde(default = "colour")]
    pub kept: Kept,
}

/// Wavelengths at one distance from each other, nm; for what falls in and what comes out alike.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Wavelengths {
    /// First, nm.
    pub from: f64,
    /// Last, nm.
    pub to: f64,
    /// Distance, nm.
    pub step: f64,
}

impl Default for Wavelengths {
    fn default() -> Self {
        Self { from: 300.0, to: 780.0, step: 5.0 }
    }
}

named! {
    /// How a camera sees.
    View, "projection" {
        /// Along parallel lines.
        Orthographic = "orthographic",
        /// From a point.
        Perspective = "perspective",
    }
}

/// From where the scene is seen.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(extend("oneOf" = [{"required": ["width"]}, {"required": ["width_deg"]}]))]
pub struct CameraSection {
    /// Along parallel lines, with `width`; from a point, with `width_deg`.
    pub projection: View,
    /// Where the camera stands.
    pub from: [f64; 3],
    /// What it looks at: the middle of the image.
    pub at: [f64; 3],
    /// What is up.
    #[serde(default = "up")]
    pub up: [f64; 3],
    /// How much of the scene is as wide as the image, in the unit of the scene; for parallel lines.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
    /// The angle between the left and the right edge of the image, degrees below 179; from a point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width_deg: Option<f64>,
}

fn two() -> Observer {
    Observer::Two
}

fn all() -> Bounces {
    Bounces::All
}

fn sixteen() -> u32 {
    16
}

fn one_seed() -> u64 {
    1
}

pub(super) fn one() -> f64 {
    1.0
}

fn colour() -> Kept {
    Kept::Colour
}

pub(super) fn up() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}
