//! What a design predicts is what fits then have; what it says is undetermined is; what it chooses helps most.
#![allow(unreachable_pub, clippy::unwrap_used, clippy::panic)]

mod common {
    pub mod scans;
}
mod spectra;

use bbrf::fit::design::{CandidateGrid, Goal, Guess, Noise, Predicted, Sensitivities, choose, in_plane_grid, predict};
use bbrf::fit::{Fitter, GeometrySet, Terms};
use bbrf::import::{Options, import, scan_manifest};
use bbrf::quantity::{Geometry, Reference, SignHabit};
use bbrf::terms::{Denominator, Distribution};
use common::scans::{Random, Truth, measure, paper_grid};
use spectra::{Folder, good};

const SEED: Truth = Truth { albedo: 0.8, intensity: 30.0, roughness: 0.05, index_minus_one: 0.45 };
const PERCENT: Noise = Noise { relative: 0.01, floor: 0.0 };

fn guess(truth: &Truth) -> Guess {
    Guess::new(truth.terms().to_vec(), Reference::None).unwrap()
}

fn predicted(truth: &Truth, geometry: &[Geometry], noise: &Noise) -> Predicted {
    let guess = guess(truth);
    predict(&guess, geometry, &Sensitivities::new(&guess, noise, geometry))
}

fn grid(text: &str) -> CandidateGrid {
    text.parse().unwrap()
}

#[test]
fn the_papers_grid_is_the_grid_in_steps_of_ten_without_the_retro_directions() {
    assert_eq!(in_plane_grid(&grid("step=10,max=80"), 10.0), paper_grid());
    assert_eq!(in_plane_grid(&grid("step=10,max=80"), 0.0).len(), 289);
    assert!(in_plane_grid(&grid("step=5,max=85"), 10.0).iter().all(|geometry| !geometry.is_retro(9.9)));
    for wrong in
        ["step=0,max=80", "step=10", "step=-1,max=80", "max=80,step=1e-9", "step=10,max=91", "step=nan,max=80", ""]
    {
        assert!(wrong.parse::<CandidateGrid>().is_err(), "{wrong}");
    }
}

/// Few hundred simulated scans, fitted without a start.
#[test]
fn the_predicted_uncertainty_is_the_scatter_of_fits_and_their_own_covariance() {
    let grid = paper_grid();
    let set =
        GeometrySet::new(&grid, &Reference::None, Distribution::GaussianHalfHeight, Denominator::CosThetaI).unwrap();
    let fitter = Fitter::new(&set, Terms { diffuse: true, specular: true });
    let predicted = predicted(&SEED, &grid, &PERCENT);
    let mut random = Random::new(271_828);
    let trials = 400;
    let (mut square, mut claimed) = ([0.0; 4], [0.0; 4]);
    for _ in 0..trials {
        let (values, sigma) = measure(&SEED, &grid, 0.01, &mut random);
        let fit = fitter.fit(&values, Some(&sigma)).unwrap();
        let found = [fit.bands[0].diffuse, fit.bands[0].intensity, fit.roughness, fit.index_minus_one];
        for k in 0..4 {
            square[k] += (found[k] - SEED.as_array()[k]).powi(2);
            claimed[k] += fit.standard_uncertainty(0)[k];
        }
    }
    for k in 0..4 {
        let sigma = predicted.standard_uncertainty[k];
        let scatter = (square[k] / f64::from(trials)).sqrt() / sigma;
        let claimed = claimed[k] / f64::from(trials) / sigma;
        println!(
            "parameter {k}: predicted {sigma:.4e}, scatter / predicted {scatter:.3}, claimed / predicted {claimed:.4}"
        );
        // A standard deviation of 400 trials has a relative standard error of 3.5 %.
        assert!((scatter - 1.0).abs() < 0.12, "{k}: {scatter}");
        assert!((claimed - 1.0).abs() < 0.02, "{k}: {claimed}");
    }
    // At the truth itself the two are one number, correlations included.
    let values: Vec<f64> = grid.iter().map(|geometry| SEED.evaluate(geometry).0).collect();
    let sigma: Vec<f64> = values.iter().map(|value| 0.01 * value).collect();
    let fit = fitter.fit(&values, Some(&sigma)).unwrap();
    for i in 0..4 {
        for j in 0..4 {
            let (found, expected) = (predicted.covariance[(i, j)], fit.bands[0].covariance[i][j]);
            let scale = predicted.standard_uncertainty[i] * predicted.standard_uncertainty[j];
            assert!((found - expected).abs() < 1e-5 * scale, "{i} {j}: {found:e} {expected:e}");
        }
    }
}

