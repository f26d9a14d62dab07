//! Readings of which one side is known: a detector that was overloaded, and a signal below the floor of the instrument.

use bbrf::fit::{Bound, DataError, Fitter, GeometrySet, Loss, Observations, Observed, Side, Terms};
use bbrf::quantity::{Geometry, Reference};
use ndarray::{ArrayView1, Axis};

use crate::fits::{BOTH, assert_recovered, fit, found, paper_sphere, set};
use crate::scans::{Random, Truth, measure, paper_grid};

const DIFFUSE: Terms = Terms { diffuse: true, specular: false };

fn observe(fitter: &Fitter<'_>, values: &[f64], sigma: &[f64], bounds: &[Bound]) -> Result<Observed, DataError> {
    let row = |values| ArrayView1::from(values).insert_axis(Axis(0));
    let data = Observations { values: row(values), sigma: Some(row(sigma)), bounds, loss: Loss::Squares };
    fitter.fit_observed(&data, 0.95)
}

fn beyond(values: &[f64], sigma: &[f64], limit: f64, side: Side) -> Vec<Bound> {
    let is_beyond = |value: &f64| if side == Side::AtLeast { *value > limit } else { *value < limit };
    let places = (0..values.len()).filter(|geometry| is_beyond(&values[*geometry]));
    places.map(|geometry| Bound { emission: 0, geometry, side, bound: limit, sigma: sigma[geometry] }).collect()
}

/// Two of 272 values read 20 because the detector ends there. Believed, they turn (30, 1.45) into (20, 1.58) with small
/// residuals elsewhere.
#[test]
fn an_overloaded_detector_says_that_the_value_is_at_least_so_large() {
    let grid = paper_grid();
    let set = set(&grid);
    let fitter = Fitter::new(&set, BOTH);
    let truth = paper_sphere();
    let (mut intensities, mut indices) = (0.0, 0.0);
    let trials = 40_u32;
    for seed in 0..trials {
        let (values, sigma) = measure(&truth, &grid, 0.01, &mut Random::new(200 + u64::from(seed)));
        let bounds = beyond(&values, &sigma, 20.0, Side::AtLeast);
        assert_eq!(bounds.len(), 2);
        let observed = observe(&fitter, &values, &sigma, &bounds).unwrap();
        assert!(observed.settled, "{observed:?}");
        assert_recovered(&observed.fit, &truth);
        let clipped = |with: f64| values.iter().map(|v| if *v > 20.0 { with } else { *v }).collect::<Vec<f64>>();
        let believed = fit(&grid, &clipped(20.0), &sigma);
        intensities += believed.bands[0].intensity / f64::from(trials);
        indices += believed.refractive_index() / f64::from(trials);
    }
    println!("believed: intensity {intensities:.2}, index {indices:.3}");
    assert!((18.0..22.0).contains(&intensities) && (1.55..1.62).contains(&indices), "{intensities} {indices}");
}

/// Where many readings lie around the limit, leaving out those beyond it chooses by their noise: the lobe that is left is
/// too low, and by how much depends on the noise.
#[test]
fn leaving_out_what_is_overloaded_chooses_by_noise_and_a_bound_does_not() {
    let grid = paper_grid();
    let set = set(&grid);
    let fitter = Fitter::new(&set, BOTH);
    let truth = Truth { albedo: 0.5, intensity: 10.0, roughness: 0.3, index_minus_one: 0.5 };
    let (mut with, mut without) = (Vec::new(), Vec::new());
    let mut clipped = 0;
    let mut random = Random::new(300);
    for _ in 0..trials(300) {
        let (values, sigma) = measure(&truth, &grid, 0.1, &mut random);
        let bounds = beyond(&values, &sigma, 0.8, Side::AtLeast);
        clipped += bounds.len();
        with.push((observe(&fitter, &values, &sigma, &bounds).unwrap().fit.bands[0].intensity / truth.intensity).ln());
        let left: Vec<f64> = values.iter().map(|value| if *value > 0.8 { f64::NAN } else { *value }).collect();
        let naive = fitter.fit(&left, Some(&sigma)).unwrap().bands[0].intensity;
        without.push((naive.max(1e-3) / truth.intensity).ln());
    }
    let ([mean, scatter], [naive, wide]) = (moments(&with), moments(&without));
    println!(
        "{} of 272 clipped; ln intensity: with bounds {mean:.4} +- {scatter:.4}, left out {naive:.4} +- {wide:.4}",
        clipped / with.len()
    );
    assert!(mean.abs() < 4.0 * scatter / (with.len() as f64).sqrt() + 0.5 * scatter * scatter, "{mean} {scatter}");
    assert!(wide > 1.1 * scatter, "{wide} {scatter}");
}

