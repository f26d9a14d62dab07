//! Hard cases of the terms' values. Their digits everywhere are `tests/terms_60_digits.rs`'s.

use bbrf::quantity::{Geometry, Reference, SignHabit};
use bbrf::terms::{Denominator, Distribution, Evaluation, Term, TorranceSparrow, Undefined};

fn specular(distribution: Distribution, denominator: Denominator, roughness: f64, refractive_index: f64) -> Term {
    Term::TorranceSparrow(TorranceSparrow { intensity: 30.0, roughness, refractive_index, distribution, denominator })
}

fn shiny(distribution: Distribution, denominator: Denominator) -> Term {
    specular(distribution, denominator, 0.05, 1.45)
}

fn in_plane(theta_i: f64, theta_v: f64) -> Geometry {
    Geometry::from_signed(theta_i, theta_v, SignHabit::MirrorAtEqual).unwrap()
}

fn is_finite(found: &Evaluation) -> bool {
    found.value.is_finite() && found.by.iter().all(|by| by.is_finite())
}

/// `acos(N.Q)` is off by 100 % at 1e-8 rad, and NaN for the fifth of unit vectors whose product rounds to above 1.
#[test]
fn the_half_vector_angle_keeps_its_digits_down_to_the_mirror_direction() {
    for theta in [0.5, 30.0, 80.0, 89.9] {
        for exponent in 1..=12 {
            let viewing = theta + 10_f64.powi(-exponent);
            if viewing > 90.0 {
                continue;
            }
            // In the plane phi is half the difference of the angles, and that difference of doubles is exact.
            let expected = ((viewing - theta) / 2.0).to_radians();
            let found = in_plane(theta, viewing).half_angles().phi;
            assert!((found / expected - 1.0).abs() < 2e-15, "{theta} {viewing}: {found:e}, expected {expected:e}");
        }
    }
}

/// Q = (L + V)/|L + V| is 0/0 where source and detector face each other along the surface.
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

/// 1/cos(theta_i) is 0/0 at 90 degrees; the limit of G/cos(theta_i) is 2 (N.Q)/(V.Q).
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

/// G and its denominator vanish together where viewing grazes; G alone makes the term exactly 0.
#[test]
fn at_grazing_viewing_the_term_is_zero_or_its_limit() {
    let at = |denominator, theta_v: f64| {
        let term = specular(Distribution::Beckmann, denominator, 0.6, 1.5);
        term.evaluate(&in_plane(80.0, theta_v), &Reference::None).unwrap().value
    };
    assert_eq!(at(Denominator::CosThetaI, 90.0), 0.0);
    for denominator in [Denominator::CosThetaV, Denominator::CosICosV] {
        let (limit, near) = (at(denominator, 90.0), at(denominator, 90.0 - 1e-12));
        assert!(limit > 0.0 && (limit / near - 1.0).abs() < 1e-10, "{denominator}: {limit} {near}");
    }
}

