//! Fits of values that are not all alike: bounds beside values, and outliers among them.

use ndarray::{Array2, ArrayView2};

use super::columns::{Columns, Point};
use super::loss::{Loss, Working, expected, one_sided};
use super::outcome::Fit;
use super::profile::Intervals;
use super::solve::{DataError, Fitter};
use crate::dataset::{Bound, Side};

/// Most passes of least squares; ten are usual, for Tukey's loss thirty.
const MOST_PASSES: usize = 200;
/// The passes end when no prediction moves by more than this, in standard uncertainties.
const SETTLED: f64 = 1e-6;
/// The normal distribution's standard deviation over its median absolute deviation.
const MEDIAN_TO_SIGMA: f64 = 1.482_602_218_505_602;
/// An outlier is what has less than this of its weight.
const OUTLYING: f64 = 0.5;

/// What was observed.
#[derive(Debug, Clone, Copy)]
pub struct Observations<'a> {
    /// Values \[B, N\]; NaN where there is none.
    pub values: ArrayView2<'a, f64>,
    /// Their standard uncertainties \[B, N\], if known.
    pub sigma: Option<ArrayView2<'a, f64>>,
    /// Readings of which one side is known; where one is listed, `values` holds NaN.
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

/// The working data of one pass.
struct Pass {
    values: Array2<f64>,
    sigma: Array2<f64>,
    cost: f64,
}

impl Fitter<'_> {
    /// Fits observations, with intervals of the given probability.
    ///
    /// # Errors
    /// As [`Fitter::fit`].
    pub fn fit_observed<'b>(&'b self, data: &Observations<'b>, probability: f64) -> Result<Observed, DataError> {
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
        Reweighted { fitter: *self, data: *data, scale: 1.0, careful: false }.fit(probability)
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

/// The passes of one fit.
struct Reweighted<'a> {
    fitter: Fitter<'a>,
    data: Observations<'a>,
    /// Standard deviation of the residuals in units of the stated uncertainties.
    scale: f64,
    /// True where a step by curvature went up: from then on bounds are worked by their expected reading.
    careful: bool,
}

