//! The figures of a fitted model: the map, the averages, the residuals.

use super::angle_map::AngleMap;
use super::angle_points::AnglePoints;
use super::curve::{CurveText, Points, line_in_band};
use super::frame::with_unit;
use super::html::number;
use super::separability::{mean_over_incidence, mean_over_viewing};
use super::{Figure, ReportError, angle_map, histogram, interpolated_map, residual_map, subject, surface};
use crate::dataset::{Document, FittedParameter, FittedTerm, Model};
use crate::quantity::{EmissionAxis, QuantityKind};

/// Figures, and why others could not be drawn.
#[derive(Debug, Default)]
pub struct Drawn {
    /// What was drawn, in the order of reading.
    pub figures: Vec<Figure>,
    /// One sentence per figure that was not.
    pub not_drawn: Vec<String>,
}

impl Drawn {
    pub(super) fn take(&mut self, result: Result<Figure, ReportError>) {
        match result {
            Ok(figure) => self.figures.push(figure),
            Err(error) => self.not_drawn.push(error.in_full()),
        }
    }

    /// The measured values over both angles, three ways.
    pub(super) fn take_maps(&mut self, map: &AngleMap, subject: &str) {
        self.take(angle_map(map, &format!("{subject}: measured")));
        self.take(surface(map, &format!("{subject}: measured, gaps interpolated")));
        self.take(interpolated_map(map, &format!("{subject}: measured, gaps interpolated")));
    }

    /// The same figures under names that start with `prefix`.
    pub(super) fn prefixed(mut self, prefix: &str) -> Self {
        self.figures = self.figures.into_iter().map(|figure| figure.prefixed(prefix)).collect();
        self
    }
}

/// The figures of a model with the numbers it was fitted to (for a spectral fit, those of one wavelength). What cannot
/// be drawn (a map of directions out of the plane, say) is listed with the reason, and the rest is drawn.
#[must_use]
pub fn fitted_figures(document: &Document, model: &Model, points: &AnglePoints) -> Drawn {
    let measurement = document.measurement(model.measurement.as_str());
    let subject = measurement.map_or(model.measurement.to_string(), |one| subject::of_sample(document, one));
    let quantity = quantity_label(document, model, points.wavelength_nm);
    let mut drawn = Drawn::default();
    match AngleMap::from_points(points, &points.measured, &quantity, &model.unit) {
        Ok(map) => drawn.take_maps(&map, &subject),
        Err(error) => drawn.not_drawn.push(error.in_full()),
    }
    if let Some(separability) = &model.separability {
        drawn.take(mean_over_viewing(separability, &subject, &with_unit(&quantity, &model.unit)));
        drawn.take(mean_over_incidence(separability, &subject));
    }
    take_residuals(&mut drawn, model, points, &subject);
    take_parameter_spectra(&mut drawn, model, &subject);
    drawn.prefixed(model.id.as_str())
}

fn take_residuals(drawn: &mut Drawn, model: &Model, points: &AnglePoints, subject: &str) {
    if let Err(error) = points.check("residuals") {
        drawn.not_drawn.push(error.in_full());
        return;
    }
    let residuals = points.residuals();
    let unit = residuals.unit(&model.unit);
    let title = format!("{subject}: residuals");
    let map = AngleMap::from_points(points, &residuals.values, residuals.label(), unit);
    drawn.take(map.and_then(|map| residual_map(&map, &title)));
    let expected = residuals.is_scaled.then_some("normal distribution of standard deviation 1");
    let text = CurveText {
        name: "residual-histogram".to_owned(),
        title,
        subtitle: with_unit(&format!("r.m.s. residual {}", number(model.residuals.rms)), &model.unit),
        x: with_unit(residuals.label(), unit),
        y: "number of values".to_owned(),
        caption:
            "How the residuals are distributed. Where they are divided by their standard uncertainty, a model and \
                  uncertainties that are right give the curve drawn."
                .to_owned(),
    };
    drawn.take(histogram(&residuals.values, expected, &text));
}

/// Parameters that have one value per wavelength.
fn take_parameter_spectra(drawn: &mut Drawn, model: &Model, subject: &str) {
    let Some(nm) = model.emission.wavelengths() else { return };
    for term in &model.terms {
        for parameter in term.parameters.iter().filter(|parameter| parameter.value.len() > 1) {
            drawn.take(parameter_spectrum(nm, term, parameter, subject));
        }
    }
}

fn parameter_spectrum(
    nm: &[f64],
    term: &FittedTerm,
    parameter: &FittedParameter,
    subject: &str,
) -> Result<Figure, ReportError> {
    let points = Points {
        x: nm.to_vec(),
        y: parameter.value.clone(),
        error: parameter.standard_uncertainty.clone(),
        name: "fitted value".to_owned(),
        error_name: "± standard uncertainty".to_owned(),
    };
    let text = CurveText {
        name: format!("{}-{}", term.kind, parameter.name.replace('_', "-")),
        title: format!("{subject}: {} of the {} term", parameter.name, term.kind),
        subtitle: "fitted at each wavelength".to_owned(),
        x: "emission wavelength (nm)".to_owned(),
        y: with_unit(&parameter.name, &parameter.unit),
        caption: format!(
            "The fitted {} at each emission wavelength, in the band of its standard uncertainty from independent errors.",
            parameter.name
        ),
    };
    line_in_band(&points, None, &text)
}

/// The fitted quantity in words, with its band.
fn quantity_label(document: &Document, model: &Model, wavelength_nm: Option<f64>) -> String {
    let measurement = document.measurement(model.measurement.as_str());
    let words = measurement.map_or("value", |measurement| quantity_words(measurement.quantity.kind));
    match (wavelength_nm, &model.emission, model.reduction.as_str()) {
        (None, EmissionAxis::Band { band: None }, "luminance") => "luminance factor".to_owned(),
        _ => with_band(words, &model.emission, wavelength_nm),
    }
}

/// A quantity in words with its wavelength or band.
pub(super) fn with_band(words: &str, emission: &EmissionAxis, wavelength_nm: Option<f64>) -> String {
    match (wavelength_nm, emission) {
        (Some(nm), _) => format!("{words} at {nm} nm"),
        (None, EmissionAxis::Band { band: Some(band) }) => format!("{words}, {}–{} nm", band.from_nm, band.to_nm),
        _ => words.to_owned(),
    }
}

/// A quantity as an axis names it.
pub(super) fn quantity_words(kind: QuantityKind) -> &'static str {
    use QuantityKind as Kind;
    match kind {
        Kind::SpectralRadiance => "spectral radiance",
        Kind::SpectralIrradiance => "spectral irradiance",
        Kind::BandRadiance => "band radiance",
        Kind::Luminance => "luminance",
        Kind::RelativeSpectrum => "relative spectrum",
        Kind::RadianceFactor | Kind::BandRadianceFactor => "radiance factor",
        Kind::LuminanceFactor => "luminance factor",
        Kind::BispectralLuminescentRadianceFactor => "bispectral luminescent radiance factor",
        Kind::DonaldsonMatrix => "Donaldson matrix element",
        Kind::Brdf => "BRDF",
        Kind::Brrdf => "BRRDF",
        Kind::Unstated => "value of unstated quantity",
    }
}
