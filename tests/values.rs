//! The terms under each reference, and as the command line reads them. Their digits are `terms_60_digits.rs`'s, their edges
//! `hard_cases/terms.rs`'s.
#![allow(clippy::unwrap_used)]

use bbrf::quantity::{Geometry, Reference, SignHabit};
use bbrf::terms::{Denominator, Distribution, Term, TorranceSparrow, Undefined, gaussian_integral};

fn shiny(distribution: Distribution, denominator: Denominator) -> Term {
    Term::TorranceSparrow(TorranceSparrow {
        intensity: 30.0,
        roughness: 0.05,
        refractive_index: 1.45,
        distribution,
        denominator,
    })
}

#[test]
fn a_lambertian_factor_is_a_constant_in_the_same_geometry_and_a_cosine_against_a_fixed_one() {
    let fixed = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };
    for theta in [0.0, 30.0, 60.0, 80.0, 90.0] {
        let geometry = Geometry::from_signed(theta, 10.0, SignHabit::MirrorAtEqual).unwrap();
        let term = Term::Lambertian { albedo: 0.8 };
        assert_eq!(term.evaluate(&geometry, &Reference::SameGeometry).unwrap().value, 0.8);
        assert_eq!(term.evaluate(&geometry, &fixed).unwrap().value, 0.8 * geometry.incidence.cos_theta());
        assert!(matches!(term.evaluate(&geometry, &Reference::Unstated), Err(Undefined::Reference(_))));
    }
}

#[test]
fn a_term_reads_from_the_json_of_the_command_line() {
    let term: Term = serde_json::from_str(r#"{"kind":"torrance-sparrow","intensity":30,"roughness":0.05,"refractive_index":1.45,"distribution":"gaussian-half-height","denominator":"cos-theta-i"}"#).unwrap();
    assert_eq!(term, shiny(Distribution::GaussianHalfHeight, Denominator::CosThetaI));
    assert!(serde_json::from_str::<Term>(r#"{"kind":"lambertian","albedo":0.8,"colour":1}"#).is_err());
    assert!(Term::Lambertian { albedo: f64::NAN }.check().is_err());
    let index_one = TorranceSparrow {
        intensity: 1.0,
        roughness: 0.1,
        refractive_index: 1.0,
        distribution: Distribution::Gaussian,
        denominator: Denominator::CosThetaI,
    };
    assert!(Term::TorranceSparrow(index_one).check().unwrap_err().to_string().contains("refractive_index"));
}

/// `testdata/terms_60_digits/gaussian_integral.py` makes the table, with 60 digits, in two ways.
#[test]
fn the_norm_of_the_gaussian_keeps_its_digits() {
    let text = include_str!("../testdata/terms_60_digits/gaussian_integral.csv");
    let mut worst = [0.0_f64; 2];
    for line in text.lines().skip(2) {
        let fields: Vec<f64> = line.split(',').map(|field| field.parse().unwrap()).collect();
        let found = gaussian_integral(fields[0]);
        // Below the smallest normal number the quotient alone has digits.
        let pairs = [(found.over_square * fields[0] * fields[0], fields[1]), (found.by_log_width, fields[2])];
        for (k, (found, expected)) in pairs.into_iter().enumerate() {
            worst[k] = worst[k].max((found / expected - 1.0).abs());
        }
        assert!(worst[0] < 2e-15 && worst[1] < 2e-14, "{line}: {found:?}");
    }
    println!("largest relative error of N: {:.1e}, of d(ln N)/d(ln w): {:.1e}", worst[0], worst[1]);
    let tiny = gaussian_integral(1e-170);
    assert_eq!((tiny.value, tiny.over_square), (0.0, std::f64::consts::PI));
}

/// D cos(phi) over the hemisphere, in polar coordinates about the normal.
#[test]
fn every_form_with_a_norm_integrates_to_one() {
    for distribution in [Distribution::GaussianNormalised, Distribution::Beckmann, Distribution::TrowbridgeReitz] {
        for roughness in [0.03, 0.2, 0.9] {
            let steps = 400_000;
            let width = 90.0 / f64::from(steps);
            let sum: f64 = (0..steps)
                .map(|step| {
                    // L = V at the polar angle is the half vector.
                    let theta = (f64::from(step) + 0.5) * width;
                    let half = Geometry::from_degrees(theta, 0.0, theta, 0.0).unwrap().half_angles();
                    distribution.evaluate(&half, roughness).value * half.cos_phi * half.sin_phi
                })
                .sum();
            let integral = sum * std::f64::consts::TAU * width.to_radians();
            assert!((integral - 1.0).abs() < 1e-6, "{distribution} {roughness}: {integral}");
        }
    }
}
