//! A fit of every wavelength of the simulated scan against its truth: within the stated uncertainty, also where the
//! instrument's floor hides a part of the readings.
// A failed step of a fixture is a failed test.
#![allow(clippy::unwrap_used)]

use std::path::PathBuf;

use bbrf::dataset::{FittedParameter, Model, Reduction};
use bbrf::fit::{FitOptions, fit_measurement};
use bbrf::import::{Options, import};
use bbrf::terms::TermKind;

fn scan_folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("testdata/simulated_scan")
}

fn truth() -> serde_json::Value {
    serde_json::from_str(&std::fs::read_to_string(scan_folder().join("truth.json")).unwrap()).unwrap()
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn fitted() -> Model {
    let document = import(&[scan_folder().join("scan.csv")], &Options::default()).unwrap();
    let options = FitOptions { reduction: Reduction::None, ..FitOptions::default() };
    fit_measurement(&document, document.measurement("scan").unwrap(), &options).unwrap()
}

fn amplitude(model: &Model, kind: TermKind) -> &FittedParameter {
    &model.terms.iter().find(|term| term.kind == kind).unwrap().parameters[0]
}

/// Differences from the truth in stated standard uncertainties, shared ones included.
fn pulls(parameter: &FittedParameter, truth: &[f64]) -> Vec<f64> {
    let sigma = |k: usize| {
        parameter.standard_uncertainty[k].hypot(parameter.shared_relative_uncertainty[k] * parameter.value[k])
    };
    (0..truth.len()).map(|k| (parameter.value[k] - truth[k]) / sigma(k)).collect()
}

fn assert_sane(pulls: &[f64], nm: &[f64]) {
    let worst = (0..nm.len()).max_by(|a, b| pulls[*a].abs().total_cmp(&pulls[*b].abs())).unwrap();
    assert!(pulls[worst].abs() < 4.0, "{} standard uncertainties at {} nm", pulls[worst], nm[worst]);
    let rms = (pulls.iter().map(|pull| pull * pull).sum::<f64>() / pulls.len() as f64).sqrt();
    // The scale of the white is common to all wavelengths: with it alone the r.m.s. would be one draw.
    assert!((0.3..1.6).contains(&rms), "{rms}");
}

#[test]
fn every_fitted_wavelength_agrees_with_the_truth() {
    let (model, truth) = (fitted(), truth());
    let nm = model.emission.wavelengths().unwrap();
    let (all_nm, albedo) = (numbers(&truth["emission_nm"]), numbers(&truth["albedo"]));
    let at = |nm: &f64| albedo[all_nm.iter().position(|other| other == nm).unwrap()];
    let expected: Vec<f64> = nm.iter().map(at).collect();
    assert_sane(&pulls(amplitude(&model, TermKind::Lambertian), &expected), nm);
    let intensity = truth["torrance-sparrow"]["intensity"].as_f64().unwrap();
    assert_sane(&pulls(amplitude(&model, TermKind::TorranceSparrow), &vec![intensity; nm.len()]), nm);
    let chi_square = model.residuals.reduced_chi_square;
    assert!((0.8..1.1).contains(&chi_square), "{chi_square}");
}

#[test]
fn a_wavelength_on_the_floor_is_fitted_with_bounds_and_said() {
    let model = fitted();
    let all = numbers(&truth()["emission_nm"]);
    assert_eq!(model.emission.wavelengths().unwrap(), all, "every wavelength has a model");
    let said = model.identifiability.iter().find(|note| note.contains("fitted as bounds")).unwrap();
    assert!(said.contains("below detection as upper bounds"), "{said}");
    // A bound has no residual.
    let bounds: u64 = said.split_whitespace().find_map(|word| word.parse().ok()).unwrap();
    assert_eq!(model.residuals.count + bounds, 272 * 101);
    assert_eq!(model.residuals.left_out, bounds);
}

/// The darkest wavelengths by themselves: values that are left over above the floor would be too bright by many standard
/// uncertainties.
#[test]
fn bounds_leave_the_darkest_wavelengths_unbiased() {
    let (model, truth) = (fitted(), truth());
    let nm = model.emission.wavelengths().unwrap();
    let albedo = numbers(&truth["albedo"]);
    let pulls = pulls(amplitude(&model, TermKind::Lambertian), &albedo);
    let dark: Vec<f64> = (0..nm.len()).filter(|&k| (390.0..=410.0).contains(&nm[k])).map(|k| pulls[k]).collect();
    let mean = dark.iter().sum::<f64>() / dark.len() as f64;
    assert!(dark.len() >= 4 && mean.abs() < 2.5, "{dark:?}");
}
