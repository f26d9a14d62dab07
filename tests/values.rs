//! The terms under each reference, and as the command line reads them. Their digits are `terms_60_digits.rs`'s, their edges
//! `hard_cases/terms.rs`'s.
#![allow(clippy::unwrap_used)]

use bbrf::quantity::{Geometry, Reference, SignHabit};
use bbrf::terms::{Denominator, Distribution, Term, TorranceSparrow, Undefined};

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
