//! Outliers: a robust loss bounds their pull, is started where it finds the right minimum, and claims what it scatters.

use bbrf::fit::{Fitter, Loss, Observations, Observed};
use ndarray::{ArrayView1, Axis};

use crate::fits::{BOTH, paper_sphere, set};
use crate::scans::{Random, Truth, measure, paper_grid, peer_fit, prepare};

fn observe(fitter: &Fitter<'_>, values: &[f64], sigma: Option<&[f64]>, loss: Loss) -> Observed {
    let row = |values| ArrayView1::from(values).insert_axis(Axis(0));
    let data = Observations { values: row(values), sigma: sigma.map(row), bounds: &[], loss };
    fitter.fit_observed(&data, 0.95).unwrap()
}

/// Five of the values three times as large.
fn spoil(values: &mut [f64], random: &mut Random) -> Vec<usize> {
    let mut places: Vec<usize> = Vec::new();
    while places.len() < 5 {
        let place = (random.uniform() * values.len() as f64) as usize;
        if !places.contains(&place) {
            values[place] *= 3.0;
            places.push(place);
        }
    }
    places
}

fn root_mean_square(list: &[f64]) -> f64 {
    (list.iter().map(|x| x * x).sum::<f64>() / list.len() as f64).sqrt()
}

#[test]
fn five_values_three_times_too_large_do_not_move_a_robust_intensity() {
    let grid = paper_grid();
    let set = set(&grid);
    let fitter = Fitter::new(&set, BOTH);
    let mut random = Random::new(21);
    let losses = [Loss::Squares, Loss::Huber, Loss::Tukey];
    let mut errors: [Vec<f64>; 3] = Default::default();
    let mut found = 0;
    for _ in 0..60 {
        let truth = Truth::random(&mut random);
        let (mut values, sigma) = measure(&truth, &grid, 0.01, &mut random);
        let places = spoil(&mut values, &mut random);
        for (errors, loss) in errors.iter_mut().zip(losses) {
            let observed = observe(&fitter, &values, Some(&sigma), loss);
            errors.push(observed.fit.bands[0].intensity / truth.intensity - 1.0);
            if loss == Loss::Tukey {
                let seen = |place: &&usize| observed.outliers.contains(&(0, **place));
                found += places.iter().filter(seen).count();
            }
        }
    }
    let [squares, huber, tukey] = errors.map(|list| root_mean_square(&list));
    println!(
        "intensity r.m.s. error: squares {squares:.3}, huber {huber:.4}, tukey {tukey:.4}; {found} of 300 outliers named"
    );
    assert!(squares > 0.1 && huber < 0.04 && tukey < 0.04, "{squares} {huber} {tukey}");
    assert_eq!(found, 300);
}

/// Scatter of each parameter over trials, and what was claimed (root mean square).
fn scatter_and_claim(loss: Loss, is_spoilt: bool, trials: usize) -> ([f64; 4], [f64; 4]) {
    let grid = paper_grid();
    let set = set(&grid);
    let fitter = Fitter::new(&set, BOTH);
    let truth = Truth { albedo: 0.5, intensity: 20.0, roughness: 0.15, index_minus_one: 0.5 };
    let mut random = Random::new(41);
    let (mut found, mut claims): ([Vec<f64>; 4], [Vec<f64>; 4]) = Default::default();
    for _ in 0..trials {
        let (mut values, sigma) = measure(&truth, &grid, 0.01, &mut random);
        if is_spoilt {
            spoil(&mut values, &mut random);
        }
        let fit = observe(&fitter, &values, Some(&sigma), loss).fit;
        let numbers = [fit.bands[0].diffuse, fit.bands[0].intensity, fit.roughness, fit.index_minus_one];
        for k in 0..4 {
            found[k].push(numbers[k]);
            claims[k].push(fit.standard_uncertainty(0)[k]);
        }
    }
    let scatter = found.map(|list| {
        let mean = list.iter().sum::<f64>() / list.len() as f64;
        (list.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (list.len() - 1) as f64).sqrt()
    });
    (scatter, claims.map(|list| root_mean_square(&list)))
}

