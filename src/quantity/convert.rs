//! Every conversion between quantities, by name. Each may refuse: a conversion that needs what the source did not
//! state has no answer.

use super::angle::cos_deg;
use super::direction::Geometry;
use super::kind::Reference;

/// Why a conversion has no answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConversionRefused {
    /// The reference geometry is not stated, so it is unknown whether cos(theta_i) is inside the factor.
    #[error(
        "the reference of this factor is unstated, so it is unknown whether cos(theta_i) is inside; state \
         `same-geometry`, `fixed-geometry(theta_i,theta_v)` or `none`"
    )]
    ReferenceUnstated,
    /// The reference was lit at grazing incidence, where it receives nothing.
    #[error("the reference was lit at 90 degrees, where a diffuser receives no light")]
    ReferenceUnlit,
}

impl Reference {
    /// What the reference had of the beam's irradiance: cos(theta_i) of the value for `same-geometry`, cos(theta_ref)
    /// for `fixed-geometry`, 1 without a reference. A radiance factor is Y/E divided by this number.
    ///
    /// # Errors
    /// [`ConversionRefused`] when the reference is unstated or received no light.
    pub fn lit_fraction(&self, geometry: &Geometry) -> Result<f64, ConversionRefused> {
        match self {
            Self::SameGeometry => Ok(geometry.incidence.cos_theta()),
            Self::FixedGeometry { theta_i_deg, .. } => {
                let cosine = cos_deg(*theta_i_deg);
                if cosine > 0.0 { Ok(cosine) } else { Err(ConversionRefused::ReferenceUnlit) }
            }
            Self::None => Ok(1.0),
            Self::Unstated => Err(ConversionRefused::ReferenceUnstated),
        }
    }
}

/// A quotient with its standard uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quotient {
    /// The quotient, dimensionless.
    pub value: f64,
    /// The part of its standard uncertainty that comes from the numerator.
    pub sigma_numerator: f64,
    /// The *relative* standard uncertainty that comes from the denominator; shared by all that divide by it.
    pub relative_denominator: f64,
}

/// A signal over a reference signal, times the certified factor of the reference: the radiance factor
/// (CIE S 017 term 17-24-062) when both are radiances under the same irradiation. `numerator` and `denominator` are
/// (signal, standard uncertainty) in one unit. `None` where the reference is not positive: nothing can be divided by it.
#[must_use]
pub fn ratio_to_reference(numerator: (f64, f64), denominator: (f64, f64), certified_factor: f64) -> Option<Quotient> {
    if !(denominator.0 > 0.0 && denominator.0.is_finite() && numerator.0.is_finite()) {
        return None;
    }
    let scale = certified_factor / denominator.0;
    Some(Quotient {
        value: numerator.0 * scale,
        sigma_numerator: numerator.1 * scale.abs(),
        relative_denominator: denominator.1 / denominator.0,
    })
}

#[cfg(test)]
mod tests {
    use super::super::direction::SignHabit;
    use super::*;

    #[test]
    fn an_unstated_reference_refuses() {
        let geometry = Geometry::from_signed(60.0, 0.0, SignHabit::MirrorAtEqual).unwrap();
        assert_eq!(Reference::Unstated.lit_fraction(&geometry), Err(ConversionRefused::ReferenceUnstated));
        assert_eq!(Reference::SameGeometry.lit_fraction(&geometry), Ok(geometry.incidence.cos_theta()));
        assert_eq!(Reference::None.lit_fraction(&geometry), Ok(1.0));
        let grazing = Reference::FixedGeometry { theta_i_deg: 90.0, theta_v_deg: 0.0 };
        assert_eq!(grazing.lit_fraction(&geometry), Err(ConversionRefused::ReferenceUnlit));
    }

    #[test]
    fn nothing_is_divided_by_a_dark_reference() {
        assert_eq!(ratio_to_reference((1.0, 0.1), (0.0, 0.1), 0.99), None);
        assert_eq!(ratio_to_reference((1.0, 0.1), (-1e-9, 0.1), 0.99), None);
        let quotient = ratio_to_reference((-0.5, 0.1), (2.0, 0.02), 0.98).unwrap();
        assert_eq!((quotient.value, quotient.sigma_numerator), (-0.245, 0.049));
        assert_eq!(quotient.relative_denominator, 0.01);
    }
}