impl Reweighted<'_> {
    fn fit(mut self, probability: f64) -> Result<Observed, DataError> {
        let robust = self.data.loss != Loss::Squares;
        let mut loss = if robust { Loss::Huber } else { Loss::Squares };
        let mut pass = self.first();
        let mut predicted: Option<Array2<f64>> = None;
        let (mut passes, mut cost) = (0, f64::INFINITY);
        let (fit, settled) = loop {
            passes += 1;
            let fit = self.fitter.fit_bands(pass.values.view(), Some(pass.sigma.view()))?;
            let next = self.fitter.predicted(&fit);
            if robust && loss == Loss::Huber {
                self.scale = self.scale_of(&next);
            }
            let moved = predicted.as_ref().map_or(f64::INFINITY, |last| self.moved(last, &next));
            pass = self.worked(&next, loss);
            if !robust && pass.cost > cost * (1.0 + 1e-12) + 1e-9 {
                self.careful = true;
            }
            cost = pass.cost;
            predicted = Some(next);
            let stands = moved < SETTLED;
            if stands && loss != self.data.loss {
                // Tukey's loss has minima of its own; Huber's has one, and leads to the right one of them.
                (loss, predicted) = (self.data.loss, None);
                pass = self.worked(&self.fitter.predicted(&fit), loss);
                continue;
            }
            if stands || passes == MOST_PASSES {
                break (fit, stands);
            }
        };
        let predicted = self.fitter.predicted(&fit);
        let (fit, intervals) = self.finish(&fit, &predicted, loss, &pass, probability)?;
        let outliers = if robust { self.outliers(&predicted, loss) } else { Vec::new() };
        let scale = robust.then_some(self.scale);
        let working = (!robust).then_some((pass.values, pass.sigma));
        Ok(Observed { fit, intervals, scale, outliers, working, passes, settled })
    }

    fn sigma(&self, at: (usize, usize)) -> f64 {
        self.data.sigma.map_or(1.0, |sigma| sigma[at])
    }

    /// The values as they are, and bounds by what a reading on their side of nothing (or of the bound) would be.
    fn first(&self) -> Pass {
        let mut pass = Pass { values: self.data.values.to_owned(), sigma: self.stated(), cost: f64::INFINITY };
        for bound in self.data.bounds {
            let (at, limit) = ((bound.emission, bound.geometry), bound.bound / bound.sigma);
            let start = if bound.side == Side::AtMost { limit.min(0.0) } else { limit };
            pass.values[at] = bound.sigma * expected(bound.side, start, limit);
            pass.sigma[at] = bound.sigma;
        }
        pass
    }

    fn stated(&self) -> Array2<f64> {
        Array2::from_shape_fn(self.data.values.dim(), |at| self.sigma(at))
    }

    /// Working values and weights at a prediction.
    fn worked(&self, predicted: &Array2<f64>, loss: Loss) -> Pass {
        let mut pass = Pass { values: self.data.values.to_owned(), sigma: self.stated(), cost: 0.0 };
        if loss != Loss::Squares {
            for (at, sigma) in pass.sigma.indexed_iter_mut() {
                let u = (self.data.values[at] - predicted[at]) / (self.scale * *sigma);
                if u.is_finite() {
                    *sigma *= self.scale / loss.weight(u).sqrt();
                }
            }
        } else {
            let residual = |(at, value): ((usize, usize), &f64)| (value - predicted[at]) / self.sigma(at);
            let costs = self.data.values.indexed_iter().map(residual).map(|u| u * u);
            pass.cost = costs.filter(|cost| cost.is_finite()).sum();
        }
        for bound in self.data.bounds {
            let at = (bound.emission, bound.geometry);
            let sigma = bound.sigma * self.scale;
            let (mu, limit) = (predicted[at] / sigma, bound.bound / sigma);
            if !mu.is_finite() {
                continue;
            }
            let Working { value, weight, cost } = one_sided(bound.side, mu, limit);
            pass.cost += cost;
            (pass.values[at], pass.sigma[at]) = if self.careful {
                (sigma * expected(bound.side, mu, limit), sigma)
            } else {
                (sigma * value, sigma / weight.sqrt())
            };
        }
        pass
    }

    /// The largest move of a prediction, in standard uncertainties.
    fn moved(&self, last: &Array2<f64>, next: &Array2<f64>) -> f64 {
        let moves = next.indexed_iter().map(|(at, next)| (next - last[at]).abs() / (self.sigma(at) * self.scale));
        moves.filter(|moved| moved.is_finite()).fold(0.0, f64::max)
    }

    fn residuals(&self, predicted: &Array2<f64>) -> Vec<((usize, usize), f64)> {
        let residual = |(at, value): ((usize, usize), &f64)| (at, (value - predicted[at]) / self.sigma(at));
        self.data.values.indexed_iter().map(residual).filter(|(_, u)| u.is_finite()).collect()
    }

    /// From the median absolute residual, with the degrees of freedom that the parameters took.
    fn scale_of(&self, predicted: &Array2<f64>) -> f64 {
        let mut sizes: Vec<f64> = self.residuals(predicted).into_iter().map(|(_, u)| u.abs()).collect();
        let (count, parameters) = (sizes.len(), self.fitter.parameters(predicted.nrows()));
        let lost = (count as f64 / (count.saturating_sub(parameters).max(1)) as f64).sqrt();
        let middle = sizes.len() / 2;
        if sizes.is_empty() {
            return 1.0;
        }
        let median = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
        // Values without noise: then any scale will do that is not 0.
        (MEDIAN_TO_SIGMA * median * lost).max(1e-9)
    }

    fn outliers(&self, predicted: &Array2<f64>, loss: Loss) -> Vec<(usize, usize)> {
        let light = |&(_, u): &((usize, usize), f64)| loss.weight(u / self.scale) < OUTLYING;
        self.residuals(predicted).into_iter().filter(light).map(|(at, _)| at).collect()
    }

    /// Covariance and intervals at the solution, and the chi-square of the values.
    fn finish(
        &self,
        solution: &Fit,
        predicted: &Array2<f64>,
        loss: Loss,
        pass: &Pass,
        probability: f64,
    ) -> Result<(Fit, Intervals), DataError> {
        let (mut values, mut sigma) = (pass.values.clone(), pass.sigma.clone());
        if loss != Loss::Squares {
            // Least squares of the predictions themselves have the solution for their minimum, and the variance of the
            // estimate (Huber 1981, 7.6) for theirs where each value has this uncertainty.
            let factor = self.spread(predicted, loss);
            values.assign(predicted);
            values.zip_mut_with(&self.data.values, |value, measured| {
                *value = if measured.is_finite() { *value } else { f64::NAN };
            });
            sigma = self.stated().mapv(|sigma| factor * sigma);
            for bound in self.data.bounds {
                let at = (bound.emission, bound.geometry);
                (values[at], sigma[at]) = (predicted[at], pass.sigma[at]);
            }
        }
        let (mut fit, intervals) = self.fitter.fit_with_intervals(values.view(), Some(sigma.view()), probability)?;
        fit.specular_gain = solution.specular_gain;
        fit.evaluations = solution.evaluations;
        let residuals = self.residuals(predicted);
        for band in &mut fit.bands {
            (band.chi_square, band.count) = (0.0, 0);
        }
        for ((emission, _), u) in &residuals {
            fit.bands[*emission].chi_square += u * u;
            fit.bands[*emission].count += 1;
        }
        fit.chi_square = fit.bands.iter().map(|band| band.chi_square).sum();
        let bounds = self.data.bounds.len() as f64;
        fit.degrees_of_freedom = (fit.degrees_of_freedom - bounds).max(1.0);
        Ok((fit, intervals))
    }

    /// The standard deviation that a value of unit uncertainty seems to have for the estimate's variance.
    fn spread(&self, predicted: &Array2<f64>, loss: Loss) -> f64 {
        let residuals = self.residuals(predicted);
        let count = residuals.len() as f64;
        let freedom = (count - self.fitter.parameters(predicted.nrows()) as f64).max(1.0);
        let (mut square, mut curved) = (0.0, 0.0);
        for (_, u) in residuals {
            let u = u / self.scale;
            square += (loss.weight(u) * u).powi(2);
            curved += loss.curvature(u);
        }
        self.scale * (square / freedom).sqrt() / (curved / count).max(0.1)
    }
}
