//! Fits of values that are not all alike: bounds beside values, and outliers among them.

use ndarray::{Array2, ArrayView2};

use super::columns::{Columns, Point};
use super::error::DataError;
use super::loss::Loss;
use super::outcome::Fit;
use super::profile::Intervals;
use super::reweighted::Reweighted;
use super::solve::Fitter;
use crate::dataset::Bound;

/// What was observed.
#[derive(Debug, Clone, Copy)]
pub struct Observations<'a> {
    /// Values \[B, N\]; NaN where there is none.
    pub values: ArrayView2<'a, f64>,
    /// Their standard uncertainties \[B, N\], if known.
    pub sigma: Option<ArrayView2<'a, f64>>,
    /// Readings of which one side is known. What `values` holds in the place of one does not count.
    pub bounds: &'a [Bound],
    /// What a residual costs.
    pub loss: Loss,
}

/// A fit of observations.
#[derive(Debug, Clone, PartialEq)]
pub struct Observed {
    /// The fit. Chi-square and degrees of freedom are of the values; bounds count for the parameters only.
    pub fit: Fit,
    /// Intervals of its parameters.
    pub intervals: Intervals,
    /// The residuals' standard deviation in units of the stated uncertainties, of a robust loss; of no unit where none is
    /// stated.
    pub scale: Option<f64>,
    /// Indices (emission, geometry) of values that a robust loss gave less than half of their weight.
    pub outliers: Vec<(usize, usize)>,
    /// Values and standard uncertainties \[B, N\] of which plain least squares has the same minimum; none where those are the
    /// observations themselves.
    pub working: Option<(Array2<f64>, Array2<f64>)>,
    /// Passes of least squares.
    pub passes: usize,
    /// True where the passes stood still in the end.
    pub settled: bool,
}

impl Fitter<'_> {
    /// Fits observations, with intervals of the given probability.
    ///
    /// A bound replaces what `values` holds in its place. One that is no number, or whose uncertainty is none, is left out
    /// as a value would be.
    ///
    /// # Errors
    /// As [`Fitter::fit`]; a bound that has no place, or a place that another has, and bounds beside values without
    /// uncertainties are errors, too.
    pub fn fit_observed(&self, data: &Observations<'_>, probability: f64) -> Result<Observed, DataError> {
        if data.bounds.is_empty() && data.loss == Loss::Squares {
            let (fit, intervals) = self.fit_with_intervals(data.values, data.sigma, probability)?;
            return Ok(Observed {
                fit,
                intervals,
                scale: None,
                outliers: Vec::new(),
                working: None,
                passes: 1,
                settled: true,
            });
        }
        Reweighted::new(*self, data)?.fit(probability)
    }

    /// The predicted values \[B, N\] of a fit; NaN at a geometry where a term is undefined.
    #[must_use]
    pub fn predicted(&self, fit: &Fit) -> Array2<f64> {
        let mut columns = Columns::default();
        let has_specular = fit.has_specular();
        if has_specular {
            columns.update(self.set, &Point { log: [fit.roughness.ln(), fit.index_minus_one.ln()] });
        }
        let mut predicted = Array2::from_elem((fit.bands.len(), self.set.len()), f64::NAN);
        for (band, mut row) in fit.bands.iter().zip(predicted.rows_mut()) {
            for (point, &input) in self.set.order.iter().enumerate() {
                let specular = if has_specular { band.intensity * columns.specular[point] } else { 0.0 };
                row[input] = band.diffuse * self.set.diffuse[point] + specular;
            }
        }
        predicted
    }
}
