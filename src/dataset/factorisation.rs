//! A Donaldson matrix as what it is made of: an elastic spectrum and products of excitation and emission spectra.

use ndarray::ArcArray2;
use serde::{Deserialize, Serialize};

use super::Id;
use crate::quantity::{WavelengthAxis, rows_plain};

/// The factors of a matrix: its luminescent value at an excitation and an emission is the sum over the factors of their
/// excitation spectrum there times their emission spectrum there; nothing below the excitation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Factorisation {
    /// Identifier in the document.
    pub id: Id,
    /// Name, free text.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub title: Option<String>,
    /// The matrix that was factorised, by id.
    pub measurement: Id,
    /// Digest of that matrix as it was then.
    pub data_digest: String,
    /// Centres of the excitation, nm, ascending.
    pub excitation_nm: Vec<f64>,
    /// The emission axis; its bandpass is the width that the luminescent values hold.
    pub emission: WavelengthAxis,
    /// Excitation spectra \[factor, excitation\], each 1 where its luminescence is strongest.
    #[serde(with = "rows_plain")]
    #[schemars(with = "Vec<Vec<Option<f64>>>")]
    pub excitation: ArcArray2<f64>,
    /// Standard uncertainties of these (k = 1).
    #[serde(with = "rows_plain")]
    #[schemars(with = "Vec<Vec<Option<f64>>>")]
    pub excitation_u: ArcArray2<f64>,
    /// Emission spectra \[factor, emission\], in the unit of the matrix.
    #[serde(with = "rows_plain")]
    #[schemars(with = "Vec<Vec<Option<f64>>>")]
    pub emission_factor: ArcArray2<f64>,
    /// Standard uncertainties of these (k = 1).
    #[serde(with = "rows_plain")]
    #[schemars(with = "Vec<Vec<Option<f64>>>")]
    pub emission_factor_u: ArcArray2<f64>,
    /// Elastic radiance factor, one per emission; NaN where the matrix does not tell.
    #[serde(with = "unknown_as_null")]
    #[schemars(with = "Vec<Option<f64>>")]
    pub elastic: Vec<f64>,
    /// Standard uncertainty of it.
    #[serde(with = "unknown_as_null")]
    #[schemars(with = "Vec<Option<f64>>")]
    pub elastic_u: Vec<f64>,
    /// Reflected light reaches cells whose emission is less than this from the excitation, nm.
    pub reach_nm: f64,
    /// Root mean square of the matrix where no light can be; NaN where it has no such cell.
    pub floor: f64,
    /// Root mean square of what the factors leave in the cells that hold luminescence alone.
    pub residual_rms: f64,
    /// How many such cells there are.
    pub residual_count: u64,
    /// How it was done.
    pub method: String,
    /// What the matrix cannot tell, and other findings, one sentence each.
    #[serde(default)]
    pub findings: Vec<String>,
}

/// Numbers in JSON with `null` for NaN.
mod unknown_as_null {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    pub(super) fn serialize<S: Serializer>(numbers: &[f64], serializer: S) -> Result<S::Ok, S::Error> {
        numbers.iter().map(|x| x.is_finite().then_some(*x)).collect::<Vec<Option<f64>>>().serialize(serializer)
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
        let numbers = Vec::<Option<f64>>::deserialize(deserializer)?;
        Ok(numbers.into_iter().map(|x| x.unwrap_or(f64::NAN)).collect())
    }
}

impl Factorisation {
    /// How many factors.
    #[must_use]
    pub fn rank(&self) -> usize {
        self.excitation.nrows()
    }

    /// The luminescent value of a cell; 0 below the excitation, `None` outside the arrays.
    #[must_use]
    pub fn luminescent(&self, excitation: usize, emission: usize) -> Option<f64> {
        let (from, to) = (self.excitation_nm.get(excitation)?, self.emission.nm.get(emission)?);
        if to < from {
            return Some(0.0);
        }
        let product = |k: usize| Some(self.excitation.get((k, excitation))? * self.emission_factor.get((k, emission))?);
        (0..self.rank()).map(product).sum()
    }

    /// The first array whose shape is not that of the axes, with the shape it should have.
    #[must_use]
    pub fn misfit(&self) -> Option<(&'static str, Vec<usize>, Vec<usize>)> {
        let (k, rows, columns) = (self.rank(), self.excitation_nm.len(), self.emission.nm.len());
        let arrays = [
            ("excitation_factor", self.excitation.shape(), vec![k, rows]),
            ("excitation_factor_u", self.excitation_u.shape(), vec![k, rows]),
            ("emission_factor", self.emission_factor.shape(), vec![k, columns]),
            ("emission_factor_u", self.emission_factor_u.shape(), vec![k, columns]),
            ("elastic", &[self.elastic.len()][..], vec![columns]),
            ("elastic_u", &[self.elastic_u.len()][..], vec![columns]),
        ];
        arrays.into_iter().find(|(_, found, expected)| *found != &expected[..]).map(|(n, f, e)| (n, f.to_vec(), e))
    }
}
