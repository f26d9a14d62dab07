//! What `bbrf donaldson predict` says.

mod text;

use schemars::JsonSchema;
use serde::Serialize;

use super::Predicted;
use crate::donaldson::{Colour, Extend, Observer, Prediction};
use crate::quantity::QuantityKind;

/// What `--json` prints.
#[derive(Debug, Serialize, JsonSchema)]
pub(crate) struct PredictResult {
    /// The observer, degrees.
    observer: Observer,
    /// What lights do where they have no value.
    extend: Extend,
    /// Each matrix under each light.
    predictions: Vec<PredictionResult>,
    /// Colour differences between them.
    differences: Vec<DifferenceResult>,
}

/// One matrix under one light. Spectra are pi times the radiance.
#[derive(Debug, Serialize, JsonSchema)]
struct PredictionResult {
    /// The matrix, as it was named.
    material: String,
    /// The light, as it was named.
    light: String,
    /// Which luminescence was applied: full, stokes or factors.
    luminescence: String,
    /// The stored separation that was used, by the id of its factorisation; `null` where the matrix was separated anew.
    separation: Option<String>,
    /// The unit of the spectra: W m-2 nm-1 under a spectral irradiance, else that of a relative light.
    unit: String,
    /// Centres of the emission, nm.
    emission_nm: Vec<f64>,
    /// What falls in, seen through the bandpass of the emission.
    irradiance: Vec<f64>,
    /// Elastic part; `null` where it is not known.
    elastic: Vec<Option<f64>>,
    /// Luminescent part.
    luminescent: Vec<f64>,
    /// Their sum.
    total: Vec<Option<f64>>,
    /// Standard uncertainty of the sum from independent errors of the matrix; `null` where it is not known.
    total_standard_uncertainty: Vec<Option<f64>>,
    /// Total radiance factor; `null` where no light falls in.
    radiance_factor: Vec<Option<f64>>,
    /// Its elastic part.
    elastic_radiance_factor: Vec<Option<f64>>,
    /// Its luminescent part.
    luminescent_radiance_factor: Vec<Option<f64>>,
    /// Standard uncertainty of the total radiance factor.
    radiance_factor_standard_uncertainty: Vec<Option<f64>>,
    /// Relative standard uncertainty that all values of the matrix share, one per emission, or none; not contained in the others.
    shared_relative_uncertainty: Vec<f64>,
    /// The colour; `null` under a light that the observer does not see.
    colour: Option<ColourResult>,
    /// Wavelengths at which the light has no value, and what is lost with them.
    unlit: Vec<UnlitResult>,
    /// What to know about these numbers.
    findings: Vec<String>,
}

/// A colour beside its white, of which Y is 100. Nothing is clipped.
#[derive(Debug, Serialize, JsonSchema)]
struct ColourResult {
    xyz: [f64; 3],
    xyz_standard_uncertainty: Option<[f64; 3]>,
    white: [f64; 3],
    lab: Option<[f64; 3]>,
    lab_standard_uncertainty: Option<[f64; 3]>,
    luv: Option<[f64; 3]>,
    /// CIE whiteness.
    whiteness: Option<f64>,
    /// CIE tint.
    tint: Option<f64>,
    /// True where the light and the colour are such that whiteness is defined.
    whiteness_is_defined: bool,
}

/// Wavelengths without light.
#[derive(Debug, Serialize, JsonSchema)]
struct UnlitResult {
    from_nm: f64,
    to_nm: f64,
    /// Share of the luminescence under equal energy that is excited there.
    excitation_share: f64,
    /// Share of the luminescence that is lost, were the light to go on at its last known value.
    luminescence_lost: f64,
    /// CIE 1976 difference that everything missing makes, 2 degree observer.
    de76: Option<f64>,
    /// CIEDE2000 likewise.
    de2000: Option<f64>,
    /// In words.
    sentence: String,
}

