//! Which model is preferred, and which others the data cannot tell from it.

use super::apart::{Difference, differences};
use super::{Compared, Shape};
use crate::dataset::Reduced;
use crate::quantity::Reference;
use crate::terms::TermKind;

/// Differences of AICc below this say nothing (Burnham and Anderson 2002, 2.6).
const AICC_SAYS_NOTHING: f64 = 2.0;

/// The information criteria of a fit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Criterion {
    /// Akaike's, corrected for few values.
    pub aicc: f64,
    /// The Bayesian one.
    pub bic: f64,
}

impl Criterion {
    /// From chi-square, or from the sum of squared residuals where no uncertainty is known: then -2 ln L is n ln(RSS/n),
    /// and the variance is one more parameter.
    #[must_use]
    pub fn of(chi_square: f64, values: usize, parameters: usize, has_sigma: bool) -> Self {
        let n = values as f64;
        let (deviance, k) = if has_sigma {
            (chi_square, parameters as f64)
        } else {
            (n * (chi_square / n).ln(), parameters as f64 + 1.0)
        };
        let correction = if n > k + 1.0 { 2.0 * k * (k + 1.0) / (n - k - 1.0) } else { f64::NAN };
        Self { aicc: deviance + 2.0 * k + correction, bic: deviance + k * n.ln() }
    }
}

/// A model that the data cannot tell from the preferred one.
#[derive(Debug, Clone, PartialEq)]
pub struct Indistinguishable {
    /// The other model.
    pub shape: Shape,
    /// Its AICc minus that of the preferred one.
    pub delta_aicc: f64,
    /// Its cross-validation minus that of the preferred one, and the standard error of that.
    pub delta_cross_validation: (f64, f64),
    /// The geometries at which the two differ most, over the noise of one value; the best first.
    pub apart: Vec<Difference>,
}

/// Sorts by cross-validation; the position of the model of fewest parameters within one standard error of the best.
pub(super) fn rank(models: &mut [Compared]) -> usize {
    // What is no model of its own goes last.
    models.sort_by(|a, b| b.is_own.cmp(&a.is_own).then(a.cross_validation.total_cmp(&b.cross_validation)));
    let Some(best) = models.first().map(|best| best.scores.clone()) else { return 0 };
    for model in models.iter_mut() {
        let values: usize = model.fit.bands.iter().map(|band| band.count).sum();
        model.behind = behind(&model.scores, &best, values as f64);
    }
    let within = |model: &Compared| model.is_own && model.behind.0 <= model.behind.1;
    let near = models.iter().enumerate().filter(|(_, model)| within(model));
    let by_size = |(_, a): &(usize, &Compared), (_, b): &(usize, &Compared)| {
        a.parameters.cmp(&b.parameters).then(a.cross_validation.total_cmp(&b.cross_validation))
    };
    near.min_by(by_size).map_or(0, |(position, _)| position)
}

/// Mean difference per value, with its standard error from the scatter over the geometries.
fn behind(scores: &[f64], best: &[f64], values: f64) -> (f64, f64) {
    let differences: Vec<f64> = scores.iter().zip(best).map(|(a, b)| a - b).collect();
    let groups = differences.len() as f64;
    let sum: f64 = differences.iter().sum();
    let square: f64 = differences.iter().map(|d| (d - sum / groups).powi(2)).sum();
    (sum / values, (groups * square / (groups - 1.0).max(1.0)).sqrt() / values)
}

pub(super) fn indistinguishable(
    models: &[Compared],
    preferred: usize,
    data: &Reduced,
    reference: &Reference,
    diffuse: TermKind,
) -> Vec<Indistinguishable> {
    let Some(chosen) = models.get(preferred) else { return Vec::new() };
    let values: f64 = chosen.fit.bands.iter().map(|band| band.count as f64).sum();
    let others = models.iter().enumerate().filter(|(position, model)| *position != preferred && model.is_own);
    others
        .filter_map(|(_, other)| {
            let delta_aicc = other.aicc - chosen.aicc;
            let delta = behind(&other.scores, &chosen.scores, values);
            let same = delta_aicc.abs() < AICC_SAYS_NOTHING || delta.0.abs() <= delta.1;
            same.then(|| Indistinguishable {
                shape: other.shape,
                delta_aicc,
                delta_cross_validation: delta,
                apart: differences((chosen.shape, &chosen.fit), (other.shape, &other.fit), data, reference, diffuse),
            })
        })
        .collect()
}
