//! The uncertainty that geometries will give, and what they leave undetermined.

use nalgebra::DMatrix;

use super::guess::Guess;
use super::sensitivity::Sensitivities;
use super::unresolved;
use crate::quantity::Geometry;

/// A direction of the parameters whose column keeps less than this share of its length beside all others cannot be told
/// from them; as in a fit.
const SINGULAR: f64 = 1e-8;
/// The share of a parameter in such a direction beyond which it is not determined.
const PART: f64 = 1e-6;

/// What a list of geometries will give.
#[derive(Debug, Clone, PartialEq)]
pub struct Predicted {
    /// Standard uncertainty of each parameter, in its unit; NaN where the geometries cannot tell it.
    pub standard_uncertainty: Vec<f64>,
    /// Covariance of the parameters; NaN where the geometries cannot tell.
    pub covariance: DMatrix<f64>,
    /// What stays undetermined, one sentence each.
    pub undetermined: Vec<String>,
}

/// Singular directions of the sensitivities, whose columns are scaled to length 1.
pub(super) struct Directions {
    /// Lengths of the columns.
    pub(super) norms: Vec<f64>,
    /// Singular values with their directions.
    pub(super) values: Vec<(f64, Vec<f64>)>,
}

impl Directions {
    fn of(sensitivities: &Sensitivities) -> Self {
        let p = sensitivities.parameters();
        let mut matrix = DMatrix::from_row_slice(sensitivities.len(), p, sensitivities.rows());
        let norms: Vec<f64> = matrix.column_iter().map(|column| column.norm()).collect();
        for (k, mut column) in matrix.column_iter_mut().enumerate() {
            column.unscale_mut(if norms[k] > 0.0 { norms[k] } else { 1.0 });
        }
        // The triangle has the singular values of the whole; rows of 0 make it square for a short list.
        let rows = matrix.nrows().max(p);
        let r = matrix.resize_vertically(rows, 0.0).qr().r();
        let svd = r.svd(false, true);
        let v = svd.v_t.unwrap_or_else(|| DMatrix::identity(p, p));
        let values = svd.singular_values.iter().zip(v.row_iter());
        Self { norms, values: values.map(|(value, row)| (*value, row.iter().copied().collect())).collect() }
    }

    /// Directions that cannot be told, each with the share of every parameter in it.
    pub(super) fn null(&self) -> impl Iterator<Item = &Vec<f64>> {
        self.values.iter().filter(|(value, _)| *value < SINGULAR).map(|(_, direction)| direction)
    }

    /// True where a parameter has a part in a direction that cannot be told.
    pub(super) fn hides(&self, parameter: usize) -> bool {
        self.norms[parameter] == 0.0 || self.null().any(|direction| direction[parameter].abs() > PART)
    }
}

/// Predicts the uncertainty of a fit of every parameter to values at these geometries.
#[must_use]
pub fn predict(guess: &Guess, geometry: &[Geometry], sensitivities: &Sensitivities) -> Predicted {
    let directions = Directions::of(sensitivities);
    let p = sensitivities.parameters();
    let scale = |k: usize| guess.parameters()[k].scale / directions.norms[k];
    let covariance = DMatrix::from_fn(p, p, |i, j| {
        if directions.hides(i) || directions.hides(j) {
            return f64::NAN;
        }
        let told = directions.values.iter().filter(|(value, _)| *value >= SINGULAR);
        told.map(|(value, v)| v[i] * v[j] / (value * value)).sum::<f64>() * scale(i) * scale(j)
    });
    let standard_uncertainty: Vec<f64> = (0..p).map(|k| covariance[(k, k)].sqrt()).collect();
    let undetermined = unresolved::sentences(guess, geometry, &directions, &standard_uncertainty);
    Predicted { standard_uncertainty, covariance, undetermined }
}
