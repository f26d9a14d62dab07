//! A Gaussian under another width or norm is the same function: predictions stay, and uncertainties are those of a fit.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod documents;
    pub mod scans;
}

use bbrf::dataset::{Document, Model, NoTwin, predict, with_distribution};
use bbrf::fit::{FitOptions, fit_measurement};
use bbrf::quantity::Reference;
use bbrf::terms::{Distribution, INTENSITY, ROUGHNESS};
use common::documents::measured_document;
use common::scans::{Random, Truth, measure, paper_grid};

const GAUSSIANS: [Distribution; 4] = [
    Distribution::GaussianHalfHeight,
    Distribution::Gaussian,
    Distribution::TorranceSparrow1967,
    Distribution::GaussianNormalised,
];

fn document(bands: usize) -> Document {
    let truth = Truth { albedo: 0.6, intensity: 8.0, roughness: 0.2, index_minus_one: 0.5 };
    measured_document(&paper_grid(), Reference::None, &vec![truth; bands], 0.01, &mut Random::new(7))
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
            let [twin, into] = [&twin, into].map(|model| model.covariance_at(0).unwrap());
            for (index, found) in twin.indexed_iter() {
                let scale = (into[(index.0, index.0)] * into[(index.1, index.1)]).sqrt();
                assert!((found - into[index]).abs() < 1e-3 * scale, "{form} {index:?}");
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

#[test]
fn every_wavelength_of_a_spectral_model_is_that_of_a_fit_of_the_other_form() {
    let [half, normalised] =
        [Distribution::GaussianHalfHeight, Distribution::GaussianNormalised].map(|form| fit(&document(3), form));
    let twin = with_distribution(&half, Distribution::GaussianNormalised).unwrap();
    for (found, asked) in twin.terms[1].parameters.iter().zip(&normalised.terms[1].parameters) {
        for (one, other) in found.standard_uncertainty.iter().zip(&asked.standard_uncertainty) {
            assert!((one / other - 1.0).abs() < 1e-3, "{found:?} {asked:?}");
        }
    }
}

/// A width alone needs nothing; the norm needs what another program may not have written.
#[test]
fn what_the_file_does_not_hold_is_unknown_and_said() {
    let mut model = fit(&document(3), Distribution::GaussianHalfHeight);
    model.covariance = ndarray::ArcArray::zeros((3, 0, 0));
    model.covariance_parameters.clear();
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

/// Of an interval the ends of a width move with it; those of an amplitude under another norm are no interval of its own.
#[test]
fn an_interval_goes_with_its_number_or_is_gone() {
    let model = fit(&document(1), Distribution::GaussianHalfHeight);
    let wide = with_distribution(&model, Distribution::Gaussian).unwrap();
    let normalised = with_distribution(&model, Distribution::GaussianNormalised).unwrap();
    let refitted = fit(&document(1), Distribution::Gaussian);
    let [asked, found] = [&refitted, &wide].map(|model| model.terms[1].parameters.clone());
    for (one, other) in found.iter().zip(&asked) {
        let width = other.interval_high[0] - other.interval_low[0];
        assert!((one.interval_low[0] - other.interval_low[0]).abs() < 2e-3 * width, "{one:?} {other:?}");
        assert!((one.interval_high[0] - other.interval_high[0]).abs() < 2e-3 * width, "{one:?} {other:?}");
    }
    for parameter in &normalised.terms[1].parameters {
        assert_eq!(parameter.interval_low.is_empty(), parameter.name == INTENSITY.name, "{parameter:?}");
    }
}

/// With everything for each wavelength each has its own norm; one where no specular term was seen stays without.
#[test]
fn every_wavelength_is_converted_by_its_own_roughness() {
    let mut document = document(3);
    let diffuse = Truth { albedo: 0.6, intensity: 0.0, roughness: 0.2, index_minus_one: 0.5 };
    let (values, sigma) = measure(&diffuse, &paper_grid(), 0.01, &mut Random::new(3));
    document.measurements[0].values.column_mut(1).assign(&ndarray::aview1(&values));
    let mut all = document.measurements[0].uncertainty.standard.take().unwrap();
    all.column_mut(1).assign(&ndarray::aview1(&sigma));
    document.measurements[0].uncertainty.standard = Some(all);
    let options = FitOptions { reduction: "none".parse().unwrap(), share: None, ..FitOptions::default() };
    let model = fit_measurement(&document, &document.measurements[0], &options).unwrap();
    let twin = with_distribution(&model, Distribution::GaussianNormalised).unwrap();
    for emission in 0..3 {
        assert_eq!(twin.terms[1].is_seen_at(emission), emission != 1, "{:?}", twin.terms[1]);
        for geometry in paper_grid() {
            let value = |model: &Model| {
                predict(&model.terms_at(emission).unwrap(), &geometry, &Reference::None).unwrap().total()
            };
            assert!((value(&twin) / value(&model) - 1.0).abs() < 1e-12, "{emission}");
        }
    }
}
