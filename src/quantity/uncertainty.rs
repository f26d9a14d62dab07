//! Standard uncertainty of measured values, with what is shared between values kept apart.

use ndarray::Array2;
use serde::{Deserialize, Serialize};

/// What an uncertainty component is common to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CorrelatedOver {
    /// One error for all wavelengths of an acquisition, independent between acquisitions (a record's scale).
    Wavelengths,
    /// One error for all acquisitions, independent between wavelengths (the noise of a shared white reference).
    Acquisitions,
    /// One error for every value (the certified factor of the reference).
    All,
}

/// One shared component of relative standard uncertainty.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Component {
    /// What causes it, in words.
    pub name: String,
    /// Relative standard uncertainty: one number, or one per emission wavelength.
    pub relative: Vec<f64>,
    /// What it is common to.
    pub correlated_over: CorrelatedOver,
}

impl Component {
    /// Relative standard uncertainty at an emission index; the last one given serves all that follow, none is 0.
    #[must_use]
    pub fn relative_at(&self, emission: usize) -> f64 {
        self.relative.get(emission).or(self.relative.last()).copied().unwrap_or(0.0)
    }
}

/// The uncertainty of an array of values \[acquisition, emission\].
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Uncertainty {
    /// Standard uncertainty (k = 1) independent between values, in the unit of the values; NaN where unknown.
    #[serde(with = "rows", skip_serializing_if = "Option::is_none", default)]
    #[schemars(with = "Option<Vec<Vec<Option<f64>>>>")]
    pub standard: Option<Array2<f64>>,
    /// Components shared between values; none of them is contained in `standard`.
    #[serde(default)]
    pub components: Vec<Component>,
}

/// Arrays in JSON as rows of numbers, with `null` for NaN.
pub(crate) mod rows {
    use ndarray::Array2;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub(crate) fn serialize<S: Serializer>(array: &Option<Array2<f64>>, serializer: S) -> Result<S::Ok, S::Error> {
        let rows: Option<Vec<Vec<Option<f64>>>> = array.as_ref().map(|array| {
            array
                .rows()
                .into_iter()
                .map(|row| row.iter().map(|value| value.is_finite().then_some(*value)).collect())
                .collect()
        });
        rows.serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Array2<f64>>, D::Error> {
        let rows: Option<Vec<Vec<Option<f64>>>> = Deserialize::deserialize(deserializer)?;
        let Some(rows) = rows else { return Ok(None) };
        let columns = rows.first().map_or(0, Vec::len);
        let count = rows.len();
        let flat: Vec<f64> = rows.into_iter().flatten().map(|value| value.unwrap_or(f64::NAN)).collect();
        Array2::from_shape_vec((count, columns), flat).map(Some).map_err(D::Error::custom)
    }
}

/// The same for an array that is always there.
pub(crate) mod rows_plain {
    use ndarray::Array2;
    use serde::{Deserializer, Serializer, de::Error};

    pub(crate) fn serialize<S: Serializer>(array: &Array2<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        super::rows::serialize(&Some(array.clone()), serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Array2<f64>, D::Error> {
        super::rows::deserialize(deserializer)?.ok_or_else(|| D::Error::custom("expected rows of numbers, found null"))
    }
}
