//! Standard uncertainty of measured values, with what is shared between values kept apart.

use ndarray::ArcArray2;
use serde::{Deserialize, Serialize};

use super::{Finite, named};

named! {
    /// What an uncertainty component is common to.
    CorrelatedOver, "correlation" {
        /// One error for all wavelengths of an acquisition, independent between acquisitions (a record's scale).
        Wavelengths = "wavelengths",
        /// One error for all acquisitions, independent between wavelengths (the noise of a shared white reference).
        Acquisitions = "acquisitions",
        /// One error for every value (the certified factor of the reference).
        All = "all",
    }
}

named! {
    /// The distribution of an error, as the GUM (JCGM 100:2008, 4.3) names them.
    ErrorDistribution, "error distribution" {
        /// Normal.
        Normal = "normal",
        /// Student's t, of the degrees of freedom stated with it.
        StudentT = "student-t",
        /// Rectangular.
        Rectangular = "rectangular",
        /// Triangular.
        Triangular = "triangular",
        /// Arc sine, as of a quantity that swings.
        ArcSine = "arc-sine",
    }
}

named! {
    /// How an uncertainty was evaluated (JCGM 100:2008, 2.3.2 and 2.3.3).
    EvaluationType, "evaluation" {
        /// By statistics of repeated readings.
        A = "type-a",
        /// By other means: certificate, data sheet, experience.
        B = "type-b",
    }
}

/// How the source states an uncertainty. The numbers of a file are always standard uncertainties (k = 1): where the
/// source gave an expanded one, its coverage factor was divided out and stands here.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default)]
pub struct Statement {
    /// Coverage factor k of the expanded uncertainty that the source gave; the stored numbers are already divided by it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coverage_factor: Option<Finite>,
    /// Coverage probability of that expanded uncertainty, between 0 and 1.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub coverage_probability: Option<Finite>,
    /// Distribution of the error.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub distribution: Option<ErrorDistribution>,
    /// Effective degrees of freedom.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degrees_of_freedom: Option<Finite>,
    /// Statistics, or other means.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evaluation: Option<EvaluationType>,
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
    /// How the source states it.
    #[serde(flatten)]
    pub statement: Statement,
}

impl Component {
    /// A component of which no more is stated.
    #[must_use]
    pub fn new(name: impl Into<String>, relative: Vec<f64>, correlated_over: CorrelatedOver) -> Self {
        Self { name: name.into(), relative, correlated_over, statement: Statement::default() }
    }

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
    pub standard: Option<ArcArray2<f64>>,
    /// How the source states it.
    #[serde(default)]
    pub statement: Statement,
    /// Components shared between values; none of them is contained in `standard`.
    #[serde(default)]
    pub components: Vec<Component>,
}

/// Arrays in JSON as rows of numbers, with `null` for NaN.
pub(crate) mod rows {
    use ndarray::ArcArray2;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub(crate) fn serialize<S: Serializer>(array: &Option<ArcArray2<f64>>, serializer: S) -> Result<S::Ok, S::Error> {
        let rows: Option<Vec<Vec<Option<f64>>>> = array.as_ref().map(|array| {
            array
                .rows()
                .into_iter()
                .map(|row| row.iter().map(|value| value.is_finite().then_some(*value)).collect())
                .collect()
        });
        rows.serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<ArcArray2<f64>>, D::Error> {
        let rows: Option<Vec<Vec<Option<f64>>>> = Deserialize::deserialize(deserializer)?;
        let Some(rows) = rows else { return Ok(None) };
        let columns = rows.first().map_or(0, Vec::len);
        let count = rows.len();
        let flat: Vec<f64> = rows.into_iter().flatten().map(|value| value.unwrap_or(f64::NAN)).collect();
        ArcArray2::from_shape_vec((count, columns), flat).map(Some).map_err(D::Error::custom)
    }
}

/// The same for an array of tables.
pub(crate) mod tables_plain {
    use ndarray::{ArcArray, ArcArray2, Axis, Ix3};
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    #[derive(Serialize, Deserialize)]
    struct Table(#[serde(with = "super::rows_plain")] ArcArray2<f64>);

    pub(crate) fn serialize<S: Serializer>(array: &ArcArray<f64, Ix3>, serializer: S) -> Result<S::Ok, S::Error> {
        let tables: Vec<Table> = array.outer_iter().map(|table| Table(table.to_owned().into_shared())).collect();
        tables.serialize(serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<ArcArray<f64, Ix3>, D::Error> {
        let tables = Vec::<Table>::deserialize(deserializer)?;
        let views: Vec<_> = tables.iter().map(|table| table.0.view()).collect();
        if views.is_empty() {
            return Ok(ArcArray::zeros((0, 0, 0)));
        }
        ndarray::stack(Axis(0), &views).map(ndarray::ArrayBase::into_shared).map_err(D::Error::custom)
    }
}

/// The same for an array that is always there.
pub(crate) mod rows_plain {
    use ndarray::ArcArray2;
    use serde::{Deserializer, Serializer, de::Error};

    pub(crate) fn serialize<S: Serializer>(array: &ArcArray2<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        super::rows::serialize(&Some(array.clone()), serializer)
    }

    pub(crate) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<ArcArray2<f64>, D::Error> {
        super::rows::deserialize(deserializer)?.ok_or_else(|| D::Error::custom("expected rows of numbers, found null"))
    }
}
