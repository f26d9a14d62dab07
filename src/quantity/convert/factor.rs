//! Factors and BRDFs, and factors relative to a diffuser in one geometry or another.

use std::f64::consts::PI;

use super::super::angle::cos_deg;
use super::super::direction::Geometry;
use super::super::kind::{NormalisedAt, Part, Quantity, QuantityKind, Reference, ReferenceLight};
use super::{Conversion, ConversionRefused, expect_kind, expect_no_reference, expect_part, expect_same_geometry};

/// f_r = R / pi, sr-1: the perfect diffuser in the same geometry has a BRDF of 1/pi (Nicodemus et al. 1977).
///
/// Holds for the elastic part: what fluorescence adds depends on the light, and a BRDF does not.
///
/// # Errors
/// [`ConversionRefused`] unless it is an elastic `radiance-factor` with the reference `same-geometry`.
pub fn brdf_from_radiance_factor(quantity: &Quantity) -> Result<Conversion, ConversionRefused> {
    expect_kind(quantity, QuantityKind::RadianceFactor, "`radiance-factor`")?;
    expect_part(quantity, Part::Elastic)?;
    expect_same_geometry(quantity)?;
    let quantity = Quantity {
        kind: QuantityKind::Brdf,
        reference: Reference::None,
        certified_factor: Vec::new(),
        ..quantity.clone()
    };
    Ok(Conversion { quantity, factor: 1.0 / PI })
}

/// R = pi f_r, relative to the perfect diffuser in the same geometry under the same light.
///
/// # Errors
/// [`ConversionRefused`] unless it is an elastic `brdf` without a reference.
pub fn radiance_factor_from_brdf(quantity: &Quantity) -> Result<Conversion, ConversionRefused> {
    expect_kind(quantity, QuantityKind::Brdf, "`brdf`")?;
    expect_part(quantity, Part::Elastic)?;
    expect_no_reference(quantity, "`none`: a BRDF is no ratio to a diffuser")?;
    let quantity = Quantity {
        kind: QuantityKind::RadianceFactor,
        normalised_at: NormalisedAt::Emission,
        reference: Reference::SameGeometry,
        reference_light: ReferenceLight::Same,
        certified_factor: Vec::new(),
        ..quantity.clone()
    };
    Ok(Conversion { quantity, factor: PI })
}

/// The cosine of the incidence at the sample, where a reference in its place would be lit.
fn cosine_at_sample(geometry: &Geometry) -> Result<f64, ConversionRefused> {
    let cosine = geometry.incidence.cos_theta();
    if cosine > 0.0 { Ok(cosine) } else { Err(ConversionRefused::SampleUnlit) }
}

fn expect_factor(quantity: &Quantity) -> Result<(), ConversionRefused> {
    let found = quantity.kind;
    if found.is_factor() { Ok(()) } else { Err(ConversionRefused::Kind { found, expected: "a factor" }) }
}

/// A factor relative to a reference in one geometry as one relative to a reference in the geometry of each value:
/// times cos(theta_ref) / cos(theta_i), because Y/E is the same in both.
///
/// # Errors
/// [`ConversionRefused`] unless it is a factor with a `fixed-geometry`, and sample and reference are lit.
pub fn to_same_geometry(quantity: &Quantity, geometry: &Geometry) -> Result<Conversion, ConversionRefused> {
    expect_factor(quantity)?;
    match quantity.reference {
        Reference::FixedGeometry { .. } => {}
        Reference::Unstated => return Err(ConversionRefused::ReferenceUnstated),
        found => return Err(ConversionRefused::Reference { found, expected: "`fixed-geometry`" }),
    }
    let factor = quantity.reference.lit_fraction(geometry)? / cosine_at_sample(geometry)?;
    Ok(Conversion { quantity: Quantity { reference: Reference::SameGeometry, ..quantity.clone() }, factor })
}

