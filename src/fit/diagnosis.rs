//! What a fit rests on: residuals, leverage and influence of each value, and the profile of each parameter.

use ndarray::{Array2, ArrayView2, Zip};

use super::error::DataError;
use super::measurement::{Prepared, fit_reduced, prepared};
use super::options::{FitError, FitOptions};
use super::outcome::Fit;
use super::profile::{Intervals, ProfileCurve};
use super::repeats::Repeats;
use super::solve::{Fitter, Terms};
use crate::dataset::{Document, Measurement, Reduced};

/// Probability of the intervals of a diagnosis.
const PROBABILITY: f64 = 0.95;
/// A value whose leverage is within this of 1 is met whatever it is.
const ALONE: f64 = 1e-9;

/// A fit with what it rests on. Tables are \[B, N\], NaN for a value that took no part.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// The fit.
    pub fit: Fit,
    /// Intervals of its parameters.
    pub intervals: Intervals,
    /// Predicted values; NaN at a geometry where a term is undefined.
    pub predicted: Array2<f64>,
    /// Measured minus predicted over the standard uncertainty; where none is stated, over that of the residuals.
    pub residual: Array2<f64>,
    /// Diagonal of the hat matrix: what a prediction moves by when its value moves by one.
    pub leverage: Array2<f64>,
    /// Cook's distance: how far all predictions move when the value is left out, per parameter. Infinite for a value that
    /// alone determines a parameter.
    pub influence: Array2<f64>,
    /// Parameters that are free and told by the data; the leverages add up to it.
    pub parameters: usize,
    /// Profiles of the parameters that have an interval.
    pub profiles: Vec<ProfileCurve>,
}

impl Fitter<'_> {
    /// Fits as [`Fitter::fit_with_intervals`], and tells what the fit rests on.
    ///
    /// # Errors
    /// As [`Fitter::fit`].
    pub fn diagnose(
        &self,
        values: ArrayView2<f64>,
        sigma: Option<ArrayView2<f64>>,
        probability: f64,
    ) -> Result<Diagnosis, DataError> {
        let (fit, intervals) = self.fit_with_intervals(values, sigma, probability)?;
        let data = self.prepare(values, sigma)?;
        let leverage = self.leverage(&data, &fit);
        let predicted = self.predicted(&fit);
        let profiles = self.curves(&data, &fit, &intervals);
        let scale = if sigma.is_some() { 1.0 } else { (fit.chi_square / fit.degrees_of_freedom).sqrt() };
        let mut residual = &values - &predicted;
        residual.indexed_iter_mut().for_each(|(at, residual)| {
            let took_part = leverage.hat[at].is_finite();
            *residual = if took_part { *residual / (scale * sigma.map_or(1.0, |sigma| sigma[at])) } else { f64::NAN };
        });
        let parameters = leverage.parameters;
        let cook = |u: f64, h: f64| match 1.0 - h {
            left if left < ALONE => f64::INFINITY,
            left => u * u * h / (parameters.max(1) as f64 * left * left),
        };
        let influence = Zip::from(&residual).and(&leverage.hat).map_collect(|u, h| cook(*u, *h));
        Ok(Diagnosis { fit, intervals, predicted, residual, leverage: leverage.hat, influence, parameters, profiles })
    }
}

impl Diagnosis {
    /// Indices (emission, geometry) of the most influential values, the first the most.
    #[must_use]
    pub fn most_influential(&self, count: usize) -> Vec<(usize, usize)> {
        let mut all: Vec<((usize, usize), f64)> = self
            .influence
            .indexed_iter()
            .map(|(at, influence)| (at, *influence))
            .filter(|(_, d)| !d.is_nan())
            .collect();
        all.sort_by(|a, b| b.1.total_cmp(&a.1));
        all.into_iter().take(count).map(|(at, _)| at).collect()
    }

    /// Weighted sum of squared residuals of each emission value over its share of the degrees of freedom.
    #[must_use]
    pub fn reduced_chi_square(&self) -> Vec<f64> {
        let sums = self.residual.rows().into_iter().zip(self.leverage.rows());
        sums.map(|(residual, leverage)| {
            let finite = residual.iter().zip(leverage).filter(|(u, _)| u.is_finite());
            let (square, freedom) = finite.fold((0.0, 0.0), |(sum, free), (u, h)| (sum + u * u, free + 1.0 - h));
            square / freedom
        })
        .collect()
    }
}

/// A measurement's diagnosis with the numbers that were fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasurementDiagnosis {
    /// The numbers.
    pub data: Reduced,
    /// What the fit rests on.
    pub diagnosis: Diagnosis,
    /// Geometries that were measured more than once; `None` where there are none or no uncertainties to compare with.
    pub repeats: Option<Repeats>,
}

/// Tells what the fit of a measurement rests on: the plain fit of its values, roughness and index common, each value with
/// its whole uncertainty by itself. That is the fit of [`super::fit_measurement`] without a robust loss and effects of the
/// instrument, and but for the weight of records whose wavelengths hang together.
///
/// # Errors
/// As [`super::fit_measurement`].
pub fn diagnose_measurement(
    document: &Document,
    measurement: &Measurement,
    options: &FitOptions,
) -> Result<MeasurementDiagnosis, FitError> {
    let name = || measurement.id.to_string();
    let data_error = |source| FitError::Data { measurement: name(), source };
    let Prepared { choice, data, reference, .. } = prepared(document, measurement, options)?;
    let (set, fits, _) = fit_reduced(&name(), &data, &reference, choice.terms(), options)?;
    let terms = Terms { specular: choice.terms().specular && fits.has_specular(), ..choice.terms() };
    let sigma = data.sigma.as_ref().map(|sigma| sigma.view());
    let diagnosis = Fitter::new(&set, terms).diagnose(data.values.view(), sigma, PROBABILITY).map_err(data_error)?;
    let repeats = data.sigma.as_ref().and_then(|sigma| Repeats::of(&data.geometry, &data.values, sigma));
    Ok(MeasurementDiagnosis { data, diagnosis, repeats })
}
