//! Which model: the one that made the data wins, and where data cannot tell, that is said.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod documents;
    pub mod scans;
}

use bbrf::dataset::Document;
use bbrf::fit::{Comparison, Criterion, FitOptions, Shape, compare_measurement};
use bbrf::quantity::{Geometry, Reference, SignHabit};
use bbrf::terms::{Denominator, Distribution, Term, TorranceSparrow};
use common::documents::scan_document;
use common::scans::Random;
use ndarray::Array2;

fn scan(angles: &[f64], terms: &[Term], noise: f64, has_sigma: bool, seed: u64) -> Document {
    let pairs = angles.iter().flat_map(|i| angles.iter().map(move |v| (*i, *v))).filter(|(i, v)| *i != -*v);
    let grid: Vec<Geometry> =
        pairs.map(|(i, v)| Geometry::from_signed(i, v, SignHabit::MirrorAtEqual).unwrap()).collect();
    let mut random = Random::new(seed);
    let exact: Vec<f64> = grid
        .iter()
        .map(|geometry| bbrf::dataset::predict(terms, geometry, &Reference::SameGeometry).unwrap().total())
        .collect();
    let values: Vec<f64> = exact.iter().map(|value| value * (1.0 + noise * random.normal())).collect();
    let column = |values: Vec<f64>| Array2::from_shape_vec((grid.len(), 1), values).unwrap();
    let sigma = has_sigma.then(|| column(exact.iter().map(|value| noise * value).collect()));
    scan_document(&grid, Reference::SameGeometry, column(values), sigma)
}

fn compare(document: &Document) -> Comparison {
    compare_measurement(document, &document.measurements[0], &FitOptions::default()).unwrap()
}

fn specular(distribution: Distribution, denominator: Denominator, intensity: f64) -> [Term; 2] {
    let term = TorranceSparrow { intensity, roughness: 0.25, refractive_index: 1.5, distribution, denominator };
    [Term::Lambertian { albedo: 0.4 }, Term::TorranceSparrow(term)]
}

fn wide() -> Vec<f64> {
    (-7..=7).map(|k| f64::from(k) * 10.0).collect()
}

#[test]
fn the_model_that_made_the_data_is_preferred() {
    for (distribution, denominator, intensity) in [
        (Distribution::Beckmann, Denominator::CosThetaV, 1.0),
        (Distribution::TrowbridgeReitz, Denominator::CosICosV, 1.0),
        (Distribution::GaussianHalfHeight, Denominator::CosThetaI, 5.0),
    ] {
        for has_sigma in [true, false] {
            let found = compare(&scan(&wide(), &specular(distribution, denominator, intensity), 0.01, has_sigma, 5));
            let best = &found.models[found.preferred];
            let expected = Shape { diffuse: true, specular: Some((distribution, denominator)) };
            assert_eq!(best.shape, expected, "sigma {has_sigma}: {}", best.shape);
            let others = found.models.iter().filter(|model| model.is_own && model.shape != expected);
            assert!(others.clone().all(|other| other.aicc > best.aicc), "AICc agrees on simulated data");
            assert_eq!((found.models.len(), found.has_sigma), (19, has_sigma));
            assert_eq!(found.folds, found.geometries, "each geometry is left out by itself");
        }
    }
}

#[test]
fn a_pure_diffuser_is_diffuse_and_nothing_else() {
    for has_sigma in [true, false] {
        let found = compare(&scan(&wide(), &[Term::Lambertian { albedo: 0.9 }], 0.01, has_sigma, 11));
        assert_eq!(found.models[found.preferred].shape, Shape { diffuse: true, specular: None });
    }
}

/// Near the normal all cosines are near 1: no denominator shows.
#[test]
fn models_that_agree_on_a_narrow_scan_are_said_to_be_indistinguishable() {
    let narrow: Vec<f64> = (-5..=5).map(|k| f64::from(k) * 1.5).collect();
    let truth = specular(Distribution::GaussianHalfHeight, Denominator::CosThetaI, 5.0);
    let found = compare(&scan(&narrow, &truth, 0.02, true, 3));
    let preferred = found.models[found.preferred].shape;
    assert!(preferred.specular.is_some());
    let others: Vec<Shape> = found.indistinguishable.iter().map(|other| other.shape).collect();
    let denominators = others.iter().chain([&preferred]).filter_map(|shape| shape.specular.map(|(_, one)| one));
    let mut denominators: Vec<Denominator> = denominators.collect();
    denominators.sort();
    denominators.dedup();
    assert_eq!(denominators.len(), 3, "{others:?}");
    let rival = found.indistinguishable.iter().find(|other| {
        let form = |shape: Shape| shape.specular.map(|(distribution, _)| distribution);
        other.shape.diffuse == preferred.diffuse && form(other.shape) == form(preferred)
    });
    let first = rival.unwrap().apart[0];
    let (i, v) = (first.geometry.incidence.theta_deg(), first.geometry.viewing.theta_deg());
    assert!(i.max(v) > 40.0 && first.in_sigma > 2.0, "they part beyond the scan: {first:?}");
}

/// Burnham and Anderson 2002: AICc = -2 ln L + 2k + 2k(k+1)/(n-k-1), BIC = -2 ln L + k ln n.
#[test]
fn the_criteria_are_those_of_the_books() {
    let with = Criterion::of(50.0, 60, 4, true);
    assert!((with.aicc - (58.0 + 40.0 / 55.0)).abs() < 1e-12);
    assert!((with.bic - (50.0 + 4.0 * 60.0_f64.ln())).abs() < 1e-12);
    // Without uncertainties the variance is a fifth parameter.
    let without = Criterion::of(6.0, 60, 4, false);
    assert!((without.aicc - (60.0 * 0.1_f64.ln() + 10.0 + 60.0 / 54.0)).abs() < 1e-12);
    assert!(Criterion::of(1.0, 5, 4, true).aicc.is_nan(), "too few values for the correction");
}
