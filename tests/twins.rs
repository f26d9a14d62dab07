//! A Gaussian under another width or norm is the same function: predictions stay, and uncertainties are those of a fit.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod scans;
}

use bbrf::dataset::{Acquisition, Document, Id, Measurement, Model, NoTwin, Role, predict, with_distribution};
use bbrf::fit::{FitOptions, fit_measurement};
use bbrf::quantity::{Bandpass, EmissionAxis, Quantity, QuantityKind, Reference, Uncertainty, WavelengthAxis};
use bbrf::terms::{Distribution, INTENSITY, ROUGHNESS};
use common::scans::{Random, Truth, measure, paper_grid};
use ndarray::Array2;

const GAUSSIANS: [Distribution; 4] = [
    Distribution::GaussianHalfHeight,
    Distribution::Gaussian,
    Distribution::TorranceSparrow1967,
    Distribution::GaussianNormalised,
];

fn document(bands: usize) -> Document {
    let grid = paper_grid();
    let mut random = Random::new(7);
    let truth = Truth { albedo: 0.6, intensity: 8.0, roughness: 0.2, index_minus_one: 0.5 };
    let columns: Vec<(Vec<f64>, Vec<f64>)> = (0..bands).map(|_| measure(&truth, &grid, 0.01, &mut random)).collect();
    let values = Array2::from_shape_fn((grid.len(), bands), |(row, band)| columns[band].0[row]);
    let sigma = Array2::from_shape_fn((grid.len(), bands), |(row, band)| columns[band].1[row]);
    let kind = if bands == 1 { QuantityKind::BandRadianceFactor } else { QuantityKind::RadianceFactor };
    let mut quantity = Quantity::unstated(kind);
    quantity.reference = Reference::None;
    let emission = if bands == 1 {
        EmissionAxis::Band { band: None }
    } else {
        let nm = (0..bands).map(|band| 500.0 + 10.0 * band as f64).collect();
        EmissionAxis::Wavelengths(WavelengthAxis::new(nm, Bandpass::Unstated).unwrap())
    };
    let acquisitions = grid.iter().zip(0..).map(|(geometry, order)| Acquisition::at(Some(*geometry), order)).collect();
    let mut measurement =
        Measurement::new(Id::new("scan").unwrap(), Role::Sample, quantity, emission, acquisitions, values);
    measurement.uncertainty = Uncertainty { standard: Some(sigma.into_shared()), ..Uncertainty::default() };
    Document { measurements: vec![measurement], ..Document::default() }
}

fn fit(document: &Document, distribution: Distribution) -> Model {
    let reduction = if document.measurements[0].shape().1 > 1 { "none" } else { "auto" };
    let options = FitOptions { distribution, reduction: reduction.parse().unwrap(), ..FitOptions::default() };
    fit_measurement(document, &document.measurements[0], &options).unwrap()
}

#[test]
fn every_conversion_gives_the_fit_of_the_other_form_with_its_covariance() {
    let document = document(1);
    let fits: Vec<Model> = GAUSSIANS.iter().map(|form| fit(&document, *form)).collect();
    for from in &fits {
        for into in &fits {
            let form = into.terms[1].distribution.unwrap();
            if from.terms[1].distribution == Some(form) {
                assert_eq!(with_distribution(from, form), Err(NoTwin::Same(form)));
                continue;
            }
            let twin = with_distribution(from, form).unwrap();
            assert_eq!(twin.covariance_parameters, into.covariance_parameters);
            for (one, other) in twin.terms.iter().zip(&into.terms) {
                for (one, other) in one.parameters.iter().zip(&other.parameters) {
                    let sigma = other.standard_uncertainty[0];
                    assert_eq!((&one.name, &one.unit), (&other.name, &other.unit));
                    assert!(
                        (one.value[0] - other.value[0]).abs() < 1e-3 * sigma,
                        "{form} {}: {one:?} {other:?}",
                        one.name
                    );
                    assert!((one.standard_uncertainty[0] / sigma - 1.0).abs() < 1e-3, "{form}: {one:?} {other:?}");
                }
            }
            for (index, found) in twin.covariance.indexed_iter() {
                let scale = (into.covariance[(index.0, index.0)] * into.covariance[(index.1, index.1)]).sqrt();
                assert!((found - into.covariance[index]).abs() < 1e-3 * scale, "{form} {index:?}");
            }
        }
    }
}

#[test]
fn predictions_stay_and_there_and_back_is_where_it_was() {
    let model = fit(&document(1), Distribution::GaussianHalfHeight);
    for form in &GAUSSIANS[1..] {
        let twin = with_distribution(&model, *form).unwrap();
        let back = with_distribution(&twin, Distribution::GaussianHalfHeight).unwrap();
        for geometry in paper_grid() {
            let value =
                |model: &Model| predict(&model.terms_at(0).unwrap(), &geometry, &Reference::None).unwrap().total();
            assert!((value(&twin) / value(&model) - 1.0).abs() < 1e-12, "{form}");
        }
        for (one, other) in back.terms[1].parameters.iter().zip(&model.terms[1].parameters) {
            assert!((one.value[0] / other.value[0] - 1.0).abs() < 1e-13);
            assert!((one.standard_uncertainty[0] / other.standard_uncertainty[0] - 1.0).abs() < 1e-9);
        }
    }
}

#[test]
fn another_function_is_refused_with_the_way_out() {
    let model = fit(&document(1), Distribution::GaussianHalfHeight);
    for form in [Distribution::Beckmann, Distribution::TrowbridgeReitz] {
        let error = with_distribution(&model, form).unwrap_err().to_string();
        assert!(
            error.contains("another function") && error.contains(&format!("bbrf fit --distribution {form}")),
            "{error}"
        );
    }
    let mut diffuse = model;
    diffuse.terms.truncate(1);
    assert_eq!(with_distribution(&diffuse, Distribution::Gaussian), Err(NoTwin::NoSpecularTerm));
}

/// A file of many wavelengths does not hold what the norm needs; a width alone needs nothing.
#[test]
fn what_the_file_does_not_hold_is_unknown_and_said() {
    let model = fit(&document(3), Distribution::GaussianHalfHeight);
    let sigma = |model: &Model, name: &str| {
        let parameter = model.terms[1].parameters.iter().find(|one| one.name == name).unwrap();
        parameter.standard_uncertainty.clone()
    };
    let wide = with_distribution(&model, Distribution::Gaussian).unwrap();
    assert_eq!(sigma(&wide, INTENSITY.name), sigma(&model, INTENSITY.name));
    let normalised = with_distribution(&model, Distribution::GaussianNormalised).unwrap();
    assert!(sigma(&normalised, INTENSITY.name).iter().all(|sigma| sigma.is_nan()));
    assert!(sigma(&normalised, ROUGHNESS.name)[0] > 0.0);
    assert!(normalised.identifiability.iter().any(|sentence| sentence.contains("are not known here")));
}