/// The price of robustness where there is nothing to be robust against: 5 % in the variance.
#[test]
fn a_robust_fit_of_clean_values_is_nearly_as_good_as_least_squares() {
    let trials = 300;
    let (squares, _) = scatter_and_claim(Loss::Squares, false, trials);
    for loss in [Loss::Huber, Loss::Tukey] {
        let (scatter, claim) = scatter_and_claim(loss, false, trials);
        let efficiency: [f64; 4] = std::array::from_fn(|k| (squares[k] / scatter[k]).powi(2));
        let honest: [f64; 4] = std::array::from_fn(|k| claim[k] / scatter[k]);
        println!("{}: efficiency {efficiency:.3?}, claimed over scatter {honest:.3?}", loss.name());
        for k in 0..4 {
            // The same noise for both: the ratio scatters far less than either.
            assert!(efficiency[k] >= 0.90, "{} parameter {k}: {efficiency:?}", loss.name());
            assert!((honest[k] - 1.0).abs() < 0.15, "{} parameter {k}: {honest:?}", loss.name());
        }
    }
}

#[test]
fn a_robust_fit_of_spoilt_values_claims_what_it_scatters() {
    for loss in [Loss::Huber, Loss::Tukey] {
        let (scatter, claim) = scatter_and_claim(loss, true, 300);
        let honest: [f64; 4] = std::array::from_fn(|k| claim[k] / scatter[k]);
        println!("{}: claimed over scatter {honest:.3?}", loss.name());
        assert!(honest.iter().all(|ratio| (ratio - 1.0).abs() < 0.2), "{} {honest:?}", loss.name());
    }
}

/// The scale of the residuals comes with the values' unit, where no uncertainties are stated.
#[test]
fn a_robust_fit_does_not_depend_on_the_unit() {
    let grid = paper_grid();
    let set = set(&grid);
    let fitter = Fitter::new(&set, BOTH);
    let mut random = Random::new(43);
    let (mut values, _) = measure(&paper_sphere(), &grid, 0.01, &mut random);
    spoil(&mut values, &mut random);
    for loss in [Loss::Huber, Loss::Tukey] {
        let plain = observe(&fitter, &values, None, loss);
        for unit in [1e-20, 1e20] {
            let scaled: Vec<f64> = values.iter().map(|value| unit * value).collect();
            let other = observe(&fitter, &scaled, None, loss);
            assert!((other.fit.roughness / plain.fit.roughness - 1.0).abs() < 1e-6, "{} {unit:e}", loss.name());
            let ratio = other.fit.bands[0].intensity / (unit * plain.fit.bands[0].intensity);
            assert!((ratio - 1.0).abs() < 1e-6, "{} {unit:e}: {ratio}", loss.name());
            assert_eq!(other.outliers, plain.outliers, "{} {unit:e}", loss.name());
        }
    }
}

/// A redescending loss from a start that is 10 % off in intensity and roughness, at 0.3 % noise: most of the lobe lies beyond
/// 4.685 standard deviations and has no weight, and in 11 of 60 scans the search ends more than 5 % off, with the lobe for an
/// outlier. From Huber's fit, which has one minimum, it never does.
#[test]
fn a_redescending_loss_is_started_where_it_finds_the_right_minimum() {
    let grid = paper_grid();
    let set = set(&grid);
    let fitter = Fitter::new(&set, BOTH);
    let prepared = prepare(&grid);
    let mut random = Random::new(44);
    let (mut wrong, mut wrong_from_huber, trials) = (0, 0, 60);
    for _ in 0..trials {
        let truth = Truth { albedo: 0.5, intensity: 20.0, roughness: 0.15, index_minus_one: 0.5 };
        let (mut values, sigma) = measure(&truth, &grid, 0.003, &mut random);
        spoil(&mut values, &mut random);
        let tukey = observe(&fitter, &values, Some(&sigma), Loss::Tukey);
        wrong_from_huber += i32::from((tukey.fit.bands[0].intensity / truth.intensity - 1.0).abs() > 0.05);
        let mut at = Truth { intensity: 22.0, roughness: 0.165, ..truth };
        for _ in 0..100 {
            let weight = |k: usize| {
                let u = (values[k] - at.evaluate(&grid[k]).0) / sigma[k];
                (1.0 - (u / 4.685).powi(2)).max(0.0).powi(2)
            };
            let weighted: Vec<f64> = (0..grid.len()).map(|k| sigma[k] / weight(k).max(1e-12).sqrt()).collect();
            at = peer_fit(&prepared, &values, &weighted, &at).1;
        }
        wrong += i32::from((at.intensity / truth.intensity - 1.0).abs() > 0.05);
    }
    println!(
        "intensity beyond 5 % of the truth: {wrong} of {trials} from a start 10 % off, {wrong_from_huber} from Huber's fit"
    );
    assert_eq!(wrong_from_huber, 0);
    assert!(wrong >= 5, "the naive way failed in {wrong} only");
}