/// The other way: a factor relative to a reference in the same geometry as one relative to a reference at
/// (`theta_i_deg`, `theta_v_deg`): times cos(theta_i) / cos(theta_ref).
///
/// # Errors
/// [`ConversionRefused`] unless it is a factor with the reference `same-geometry`, and sample and reference are lit.
pub fn to_fixed_geometry(
    quantity: &Quantity,
    geometry: &Geometry,
    theta_i_deg: f64,
    theta_v_deg: f64,
) -> Result<Conversion, ConversionRefused> {
    expect_factor(quantity)?;
    expect_same_geometry(quantity)?;
    let lit = cos_deg(theta_i_deg);
    // Not a number is no light either.
    if lit.is_nan() || lit <= 0.0 {
        return Err(ConversionRefused::ReferenceUnlit);
    }
    let factor = cosine_at_sample(geometry)? / lit;
    let reference = Reference::FixedGeometry { theta_i_deg, theta_v_deg };
    Ok(Conversion { quantity: Quantity { reference, ..quantity.clone() }, factor })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::super::super::kind::Basis;
    use super::*;

    fn factor(part: Part, reference: Reference) -> Quantity {
        Quantity {
            kind: QuantityKind::RadianceFactor,
            part,
            normalised_at: NormalisedAt::Emission,
            basis: Basis::Energy,
            reference,
            reference_light: ReferenceLight::Same,
            certified_factor: vec![0.99],
        }
    }

    fn at(theta_i: f64) -> Geometry {
        Geometry::from_degrees(theta_i, 180.0, 0.0, 0.0).unwrap()
    }

    const FIXED: Reference = Reference::FixedGeometry { theta_i_deg: 60.0, theta_v_deg: 0.0 };

    #[test]
    fn a_perfect_diffuser_has_a_brdf_of_one_over_pi() {
        let there = brdf_from_radiance_factor(&factor(Part::Elastic, Reference::SameGeometry)).unwrap();
        assert_eq!((there.quantity.kind, there.factor), (QuantityKind::Brdf, std::f64::consts::FRAC_1_PI));
        let back = radiance_factor_from_brdf(&there.quantity).unwrap();
        assert_eq!(
            back.quantity,
            Quantity { certified_factor: vec![], ..factor(Part::Elastic, Reference::SameGeometry) }
        );
        assert!((there.factor * back.factor - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_brdf_needs_the_elastic_part_and_a_reference_in_the_same_geometry() {
        for part in [Part::Total, Part::Luminescent, Part::Unstated] {
            let refused = brdf_from_radiance_factor(&factor(part, Reference::SameGeometry));
            assert_eq!(refused, Err(ConversionRefused::Part { found: part, expected: Part::Elastic }));
        }
        let refused = |reference| brdf_from_radiance_factor(&factor(Part::Elastic, reference)).unwrap_err();
        assert!(matches!(refused(FIXED), ConversionRefused::Reference { found, .. } if found == FIXED));
        assert_eq!(refused(Reference::Unstated), ConversionRefused::ReferenceUnstated);
        let radiance = Quantity::absolute(QuantityKind::SpectralRadiance, Part::Elastic);
        assert!(matches!(brdf_from_radiance_factor(&radiance), Err(ConversionRefused::Kind { .. })));
        assert!(matches!(radiance_factor_from_brdf(&radiance), Err(ConversionRefused::Kind { .. })));
    }

    #[test]
    fn a_lambertian_cosine_becomes_a_constant() {
        for theta in [0.0, 30.0, 80.0, 89.999_999] {
            let fixed = factor(Part::Total, FIXED);
            let to_same = to_same_geometry(&fixed, &at(theta)).unwrap();
            // Y/E of albedo 0.8 is 0.8 cos(theta); over the reference's cosine it is the factor.
            let value = 0.8 * at(theta).incidence.cos_theta() / 0.5;
            assert!((value * to_same.factor - 0.8).abs() < 1e-15, "{theta}");
            let back = to_fixed_geometry(&to_same.quantity, &at(theta), 60.0, 0.0).unwrap();
            assert_eq!(back.quantity, fixed);
            assert!((to_same.factor * back.factor - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn at_ninety_degrees_nothing_is_converted() {
        let (same, fixed) = (factor(Part::Total, Reference::SameGeometry), factor(Part::Total, FIXED));
        assert_eq!(to_same_geometry(&fixed, &at(90.0)), Err(ConversionRefused::SampleUnlit));
        assert_eq!(to_fixed_geometry(&same, &at(90.0), 0.0, 45.0), Err(ConversionRefused::SampleUnlit));
        assert_eq!(to_fixed_geometry(&same, &at(10.0), 90.0, 45.0), Err(ConversionRefused::ReferenceUnlit));
        assert_eq!(to_fixed_geometry(&same, &at(10.0), f64::NAN, 45.0), Err(ConversionRefused::ReferenceUnlit));
        let unlit = factor(Part::Total, Reference::FixedGeometry { theta_i_deg: -90.0, theta_v_deg: 0.0 });
        assert_eq!(to_same_geometry(&unlit, &at(10.0)), Err(ConversionRefused::ReferenceUnlit));
    }

    #[test]
    fn the_geometry_of_the_reference_has_to_be_known() {
        let unstated = factor(Part::Total, Reference::Unstated);
        assert_eq!(to_same_geometry(&unstated, &at(0.0)), Err(ConversionRefused::ReferenceUnstated));
        assert_eq!(to_fixed_geometry(&unstated, &at(0.0), 0.0, 45.0), Err(ConversionRefused::ReferenceUnstated));
        let same = factor(Part::Total, Reference::SameGeometry);
        assert!(matches!(to_same_geometry(&same, &at(0.0)), Err(ConversionRefused::Reference { .. })));
        let fixed = factor(Part::Total, FIXED);
        assert!(matches!(to_fixed_geometry(&fixed, &at(0.0), 0.0, 45.0), Err(ConversionRefused::Reference { .. })));
    }
}
