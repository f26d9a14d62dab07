//! Fitted models: terms, parameters with covariance, what they were fitted to and how.

use ndarray::{ArcArray, ArrayView2, Axis, Ix3};
use serde::{Deserialize, Serialize};

use super::{Attachment, Id};
use crate::quantity::{EmissionAxis, Reference, tables_plain};
use crate::terms::{Denominator, Distribution, TermKind};

/// A fitted parameter: one number, or one per emission value (an amplitude of a spectral fit).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FittedParameter {
    /// The parameter's name in the standard.
    pub name: String,
    /// Unit, `1` for none.
    pub unit: String,
    /// Value, one or one per emission value.
    pub value: Vec<f64>,
    /// Standard uncertainty (k = 1) from the independent errors, one per value; NaN where the data cannot tell.
    pub standard_uncertainty: Vec<f64>,
    /// Relative standard uncertainty from errors shared by all rows (white reference, certificate), one per value;
    /// empty where there is none. It is not contained in `standard_uncertainty`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shared_relative_uncertainty: Vec<f64>,
    /// Lower ends of the 95 % intervals by profile likelihood, one per value; NaN at an end that the data leave open (the
    /// interval reaches the edge of the searched box). Empty where no interval was formed.
    #[serde(default, skip_serializing_if = "Vec::is_empty", with = "open_ends")]
    #[schemars(with = "Vec<Option<f64>>")]
    pub interval_low: Vec<f64>,
    /// Upper ends, likewise.
    #[serde(default, skip_serializing_if = "Vec::is_empty", with = "open_ends")]
    #[schemars(with = "Vec<Option<f64>>")]
    pub interval_high: Vec<f64>,
}

/// Numbers in JSON with `null` for NaN.
mod open_ends {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(numbers: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
        numbers.iter().map(|x| (!x.is_nan()).then_some(*x)).collect::<Vec<Option<f64>>>().serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
        let numbers = Vec::<Option<f64>>::deserialize(deserializer)?;
        Ok(numbers.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect())
    }
}

/// A term of a fitted model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct FittedTerm {
    /// Which term.
    pub kind: TermKind,
    /// Form of D, for a specular term.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub distribution: Option<Distribution>,
    /// Denominator, for a specular term.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub denominator: Option<Denominator>,
    /// Parameters in the order of the term.
    pub parameters: Vec<FittedParameter>,
}

/// How far the model is from the data.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Residuals {
    /// Root mean square of measured minus predicted, in the unit of the fitted number.
    pub rms: f64,
    /// Weighted sum of squares over degrees of freedom; NaN where the data have no uncertainty.
    pub reduced_chi_square: f64,
    /// Number of values fitted.
    pub count: u64,
    /// Number of values left out, because of their flags or because they have no usable uncertainty.
    pub left_out: u64,
}

/// The paper's check that a factor is separable into a function of incidence times a function of viewing.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Separability {
    /// Signed in-plane incidence angles, degrees.
    pub theta_i_deg: Vec<f64>,
    /// Value averaged over viewing, times what the reference received, one per incidence angle.
    pub mean_over_viewing: Vec<f64>,
    /// Standard deviation of what was averaged.
    pub spread_over_viewing: Vec<f64>,
    /// Signed in-plane viewing angles, degrees.
    pub theta_v_deg: Vec<f64>,
    /// Value averaged over incidence after division by the fitted cosine, one per viewing angle.
    pub mean_over_incidence: Vec<f64>,
    /// Standard deviation of what was averaged.
    pub spread_over_incidence: Vec<f64>,
    /// Amplitude of the cosine fitted to the first average.
    pub cosine_amplitude: f64,
    /// Root mean square departure of the first average from that cosine, relative to the amplitude.
    pub cosine_relative_rms: f64,
    /// Root mean square departure of the second average from its mean, relative to it.
    pub constancy_relative_rms: f64,
    /// Root mean square of what the best product f(theta_i) g(theta_v) leaves, relative to the r.m.s. of the table.
    pub rank_one_relative_rms: f64,
}

/// A fitted model.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Model {
    /// Identifier in the document.
    pub id: Id,
    /// Name, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// The measurement it was fitted to, by id.
    pub measurement: Id,
    /// Digest of that measurement as it was then.
    pub data_digest: String,
    /// How a spectrum became the fitted number, as in `band:500-620`.
    pub reduction: String,
    /// Which rows were masked out on request, as [`Mask`](super::Mask) writes it; none where all were offered.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mask: Option<String>,
    /// The reference convention that the forward model included.
    pub reference: Reference,
    /// Unit of the fitted number.
    pub unit: String,
    /// The emission axis of the fitted numbers.
    pub emission: EmissionAxis,
    /// The terms.
    pub terms: Vec<FittedTerm>,
    /// Effects of the instrument on the geometry, as [`Effect`](super::Effect) names them: the terms predict what was measured
    /// at the geometries that the instrument saw.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub nuisances: Vec<FittedParameter>,
    /// Names of the parameters in the order of the covariance, as [`Model::covariance_name`] gives them: `TERM.PARAMETER`,
    /// or `TERM:POSITION.PARAMETER` where several terms are of one kind.
    pub covariance_parameters: Vec<String>,
    /// Covariance of these parameters, one table or one per emission value \[1 or emission, parameter, parameter\]; NaN where
    /// the data cannot tell.
    #[serde(with = "tables_plain")]
    #[schemars(with = "Vec<Vec<Vec<Option<f64>>>>")]
    pub covariance: ArcArray<f64, Ix3>,
    /// Residuals.
    pub residuals: Residuals,
    /// True when the fit ended at a minimum and not at a limit.
    pub converged: bool,
    /// Why the fit stopped, and how it was done.
    pub method: String,
    /// What the data cannot tell, and other findings, one sentence each.
    #[serde(default)]
    pub identifiability: Vec<String>,
    /// The separability check, where the scan is a table of in-plane angles.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub separability: Option<Separability>,
    /// The bispectral matrix that makes the model complete, where one is attached.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub donaldson: Option<Attachment>,
}

impl Model {
    /// How many parameters were fitted to the numbers: those of each emission value, and the common ones once.
    #[must_use]
    pub fn fitted_parameters(&self) -> usize {
        self.terms.iter().flat_map(|term| &term.parameters).map(|parameter| parameter.value.len()).sum()
    }

    /// Covariance of `covariance_parameters` at one emission value; none where the model has none for it.
    #[must_use]
    pub fn covariance_at(&self, emission: usize) -> Option<ArrayView2<'_, f64>> {
        let tables = self.covariance.len_of(Axis(0));
        let table = if tables == 1 { 0 } else { emission };
        (table < tables).then(|| self.covariance.index_axis(Axis(0), table))
    }

    /// The name of a parameter of the term at a position in `covariance_parameters`: `TERM.PARAMETER`, and where the
    /// model has several terms of that kind `TERM:POSITION.PARAMETER`, so that every name means one parameter.
    #[must_use]
    pub fn covariance_name(&self, position: usize, parameter: &str) -> String {
        let kinds: Vec<TermKind> = self.terms.iter().map(|term| term.kind).collect();
        Self::name_in_covariance(&kinds, position, parameter)
    }

    /// The same for a list of terms that is no model yet.
    pub(super) fn name_in_covariance(terms: &[TermKind], position: usize, parameter: &str) -> String {
        let kind = terms.get(position);
        match (kind, terms.iter().filter(|other| Some(*other) == kind).count()) {
            (Some(kind), 1) => format!("{kind}.{parameter}"),
            (Some(kind), _) => format!("{kind}:{position}.{parameter}"),
            (None, _) => String::new(),
        }
    }
}