#[test]
fn a_floor_and_a_relative_noise_add_in_squares() {
    let grid = paper_grid();
    let sigma =
        |relative, floor| predicted(&SEED, &grid, &Noise::new(relative, floor).unwrap()).standard_uncertainty[0];
    assert!((sigma(0.02, 0.0) / sigma(0.01, 0.0) - 2.0).abs() < 1e-9);
    assert!(sigma(0.01, 0.01) > sigma(0.01, 0.0));
    assert!(Noise::new(0.0, 0.0).is_err() && Noise::new(-0.1, 1.0).is_err() && Noise::new(f64::NAN, 1.0).is_err());
}

#[test]
fn what_a_scan_cannot_tell_is_said_in_words() {
    // Co-located light and detector: every geometry has the same angle at the facet.
    let colocated: Vec<Geometry> = (-8..=8)
        .map(|k| Geometry::from_signed(f64::from(k) * 5.0, f64::from(k) * 5.0, SignHabit::RetroAtEqual).unwrap())
        .collect();
    let wide = Truth { roughness: 0.3, ..SEED };
    let found = predicted(&wide, &colocated, &PERCENT);
    let text = found.undetermined.join("\n");
    assert!(text.contains("torrance-sparrow.intensity and torrance-sparrow.refractive_index: only together"), "{text}");
    assert!(found.standard_uncertainty[1].is_nan() && found.standard_uncertainty[3].is_nan(), "{found:?}");
    assert!(found.standard_uncertainty[0].is_finite() && found.standard_uncertainty[2].is_finite(), "{found:?}");
    // d(ln F0)/d(ln(n-1)) = 4/(n+1): one percent more of n - 1 takes 4/2.45 % of the intensity.
    let ratio = -(2.45 / 4.0);
    assert!(text.contains(&format!("- 1 by {ratio:+.3} %")), "{text}");
    // A lobe below the angles of the grid: its column is exactly 0.
    let narrow = predicted(&Truth { roughness: 0.001, ..SEED }, &paper_grid(), &PERCENT);
    assert!(narrow.standard_uncertainty[2].is_nan() && narrow.standard_uncertainty[1].is_finite(), "{narrow:?}");
    let text = narrow.undetermined.join("\n");
    assert!(
        text.contains("torrance-sparrow.roughness: not determined") && text.contains("beside 0 is 5.000"),
        "{text}"
    );
    // One that is there in numbers alone.
    let faint = predicted(&Truth { roughness: 0.01, ..SEED }, &paper_grid(), &PERCENT).undetermined.join("\n");
    assert!(faint.contains("above its own size"), "{faint}");
    assert!(predicted(&SEED, &paper_grid(), &PERCENT).undetermined.is_empty());
}

#[test]
fn nothing_planned_is_no_obstacle_and_four_geometries_tell_four_parameters() {
    let guess = guess(&SEED);
    let none = Sensitivities::new(&guess, &PERCENT, &[]);
    let before = predict(&guess, &[], &none);
    assert!(before.standard_uncertainty.iter().all(|sigma| sigma.is_nan()));
    let candidates = grid("step=5,max=80").geometries(10.0);
    let offered = Sensitivities::new(&guess, &PERCENT, &candidates);
    let added = choose(&guess, (&[], &none), (&candidates, &offered), &Goal::All, 4).unwrap();
    assert_eq!(added.len(), 4);
    assert!(added[2].standard_uncertainty.iter().any(|sigma| sigma.is_nan()), "three cannot tell four");
    assert!(added[3].standard_uncertainty.iter().all(|sigma| sigma.is_finite()), "{added:?}");
}

/// ln det of the information, or the variance of a parameter, of a choice.
fn merit(guess: &Guess, geometry: &[Geometry], parameter: Option<usize>) -> f64 {
    let found = predict(guess, geometry, &Sensitivities::new(guess, &PERCENT, geometry));
    match parameter {
        Some(k) => -found.standard_uncertainty[k],
        None => -found.covariance.determinant(),
    }
}

