//! Laws that hold for every geometry and parameter. `BBRF_PROPTEST_CASES` asks for more cases; the seed is fixed.
#![allow(clippy::unwrap_used)]

use bbrf::dataset::predict;
use bbrf::fit::{Fitter, GeometrySet, Terms};
use bbrf::quantity::{Geometry, Reference};
use bbrf::terms::{Denominator, Distribution, Term, TorranceSparrow};
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

fn runner() -> TestRunner {
    let cases = std::env::var("BBRF_PROPTEST_CASES").ok().and_then(|text| text.parse().ok()).unwrap_or(512);
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]))
}

fn geometry() -> impl Strategy<Value = Geometry> {
    (0.0..=90.0, 0.0..360.0, 0.0..=90.0, 0.0..360.0)
        .prop_map(|(ti, pi, tv, pv)| Geometry::from_degrees(ti, pi, tv, pv).unwrap())
}

fn specular() -> impl Strategy<Value = TorranceSparrow> {
    let distribution = prop::sample::select(Distribution::ALL);
    let denominator = prop::sample::select(Denominator::ALL);
    (0.01..100.0, -3.0..0.3, 1.001..4.0, distribution, denominator).prop_map(
        |(intensity, log_width, refractive_index, distribution, denominator)| TorranceSparrow {
            intensity,
            roughness: distribution.roughness_from_half_width(10_f64.powf(log_width)),
            refractive_index,
            distribution,
            denominator,
        },
    )
}

#[test]
fn no_term_is_negative_or_nan_anywhere() {
    let check = |(geometry, term): (Geometry, TorranceSparrow)| {
        if let Ok(value) = Term::TorranceSparrow(term).evaluate(&geometry, &Reference::None) {
            prop_assert!(value.value >= 0.0 && value.value.is_finite(), "{value:?}");
            prop_assert!(value.by.iter().all(|by| by.is_finite()), "{value:?}");
        }
        let factors = term.factors(&geometry).unwrap();
        prop_assert!((0.0..=1.0).contains(&factors.g) && (0.0..=1.0).contains(&factors.f));
        Ok(())
    };
    runner().run(&(geometry(), specular()), check).unwrap();
}

/// Any finite number, of every order of magnitude, sensible or not.
fn any_number() -> impl Strategy<Value = f64> {
    use proptest::num::f64::{NEGATIVE, NORMAL, POSITIVE, SUBNORMAL, ZERO};
    let edges = vec![1e200, 1e-160, 1e-308, f64::MAX, f64::MIN_POSITIVE, 1.0, 1.0 + f64::EPSILON];
    prop_oneof![POSITIVE | NEGATIVE | NORMAL | SUBNORMAL | ZERO, prop::sample::select(edges), 1e-3..4.0]
}

#[test]
fn whatever_the_parameters_a_value_is_finite_or_typed_undefined() {
    let special = prop::sample::select(vec![0.0, 45.0, 90.0, 100.0, 180.0]);
    let theta = prop_oneof![special, 0.0..=180.0];
    let geometry = (theta.clone(), 0.0..360.0, theta, 0.0..360.0)
        .prop_map(|(ti, pi, tv, pv)| Geometry::from_degrees(ti, pi, tv, pv).unwrap());
    let references = vec![
        Reference::None,
        Reference::SameGeometry,
        Reference::FixedGeometry { theta_i_deg: 60.0, theta_v_deg: 0.0 },
    ];
    let term = (
        any_number(),
        any_number(),
        any_number(),
        prop::sample::select(Distribution::ALL),
        prop::sample::select(Denominator::ALL),
    );
    let check = |(geometry, mirror, term, reference): (Geometry, bool, _, Reference)| {
        let (intensity, roughness, refractive_index, distribution, denominator) = term;
        let mut geometry = geometry;
        if mirror {
            // The peak of D, where a small roughness is largest.
            let i = geometry.incidence;
            geometry = Geometry::from_degrees(i.theta_deg(), 180.0, i.theta_deg(), 0.0).unwrap();
        }
        let specular = TorranceSparrow { intensity, roughness, refractive_index, distribution, denominator };
        let terms = [Term::TorranceSparrow(specular), Term::Lambertian { albedo: intensity }];
        for term in &terms {
            if let Ok(value) = term.evaluate(&geometry, &reference) {
                let is_finite = value.value.is_finite() && value.by.iter().all(|by| by.is_finite());
                prop_assert!(is_finite, "{term:?} {value:?}");
            }
        }
        if let Ok(sum) = predict(&terms, &geometry, &reference) {
            prop_assert!(sum.total().is_finite(), "{sum:?}");
        }
        if let Ok(factors) = specular.factors(&geometry) {
            prop_assert!([factors.d, factors.g, factors.f].iter().all(|factor| factor.is_finite()), "{factors:?}");
        }
        Ok(())
    };
    let strategy = (geometry, any::<bool>(), term, prop::sample::select(references));
    runner().run(&strategy, check).unwrap();
}

/// A BRDF times cos(theta_i): with cos(theta_v) below, the term over cos(theta_i) is symmetric in L and V.
#[test]
fn the_denominator_cos_theta_v_makes_a_reciprocal_brdf() {
    let check = |(geometry, mut term): (Geometry, TorranceSparrow)| {
        term.denominator = Denominator::CosThetaV;
        let swapped = Geometry { incidence: geometry.viewing, viewing: geometry.incidence };
        let brdf = |g: &Geometry| {
            Term::TorranceSparrow(term).evaluate(g, &Reference::None).map(|v| v.value / g.incidence.cos_theta())
        };
        if let (Ok(there), Ok(back)) = (brdf(&geometry), brdf(&swapped)) {
            prop_assert!((there - back).abs() <= 1e-12 * there.abs() + 1e-300, "{there:e} {back:e}");
        }
        Ok(())
    };
    runner().run(&(geometry(), specular()), check).unwrap();
}

