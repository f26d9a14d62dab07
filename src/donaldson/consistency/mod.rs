//! Do a scan and a matrix belong together? The shape of the scan's spectrum against that of the matrix under the same light, with
//! the scale between them fitted away; the level only where what fell in is known.

mod comparison;
mod light;
mod scan;
mod shape;

pub use comparison::Deviation;
pub use shape::{Level, Shape};

use self::comparison::{Compared, Spectrum, compare};
use self::light::{Lamp, lamp};
use self::scan::spectra;
use super::predict::Prediction;
use super::{Complete, Extend};
use crate::dataset::{Document, Measurement, Model};
use crate::quantity::{CorrelatedOver, Part, QuantityKind, named};

/// Where the light of a scan is less than this of its peak, none of what is seen there is reflected.
const DARK: f64 = 1e-3;
/// The share of an excitation that counts for where reflected light may be.
const SHARE: f64 = 1e-3;

named! {
    /// What a scan is compared as.
    ScanOf, "scan of" {
        /// Reflected light alone.
        Elastic = "elastic",
        /// Light at other wavelengths than those that fall in.
        Luminescence = "luminescence",
        /// Both.
        Total = "total",
    }
}

/// How a scan and a matrix go together.
#[derive(Debug, Clone, PartialEq)]
pub struct Consistency {
    /// One check for each excitation of the scan that can be checked.
    pub shapes: Vec<Shape>,
    /// Weighted sum of squares over degrees of freedom of the fit over the geometries, which says whether the scan follows the
    /// angular shape of the terms; NaN without uncertainties.
    pub angular_reduced_chi_square: f64,
    /// All of it in words, and what cannot be checked.
    pub findings: Vec<String>,
    /// The findings of these that disagree: what to warn of.
    pub warnings: Vec<String>,
}

impl Consistency {
    /// Holds the scan of a model against its matrix.
    #[must_use]
    pub fn of(document: &Document, model: &Model, complete: &Complete) -> Self {
        let angular_reduced_chi_square = model.residuals.reduced_chi_square;
        let mut all =
            Self { shapes: Vec::new(), angular_reduced_chi_square, findings: Vec::new(), warnings: Vec::new() };
        let Some(scan) = document.measurement(model.measurement.as_str()) else { return all };
        let states = match spectra(document, scan, model) {
            Ok(states) => states,
            Err(sentence) => {
                all.findings.push(sentence);
                return all;
            }
        };
        for (state, measured) in states {
            match check(document, model, scan, complete, state, &measured) {
                Ok(shape) => all.take(shape),
                Err(sentence) => all.findings.push(sentence),
            }
        }
        if all.shapes.iter().any(|shape| shape.of == ScanOf::Luminescence) {
            all.findings.push(if angular_reduced_chi_square.is_nan() {
                "the angular shape of the luminescence, cos(theta_i), cannot be judged: the scan states no uncertainties".to_owned()
            } else {
                format!(
                    "the angular shape of the luminescence, cos(theta_i), is checked by the fit: reduced chi-square \
                     {angular_reduced_chi_square:.3} over its geometries"
                )
            });
        }
        all
    }

    /// True where nothing that could be checked disagrees.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.warnings.is_empty()
    }

    fn take(&mut self, shape: Shape) {
        let sentence = shape.sentence();
        if !shape.agrees() {
            self.warnings.push(sentence.clone());
        }
        self.findings.push(sentence);
        let level = match &shape.level {
            None => "the level cannot be checked: the irradiance of the excitation is not known".to_owned(),
            Some(level) => {
                let verdict = if level.agrees() { "agree" } else { "DISAGREE" };
                format!("levels {verdict}: scan over matrix is {:.4} ± {:.4}", level.ratio, level.sigma)
            }
        };
        if shape.level.is_some_and(|level| !level.agrees()) {
            self.warnings.push(level.clone());
        }
        self.findings.push(level);
        self.shapes.push(shape);
    }
}