#[test]
fn the_choice_is_the_best_of_all_pairs_and_beats_random_ones() {
    let guess = guess(&SEED);
    let planned: Vec<Geometry> = in_plane_grid(&grid("step=20,max=60"), 10.0);
    let known = Sensitivities::new(&guess, &PERCENT, &planned);
    let candidates = grid("step=10,max=80").geometries(10.0);
    let offered = Sensitivities::new(&guess, &PERCENT, &candidates);
    for (goal, parameter) in [
        ("d", None),
        ("albedo", Some(0)),
        ("intensity", Some(1)),
        ("roughness", Some(2)),
        ("refractive-index", Some(3)),
    ] {
        let goal: Goal = goal.parse().unwrap();
        let added = choose(&guess, (&planned, &known), (&candidates, &offered), &goal, 2).unwrap();
        let with = |pair: [usize; 2]| {
            let all: Vec<Geometry> = planned.iter().copied().chain(pair.map(|index| candidates[index])).collect();
            merit(&guess, &all, parameter)
        };
        let chosen = with([added[0].candidate, added[1].candidate]);
        let is_new = |index: usize| !planned.contains(&candidates[index]);
        for a in (0..candidates.len()).filter(|index| is_new(*index)) {
            for b in (a + 1..candidates.len()).filter(|index| is_new(*index)) {
                let other = with([a, b]);
                assert!(chosen >= other - 1e-9 * other.abs(), "{goal:?}: {a} {b} are better: {other} {chosen}");
            }
        }
        assert!(is_new(added[0].candidate) && is_new(added[1].candidate) && added[0].candidate != added[1].candidate);
    }
    let error = choose(&guess, (&planned, &known), (&candidates, &offered), &"colour".parse().unwrap(), 2).unwrap_err();
    assert!(error.to_string().contains("albedo, intensity, roughness, refractive-index"), "{error}");
}

#[test]
fn the_source_blocks_what_is_never_proposed() {
    let guess = guess(&Truth { roughness: 0.3, ..SEED });
    let planned = paper_grid();
    let known = Sensitivities::new(&guess, &PERCENT, &planned);
    let candidates = grid("step=2,max=84,azimuths=7").geometries(15.0);
    let offered = Sensitivities::new(&guess, &PERCENT, &candidates);
    let added = choose(&guess, (&planned, &known), (&candidates, &offered), &Goal::All, 20).unwrap();
    assert_eq!(added.len(), 20);
    assert!(added.iter().all(|one| !candidates[one.candidate].is_retro(14.9)));
    let first = predict(&guess, &planned, &known).standard_uncertainty;
    let last = &added[19].standard_uncertainty;
    assert!(first.iter().zip(last).all(|(before, after)| after <= before), "{first:?} {last:?}");
}

/// The lab fills the manifest in; import then has what was planned.
#[test]
fn a_manifest_is_what_import_takes() {
    let plane: Vec<Geometry> = in_plane_grid(&grid("step=20,max=60"), 10.0);
    let mut repeated = plane.clone();
    repeated.extend([plane[3], plane[3]]);
    let space = grid("step=25.5,max=80,azimuths=3").geometries(10.0);
    let fixed = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };
    for (geometry, reference, expected) in [
        (&plane, Reference::SameGeometry, plane.len()),
        (&repeated, fixed, plane.len()),
        (&space, Reference::SameGeometry, space.len()),
    ] {
        let folder = Folder::new();
        let text = scan_manifest(geometry, &reference);
        let names: Vec<&str> =
            text.lines().filter(|line| line.starts_with("raw/")).map(|line| line.split(',').next().unwrap()).collect();
        for (number, name) in (0..).zip(&names) {
            let white = if name.contains("white") { 2.0 } else { 1.0 };
            folder.write(name, good(white * (1.0 + f64::from(number) * 1e-3)));
        }
        let manifest = folder.write("scan.csv", &text);
        let document = import(&[manifest], &Options::default()).unwrap_or_else(|error| panic!("{error}\n{text}"));
        let scan = document.measurement("scan").unwrap();
        assert_eq!(scan.quantity.reference, reference);
        let found: Vec<Geometry> = scan.acquisitions.iter().map(|row| row.geometry.unwrap()).collect();
        assert_eq!(found.len(), expected);
        assert!(found.iter().all(|one| geometry.contains(one)), "{text}");
    }
    let none = scan_manifest(&plane, &Reference::None);
    assert!(!none.contains("white"), "{none}");
}
