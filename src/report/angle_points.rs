//! The numbers that a model was fitted to, over their geometries.

use ndarray::{Array2, ArrayView1};

use super::ReportError;
use crate::dataset::{Document, Model, Reduced, Reduction, reduce, residuals};
use crate::quantity::{EmissionAxis, Geometry};

/// The numbers that a model was fitted to, one per geometry, with what the model predicts.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct AnglePoints {
    /// Directions of each value.
    pub geometry: Vec<Geometry>,
    /// Measured values, in the unit of the model; NaN where there is none.
    pub measured: Vec<f64>,
    /// Their standard uncertainties; NaN where unknown.
    pub sigma: Vec<f64>,
    /// What the model predicts.
    pub predicted: Vec<f64>,
    /// The wavelength they belong to, nm, where the model was fitted to each wavelength: that of the largest mean value.
    pub wavelength_nm: Option<f64>,
}

impl AnglePoints {
    /// The numbers of a model of the document: its measurement, reduced as the model says. Of a model fitted to each
    /// wavelength, those of the wavelength at which the mean value is largest.
    ///
    /// # Errors
    /// [`ReportError`] when the measurement is not there, cannot be reduced so, has another emission axis than the model,
    /// or the model cannot be evaluated.
    pub fn of(document: &Document, model: &Model) -> Result<Self, ReportError> {
        let name = || model.id.to_string();
        let measurement = document
            .measurement(model.measurement.as_str())
            .ok_or_else(|| ReportError::NoMeasurement { model: name(), measurement: model.measurement.to_string() })?;
        let reduction: Reduction =
            model.reduction.parse().map_err(|source| ReportError::Reduction { model: name(), source })?;
        let data =
            reduce(document, measurement, reduction).map_err(|source| ReportError::Reduce { model: name(), source })?;
        check_axis(model, &data)?;
        let (residual, _) =
            residuals(model, &data, 0).map_err(|source| ReportError::Terms { model: name(), source })?;
        let points = Self::measured(&data);
        let residual = column(&residual, strongest(&data.values));
        let predicted = points.measured.iter().zip(residual).map(|(value, residual)| value - residual).collect();
        Ok(Self { predicted, ..points })
    }

    /// The numbers of a scan at its strongest emission value, with nothing predicted.
    pub(super) fn measured(data: &Reduced) -> Self {
        let emission = strongest(&data.values);
        let measured = column(&data.values, emission);
        let unknown = vec![f64::NAN; measured.len()];
        Self {
            geometry: data.geometry.clone(),
            sigma: data.sigma.as_ref().map_or(unknown.clone(), |sigma| column(sigma, emission)),
            predicted: unknown,
            measured,
            wavelength_nm: data.emission.wavelengths().and_then(|nm| nm.get(emission)).copied(),
        }
    }

    /// Checks that there is one of each per geometry.
    pub(super) fn check(&self, figure: &str) -> Result<(), ReportError> {
        let expected = self.geometry.len();
        let lists =
            [("measured", self.measured.len()), ("sigma", self.sigma.len()), ("predicted", self.predicted.len())];
        match lists.into_iter().find(|(_, found)| *found != expected) {
            Some((what, found)) => Err(ReportError::Lengths { figure: figure.to_owned(), what, found, expected }),
            None => Ok(()),
        }
    }

    /// Root mean square of measured minus predicted, in the unit of the values.
    pub(super) fn rms(&self) -> f64 {
        let squares = self.measured.iter().zip(&self.predicted).map(|(value, predicted)| (value - predicted).powi(2));
        let finite: Vec<f64> = squares.filter(|square| square.is_finite()).collect();
        (finite.iter().sum::<f64>() / finite.len() as f64).sqrt()
    }

    /// ` at 528 nm`, or nothing.
    pub(super) fn at_wavelength(&self) -> String {
        self.wavelength_nm.map_or_else(String::new, |nm| format!(" at {nm} nm"))
    }

    /// Measured minus predicted: over the standard uncertainty where every value has one, else as it is.
    pub(super) fn residuals(&self) -> ScaledResiduals {
        let pairs = || self.measured.iter().zip(&self.predicted).zip(&self.sigma);
        let usable = |value: &f64, sigma: &f64| !value.is_finite() || (sigma.is_finite() && *sigma > 0.0);
        let is_scaled = pairs().all(|((value, _), sigma)| usable(value, sigma));
        let values = pairs()
            .map(|((measured, predicted), sigma)| (measured - predicted) / if is_scaled { *sigma } else { 1.0 })
            .collect();
        ScaledResiduals { values, is_scaled }
    }
}

/// Checks that an emission index means the same in the model and in its data.
fn check_axis(model: &Model, data: &Reduced) -> Result<(), ReportError> {
    let is_same = match (model.emission.wavelengths(), data.emission.wavelengths()) {
        (Some(stored), Some(data)) => stored == data,
        (None, None) => true,
        _ => false,
    };
    if is_same {
        return Ok(());
    }
    let in_words = |axis: &EmissionAxis| match axis.wavelengths() {
        Some([first, .., last]) => format!("{} wavelengths from {first} to {last} nm", axis.len()),
        Some([only]) => format!("{only} nm"),
        Some([]) => "no wavelength".to_owned(),
        None => "one band".to_owned(),
    };
    let (stored, data) = (in_words(&model.emission), in_words(&data.emission));
    Err(ReportError::OtherAxis { model: model.id.to_string(), stored, data })
}

/// Residuals, and in what they are counted.
#[derive(Debug)]
pub(super) struct ScaledResiduals {
    pub(super) values: Vec<f64>,
    /// Over the standard uncertainty.
    pub(super) is_scaled: bool,
}

impl ScaledResiduals {
    pub(super) fn label(&self) -> &'static str {
        if self.is_scaled { "(measured − predicted) / standard uncertainty" } else { "measured − predicted" }
    }

    pub(super) fn unit<'a>(&self, unit: &'a str) -> &'a str {
        if self.is_scaled { "1" } else { unit }
    }
}

/// The emission index at which the mean of the finite values is largest.
pub(super) fn strongest(values: &Array2<f64>) -> usize {
    let mean = |row: ArrayView1<'_, f64>| {
        let finite: Vec<f64> = row.iter().copied().filter(|value| value.is_finite()).collect();
        finite.iter().sum::<f64>() / finite.len() as f64
    };
    let means = values.rows().into_iter().map(mean).enumerate().filter(|(_, mean)| mean.is_finite());
    means.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(0, |(index, _)| index)
}

/// The values of all geometries at an emission index; none where there is no such index.
fn column(values: &Array2<f64>, emission: usize) -> Vec<f64> {
    if emission < values.nrows() { values.row(emission).to_vec() } else { Vec::new() }
}