fn check(
    document: &Document,
    model: &Model,
    scan: &Measurement,
    complete: &Complete,
    state: Option<u32>,
    measured: &Spectrum,
) -> Result<Shape, String> {
    let lamp = lamp(document, scan, state);
    let is_factor = scan.quantity.kind.is_factor();
    let stated = match scan.quantity.part {
        Part::Elastic => Some(ScanOf::Elastic),
        Part::Luminescent => Some(ScanOf::Luminescence),
        Part::Total | Part::Unstated => None,
    };
    if is_factor && stated == Some(ScanOf::Elastic) {
        let predicted = elastic(complete);
        let compared = compared(measured, &predicted, None)?;
        let level = Some(level(&compared, scan, model, complete, 1.0));
        return Ok(Shape::of(ScanOf::Elastic, None, compared, level));
    }
    let Some(lamp) = lamp else {
        return Err("the shape cannot be checked: the file does not say what fell on the scan (no spectrum of its light, no excitation \
                    wavelength)"
            .to_owned());
    };
    outside(complete, &lamp)?;
    let prediction = complete.under(&lamp.light, Extend::Zero).prediction().clone();
    let of = stated.unwrap_or_else(|| kind(&prediction, &lamp));
    let needs_spectrum = is_factor || of != ScanOf::Luminescence;
    if needs_spectrum && !lamp.is_measured {
        return Err(format!(
            "the shape under {} cannot be checked: a {} of the part {} depends on the spectrum of the light, which is not in the file",
            lamp.name, scan.quantity.kind, scan.quantity.part
        ));
    }
    let predicted = predicted(complete, scan, &prediction, of, &lamp);
    let compared = compared(measured, &predicted, Some(&lamp.name))?;
    let is_absolute =
        scan.quantity.kind == QuantityKind::SpectralRadiance && lamp.light.kind() == QuantityKind::SpectralIrradiance;
    let pi = if is_factor { 1.0 } else { std::f64::consts::PI };
    let level = (is_factor || is_absolute).then(|| level(&compared, scan, model, complete, pi));
    Ok(Shape::of(of, Some(lamp.name), compared, level))
}

fn compared(measured: &Spectrum, predicted: &Spectrum, light: Option<&str>) -> Result<Compared, String> {
    let light = light.map_or(String::new(), |light| format!(" under {light}"));
    compare(measured, predicted).ok_or_else(|| {
        format!(
            "the shape{light} cannot be checked: fewer than 3 wavelengths at which scan and matrix both have a value with an uncertainty"
        )
    })
}

/// A sentence where the light excites nothing that the matrix knows.
fn outside(complete: &Complete, lamp: &Lamp) -> Result<(), String> {
    let axis = &complete.surface().excitation_nm;
    let (first, last) = (axis[0], axis[axis.len() - 1]);
    if complete.surface().shares(&lamp.light).iter().all(|share| *share <= 0.0) {
        return Err(format!(
            "the shape under {} cannot be checked: the matrix was excited from {first} to {last} nm, and is not continued outside",
            lamp.name
        ));
    }
    Ok(())
}

/// What a scan of both parts shows under a light: a narrow one leaves most of the emission to luminescence.
fn kind(prediction: &Prediction, lamp: &Lamp) -> ScanOf {
    let dark = is_dark(prediction, lamp);
    let count = prediction.emission_nm.len();
    if 2 * (0..count).filter(|j| dark(*j)).count() > count { ScanOf::Luminescence } else { ScanOf::Total }
}

fn is_dark(prediction: &Prediction, lamp: &Lamp) -> impl Fn(usize) -> bool {
    let peak = lamp.light.values().iter().copied().fold(0.0, f64::max);
    move |j| prediction.irradiance[j] <= DARK * peak
}

/// The reflectance by the matrix.
fn elastic(complete: &Complete) -> Spectrum {
    let (values, sigma) = (0..complete.emission_nm().len()).map(|j| complete.matrix_reflectance(j)).unzip();
    with_own(complete, Spectrum { nm: complete.emission_nm().to_vec(), values, sigma, fwhm_nm: None })
}

