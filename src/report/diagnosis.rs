//! The figures of a diagnosis: where the residuals lie, what the fit hangs on, and where a parabola misleads.

mod page;
mod profile;
mod scatter;

pub use page::diagnosis_page;

use super::angle_map::AngleMap;
use super::angle_points::{AnglePoints, strongest};
use super::curve::{Curve, CurveText, Points, line_in_band};
use super::fitted::{Drawn, take_parameter_spectra};
use super::map::leverage_map;
use super::{residual_map, subject};
use crate::dataset::{Document, Model};
use crate::fit::MeasurementDiagnosis;
use crate::quantity::EmissionAxis;

/// What a residual is, on every axis.
const RESIDUAL: &str = "(measured − predicted) / standard uncertainty (unit 1)";
const RESIDUAL_OF_SCATTER: &str = "(measured − predicted) / standard deviation of the residuals (unit 1)";

/// What is drawn of a diagnosis.
struct Shown<'a> {
    document: &'a Document,
    model: &'a Model,
    of: &'a MeasurementDiagnosis,
    /// The emission index of the figures over the geometries.
    emission: usize,
    subject: String,
}

impl<'a> Shown<'a> {
    fn new(document: &'a Document, model: &'a Model, of: &'a MeasurementDiagnosis) -> Self {
        let measurement = document.measurement(model.measurement.as_str());
        let subject = measurement.map_or(model.measurement.to_string(), |one| subject::of_sample(document, one));
        Self { document, model, of, emission: strongest(&of.data.values), subject }
    }

    /// The numbers of the emission value that is shown.
    fn points(&self) -> AnglePoints {
        let predicted = self.of.diagnosis.predicted.row(self.emission).to_vec();
        AnglePoints { predicted, ..AnglePoints::measured(&self.of.data) }
    }

    fn residual(&self) -> Vec<f64> {
        self.of.diagnosis.residual.row(self.emission).to_vec()
    }

    fn residual_label(&self) -> &'static str {
        if self.of.data.sigma.is_some() { RESIDUAL } else { RESIDUAL_OF_SCATTER }
    }

    fn wavelengths(&self) -> Option<&[f64]> {
        match &self.model.emission {
            EmissionAxis::Wavelengths(axis) if axis.nm.len() == self.of.data.values.nrows() => Some(&axis.nm),
            _ => None,
        }
    }

    /// Residuals and leverage over both angles, and residuals over everything else that may have gone wrong.
    fn residual_figures(&self) -> Drawn {
        let (mut drawn, points) = (Drawn::default(), self.points());
        let title = format!("{}: residuals{}", self.subject, points.at_wavelength());
        let label = self.residual_label().trim_end_matches(" (unit 1)");
        let map = AngleMap::from_points(&points, &self.residual(), label, "1");
        drawn.take(map.and_then(|map| residual_map(&map, &title)));
        let leverage = self.of.diagnosis.leverage.row(self.emission).to_vec();
        let title = format!("{}: leverage{}", self.subject, points.at_wavelength());
        let map = AngleMap::from_points(&points, &leverage, "leverage", "1");
        drawn.take(map.and_then(|map| leverage_map(&map, &title)));
        for figure in scatter::figures(self, &points) {
            drawn.take(figure);
        }
        drawn
    }

    fn profile_figures(&self) -> Drawn {
        let mut drawn = Drawn::default();
        for curve in &self.of.diagnosis.profiles {
            drawn.take(profile::figure(self, curve));
        }
        drawn
    }

    /// Of a spectral fit: how well each wavelength is described, and the parameters.
    fn spectral_figures(&self) -> Drawn {
        let mut drawn = Drawn::default();
        let Some(nm) = self.wavelengths() else { return drawn };
        let measurement = self.document.measurement(self.model.measurement.as_str());
        let measured = measurement.and_then(|one| one.emission.wavelengths()).unwrap_or(nm);
        let reduced = self.of.diagnosis.reduced_chi_square();
        // A measured wavelength without a model is a gap.
        let at = |one: &f64| nm.iter().position(|other| other == one).map_or(f64::NAN, |emission| reduced[emission]);
        let points = Points {
            x: measured.to_vec(),
            y: measured.iter().map(at).collect(),
            error: Vec::new(),
            name: "each wavelength".to_owned(),
            error_name: String::new(),
        };
        let one = Curve {
            x: nm.to_vec(),
            y: vec![1.0; nm.len()],
            name: "expected where model and uncertainties are right".to_owned(),
        };
        let text = CurveText {
            name: "reduced-chi-square".to_owned(),
            title: format!("{}: reduced chi-square at each wavelength", self.subject),
            subtitle: "a wavelength above 1 is described worse than its uncertainties say".to_owned(),
            x: "emission wavelength (nm)".to_owned(),
            y: "reduced chi-square (unit 1)".to_owned(),
            caption: "Weighted sum of squared residuals of each wavelength over its share of the degrees of freedom."
                .to_owned(),
        };
        drawn.take(line_in_band(&points, Some(&one), &text));
        take_parameter_spectra(&mut drawn, self.model, measurement, &self.subject);
        drawn
    }
}
