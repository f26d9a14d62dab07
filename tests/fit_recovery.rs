//! Start-free fits of random scans: every one at the global optimum, errors at the Cramer-Rao bound.
//! `BBRF_TRIALS=2000` runs the full set.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod scans;
}

use bbrf::fit::{Effort, Fitter, GeometrySet, LeftOut, Stop, Terms};
use bbrf::quantity::Reference;
use bbrf::terms::{Denominator, Distribution};
use common::scans::{Random, Truth, measure, paper_grid, peer_fit, prepare};

const BOTH: Terms = Terms { diffuse: true, specular: true };

fn trials() -> usize {
    std::env::var("BBRF_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(400)
}

fn paper_set() -> GeometrySet {
    GeometrySet::new(&paper_grid(), &Reference::None, Distribution::GaussianHalfHeight, Denominator::CosThetaI).unwrap()
}

/// A single-start Levenberg-Marquardt is right in 62 % of such cases and reports success in the others.
#[test]
fn random_scans_are_recovered_at_the_global_optimum_and_the_cramer_rao_bound() {
    let (grid, set) = (paper_grid(), paper_set());
    let prepared = prepare(&grid);
    let fitter = Fitter::new(&set, BOTH);
    let mut random = Random::new(20_131_111);
    let count = trials();
    let (mut square, mut claimed) = ([0.0; 4], [0.0; 4]);
    for trial in 0..count {
        let truth = Truth::random(&mut random);
        let (values, sigma) = measure(&truth, &grid, 0.01, &mut random);
        let fit = fitter.fit(&values, Some(&sigma)).unwrap();
        assert_eq!(fit.stop, Stop::Converged, "trial {trial}: {truth:?}");
        let (from_truth, _) = peer_fit(&prepared, &values, &sigma, &truth);
        assert!(fit.chi_square <= from_truth + 1e-4, "trial {trial}: {} above {from_truth}: {truth:?}", fit.chi_square);
        let found = [fit.bands[0].diffuse, fit.bands[0].intensity, fit.roughness, fit.index_minus_one];
        let bound = truth.cramer_rao(&grid, 0.01);
        let uncertainty = fit.standard_uncertainty(0);
        for k in 0..4 {
            square[k] += ((found[k] - truth.as_array()[k]) / bound[k]).powi(2);
            claimed[k] += uncertainty[k] / bound[k];
        }
    }
    for (k, name) in ["albedo", "intensity", "roughness", "n - 1"].into_iter().enumerate() {
        let ratio = (square[k] / count as f64).sqrt();
        println!("{name}: r.m.s. error / Cramer-Rao {ratio:.4}, claimed / Cramer-Rao {:.4}", claimed[k] / count as f64);
        // The ratio itself scatters by 1/sqrt(2 count).
        let scatter = 3.0 / (2.0 * count as f64).sqrt();
        assert!(ratio < 1.0 + scatter.max(0.05), "{name}: r.m.s. error is {ratio} of the Cramer-Rao bound");
        assert!((claimed[k] / count as f64 - 1.0).abs() < 0.05, "{name}: claimed uncertainty is off");
    }
}

#[test]
fn exact_data_give_back_the_parameters() {
    let (grid, set) = (paper_grid(), paper_set());
    let truth = Truth { albedo: 0.8, intensity: 30.0, roughness: 0.05, index_minus_one: 0.45 };
    let values: Vec<f64> = grid.iter().map(|geometry| truth.evaluate(geometry).0).collect();
    let fit = Fitter::new(&set, BOTH).fit(&values, None).unwrap();
    let found = [fit.bands[0].diffuse, fit.bands[0].intensity, fit.roughness, fit.index_minus_one];
    for (found, expected) in found.into_iter().zip(truth.as_array()) {
        assert!((found / expected - 1.0).abs() < 1e-7, "{found} {expected} {fit:?}");
    }
}

#[test]
fn the_covariance_is_that_of_the_full_jacobian() {
    let (grid, set) = (paper_grid(), paper_set());
    let truth = Truth { albedo: 0.3, intensity: 8.0, roughness: 0.2, index_minus_one: 0.6 };
    let values: Vec<f64> = grid.iter().map(|geometry| truth.evaluate(geometry).0).collect();
    let sigma: Vec<f64> = values.iter().map(|value| 0.01 * value).collect();
    let fit = Fitter::new(&set, BOTH).fit(&values, Some(&sigma)).unwrap();
    let bound = truth.cramer_rao(&grid, 0.01);
    for (found, expected) in fit.standard_uncertainty(0).into_iter().zip(bound) {
        assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
    }
}

#[test]
fn several_bands_share_roughness_and_index() {
    let (grid, set) = (paper_grid(), paper_set());
    let mut random = Random::new(11);
    let truths: Vec<Truth> = (0..5)
        .map(|b| Truth { albedo: 0.2 + 0.1 * f64::from(b), intensity: 20.0, roughness: 0.1, index_minus_one: 0.5 })
        .collect();
    let (values, sigma): (Vec<Vec<f64>>, Vec<Vec<f64>>) =
        truths.iter().map(|truth| measure(truth, &grid, 0.01, &mut random)).unzip();
    let array = |rows: &[Vec<f64>]| ndarray::Array2::from_shape_fn((5, grid.len()), |(b, k)| rows[b][k]);
    let (values, sigma) = (array(&values), array(&sigma));
    let fit = Fitter::new(&set, BOTH).fit_bands(values.view(), Some(sigma.view())).unwrap();
    assert_eq!(fit.stop, Stop::Converged);
    for (b, (band, truth)) in fit.bands.iter().zip(&truths).enumerate() {
        let uncertainty = fit.standard_uncertainty(b);
        let found = [band.diffuse, band.intensity, fit.roughness, fit.index_minus_one];
        for k in 0..4 {
            let error = (found[k] - truth.as_array()[k]) / uncertainty[k];
            assert!(error.abs() < 4.5, "band {b}, parameter {k}: {error} standard uncertainties");
        }
    }
    let alone = truths[0].cramer_rao(&grid, 0.01)[2];
    let ratio = fit.standard_uncertainty(0)[2] / alone;
    assert!(
        ratio > 0.35 && ratio < 0.55,
        "five bands know the roughness {ratio} as well as one; expected about 1/sqrt 5"
    );
}

/// More nodes, more of them polished and a finer tolerance find what the usual effort finds.
#[test]
fn more_effort_changes_nothing_that_the_data_could_tell() {
    let (grid, set) = (paper_grid(), paper_set());
    let more = set.clone().with_effort(Effort { roughness_nodes: 40, index_nodes: 7, starts: 5, tolerance: 1e-14 });
    let mut random = Random::new(3);
    for trial in 0..trials().div_ceil(10) {
        let truth = Truth::random(&mut random);
        let (values, sigma) = measure(&truth, &grid, 0.01, &mut random);
        let [usual, careful] = [&set, &more].map(|set| Fitter::new(set, BOTH).fit(&values, Some(&sigma)).unwrap());
        let apart = (usual.roughness.ln() - careful.roughness.ln()).abs() / careful.log_sigma[0];
        assert!(apart < 1e-3, "trial {trial}: {apart} standard uncertainties: {truth:?}");
    }
}

/// A single start in the middle of nothing misses lobes: the effort is really spent.
#[test]
fn less_effort_misses_some_scans() {
    let (grid, set) = (paper_grid(), paper_set());
    let less = set.clone().with_effort(Effort { roughness_nodes: 1, index_nodes: 1, starts: 1, tolerance: 1e-8 });
    let mut random = Random::new(4);
    let missed = (0..200).filter(|_| {
        let truth = Truth { roughness: random.log_between(0.015, 0.045), ..Truth::random(&mut random) };
        let (values, sigma) = measure(&truth, &grid, 0.01, &mut random);
        let [usual, quick] = [&set, &less].map(|set| Fitter::new(set, BOTH).fit(&values, Some(&sigma)).unwrap());
        quick.chi_square > usual.chi_square + 1.0
    });
    assert!(missed.count() > 0);
}

/// Files made on different machines are compared digit by digit.
#[test]
fn vector_instructions_change_no_bit_of_a_fit() {
    let (grid, set) = (paper_grid(), paper_set());
    let mut random = Random::new(6);
    for trial in 0..20 {
        let truth = Truth::random(&mut random);
        let (values, sigma) = measure(&truth, &grid, 0.01, &mut random);
        let fitter = Fitter::new(&set, BOTH);
        let [first, second] = [fitter, fitter.plain()].map(|fitter| fitter.fit(&values, Some(&sigma)).unwrap());
        assert_eq!(first, second, "trial {trial}");
    }
}

#[test]
fn useless_values_are_left_out_and_too_few_are_refused() {
    let (grid, set) = (paper_grid(), paper_set());
    let truth = Truth { albedo: 0.5, intensity: 20.0, roughness: 0.3, index_minus_one: 0.5 };
    let (mut values, mut sigma) = measure(&truth, &grid, 0.01, &mut Random::new(5));
    values[3] = f64::NAN;
    sigma[10] = 0.0;
    sigma[11] = f64::NAN;
    sigma[12] = -1.0;
    let fit = Fitter::new(&set, BOTH).fit(&values, Some(&sigma)).unwrap();
    let expected = LeftOut { no_value: 1, undefined_geometry: 0, zero_sigma: 1, unknown_sigma: 2 };
    assert_eq!((fit.left_out, fit.left_out.total(), fit.bands[0].count), (expected, 4, 268));
    sigma.fill(0.0);
    let error = Fitter::new(&set, BOTH).fit(&values, Some(&sigma)).unwrap_err().to_string();
    assert!(error.contains("271 whose standard uncertainty (sigma) is 0"), "{error}");
    assert!(Fitter::new(&set, BOTH).fit(&values[1..], None).is_err());
}
