//! A number that descriptions may hold: never NaN, never infinite.

use serde::{Deserialize, Serialize};

/// A finite number. What a description does not know is absent, never NaN.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(into = "f64", try_from = "f64")]
#[schemars(with = "f64")]
pub struct Finite(f64);

/// A number that is not finite.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{0} is not finite; leave the field out where the number is unknown")]
pub struct NotFinite(f64);

impl Finite {
    /// The number.
    #[must_use]
    pub const fn get(self) -> f64 {
        self.0
    }
}

impl TryFrom<f64> for Finite {
    type Error = NotFinite;

    fn try_from(number: f64) -> Result<Self, NotFinite> {
        if number.is_finite() { Ok(Self(number)) } else { Err(NotFinite(number)) }
    }
}

impl From<Finite> for f64 {
    fn from(number: Finite) -> Self {
        number.0
    }
}
