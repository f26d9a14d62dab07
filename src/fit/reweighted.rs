//! The passes of a fit of observations: least squares of working values and weights, formed anew until they stand still.

use std::collections::HashSet;

use ndarray::Array2;

use super::error::DataError;
use super::left_out::reason;
use super::loss::{Loss, Working, expected, one_sided};
use super::magnitude;
use super::observed::{Observations, Observed};
use super::outcome::Fit;
use super::profile::Intervals;
use super::solve::Fitter;
use crate::dataset::{Bound, Side};

/// Most passes of least squares; ten are usual, for Tukey's loss thirty.
const MOST_PASSES: usize = 200;
/// The passes end when no prediction moves by more than this, in standard uncertainties.
const SETTLED: f64 = 1e-6;
/// The normal distribution's standard deviation over its median absolute deviation.
const MEDIAN_TO_SIGMA: f64 = 1.482_602_218_505_602;
/// The least scale of residuals over the largest value, each in its uncertainties: of values without noise any will do that
/// is not 0 and lets the passes stand still.
const LEAST_SCALE: f64 = 1e-8;
/// The least mean curvature of a loss: where most values are outliers nothing is known.
const LEAST_CURVED: f64 = 0.1;
/// An outlier is what has less than this of its weight.
const OUTLYING: f64 = 0.5;

/// The working data of one pass.
struct Pass {
    values: Array2<f64>,
    sigma: Array2<f64>,
    cost: f64,
}

/// The passes of one fit.
pub(super) struct Reweighted<'a> {
    fitter: Fitter<'a>,
    /// Values; none where there is a bound.
    values: Array2<f64>,
    /// Their standard uncertainties, 1 where none are stated, and in the place of a bound that of the bound.
    sigma: Array2<f64>,
    /// The bounds that can be used.
    bounds: Vec<Bound>,
    loss: Loss,
    /// Standard deviation of the residuals in units of the stated uncertainties.
    scale: f64,
    /// True where a step by curvature went up: from then on bounds are worked by their expected reading.
    careful: bool,
}

impl<'a> Reweighted<'a> {
    pub(super) fn new(fitter: Fitter<'a>, data: &Observations<'_>) -> Result<Self, DataError> {
        fitter.check_shape(data.values, data.sigma)?;
        let (mut values, mut placed) = (data.values.to_owned(), HashSet::new());
        let mut sigma = data.sigma.map_or_else(|| Array2::ones(values.dim()), |sigma| sigma.to_owned());
        let mut bounds = Vec::with_capacity(data.bounds.len());
        for bound in data.bounds {
            let at = (bound.emission, bound.geometry);
            let misplaced = |problem| DataError::Bound { emission: at.0, geometry: at.1, problem };
            if at.0 >= values.nrows() || at.1 >= values.ncols() {
                return Err(misplaced("there is no such value"));
            }
            if !placed.insert(at) {
                return Err(misplaced("there is another bound for the same value; one of the two says less"));
            }
            if data.sigma.is_none() {
                return Err(misplaced("the values beside it have no uncertainties, so that its weight is not known"));
            }
            (values[at], sigma[at]) = (bound.bound, bound.sigma);
            if reason(bound.bound, Some(bound.sigma)).is_none() {
                bounds.push(*bound);
            }
        }
        magnitude::check(values.view(), Some(sigma.view()), false)?;
        bounds.iter().for_each(|bound| values[(bound.emission, bound.geometry)] = f64::NAN);
        Ok(Self { fitter, values, sigma, bounds, loss: data.loss, scale: 1.0, careful: false })
    }

