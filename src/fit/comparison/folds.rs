//! Cross-validation: which values are left out together, and how well the others predict them.

use std::collections::BTreeMap;

use ndarray::Array2;

use crate::dataset::Reduced;
use crate::fit::outcome::Fit;
use crate::fit::solve::Fitter;
use crate::quantity::Geometry;

/// Up to this many values each geometry is left out by itself.
const FEW: usize = 3000;
/// How many sets of geometries are left out in turn where there are more.
const FOLDS: usize = 20;

/// Sets of rows that are left out in turn.
#[derive(Debug)]
pub(super) struct Folds {
    /// The geometry of each row, counted from 0.
    group: Vec<usize>,
    /// How many geometries.
    pub(super) groups: usize,
    /// Geometries with the same remainder are left out together.
    stride: usize,
}

impl Folds {
    pub(super) fn new(geometry: &[Geometry], bands: usize) -> Self {
        let mut seen: BTreeMap<[i64; 3], usize> = BTreeMap::new();
        let group = geometry
            .iter()
            .map(|geometry| {
                let next = seen.len();
                *seen.entry(key(geometry)).or_insert(next)
            })
            .collect();
        let groups = seen.len();
        let stride = if geometry.len() * bands <= FEW { groups } else { groups.min(FOLDS) };
        Self { group, groups, stride: stride.max(1) }
    }

    pub(super) fn count(&self) -> usize {
        self.stride
    }

    /// Squared errors of the values left out, over their variance, summed over each geometry; infinite where the others
    /// cannot be fitted.
    pub(super) fn scores(
        &self,
        fitter: &Fitter<'_>,
        data: &Reduced,
        predictions: impl Fn(&Fit) -> Array2<f64>,
    ) -> Vec<f64> {
        let sigma = data.sigma.as_ref().map(|sigma| sigma.view());
        let mut scores = vec![0.0; self.groups];
        for fold in 0..self.stride {
            let is_out = |row: usize| self.group[row] % self.stride == fold;
            let mut values = data.values.clone();
            (0..self.group.len()).filter(|row| is_out(*row)).for_each(|row| values.column_mut(row).fill(f64::NAN));
            let Ok(fit) = fitter.fit_bands(values.view(), sigma) else { return vec![f64::INFINITY; self.groups] };
            let predicted = predictions(&fit);
            for ((band, row), value) in data.values.indexed_iter().filter(|((_, row), _)| is_out(*row)) {
                let scale = sigma.map_or(1.0, |sigma| sigma[(band, row)]);
                let error = (value - predicted[(band, row)]) / scale;
                if value.is_finite() && scale > 0.0 && scale.is_finite() {
                    scores[self.group[row]] += error * error;
                }
            }
        }
        scores
    }
}

/// What the terms know of a geometry: polar angles and relative azimuth, to a millionth of a degree.
fn key(geometry: &Geometry) -> [i64; 3] {
    let rounded = |degrees: f64| (degrees * 1e6).round() as i64;
    let (theta_i, theta_v) = (geometry.incidence.theta_deg(), geometry.viewing.theta_deg());
    let difference = (geometry.incidence.phi_deg() - geometry.viewing.phi_deg()).rem_euclid(360.0);
    let azimuth = if theta_i == 0.0 || theta_v == 0.0 { 0.0 } else { difference.min(360.0 - difference) };
    [theta_i, theta_v, azimuth].map(rounded)
}
