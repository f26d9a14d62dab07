//! Profile-likelihood intervals: they cover, they are open where the data cannot tell, and they find lower minima.
#![allow(unreachable_pub, clippy::unwrap_used)]

mod common {
    pub mod scans;
}

use bbrf::fit::{Fitter, GeometrySet, Interval, Terms};
use bbrf::quantity::{Geometry, Reference};
use bbrf::terms::{Denominator, Distribution};
use common::scans::{Random, Truth, measure, paper_grid};
use ndarray::{ArrayView1, Axis};

const BOTH: Terms = Terms { diffuse: true, specular: true };

fn trials() -> usize {
    std::env::var("BBRF_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(300)
}

fn set(grid: &[Geometry]) -> GeometrySet {
    GeometrySet::new(grid, &Reference::None, Distribution::GaussianHalfHeight, Denominator::CosThetaI).unwrap()
}

fn intervals(set: &GeometrySet, values: &[f64], sigma: Option<&[f64]>) -> [Option<Interval>; 4] {
    let row = |values| ArrayView1::from(values).insert_axis(Axis(0));
    let (_, found) = Fitter::new(set, BOTH).fit_with_intervals(row(values), sigma.map(row), 0.95).unwrap();
    [found.diffuse, found.intensity, found.roughness, found.index_minus_one]
}

/// Each parameter by itself, every trial counted; the share itself scatters by sqrt(.95 .05 / trials).
#[test]
fn intervals_of_95_percent_cover_the_truth_in_95_of_100_scans() {
    for (relative, has_sigma) in [(0.01, true), (0.05, true), (0.02, false)] {
        let grid = paper_grid();
        let set = set(&grid);
        let mut random = Random::new(2_026);
        let mut covered = [0; 4];
        let count = trials();
        for trial in 0..count {
            let truth = Truth::random(&mut random);
            let (values, sigma) = if has_sigma {
                measure(&truth, &grid, relative, &mut random)
            } else {
                // One noise for all values, its size not told.
                let exact: Vec<f64> = grid.iter().map(|geometry| truth.evaluate(geometry).0).collect();
                (exact.iter().map(|value| value + relative * random.normal()).collect(), Vec::new())
            };
            let found = intervals(&set, &values, has_sigma.then_some(sigma.as_slice()));
            for (k, true_value) in truth.as_array().into_iter().enumerate() {
                let interval = found[k].unwrap_or_else(|| panic!("trial {trial}: no interval of parameter {k}"));
                covered[k] += usize::from(interval.contains(true_value));
            }
        }
        let scatter = 4.0 * (0.95 * 0.05 / count as f64).sqrt();
        for (k, name) in ["albedo", "intensity", "roughness", "n - 1"].into_iter().enumerate() {
            let share = covered[k] as f64 / count as f64;
            println!("noise {relative}, known {has_sigma}: {name} covered in {share:.4}");
            assert!((share - 0.95).abs() < scatter, "{name}: 95 % intervals cover {share} at noise {relative}");
        }
    }
}

/// Below 30 degrees F is flat: the interval of the index reaches an edge of the box, and that of the intensity with it.
#[test]
fn an_index_that_the_geometries_cannot_tell_has_an_open_interval() {
    let grid: Vec<Geometry> = paper_grid()
        .into_iter()
        .filter(|geometry| geometry.signed_deg().is_some_and(|(i, v)| i.abs() <= 30.0 && v.abs() <= 30.0))
        .collect();
    let set = set(&grid);
    let truth = Truth { albedo: 0.5, intensity: 3.0, roughness: 0.1, index_minus_one: 0.5 };
    let (values, sigma) = measure(&truth, &grid, 0.03, &mut Random::new(5));
    let [_, intensity, roughness, index] = intervals(&set, &values, Some(&sigma)).map(Option::unwrap);
    assert!(!index.is_closed() && index.contains(0.5), "{index:?}");
    assert!(!intensity.is_closed() && intensity.contains(3.0), "{intensity:?}");
    assert!(roughness.is_closed() && roughness.contains(0.1), "{roughness:?}");
}

/// A parabola would be symmetric.
#[test]
fn intervals_of_a_vague_index_are_longer_on_the_side_that_the_data_allow() {
    let grid: Vec<Geometry> = paper_grid()
        .into_iter()
        .filter(|geometry| geometry.signed_deg().is_some_and(|(i, v)| i.abs() <= 60.0 && v.abs() <= 60.0))
        .collect();
    let set = set(&grid);
    let truth = Truth { albedo: 0.5, intensity: 20.0, roughness: 0.1, index_minus_one: 0.5 };
    let exact: Vec<f64> = grid.iter().map(|geometry| truth.evaluate(geometry).0).collect();
    let sigma: Vec<f64> = exact.iter().map(|value| 0.05 * value).collect();
    let index = intervals(&set, &exact, Some(&sigma))[3].unwrap();
    let (down, up) = (0.5 - index.low, index.high - 0.5);
    assert!(index.is_closed() && (up / down - 1.0).abs() > 0.03, "{index:?}");
    // The ends are where chi-square has risen by 3.84: checked by a fit that is held there by its bounds.
    for end in [index.low, index.high] {
        let held = Fitter::new(&set, BOTH).within((1e-9, 1e9), (end, end)).fit(&exact, Some(&sigma)).unwrap();
        assert!((held.chi_square - 3.841_458_8).abs() < 2e-3, "{end}: {}", held.chi_square);
    }
}

/// Held on its bound the index is known, and the others are as certain as beside a known index; counted as free it would
/// lend the intensity its own doubt.
#[test]
fn beside_an_index_on_its_bound_the_others_have_the_uncertainty_of_three_parameters() {
    let grid = paper_grid();
    let set = set(&grid);
    let truth = Truth { albedo: 0.5, intensity: 20.0, roughness: 0.1, index_minus_one: 0.5 };
    let (values, sigma) = measure(&truth, &grid, 0.05, &mut Random::new(9));
    let fit = Fitter::new(&set, BOTH).within((1e-9, 1e9), (0.05, 0.3)).fit(&values, Some(&sigma)).unwrap();
    assert_eq!(fit.at_bound, [false, true], "{fit:?}");
    let found = Truth {
        albedo: fit.bands[0].diffuse,
        intensity: fit.bands[0].intensity,
        roughness: fit.roughness,
        index_minus_one: fit.index_minus_one,
    };
    let mut information = nalgebra::Matrix3::zeros();
    for (geometry, sigma) in grid.iter().zip(&sigma) {
        let [a, c, r, _] = found.evaluate(geometry).1;
        let row = nalgebra::Vector3::new(a, c, r) / *sigma;
        information += row * row.transpose();
    }
    let covariance = information.try_inverse().unwrap();
    let claimed = fit.standard_uncertainty(0);
    for k in 0..3 {
        let expected = covariance[(k, k)].sqrt();
        assert!((claimed[k] / expected - 1.0).abs() < 1e-6, "parameter {k}: {} {expected}", claimed[k]);
    }
    assert!(claimed[3].is_nan(), "a parameter on its bound has no ordinary uncertainty");
}
