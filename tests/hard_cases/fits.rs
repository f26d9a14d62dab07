//! Hard cases of fits: what a user reads of one is true, also where the data say little.

use bbrf::fit::{DataError, Fit, Fitter, GeometrySet, SetError, Stop, Terms};
use bbrf::quantity::{Geometry, Reference, SignHabit};
use bbrf::terms::{Denominator, Distribution};

use crate::scans::{Random, Truth, measure, paper_grid, peer_fit, prepare};

pub const BOTH: Terms = Terms { diffuse: true, specular: true };

pub fn set(grid: &[Geometry]) -> GeometrySet {
    GeometrySet::new(grid, &Reference::None, Distribution::GaussianHalfHeight, Denominator::CosThetaI).unwrap()
}

pub fn fit(grid: &[Geometry], values: &[f64], sigma: &[f64]) -> Fit {
    Fitter::new(&set(grid), BOTH).fit(values, Some(sigma)).unwrap()
}

pub fn found(fit: &Fit) -> [f64; 4] {
    [fit.bands[0].diffuse, fit.bands[0].intensity, fit.roughness, fit.index_minus_one]
}

/// Every parameter within four of its standard uncertainties of the truth.
pub fn assert_recovered(fit: &Fit, truth: &Truth) {
    for ((found, truth), sigma) in found(fit).into_iter().zip(truth.as_array()).zip(fit.standard_uncertainty(0)) {
        assert!(((found - truth) / sigma).abs() < 4.0, "{found}, not {truth} within {sigma}: {fit:?}");
    }
}

pub fn paper_sphere() -> Truth {
    Truth { albedo: 0.8, intensity: 30.0, roughness: 0.05, index_minus_one: 0.45 }
}

/// D is the same everywhere, so that the intensity takes what the roughness gives, and a search runs away along the ridge.
#[test]
fn a_lobe_wider_than_the_hemisphere_is_told_or_said_to_be_beyond_the_box() {
    let grid = paper_grid();
    let measured = |roughness: f64| {
        let truth = Truth { roughness, ..paper_sphere() };
        let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(8));
        (truth, fit(&grid, &values, &sigma))
    };
    let (truth, told) = measured(2.5);
    assert_recovered(&told, &truth);
    let (_, beyond) = measured(50.0);
    assert_eq!((beyond.stop, beyond.at_bound[0]), (Stop::AtBound, true), "{beyond:?}");
    assert!(beyond.standard_uncertainty(0)[2].is_nan() && beyond.bands[0].intensity > 0.0, "{beyond:?}");
}

/// At 0.01 rad no point but the mirror direction sees the lobe: the column of the roughness is exactly 0, J'J is
/// singular, and a matrix inverse is an exception or a number of no meaning.
#[test]
fn a_lobe_narrower_than_the_grid_has_no_uncertain_roughness_stated_as_certain() {
    let grid = paper_grid();
    for roughness in [0.01, 0.004] {
        let truth = Truth { roughness, ..paper_sphere() };
        let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(9));
        let fit = fit(&grid, &values, &sigma);
        let best = peer_fit(&prepare(&grid), &values, &sigma, &truth).0;
        assert!(fit.chi_square <= best + 1.0, "{} above {best}", fit.chi_square);
        let is_vague = fit.log_sigma[0].is_nan() || fit.log_sigma[0] > 0.2 || fit.at_bound[0];
        let below_half = fit.roughness < 0.5 * 5_f64.to_radians();
        assert!(is_vague || below_half, "{fit:?}");
        // What the mirror direction tells, intensity times reflectance, is known.
        let [_, intensity, _, index] = found(&fit);
        let product = |c: f64, m: f64| c * (m / (2.0 + m)).powi(2);
        let ratio = product(intensity, index) / product(truth.intensity, truth.index_minus_one);
        assert!((ratio - 1.0).abs() < 0.05, "{ratio}");
    }
}

/// dF/dn vanishes at n = 1, so that a start there never moves; with the logarithm of n - 1 it does.
#[test]
fn an_index_next_to_one_is_found() {
    let grid = paper_grid();
    for index_minus_one in [0.01, 0.03] {
        let truth = Truth { intensity: 3000.0, roughness: 0.15, index_minus_one, ..paper_sphere() };
        let (values, sigma) = measure(&truth, &grid, 0.001, &mut Random::new(10));
        assert_recovered(&fit(&grid, &values, &sigma), &truth);
    }
}