    pub(super) fn fit(mut self, probability: f64) -> Result<Observed, DataError> {
        let robust = self.loss != Loss::Squares;
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
            if stands && loss != self.loss {
                // Tukey's loss has minima of its own; Huber's has one, and leads to the right one of them.
                (loss, predicted) = (self.loss, None);
                pass = self.worked(&self.fitter.predicted(&fit), loss);
                continue;
            }
            if stands || passes == MOST_PASSES {
                break (fit, stands);
            }
        };
        let predicted = self.fitter.predicted(&fit);
        // An expected reading is known less well than a reading: the covariance is that of the curvature.
        self.careful = false;
        let pass = self.worked(&predicted, loss);
        let (fit, intervals) = self.finish(&fit, &predicted, loss, &pass, probability)?;
        let outliers = if robust { self.outliers(&predicted, loss) } else { Vec::new() };
        let scale = robust.then_some(self.scale);
        let working = (!robust).then_some((pass.values, pass.sigma));
        Ok(Observed { fit, intervals, scale, outliers, working, passes, settled })
    }

    /// The values as they are, and bounds by what a reading on their side of nothing (or of the bound) would be.
    fn first(&self) -> Pass {
        let mut pass = Pass { values: self.values.clone(), sigma: self.sigma.clone(), cost: f64::INFINITY };
        for bound in &self.bounds {
            let (at, limit) = ((bound.emission, bound.geometry), bound.bound / bound.sigma);
            let start = if bound.side == Side::AtMost { limit.min(0.0) } else { limit };
            pass.values[at] = bound.sigma * expected(bound.side, start, limit);
            pass.sigma[at] = bound.sigma;
        }
        pass
    }

    /// Working values and weights at a prediction.
    fn worked(&self, predicted: &Array2<f64>, loss: Loss) -> Pass {
        let mut pass = Pass { values: self.values.clone(), sigma: self.sigma.clone(), cost: 0.0 };
        if loss != Loss::Squares {
            for (at, sigma) in pass.sigma.indexed_iter_mut() {
                let u = (self.values[at] - predicted[at]) / (self.scale * *sigma);
                if u.is_finite() {
                    *sigma *= self.scale / loss.weight(u).sqrt();
                }
            }
        } else {
            pass.cost = self.residuals(predicted).into_iter().map(|(_, u)| u * u).sum();
        }
        for bound in &self.bounds {
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
        let moves = next.indexed_iter().map(|(at, next)| (next - last[at]).abs() / (self.sigma[at] * self.scale));
        moves.filter(|moved| moved.is_finite()).fold(0.0, f64::max)
    }

    fn residuals(&self, predicted: &Array2<f64>) -> Vec<((usize, usize), f64)> {
        let takes_part = |&(at, value): &((usize, usize), &f64)| reason(*value, Some(self.sigma[at])).is_none();
        let residual = |(at, value): ((usize, usize), &f64)| (at, (value - predicted[at]) / self.sigma[at]);
        self.values.indexed_iter().filter(takes_part).map(residual).filter(|(_, u)| u.is_finite()).collect()
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
        (MEDIAN_TO_SIGMA * median * lost).max(self.least_scale())
    }

    /// What stands for the scale of values without noise.
    fn least_scale(&self) -> f64 {
        let sizes = self.values.indexed_iter().map(|(at, value)| (value / self.sigma[at]).abs());
        let largest = sizes.filter(|size| size.is_finite()).fold(0.0, f64::max);
        if largest > 0.0 { LEAST_SCALE * largest } else { 1.0 }
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
            // Least squares of pseudo-values have the solution for their minimum, also where that lies on a bound, and the
            // variance of the estimate for theirs (Huber 1981, 7.6 and 7.10).
            let Spread { scatter, curved } = self.spread(predicted, loss);
            for ((emission, geometry), u) in self.residuals(predicted) {
                let (at, u) = ((emission, geometry), u / self.scale);
                values[at] = predicted[at] + loss.weight(u) * u * self.scale * self.sigma[at] / curved;
                sigma[at] = scatter * self.sigma[at];
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
        let took_part = |bound: &&Bound| predicted[(bound.emission, bound.geometry)].is_finite();
        let bounds = self.bounds.iter().filter(took_part).count() as f64;
        fit.degrees_of_freedom = (fit.degrees_of_freedom - bounds).max(1.0);
        Ok((fit, intervals))
    }

    fn spread(&self, predicted: &Array2<f64>, loss: Loss) -> Spread {
        let residuals = self.residuals(predicted);
        let count = residuals.len() as f64;
        let freedom = (count - self.fitter.parameters(predicted.nrows()) as f64).max(1.0);
        let (mut square, mut curved) = (0.0, 0.0);
        for (_, u) in residuals {
            let u = u / self.scale;
            square += (loss.weight(u) * u).powi(2);
            curved += loss.curvature(u);
        }
        let curved = (curved / count).max(LEAST_CURVED);
        Spread { scatter: (self.scale * (square / freedom).sqrt() / curved).max(self.least_scale()), curved }
    }
}

/// What a robust loss makes of the residuals.
struct Spread {
    /// The standard deviation that a value of unit uncertainty seems to have for the variance of the estimate.
    scatter: f64,
    /// The mean curvature of the loss.
    curved: f64,
}