/// Negative cosines make negative radiance, and two of them a highlight from behind.
#[test]
fn below_the_horizon_every_term_is_exactly_zero() {
    let below = [Geometry::from_degrees(100.0, 180.0, 20.0, 0.0), Geometry::from_degrees(20.0, 180.0, 90.0001, 0.0)];
    let both = Geometry::from_degrees(120.0, 180.0, 120.0, 0.0);
    for geometry in below.into_iter().chain([both]).map(Result::unwrap) {
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

/// exp underflows, and its derivative is 0 times infinity.
#[test]
fn a_vanishing_roughness_gives_zero_and_not_nan() {
    for &distribution in Distribution::ALL {
        for roughness in [1e-3, 1e-8, 1e-160, 1e-300] {
            let term = specular(distribution, Denominator::CosThetaI, roughness, 1.45);
            let found = term.evaluate(&in_plane(40.0, 30.0), &Reference::None).unwrap();
            let is_right = found.value >= 0.0 && is_finite(&found);
            assert!(is_right && (roughness > 1e-4 || found.value < 1e-10), "{distribution} {roughness:e} {found:?}");
        }
    }
}

/// phi^2/r^2 is 0/0 in the mirror direction once r^2 underflows.
#[test]
fn in_the_mirror_direction_a_gaussian_of_any_width_is_one() {
    for distribution in [Distribution::GaussianHalfHeight, Distribution::Gaussian, Distribution::TorranceSparrow1967] {
        for roughness in [1e-300, 1e-160, 1e-3, 1.0, 1e300] {
            let found = distribution.evaluate(&in_plane(50.0, 50.0).half_angles(), roughness);
            assert_eq!((found.value, found.by_log_roughness), (1.0, 0.0), "{distribution} {roughness:e}");
        }
    }
}

/// A lobe without width: D is constant over the hemisphere, and its derivative goes to 0 and not to NaN.
#[test]
fn a_huge_roughness_makes_the_distribution_flat() {
    for &distribution in Distribution::ALL {
        let at = |theta_v| distribution.evaluate(&in_plane(0.0, theta_v).half_angles(), 1e12);
        let (first, second) = (at(1.0), at(60.0));
        match distribution {
            // Beckmann's has the slopes' 1/cos^4 left, and Trowbridge and Reitz's too.
            Distribution::Beckmann | Distribution::TrowbridgeReitz => {
                let cosines = (0.5_f64.to_radians().cos() / 30_f64.to_radians().cos()).powi(4);
                assert!((second.value / first.value / cosines - 1.0).abs() < 1e-14, "{distribution}");
            }
            // N tends to the integral of cos(phi) over the hemisphere, which is pi.
            Distribution::GaussianNormalised => {
                let over_pi = std::f64::consts::PI * second.value;
                assert!((over_pi - 1.0).abs() < 1e-14 && second.by_log_roughness.abs() < 1e-15, "{distribution}");
            }
            _ => assert!((second.value - 1.0).abs() < 1e-15 && second.by_log_roughness < 1e-15, "{distribution}"),
        }
    }
}

/// As the textbook writes it F is off by 2e-7 at n - 1 = 1e-10, and Snell's form is NaN at normal incidence, always.
#[test]
fn an_index_next_to_one_keeps_the_digits_of_its_reflectance() {
    for exponent in 0..=15 {
        let index = 1.0 + 2_f64.powi(-3 * exponent);
        let m = index - 1.0;
        let term = TorranceSparrow {
            intensity: 1.0,
            roughness: 0.1,
            refractive_index: index,
            distribution: Distribution::Gaussian,
            denominator: Denominator::CosThetaI,
        };
        // At normal incidence F is ((n - 1)/(n + 1))^2, and n - 1 is exact.
        let expected = (m / (2.0 + m)).powi(2);
        let found = term.factors(&in_plane(0.0, 0.0)).unwrap().f;
        assert!((found / expected - 1.0).abs() < 2e-15, "n - 1 = {m:e}: {found:e}, expected {expected:e}");
        // F goes with (n - 1)^2: a start at n = 1 would never move, and d ln F / d ln(n - 1) is 2 all the way down.
        let by_index = Term::TorranceSparrow(term).evaluate(&in_plane(0.0, 0.0), &Reference::None).unwrap().by[2];
        assert!((by_index * m / found - 4.0 / (2.0 + m)).abs() < 1e-14, "n - 1 = {m:e}");
    }
}

/// g^2 < 0 below the critical angle: NaN.
#[test]
fn an_index_of_one_or_less_is_refused_and_never_nan() {
    for index in [1.0, 0.999, 0.7, 0.0, -1.5, f64::NAN] {
        let term = shiny(Distribution::Gaussian, Denominator::CosThetaI);
        let Term::TorranceSparrow(mut specular) = term else { panic!("{term:?}") };
        specular.refractive_index = index;
        let error = Term::TorranceSparrow(specular).check().unwrap_err().to_string();
        assert!(error.contains("refractive_index") && error.contains("above 1"), "{error}");
        for geometry in [in_plane(5.0, 5.0), in_plane(80.0, 80.0)] {
            if let Ok(found) = Term::TorranceSparrow(specular).evaluate(&geometry, &Reference::None) {
                assert!(is_finite(&found), "{index}: {found:?}");
            }
        }
    }
}

/// The branches of min(1, .., ..) meet at theta_i = theta_v, where a one-sided derivative would jump.
#[test]
fn the_masking_is_continuous_over_its_kinks() {
    let term = |theta_i: f64, theta_v: f64| {
        let term = shiny(Distribution::Beckmann, Denominator::CosThetaV);
        term.evaluate(&in_plane(theta_i, theta_v), &Reference::None).unwrap()
    };
    for theta in [10.0, 45.0, 60.0, 75.0, 89.0] {
        let (below, at, above) = (term(theta, theta - 1e-9), term(theta, theta), term(theta, theta + 1e-9));
        for other in [below, above] {
            assert!((other.value / at.value - 1.0).abs() < 1e-6, "{theta}: {other:?} {at:?}");
        }
    }
}

/// 359.9 and 0.1 degrees are neighbours; half their difference of 359.8 taken in radians loses the plane of incidence.
#[test]
fn the_azimuth_has_no_seam() {
    let term = shiny(Distribution::GaussianHalfHeight, Denominator::CosThetaI);
    for turn in [0.0, 1.0, 90.0, 179.5, 180.0, 270.0, 359.5] {
        let turned = |azimuth: f64| (azimuth + turn) % 360.0;
        let here = Geometry::from_degrees(40.0, turned(180.0), 42.0, turned(0.25)).unwrap();
        let there = Geometry::from_degrees(40.0, turned(180.0), 42.0, turned(359.75)).unwrap();
        let [first, second] = [here, there].map(|g| term.evaluate(&g, &Reference::None).unwrap().value);
        let unturned = Geometry::from_degrees(40.0, 180.0, 42.0, 0.25).unwrap();
        let expected = term.evaluate(&unturned, &Reference::None).unwrap().value;
        for found in [first, second] {
            assert!((found / expected - 1.0).abs() < 1e-14, "{turn}: {found} {expected}");
        }
    }
}