/// Below 30 degrees intensity and index correlate by -0.99995: a search "converges" anywhere on the ridge and states
/// an index.
#[test]
fn near_the_normal_the_product_is_known_and_the_index_is_not() {
    let is_near = |g: &Geometry| g.incidence.theta_deg() <= 30.0 && g.viewing.theta_deg() <= 30.0;
    let grid: Vec<Geometry> = paper_grid().into_iter().filter(is_near).collect();
    for seed in 0..10 {
        let truth = paper_sphere();
        let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(seed));
        let fit = fit(&grid, &values, &sigma);
        let [_, intensity, _, index] = found(&fit);
        let product = |c: f64, m: f64| c * (m / (2.0 + m)).powi(2);
        let ratio = product(intensity, index) / product(truth.intensity, truth.index_minus_one);
        assert!((ratio - 1.0).abs() < 0.03, "seed {seed}: {ratio}");
        assert!(fit.log_sigma[1] > 0.2 || fit.at_bound[1], "seed {seed}: {fit:?}");
    }
}

/// Source and detector always together: F is F(0) everywhere, so intensity and index are one number. A pseudo-inverse
/// states an uncertainty for each.
#[test]
fn co_located_source_and_detector_give_no_index_and_no_intensity() {
    let grid: Vec<_> = (0..9)
        .flat_map(|step| {
            let theta = 10.0 * f64::from(step);
            [(theta, 0.0), (theta, 90.0), (theta, 180.0)]
        })
        .map(|(theta, phi)| Geometry::from_degrees(theta, phi, theta, phi).unwrap())
        .collect();
    let truth = Truth { albedo: 0.5, intensity: 20.0, roughness: 0.3, index_minus_one: 0.5 };
    let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(3));
    let fit = fit(&grid, &values, &sigma);
    let [diffuse, intensity, roughness, index] = fit.standard_uncertainty(0);
    assert!(index.is_nan() && intensity.is_nan(), "{fit:?}");
    assert!(diffuse.is_finite() && roughness.is_finite(), "{fit:?}");
}

/// From an intensity of 0 the noise always finds a small lobe with a roughness and an index of its own.
#[test]
fn a_pure_diffuser_has_no_specular_term() {
    let grid = paper_grid();
    let set = set(&grid);
    let mut random = Random::new(7);
    let trials = std::env::var("BBRF_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(400);
    for _ in 0..trials {
        let truth = Truth { albedo: 0.8, intensity: 0.0, roughness: 0.1, index_minus_one: 0.5 };
        let (values, sigma) = measure(&truth, &grid, 0.01, &mut random);
        let fit = Fitter::new(&set, BOTH).fit(&values, Some(&sigma)).unwrap();
        assert!(!fit.has_specular() && fit.roughness.is_nan(), "{fit:?}");
        assert!((fit.bands[0].diffuse - 0.8).abs() < 5.0 * fit.standard_uncertainty(0)[0]);
    }
}

/// Where a dip asks for a negative lobe, and an offset for a negative albedo, amplitudes solved for freely are negative.
#[test]
fn no_amplitude_is_negative() {
    let grid = paper_grid();
    let truth = Truth { roughness: 0.2, intensity: 3.0, ..paper_sphere() };
    let flat = Truth { intensity: 0.0, ..truth };
    let [lobe, flat]: [Vec<f64>; 2] = [truth, flat].map(|t| grid.iter().map(|g| t.evaluate(g).0).collect());
    let dip: Vec<f64> = lobe.iter().zip(&flat).map(|(lobe, flat)| 2.0 * flat - lobe).collect();
    let lowered: Vec<f64> = lobe.iter().map(|value| value - 1.0).collect();
    for values in [dip, lowered] {
        let fit = fit(&grid, &values, &vec![0.01; grid.len()]);
        assert!(fit.bands[0].diffuse >= 0.0 && fit.bands[0].intensity >= 0.0, "{fit:?}");
    }
}

/// min() in G switches its branch at theta_i = theta_v, where a difference quotient takes the wrong side and stalls.
#[test]
fn scans_along_the_mirror_directions_do_not_stall() {
    let pairs =
        (0..=16).flat_map(|k| (-3..=3).map(move |off| (5.0 * f64::from(k), 5.0 * f64::from(k) + 2.0 * f64::from(off))));
    let grid: Vec<Geometry> = pairs
        .filter(|(_, viewing)| viewing.abs() <= 85.0)
        .map(|(incidence, viewing)| Geometry::from_signed(incidence, viewing, SignHabit::MirrorAtEqual).unwrap())
        .collect();
    let mut random = Random::new(16);
    for _ in 0..50 {
        let truth = Truth::random(&mut random);
        let (values, sigma) = measure(&truth, &grid, 0.01, &mut random);
        let fit = fit(&grid, &values, &sigma);
        let best = peer_fit(&prepare(&grid), &values, &sigma, &truth).0;
        assert!(matches!(fit.stop, Stop::Converged | Stop::AtBound), "{truth:?} {fit:?}");
        assert!(fit.chi_square <= best + 1e-3, "{} above {best}: {truth:?}", fit.chi_square);
    }
}

/// On the edge of the box a curvature is no uncertainty (BRDFLab ships a fit that ended on its bound, unremarked).
#[test]
fn an_optimum_outside_the_box_is_said_and_has_no_uncertainty() {
    let grid = paper_grid();
    let metal = Truth { index_minus_one: 30.0, intensity: 2.0, ..paper_sphere() };
    let (values, sigma) = measure(&metal, &grid, 0.001, &mut Random::new(1));
    let fit = fit(&grid, &values, &sigma);
    assert_eq!((fit.stop, fit.at_bound), (Stop::AtBound, [false, true]));
    assert!((fit.refractive_index() - 6.0).abs() < 1e-12 && fit.standard_uncertainty(0)[3].is_nan(), "{fit:?}");
}

/// Where the detector would stand before the source there is nothing; 0 for a value says that the surface is black there.
#[test]
fn a_retro_gap_is_no_data() {
    let grid = paper_grid();
    let truth = paper_sphere();
    let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(19));
    let without = fit(&grid, &values, &sigma);
    let angles = (-8..=8).map(|step| 10.0 * f64::from(step));
    let gap: Vec<Geometry> =
        angles.map(|theta| Geometry::from_signed(theta, -theta, SignHabit::MirrorAtEqual).unwrap()).collect();
    assert!(gap.iter().all(|geometry| geometry.is_retro(1.0)));
    let (mut whole, mut all, mut all_sigma) = (grid, values, sigma);
    whole.extend(&gap);
    all.extend(vec![f64::NAN; gap.len()]);
    all_sigma.extend(vec![0.01; gap.len()]);
    let with = fit(&whole, &all, &all_sigma);
    assert_eq!(with.left_out.no_value, 17);
    for (a, b) in found(&with).into_iter().zip(found(&without)) {
        assert!((a / b - 1.0).abs() < 1e-12, "{a} {b}");
    }
    // The naive way, for comparison: it moves the albedo by far more than its uncertainty.
    all.iter_mut().filter(|value| value.is_nan()).for_each(|value| *value = 0.0);
    let filled = fit(&whole, &all, &all_sigma);
    let off = (filled.bands[0].diffuse - truth.albedo) / without.standard_uncertainty(0)[0];
    assert!(off.abs() > 10.0, "{off}");
}

