//! The terms against 60-digit arithmetic (`testdata/reference/terms.py` makes the table), and at the edges where the
//! naive formulas give NaN.
#![allow(clippy::unwrap_used)]

use bbrf::quantity::{Geometry, Reference, SignHabit};
use bbrf::terms::{Denominator, Distribution, Term, TorranceSparrow, Undefined, gaussian_integral};

/// Relative error allowed, times 1 + |ln D|: D multiplies the relative error of its argument by that.
const VALUE_TOLERANCE: f64 = 2e-14;
/// Derivatives cross zero, so their error is measured against the sum of the absolute values of their terms.
const DERIVATIVE_TOLERANCE: f64 = 1e-12;
/// Below this D is subnormal or zero and is compared absolutely.
const SMALLEST_NORMAL: f64 = 2.3e-308;

struct Row {
    geometry: Geometry,
    term: TorranceSparrow,
    phi: f64,
    d: f64,
    g: f64,
    f: f64,
    value: f64,
    by_roughness: (f64, f64),
    by_index: (f64, f64),
    text: String,
}

fn rows() -> Vec<Row> {
    let text = include_str!("../testdata/reference/terms.csv");
    text.lines().skip(2).map(parse).collect()
}

fn parse(line: &str) -> Row {
    let fields: Vec<&str> = line.split(',').collect();
    let number = |i: usize| fields[i].parse::<f64>().unwrap();
    Row {
        geometry: Geometry::from_degrees(number(0), number(1), number(2), number(3)).unwrap(),
        term: TorranceSparrow {
            intensity: 1.0,
            distribution: fields[4].parse().unwrap(),
            denominator: fields[5].parse().unwrap(),
            roughness: number(6),
            refractive_index: number(7),
        },
        phi: number(8),
        d: number(9),
        g: number(10),
        f: number(11),
        value: number(12),
        by_roughness: (number(13), number(14)),
        by_index: (number(15), number(16)),
        text: line.to_owned(),
    }
}

fn assert_close(name: &str, found: f64, expected: f64, scale: f64, tolerance: f64, row: &Row) {
    let error = (found - expected).abs();
    let allowed = tolerance * scale.abs();
    assert!(
        error <= allowed.max(SMALLEST_NORMAL),
        "{name}: {found:e}, expected {expected:e}, off by {:e} of the scale\n{}",
        error / scale.abs(),
        row.text
    );
}

#[test]
fn factors_and_term_keep_their_digits() {
    for row in rows() {
        let factors = row.term.factors(&row.geometry).unwrap();
        let allowed = VALUE_TOLERANCE * (1.0 + row.d.max(f64::MIN_POSITIVE).ln().abs());
        assert_close("phi", factors.phi_rad, row.phi, row.phi, 2e-15, &row);
        assert_close("D", factors.d, row.d, row.d, allowed, &row);
        assert_close("G", factors.g, row.g, row.g, VALUE_TOLERANCE, &row);
        assert_close("F", factors.f, row.f, row.f, VALUE_TOLERANCE, &row);
        let term = Term::TorranceSparrow(row.term).evaluate(&row.geometry, &Reference::None).unwrap();
        assert_close("term", term.value, row.value, row.value, allowed, &row);
    }
}

#[test]
fn derivatives_are_exact() {
    for row in rows() {
        let term = Term::TorranceSparrow(row.term).evaluate(&row.geometry, &Reference::None).unwrap();
        let allowed = DERIVATIVE_TOLERANCE * (1.0 + 0.02 * row.d.max(f64::MIN_POSITIVE).ln().abs());
        assert_eq!(term.by[0], term.value, "c_s is 1");
        assert_close("by roughness", term.by[1], row.by_roughness.0, row.by_roughness.1, allowed, &row);
        assert_close("by index", term.by[2], row.by_index.0, row.by_index.1, allowed, &row);
    }
}

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
fn below_the_horizon_every_term_is_exactly_zero() {
    let below = [Geometry::from_degrees(100.0, 180.0, 20.0, 0.0), Geometry::from_degrees(20.0, 180.0, 90.0001, 0.0)];
    for geometry in below.map(Result::unwrap) {
        for &distribution in Distribution::ALL {
            for &denominator in Denominator::ALL {
                let value = shiny(distribution, denominator).evaluate(&geometry, &Reference::None).unwrap();
                assert_eq!((value.value, value.by), (0.0, [0.0; 3]));
            }
        }
        let diffuse = Term::Lambertian { albedo: 0.8 }.evaluate(&geometry, &Reference::SameGeometry).unwrap();
        assert_eq!(diffuse.value, 0.0);
    }
}

/// The naive 1/cos(theta_i) is 0/0 at 90 degrees; the limit of G/cos(theta_i) is 2 (N.Q)/(V.Q).
#[test]
fn at_grazing_incidence_the_one_sided_limit_is_returned() {
    for &distribution in Distribution::ALL {
        for &denominator in Denominator::ALL {
            let at = |theta_i: f64| {
                let geometry = Geometry::from_degrees(theta_i, 180.0, 85.0, 0.0).unwrap();
                shiny(distribution, denominator).evaluate(&geometry, &Reference::None).unwrap().value
            };
            let (limit, near) = (at(90.0), at(90.0 - 1e-12));
            assert!((limit - near).abs() <= 1e-6 * near.abs() + 1e-6, "{distribution} {denominator}: {limit} {near}");
        }
    }
}

#[test]
fn what_has_no_limit_says_so_and_is_never_nan() {
    let opposite = Geometry::from_degrees(90.0, 180.0, 90.0, 0.0).unwrap();
    let term = shiny(Distribution::Gaussian, Denominator::CosThetaI);
    assert_eq!(term.evaluate(&opposite, &Reference::None), Err(Undefined::NoHalfVector));
    let aside = Geometry::from_degrees(90.0, 180.0, 90.0, 90.0).unwrap();
    let both = shiny(Distribution::TrowbridgeReitz, Denominator::CosICosV);
    assert_eq!(both.evaluate(&aside, &Reference::None), Err(Undefined::PathDependent));
    let grazing = Geometry::from_degrees(90.0, 180.0, 85.0, 0.0).unwrap();
    assert_eq!(term.evaluate(&grazing, &Reference::SameGeometry), Err(Undefined::Unbounded));
}

/// exp underflows, its derivative is 0 * inf in the naive form.
#[test]
fn a_vanishing_roughness_gives_zero_and_not_nan() {
    let geometry = Geometry::from_signed(40.0, 30.0, SignHabit::MirrorAtEqual).unwrap();
    for &distribution in Distribution::ALL {
        for roughness in [1e-3, 1e-8, 1e-160, 1e-300] {
            let term = Term::TorranceSparrow(TorranceSparrow {
                intensity: 30.0,
                roughness,
                refractive_index: 1.45,
                distribution,
                denominator: Denominator::CosThetaI,
            });
            let value = term.evaluate(&geometry, &Reference::None).unwrap();
            assert!(
                value.value >= 0.0 && value.by.iter().all(|by| !by.is_nan()),
                "{distribution} {roughness:e} {value:?}"
            );
        }
    }
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

/// `testdata/reference/gaussian_integral.py` makes the table, by adaptive quadrature with 60 digits.
#[test]
fn the_norm_of_the_gaussian_keeps_its_digits() {
    let text = include_str!("../testdata/reference/gaussian_integral.csv");
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
