//! The figures of a fitted model: the map, the averages, the residuals.

use super::angle_map::AngleMap;
use super::curve::{Curve, CurveText, Points, dots_and_curve};
use super::frame::with_unit;
use super::html::number;
use super::{Figure, ReportError, angle_map, histogram, interpolated_map, residual_map};
use crate::dataset::{Document, Measurement, Model, Separability};
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
}

impl AnglePoints {
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

    /// Measured minus predicted: over the standard uncertainty where every value has one, else as it is.
    fn residuals(&self) -> Residuals {
        let pairs = || self.measured.iter().zip(&self.predicted).zip(&self.sigma);
        let usable = |value: &f64, sigma: &f64| !value.is_finite() || (sigma.is_finite() && *sigma > 0.0);
        let is_scaled = pairs().all(|((value, _), sigma)| usable(value, sigma));
        let values = pairs()
            .map(|((measured, predicted), sigma)| (measured - predicted) / if is_scaled { *sigma } else { 1.0 })
            .collect();
        Residuals { values, is_scaled }
    }
}

#[derive(Debug)]
struct Residuals {
    values: Vec<f64>,
    /// Over the standard uncertainty.
    is_scaled: bool,
}

impl Residuals {
    fn label(&self) -> &'static str {
        if self.is_scaled { "(measured − predicted) / standard uncertainty" } else { "measured − predicted" }
    }

    fn unit<'a>(&self, unit: &'a str) -> &'a str {
        if self.is_scaled { "1" } else { unit }
    }
}

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
            Err(error) => self.not_drawn.push(error.to_string()),
        }
    }
}

/// The figures of a model with the numbers it was fitted to (for a spectral fit, those of one wavelength). What cannot
/// be drawn (a map of directions out of the plane, say) is listed with the reason, and the rest is drawn.
#[must_use]
pub fn fitted_figures(document: &Document, model: &Model, points: &AnglePoints) -> Drawn {
    let subject = subject(document, model);
    let quantity = quantity_label(document, model);
    let mut drawn = Drawn::default();
    match AngleMap::from_points(points, &points.measured, &quantity, &model.unit) {
        Ok(map) => {
            drawn.take(angle_map(&map, &format!("{subject}: measured")));
            drawn.take(interpolated_map(&map, &format!("{subject}: with interpolated gaps")));
        }
        Err(error) => drawn.not_drawn.push(error.to_string()),
    }
    if let Some(separability) = &model.separability {
        drawn.take(mean_over_viewing(separability, &subject, &with_unit(&quantity, &model.unit)));
        drawn.take(mean_over_incidence(separability, &subject));
    }
    take_residuals(&mut drawn, model, points, &subject);
    let prefix = model.id.as_str();
    drawn.figures = drawn.figures.into_iter().map(|figure| figure.prefixed(prefix)).collect();
    drawn
}

fn take_residuals(drawn: &mut Drawn, model: &Model, points: &AnglePoints, subject: &str) {
    if let Err(error) = points.check("residuals") {
        drawn.not_drawn.push(error.to_string());
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

/// What the figures are of: the sample's title, else the measurement's, else its id; and that it is simulated.
fn subject(document: &Document, model: &Model) -> String {
    let measurement = document.measurement(model.measurement.as_str());
    let sample = measurement
        .and_then(|measurement| measurement.sample.as_ref())
        .and_then(|id| document.samples.iter().find(|sample| sample.id == *id));
    let title = sample
        .and_then(|sample| sample.title.clone())
        .or_else(|| measurement.and_then(|measurement| measurement.title.clone()))
        .unwrap_or_else(|| model.measurement.to_string());
    if sample.is_some_and(|sample| sample.simulated) { format!("{title} (simulated)") } else { title }
}

/// The fitted quantity in words, with its band.
fn quantity_label(document: &Document, model: &Model) -> String {
    let kind = document.measurement(model.measurement.as_str()).map(quantity_words).unwrap_or("value");
    match (&model.emission, model.reduction.as_str()) {
        (EmissionAxis::Band { band: Some(band) }, _) => format!("{kind}, {}–{} nm", band.from_nm, band.to_nm),
        (EmissionAxis::Band { band: None }, "luminance") => "luminance factor".to_owned(),
        _ => kind.to_owned(),
    }
}

/// A quantity as an axis names it.
pub(super) fn quantity_words(measurement: &Measurement) -> &'static str {
    use crate::quantity::QuantityKind as Kind;
    match measurement.quantity.kind {
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

/// The paper's Fig. 3, left: averaged over viewing, with the fitted cosine.
fn mean_over_viewing(check: &Separability, subject: &str, quantity: &str) -> Result<Figure, ReportError> {
    let points = Points {
        x: check.theta_i_deg.clone(),
        y: check.mean_over_viewing.clone(),
        error: check.spread_over_viewing.clone(),
        name: "mean over viewing".to_owned(),
        error_name: "± standard deviation".to_owned(),
    };
    let x: Vec<f64> = (-90..=90).map(f64::from).collect();
    let y = x.iter().map(|angle| check.cosine_amplitude * angle.to_radians().cos()).collect();
    let curve = Curve { x, y, name: "fitted cosine".to_owned() };
    let text = CurveText {
        name: "mean-over-viewing".to_owned(),
        title: format!("{subject}: averaged over viewing"),
        subtitle: format!(
            "cosine of amplitude {:.4}; r.m.s. departure {:.2} % of the amplitude",
            check.cosine_amplitude,
            100.0 * check.cosine_relative_rms
        ),
        x: "incidence angle θᵢ (degrees, signed)".to_owned(),
        y: format!("mean {quantity}"),
        caption: "The average over viewing directions against the incidence angle, with the cosine fitted to it: a \
                  Lambertian surface follows it. An error bar without a cap goes on beyond the frame."
            .to_owned(),
    };
    dots_and_curve(&points, Some(&curve), &text)
}

/// The paper's Fig. 3, right: averaged over incidence, which a Lambertian surface leaves constant.
fn mean_over_incidence(check: &Separability, subject: &str) -> Result<Figure, ReportError> {
    let points = Points {
        x: check.theta_v_deg.clone(),
        y: check.mean_over_incidence.clone(),
        error: check.spread_over_incidence.clone(),
        name: "mean over incidence".to_owned(),
        error_name: "± standard deviation".to_owned(),
    };
    let finite: Vec<f64> = points.y.iter().copied().filter(|y| y.is_finite()).collect();
    let mean = finite.iter().sum::<f64>() / finite.len() as f64;
    let curve = Curve { x: vec![-90.0, 90.0], y: vec![mean; 2], name: "their mean".to_owned() };
    let text = CurveText {
        name: "mean-over-incidence".to_owned(),
        title: format!("{subject}: averaged over incidence"),
        subtitle: format!(
            "r.m.s. departure from a constant {:.2} %; best product f(θᵢ) g(θᵥ) leaves {:.2} %",
            100.0 * check.constancy_relative_rms,
            100.0 * check.rank_one_relative_rms
        ),
        x: "viewing angle θᵥ (degrees, signed)".to_owned(),
        y: "mean of value / fitted cosine (unit 1)".to_owned(),
        caption:
            "The average over incidence directions, after division by the fitted cosine, against the viewing angle: \
                  a Lambertian surface looks the same from everywhere. An error bar without a cap goes on beyond the frame."
                .to_owned(),
    };
    dots_and_curve(&points, Some(&curve), &text)
}