#[test]
fn derivatives_agree_with_difference_quotients() {
    let check = |(geometry, term): (Geometry, TorranceSparrow)| {
        let at = |change: &dyn Fn(&mut TorranceSparrow)| {
            let mut changed = term;
            change(&mut changed);
            Term::TorranceSparrow(changed).evaluate(&geometry, &Reference::None).map(|value| value.value)
        };
        let Ok(value) = Term::TorranceSparrow(term).evaluate(&geometry, &Reference::None) else { return Ok(()) };
        if value.value < 1e-290 {
            return Ok(()); // a difference of subnormal numbers has no digits
        }
        let relative = 1e-5;
        let (dr, dn) = (relative * term.roughness, relative * (term.refractive_index - 1.0));
        let by_roughness = (at(&|t| t.roughness += dr).unwrap() - at(&|t| t.roughness -= dr).unwrap()) / (2.0 * dr);
        let by_index =
            (at(&|t| t.refractive_index += dn).unwrap() - at(&|t| t.refractive_index -= dn).unwrap()) / (2.0 * dn);
        // Third derivatives of exp(-u) grow with u^3; far out in the lobe the quotient says nothing.
        let slope = value.by[1].abs() * term.roughness / value.value.max(1e-300);
        if slope < 100.0 {
            let scale = value.value / term.roughness;
            prop_assert!(
                (by_roughness - value.by[1]).abs() <= 1e-4 * (value.by[1].abs() + scale),
                "{by_roughness} {value:?}"
            );
        }
        let scale = value.value / (term.refractive_index - 1.0);
        prop_assert!((by_index - value.by[2]).abs() <= 1e-6 * (value.by[2].abs() + scale), "{by_index} {value:?}");
        Ok(())
    };
    runner().run(&(geometry(), specular()), check).unwrap();
}

#[test]
fn a_factor_is_y_over_e_over_what_the_reference_received() {
    let check = |(geometry, term): (Geometry, TorranceSparrow)| {
        let term = Term::TorranceSparrow(term);
        let fixed = Reference::FixedGeometry { theta_i_deg: 60.0, theta_v_deg: 0.0 };
        let (Ok(plain), Ok(factor)) = (term.evaluate(&geometry, &Reference::None), term.evaluate(&geometry, &fixed))
        else {
            return Ok(());
        };
        // Twice a subnormal number has a digit more than it, and the intensity multiplies what is lost.
        let intensity = term.values()[0];
        let is_subnormal = plain.value < f64::MIN_POSITIVE * intensity.max(1.0);
        let digit = if is_subnormal { 2.0 * (1.0 + intensity) * 5e-324 } else { 0.0 };
        prop_assert!((factor.value - plain.value / 0.5).abs() <= digit, "{factor:?} {plain:?}");
        Ok(())
    };
    runner().run(&(geometry(), specular()), check).unwrap();
}

/// Every form of D with every denominator and reference gives its parameters back, out of the plane too.
#[test]
fn exact_data_of_every_form_give_back_their_parameters() {
    let angles = [0.0, 15.0, 30.0, 45.0, 60.0, 75.0];
    let grid: Vec<Geometry> = angles
        .iter()
        .flat_map(|&ti| angles.iter().map(move |&tv| (ti, tv)))
        .flat_map(|(ti, tv)| [0.0, 60.0, 150.0, 180.0].map(|pv| Geometry::from_degrees(ti, 180.0, tv, pv).unwrap()))
        .filter(|geometry| !geometry.is_retro(1.0))
        .collect();
    let references =
        [Reference::None, Reference::SameGeometry, Reference::FixedGeometry { theta_i_deg: 45.0, theta_v_deg: 0.0 }];
    for &distribution in Distribution::ALL {
        for &denominator in Denominator::ALL {
            for reference in references {
                let roughness = distribution.roughness_from_half_width(0.2);
                let truth =
                    TorranceSparrow { intensity: 5.0, roughness, refractive_index: 1.5, distribution, denominator };
                let terms = [Term::Lambertian { albedo: 0.3 }, Term::TorranceSparrow(truth)];
                let value = |g: &Geometry| terms.iter().map(|t| t.evaluate(g, &reference).unwrap().value).sum::<f64>();
                let values: Vec<f64> = grid.iter().map(value).collect();
                let sigma: Vec<f64> = values.iter().map(|value| 1e-3 * value).collect();
                let set = GeometrySet::new(&grid, &reference, distribution, denominator).unwrap();
                let fitter = Fitter::new(&set, Terms { diffuse: true, specular: true });
                let fit = fitter.fit(&values, Some(&sigma)).unwrap();
                let found = [fit.bands[0].diffuse, fit.bands[0].intensity, fit.roughness, fit.refractive_index()];
                for (found, expected) in found.into_iter().zip([0.3, 5.0, roughness, 1.5]) {
                    let off = (found / expected - 1.0).abs();
                    assert!(off < 1e-5, "{distribution} {denominator} {reference}: {found}, expected {expected}");
                }
            }
        }
    }
}
