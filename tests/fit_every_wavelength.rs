//! A fit of every wavelength of the simulated scan against its truth: within the stated uncertainty where there is a
//! model, and no model where the instrument's floor truncates the sample.
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
fn a_wavelength_that_the_floor_truncates_gets_no_model_and_is_said() {
    let model = fitted();
    let nm = model.emission.wavelengths().unwrap();
    let all = numbers(&truth()["emission_nm"]);
    let left_out: Vec<f64> = all.iter().copied().filter(|wavelength| !nm.contains(wavelength)).collect();
    // Next to nothing is radiated at 400 nm; most wavelengths have light enough.
    assert!(left_out.contains(&400.0) && left_out.len() < 15, "{left_out:?}");
    let said = model.identifiability.iter().find(|note| note.contains("get no model")).unwrap();
    assert!(said.starts_with(&format!("{} of 101", left_out.len())), "{said}");
    assert!(left_out.iter().all(|wavelength| said.contains(&format!("{wavelength} nm ("))), "{said}");
    let count = model.residuals.count + model.residuals.left_out;
    assert_eq!(count, 272 * 101);
    assert!(model.residuals.left_out >= 272 * left_out.len() as u64);
}