/// A colour difference, each colour beside its own white.
#[derive(Debug, Serialize, JsonSchema)]
struct DifferenceResult {
    /// Index of the one in `predictions`.
    of: usize,
    /// Index of the other.
    to: usize,
    /// What differs: light, material or luminescence.
    between: String,
    de76: f64,
    de2000: f64,
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

impl PredictResult {
    pub(super) fn new(predicted: &[Predicted<'_>], observer: Observer, extend: Extend) -> Self {
        let predictions = predicted.iter().map(|one| PredictionResult::new(one, observer)).collect();
        Self { observer, extend, predictions, differences: differences(predicted, observer) }
    }
}

/// Each prediction beside the first of the same kind: another light, another matrix, another luminescence.
fn differences(predicted: &[Predicted<'_>], observer: Observer) -> Vec<DifferenceResult> {
    let mut list = Vec::new();
    let key = |index: usize| {
        let one = &predicted[index];
        [one.material.name.clone(), one.prediction.light.clone(), one.luminescence.to_string()]
    };
    let (Some(first), count) = (predicted.first().map(|_| key(0)), predicted.len()) else { return list };
    for (to, (place, between)) in
        (1..count).flat_map(|to| [(0, "material"), (1, "light"), (2, "luminescence")].map(|what| (to, what)))
    {
        let mut wanted = key(to);
        if wanted[place] == first[place] {
            continue;
        }
        wanted[place].clone_from(&first[place]);
        let Some(of) = (0..to).find(|index| key(*index) == wanted) else { continue };
        let colour = |index: usize| predicted[index].prediction.colour(observer);
        let difference = colour(of).zip(colour(to)).and_then(|(a, b)| a.difference(&b));
        if let Some(difference) = difference {
            let between = between.to_owned();
            list.push(DifferenceResult { of, to, between, de76: difference.de76, de2000: difference.de2000 });
        }
    }
    list
}

impl PredictionResult {
    fn new(one: &Predicted<'_>, observer: Observer) -> Self {
        let prediction = &one.prediction;
        let all = || 0..prediction.emission_nm.len();
        let factor = |of: fn(&Prediction, usize) -> Option<(f64, f64)>| {
            all().map(|j| of(prediction, j).map(|(value, _)| value)).collect::<Vec<Option<f64>>>()
        };
        let unit = match prediction.kind {
            QuantityKind::SpectralIrradiance => "W m-2 nm-1",
            _ => "1",
        };
        let mut findings = one.surface_findings.clone();
        findings.extend(one.material.separation.remark.clone());
        let dark = all().filter(|j| prediction.irradiance[*j] <= 0.0).count();
        if dark > 0 {
            findings.push(format!(
                "{} has no light at {dark} emission wavelengths: radiance is given there, a radiance factor is not",
                prediction.light
            ));
        }
        Self {
            material: one.material.name.clone(),
            light: prediction.light.clone(),
            luminescence: one.luminescence.to_string(),
            separation: one.material.separation.stored.clone(),
            unit: unit.to_owned(),
            emission_nm: prediction.emission_nm.clone(),
            irradiance: prediction.irradiance.clone(),
            elastic: prediction.elastic.iter().copied().map(finite).collect(),
            luminescent: prediction.luminescent.clone(),
            total: all().map(|j| finite(prediction.total(j))).collect(),
            total_standard_uncertainty: prediction.total_sigma.iter().copied().map(finite).collect(),
            radiance_factor: factor(Prediction::factor),
            elastic_radiance_factor: factor(Prediction::elastic_factor),
            luminescent_radiance_factor: factor(Prediction::luminescent_factor),
            radiance_factor_standard_uncertainty: all().map(|j| finite(prediction.factor(j)?.1)).collect(),
            shared_relative_uncertainty: shared(one),
            colour: prediction.colour(observer).map(|colour| ColourResult::new(&colour, prediction)),
            unlit: unlit(prediction),
            findings,
        }
    }
}

fn unlit(prediction: &Prediction) -> Vec<UnlitResult> {
    let one = |unlit: &crate::donaldson::Unlit| UnlitResult {
        from_nm: unlit.from_nm,
        to_nm: unlit.to_nm,
        excitation_share: unlit.excitation_share,
        luminescence_lost: unlit.luminescence_lost,
        de76: unlit.difference.map(|difference| difference.de76),
        de2000: unlit.difference.map(|difference| difference.de2000),
        sentence: unlit.sentence(&prediction.light),
    };
    prediction.unlit.iter().map(one).collect()
}

/// The shared components of the matrix, added in squares. One that is common to the wavelengths of a row only is counted as if it
/// were common to all: an upper bound.
fn shared(one: &Predicted<'_>) -> Vec<f64> {
    let components = &one.material.measurement.uncertainty.components;
    if components.is_empty() {
        return Vec::new();
    }
    let at = |j: usize| {
        let relative = components.iter().filter_map(|component| match component.relative.as_slice() {
            [one] => Some(*one),
            many => many.get(j).copied(),
        });
        relative.map(|relative| relative * relative).sum::<f64>().sqrt()
    };
    (0..one.prediction.emission_nm.len()).map(at).collect()
}

impl ColourResult {
    fn new(colour: &Colour, prediction: &Prediction) -> Self {
        let whiteness = colour.whiteness();
        Self {
            xyz: colour.xyz,
            xyz_standard_uncertainty: prediction.xyz_sigma(colour.observer),
            white: colour.white,
            lab: colour.lab(),
            lab_standard_uncertainty: prediction.lab_sigma(colour.observer),
            luv: colour.luv(),
            whiteness: whiteness.map(|one| one.whiteness),
            tint: whiteness.map(|one| one.tint),
            whiteness_is_defined: whiteness.is_some_and(|one| one.is_defined),
        }
    }
}
