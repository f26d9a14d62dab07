//! The figures of a fitted model: the map, the averages, the residuals.

use super::angle_map::AngleMap;
use super::angle_points::AnglePoints;
use super::curve::{CurveText, Points, line_in_band};
use super::frame::with_unit;
use super::html::number;
use super::separability::{mean_over_incidence, mean_over_viewing};
use super::{Figure, ReportError, angle_map, histogram, interpolated_map, residual_map, subject, surface};
use crate::dataset::{Document, FittedParameter, FittedTerm, Measurement, Model};
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

    /// The measured values over both angles, three ways; `at` is the wavelength, if there is one.
    pub(super) fn take_maps(&mut self, map: &AngleMap, subject: &str, at: &str) {
        self.take(angle_map(map, &format!("{subject}: measured{at}")));
        self.take(surface(map, &format!("{subject}: measured{at}, gaps interpolated")));
        self.take(interpolated_map(map, &format!("{subject}: measured{at}, gaps interpolated")));
    }

    /// The same figures with one more sentence in their captions.
    fn noted(mut self, sentence: Option<&str>) -> Self {
        if let Some(sentence) = sentence {
            self.figures = self.figures.into_iter().map(|figure| figure.noted(sentence)).collect();
        }
        self
    }

    fn append(&mut self, other: Self) {
        self.figures.extend(other.figures);
        self.not_drawn.extend(other.not_drawn);
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
    let why = why_this_wavelength(model, points);
    let mut maps = Drawn::default();
    match AngleMap::from_points(points, &points.measured, &quantity, &model.unit) {
        Ok(map) => maps.take_maps(&map, &subject, &points.at_wavelength()),
        Err(error) => maps.not_drawn.push(error.in_full()),
    }
    let mut drawn = maps.noted(why.as_deref());
    if let Some(separability) = &model.separability {
        let quantity = if points.wavelength_nm.is_some() {
            format!("{} over {}", quantity_label(document, model, None), wavelengths(model))
        } else {
            quantity
        };
        drawn.take(mean_over_viewing(separability, &subject, &with_unit(&quantity, &model.unit)));
        drawn.take(mean_over_incidence(separability, &subject));
    }
    let mut residuals = Drawn::default();
    take_residuals(&mut residuals, model, points, &subject);
    drawn.append(residuals.noted(why.as_deref()));
    take_parameter_spectra(&mut drawn, model, measurement, &subject);
    drawn.prefixed(model.id.as_str())
}

/// Of a model of several wavelengths: which one is shown, and why that one.
fn why_this_wavelength(model: &Model, points: &AnglePoints) -> Option<String> {
    let nm = points.wavelength_nm.filter(|_| model.emission.len() > 1)?;
    Some(format!(
        "Shown at {nm} nm, where the mean of the fitted values is largest; the model has {}.",
        wavelengths(model)
    ))
}

fn wavelengths(model: &Model) -> String {
    match model.emission.len() {
        1 => "1 wavelength".to_owned(),
        count => format!("{count} wavelengths"),
    }
}

fn take_residuals(drawn: &mut Drawn, model: &Model, points: &AnglePoints, subject: &str) {
    if let Err(error) = points.check("residuals") {
        drawn.not_drawn.push(error.in_full());
        return;
    }
    let residuals = points.residuals();
    let unit = residuals.unit(&model.unit);
    let at = points.at_wavelength();
    let title = format!("{subject}: residuals{at}");
    let map = AngleMap::from_points(points, &residuals.values, residuals.label(), unit);
    drawn.take(map.and_then(|map| residual_map(&map, &title)));
    let expected = residuals.is_scaled.then_some("normal distribution of standard deviation 1");
    let text = CurveText {
        name: "residual-histogram".to_owned(),
        title,
        subtitle: with_unit(&rms_in_words(model, points), &model.unit),
        x: with_unit(residuals.label(), unit),
        y: "number of values".to_owned(),
        caption: format!(
            "How the residuals{at} are distributed. Where they are divided by their standard uncertainty, a model and \
                 uncertainties that are right give the curve drawn."
        ),
    };
    drawn.take(histogram(&residuals.values, expected, &text));
}

/// The r.m.s. residual of what is shown, and of all wavelengths where it is one of several.
fn rms_in_words(model: &Model, points: &AnglePoints) -> String {
    let shown = format!("r.m.s. residual{} {}", points.at_wavelength(), number(points.rms()));
    if points.wavelength_nm.is_some() && model.emission.len() > 1 {
        format!("{shown}, of all {} {}", wavelengths(model), number(model.residuals.rms))
    } else {
        shown
    }
}

/// Parameters that have one value per wavelength.
pub(super) fn take_parameter_spectra(
    drawn: &mut Drawn,
    model: &Model,
    measurement: Option<&Measurement>,
    subject: &str,
) {
    let Some(nm) = model.emission.wavelengths() else { return };
    let measured = measurement.and_then(|one| one.emission.wavelengths()).unwrap_or(&[]);
    let without: Vec<f64> = measured.iter().copied().filter(|one| !nm.contains(one)).collect();
    for term in &model.terms {
        for parameter in term.parameters.iter().filter(|parameter| parameter.value.len() > 1) {
            drawn.take(parameter_spectrum(nm, &without, (term, parameter), subject));
        }
    }
}

/// A parameter over the wavelengths, with gaps at those measured wavelengths that are `without` a model.
fn parameter_spectrum(
    nm: &[f64],
    without: &[f64],
    (term, parameter): (&FittedTerm, &FittedParameter),
    subject: &str,
) -> Result<Figure, ReportError> {
    let sigma = |at: usize| parameter.standard_uncertainty.get(at).copied().unwrap_or(f64::NAN);
    let fitted = nm.iter().zip(&parameter.value).enumerate().map(|(at, (nm, value))| (*nm, *value, sigma(at)));
    let mut rows: Vec<(f64, f64, f64)> = fitted.chain(without.iter().map(|nm| (*nm, f64::NAN, f64::NAN))).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let subtitle = match without.len() {
        0 => "fitted at each wavelength".to_owned(),
        count => format!("fitted at {} of {} wavelengths; the others have no model", nm.len(), nm.len() + count),
    };
    let points = Points {
        x: rows.iter().map(|row| row.0).collect(),
        y: rows.iter().map(|row| row.1).collect(),
        error: rows.iter().map(|row| row.2).collect(),
        name: "fitted value".to_owned(),
        error_name: "± standard uncertainty".to_owned(),
    };
    let text = CurveText {
        name: format!("{}-{}", term.kind, parameter.name.replace('_', "-")),
        title: format!("{subject}: {} of the {} term", parameter.name, term.kind),
        subtitle,
        x: "emission wavelength (nm)".to_owned(),
        y: with_unit(&parameter.name, &parameter.unit),
        caption: format!(
            "The fitted {} at each emission wavelength that has a model, in the band of its standard uncertainty from \
             independent errors. A gap is a measured wavelength without a model.",
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