/// Two clipped values of 272 turn (30, 1.45) into (20, 1.59) with small residuals elsewhere.
#[test]
fn clipped_values_that_are_left_out_do_no_harm_and_ones_that_are_not_show() {
    let grid = paper_grid();
    let truth = paper_sphere();
    let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(20));
    let clipped = |with: f64| values.iter().map(|v| if *v > 20.0 { with } else { *v }).collect::<Vec<f64>>();
    assert_eq!(values.iter().filter(|value| **value > 20.0).count(), 2);
    assert_recovered(&fit(&grid, &clipped(f64::NAN), &sigma), &truth);
    let believed = fit(&grid, &clipped(20.0), &sigma);
    assert!(believed.chi_square / believed.degrees_of_freedom > 1.5, "{believed:?}");
}

/// Five values three times too large move the intensity by a fifth. Least squares follows them; it must not hide it.
#[test]
fn outliers_show_in_the_reduced_chi_square_at_the_global_optimum() {
    let grid = paper_grid();
    let mut random = Random::new(21);
    for _ in 0..20 {
        let truth = Truth::random(&mut random);
        let (mut values, sigma) = measure(&truth, &grid, 0.01, &mut random);
        for _ in 0..5 {
            values[(random.uniform() * 272.0) as usize] *= 3.0;
        }
        let fit = fit(&grid, &values, &sigma);
        assert!(fit.chi_square / fit.degrees_of_freedom > 10.0, "{truth:?} {fit:?}");
        let best = peer_fit(&prepare(&grid), &values, &sigma, &truth).0;
        assert!(fit.chi_square <= best * (1.0 + 1e-6), "{} above {best}: {truth:?}", fit.chi_square);
    }
}