fn trials(usual: usize) -> usize {
    std::env::var("BBRF_TRIALS").ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// Mean and standard deviation.
fn moments(list: &[f64]) -> [f64; 2] {
    let mean = list.iter().sum::<f64>() / list.len() as f64;
    let square = list.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (list.len() - 1) as f64;
    [mean, square.sqrt()]
}

/// A dark surface whose readings lie around the floor. Left out, what lies below biases the albedo upwards; set to the
/// floor, too; set to half of it, by luck of the floor.
#[test]
fn readings_below_the_floor_leave_the_albedo_of_a_dark_surface_without_bias() {
    let grid = paper_grid();
    let set = GeometrySet::diffuse(&grid, &Reference::None).unwrap();
    let fitter = Fitter::new(&set, DIFFUSE);
    let (albedo, sigma) = (0.02, vec![0.01; grid.len()]);
    let mut random = Random::new(31);
    let (mut as_bounds, mut left_out, mut at_floor, mut covered) = (Vec::new(), Vec::new(), Vec::new(), 0);
    let trials = trials(400) as f64;
    let mut claimed = 0.0;
    for _ in 0..trials as usize {
        let value = |geometry: &Geometry| albedo * geometry.incidence.cos_theta() + 0.01 * random.normal();
        let values: Vec<f64> = grid.iter().map(value).collect();
        let floor = 0.015;
        let bounds = beyond(&values, &sigma, floor, Side::AtMost);
        assert!(bounds.len() > 80);
        let observed = observe(&fitter, &values, &sigma, &bounds).unwrap();
        assert!(observed.settled);
        as_bounds.push(observed.fit.bands[0].diffuse);
        claimed += observed.fit.standard_uncertainty(0)[0] / trials;
        covered += i32::from(observed.intervals.diffuse.unwrap().contains(albedo));
        let with = |other: f64| values.iter().map(|v| if *v < floor { other } else { *v }).collect::<Vec<f64>>();
        let alone = |values: &[f64]| fitter.fit(values, Some(&sigma)).unwrap().bands[0].diffuse;
        left_out.push(alone(&with(f64::NAN)));
        at_floor.push(alone(&with(floor)));
    }
    let bias = |list: &[f64]| (moments(list)[0] - albedo) / moments(list)[1];
    let share = f64::from(covered) / trials;
    println!(
        "albedo {albedo}: bounds {:?} (bias {:.2} sigma), claimed {claimed:.3e}; left out bias {:.1} sigma; at the floor {:.1} sigma; \
         covered {share:.4}",
        moments(&as_bounds),
        bias(&as_bounds),
        bias(&left_out),
        bias(&at_floor)
    );
    assert!(bias(&as_bounds).abs() < 4.0 / trials.sqrt(), "{}", bias(&as_bounds));
    assert!(bias(&left_out) > 5.0 && bias(&at_floor) > 5.0);
    assert!((claimed / moments(&as_bounds)[1] - 1.0).abs() < 0.15);
    assert!((share - 0.95).abs() < 4.0 * (0.95 * 0.05 / trials).sqrt(), "{share}");
}

/// An interval that took a bound for a value would be too short.
#[test]
fn intervals_of_fits_with_bounds_cover_the_truth() {
    let grid = paper_grid();
    let set = set(&grid);
    let fitter = Fitter::new(&set, BOTH);
    let mut random = Random::new(32);
    let trials = trials(200) as f64;
    let mut covered = [0; 4];
    for _ in 0..trials as usize {
        let truth = Truth::random(&mut random);
        let (values, sigma) = measure(&truth, &grid, 0.02, &mut random);
        let mut sorted = values.clone();
        sorted.sort_by(f64::total_cmp);
        let mut bounds = beyond(&values, &sigma, sorted[265], Side::AtLeast);
        bounds.extend(beyond(&values, &sigma, sorted[40], Side::AtMost));
        let observed = observe(&fitter, &values, &sigma, &bounds).unwrap();
        let intervals = observed.intervals;
        let all = [intervals.diffuse, intervals.intensity, intervals.roughness, intervals.index_minus_one];
        for (k, (interval, value)) in all.into_iter().zip(truth.as_array()).enumerate() {
            covered[k] += i32::from(interval.unwrap().contains(value));
        }
    }
    println!("covered of {trials}: {covered:?}");
    let scatter = 4.0 * (0.95_f64 * 0.05 / trials).sqrt();
    for (k, covered) in covered.into_iter().enumerate() {
        let share = f64::from(covered) / trials;
        assert!((share - 0.95).abs() < scatter, "parameter {k}: {share}");
    }
}

/// Bounds that are far from saying anything change nothing.
#[test]
fn a_bound_that_says_nothing_changes_nothing() {
    let grid = paper_grid();
    let set = set(&grid);
    let fitter = Fitter::new(&set, BOTH);
    let (values, sigma) = measure(&paper_sphere(), &grid, 0.01, &mut Random::new(33));
    let mut missing = values.clone();
    missing[..20].fill(f64::NAN);
    let bounds: Vec<Bound> =
        (0..20).map(|geometry| Bound { emission: 0, geometry, side: Side::AtMost, bound: 1e3, sigma: 0.01 }).collect();
    let observed = observe(&fitter, &values, &sigma, &bounds).unwrap();
    let without = fit(&grid, &missing, &sigma);
    for k in 0..4 {
        assert!((found(&observed.fit)[k] / found(&without)[k] - 1.0).abs() < 1e-6, "parameter {k}");
        let ratio = observed.fit.standard_uncertainty(0)[k] / without.standard_uncertainty(0)[k];
        assert!((ratio - 1.0).abs() < 1e-5, "parameter {k}: {ratio}");
    }
    assert_eq!(observed.fit.degrees_of_freedom, without.degrees_of_freedom);
}