/// Adds what the matrix's errors of one wavelength share over its excitations, and its bandpass.
fn with_own(complete: &Complete, mut spectrum: Spectrum) -> Spectrum {
    let all = &complete.own_relative;
    for (j, sigma) in spectrum.sigma.iter_mut().enumerate() {
        *sigma = sigma.hypot(all.get(j).copied().unwrap_or(0.0) * spectrum.values[j]);
    }
    let fwhm = complete.surface().emission_fwhm_nm.as_ref();
    spectrum.fwhm_nm = fwhm.and_then(|all| all.get(all.len() / 2).copied());
    spectrum.only(|j| spectrum.values[j].is_finite())
}

/// What the matrix makes of the light, in the form of the scan.
fn predicted(complete: &Complete, scan: &Measurement, prediction: &Prediction, of: ScanOf, lamp: &Lamp) -> Spectrum {
    let (dark, is_factor) = (is_dark(prediction, lamp), scan.quantity.kind.is_factor());
    let at = |j: usize| {
        let irradiance = prediction.irradiance[j];
        let reflected = irradiance * complete.matrix_reflectance(j).0;
        let (value, sigma) = match of {
            ScanOf::Elastic => (reflected, prediction.elastic_sigma[j]),
            ScanOf::Total => (prediction.luminescent[j] + reflected, prediction.total_sigma[j]),
            ScanOf::Luminescence => (prediction.luminescent[j], prediction.luminescent_sigma[j]),
        };
        match is_factor {
            true if dark(j) => (f64::NAN, f64::NAN),
            true => (value / irradiance, sigma / irradiance),
            false => (value, sigma),
        }
    };
    let (values, sigma) = (0..prediction.emission_nm.len()).map(at).unzip();
    let all = Spectrum { nm: prediction.emission_nm.clone(), values, sigma, fwhm_nm: None };
    let is_separated = scan.quantity.part == Part::Luminescent || of != ScanOf::Luminescence;
    let all = if is_separated { all } else { clear_of_the_line(complete, all, lamp) };
    let shown = with_own(complete, all);
    // Below its excitation there is no luminescence, on either side.
    match (of, lightest(complete, lamp)) {
        (ScanOf::Luminescence, Some(first)) => shown.only(|j| shown.nm[j] >= first),
        _ => shown,
    }
}

/// The shortest wavelength that counts as excitation, nm.
fn lightest(complete: &Complete, lamp: &Lamp) -> Option<f64> {
    counted(complete, lamp).first().copied()
}

fn counted(complete: &Complete, lamp: &Lamp) -> Vec<f64> {
    let shares = complete.surface().shares(&lamp.light);
    let whole: f64 = shares.iter().sum();
    let all = complete.surface().excitation_nm.iter().zip(&shares);
    all.filter(|(_, share)| **share > SHARE * whole).map(|(nm, _)| *nm).collect()
}

/// Without what may be reflected: near an excitation that counts, as far as both bandpasses meet.
fn clear_of_the_line(complete: &Complete, mut spectrum: Spectrum, lamp: &Lamp) -> Spectrum {
    let counted = counted(complete, lamp);
    for (j, nm) in spectrum.nm.iter().enumerate() {
        if counted.iter().any(|excited| (nm - excited).abs() < complete.reach_nm) {
            spectrum.values[j] = f64::NAN;
        }
    }
    spectrum
}

/// Measured over predicted, with what the values of each side share.
fn level(compared: &Compared, scan: &Measurement, model: &Model, complete: &Complete, pi: f64) -> Level {
    let ratio = pi * compared.scale;
    let worst = |all: &[f64]| all.iter().copied().fold(0.0, f64::max);
    let of_scan: f64 = if model.has_spectral_albedo(scan) || scan.uncertainty.components.is_empty() {
        let amplitudes = model.terms.iter().filter_map(|term| term.parameters.first());
        amplitudes.map(|fitted| worst(&fitted.shared_relative_uncertainty)).fold(0.0, f64::max)
    } else {
        let shared = scan.uncertainty.components.iter();
        let shared = shared.filter(|one| one.correlated_over != CorrelatedOver::Wavelengths);
        shared.map(|one| worst(&one.relative).powi(2)).sum::<f64>().sqrt()
    };
    let of_matrix = worst(&complete.shared_relative);
    Level { ratio, sigma: (pi * compared.scale_sigma).hypot(ratio * of_scan.hypot(of_matrix)) }
}