/// Peak 65, diffuse 0.14: with one weight for all values the peak alone is fitted and the albedo is noise.
#[test]
fn a_weak_diffuse_term_below_a_bright_lobe_keeps_its_digits() {
    let grid = paper_grid();
    let truth = Truth { albedo: 0.02, intensity: 1000.0, ..paper_sphere() };
    let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(22));
    let fit = fit(&grid, &values, &sigma);
    assert_recovered(&fit, &truth);
    let bound = truth.cramer_rao(&grid, 0.01);
    assert!((fit.standard_uncertainty(0)[0] / bound[0] - 1.0).abs() < 0.05 && bound[0] < 0.01 * truth.albedo);
}

/// Weights of 0, NaN and less than nothing; nothing left; more parameters than values: 0/0 and N - p < 0 somewhere.
#[test]
fn data_that_say_nothing_are_refused_with_the_reason() {
    let grid = paper_grid();
    let set = set(&grid);
    let fitter = Fitter::new(&set, BOTH);
    for (values, sigma) in
        [(f64::NAN, 0.01), (0.5, 0.0), (0.5, -1.0), (0.5, f64::NAN), (0.5, f64::INFINITY), (f64::INFINITY, 0.01)]
    {
        let error = fitter.fit(&[values; 272], Some(&[sigma; 272])).unwrap_err();
        let DataError::TooFew { usable: 0, parameters: 4, left_out } = error else { panic!("{error:?}") };
        assert_eq!(left_out.total(), 272, "{values} {sigma}");
    }
    let mut four = vec![f64::NAN; 272];
    four[..4].fill(0.5);
    assert!(matches!(fitter.fit(&four, None), Err(DataError::TooFew { usable: 4, .. })));
    assert_eq!(fitter.fit(&[], None), Err(DataError::Length { found: 0, expected: 272 }));
    let none = GeometrySet::new(&[], &Reference::None, Distribution::Beckmann, Denominator::CosThetaI);
    assert_eq!(none.err(), Some(SetError::NothingDefined(0)));
}

/// One angle measured a hundred times, all values equal, all values 0: every column is every other.
#[test]
fn data_without_variety_give_finite_amplitudes_and_no_invented_uncertainty() {
    let one = vec![Geometry::from_signed(20.0, 10.0, SignHabit::MirrorAtEqual).unwrap(); 100];
    let cases = [(one.clone(), 0.7), (one, 0.0), (paper_grid(), 0.7), (paper_grid(), 0.0)];
    for (grid, value) in cases {
        let fit = fit(&grid, &vec![value; grid.len()], &vec![0.01; grid.len()]);
        assert!(fit.chi_square.is_finite() && fit.bands[0].diffuse.is_finite(), "{fit:?}");
        assert!(fit.bands[0].diffuse >= 0.0 && fit.bands[0].intensity >= 0.0, "{fit:?}");
        if grid.len() == 100 {
            assert!(!fit.has_specular() || fit.standard_uncertainty(0)[2].is_nan(), "{fit:?}");
        }
    }
}

/// Duplicates are more data: uncertainties shrink by the square root of two, and nothing else changes.
#[test]
fn a_scan_twice_is_known_better_by_the_root_of_two() {
    let grid = paper_grid();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(23));
    let once = fit(&grid, &values, &sigma);
    let twice = fit(&grid.repeat(2), &values.repeat(2), &sigma.repeat(2));
    for k in 0..4 {
        assert!((found(&twice)[k] / found(&once)[k] - 1.0).abs() < 1e-6);
        let ratio = once.standard_uncertainty(0)[k] / twice.standard_uncertainty(0)[k];
        assert!((ratio - 2_f64.sqrt()).abs() < 1e-5, "{ratio}");
    }
}

/// Sums of squares in another order, in another unit, have another rounding; the answer may not.
#[test]
fn neither_the_order_of_the_rows_nor_the_unit_changes_a_fit() {
    let grid = paper_grid();
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(24));
    let plain = fit(&grid, &values, &sigma);
    let reversed = |list: &[f64]| list.iter().rev().copied().collect::<Vec<f64>>();
    let backwards: Vec<Geometry> = grid.iter().rev().copied().collect();
    let turned = fit(&backwards, &reversed(&values), &reversed(&sigma));
    for scale in [1.0, 1e-30, 1e30, 683.0] {
        let scaled = |list: &[f64]| list.iter().map(|x| scale * x).collect::<Vec<f64>>();
        let other = if scale == 1.0 { turned.clone() } else { fit(&grid, &scaled(&values), &scaled(&sigma)) };
        let expected = found(&plain).into_iter().zip([scale, scale, 1.0, 1.0]).map(|(x, unit)| x * unit);
        for (found, expected) in found(&other).into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-9, "{scale:e}: {found} {expected}");
        }
    }
}
