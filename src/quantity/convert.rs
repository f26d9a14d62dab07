//! Every conversion between quantities, by name. Each may refuse: a conversion that needs what the source did not
//! state has no answer.
//!
//! Every conversion multiplies values, uncertainties of values included; a [`Conversion`] is that number with the
//! quantity that the products are. Relative uncertainties stay as they are.

mod basis;
mod bispectral;
mod factor;

pub use basis::to_basis;
pub use bispectral::{
    Cell, EmissionWidth, brrdf_from_density, density_from_brrdf, density_from_donaldson, donaldson_from_density,
};
pub use factor::{brdf_from_radiance_factor, radiance_factor_from_brdf, to_fixed_geometry, to_same_geometry};

use super::angle::cos_deg;
use super::direction::Geometry;
use super::kind::{Part, Quantity, QuantityKind, Reference};

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
    /// The sample is lit at grazing incidence: a reference in its place receives nothing.
    #[error("the sample is lit at 90 degrees, where a reference in its place receives no light")]
    SampleUnlit,
    /// The conversion starts from another quantity.
    #[error("found the quantity `{found}`; this conversion takes {expected}")]
    Kind {
        /// What the values are.
        found: QuantityKind,
        /// What they have to be.
        expected: &'static str,
    },
    /// The conversion holds for another part of the light.
    #[error("found the part `{found}`; this conversion holds for `{expected}` only: separate the parts first")]
    Part {
        /// The part that the values hold.
        found: Part,
        /// The part that it holds for.
        expected: Part,
    },
    /// The conversion holds for another reference.
    #[error("found the reference `{found}`; this conversion holds for {expected}")]
    Reference {
        /// The reference of the values.
        found: Reference,
        /// The references that it holds for.
        expected: &'static str,
    },
    /// The width of the bandpass is not stated, and the values contain it or are to contain it.
    #[error(
        "the emission bandpass is unstated: without its width a Donaldson matrix and a density cannot be converted"
    )]
    BandpassUnstated,
    /// The width is no width.
    #[error("the emission bandpass is {0} nm wide; expected a positive finite width")]
    Width(f64),
    /// On the diagonal of a Donaldson matrix stands reflected light.
    #[error(
        "the excitation of {excitation_nm} nm and the emission at {emission_nm} nm overlap: there the matrix holds \
         reflected light, which is no density"
    )]
    Diagonal {
        /// Centre of the excitation, nm.
        excitation_nm: f64,
        /// Centre of the emission, nm.
        emission_nm: f64,
    },
    /// It is not stated what is counted.
    #[error("the basis is unstated, so it is unknown whether energy or photons are counted; state it")]
    BasisUnstated,
    /// A wavelength is no wavelength.
    #[error("a wavelength of {0} nm; expected a positive finite number")]
    Wavelength(f64),
}

/// What a conversion does: every value, and every uncertainty in the unit of the values, times `factor` is of
/// `quantity`.
#[derive(Debug, Clone, PartialEq)]
pub struct Conversion {
    /// What the products are.
    pub quantity: Quantity,
    /// The number to multiply with, positive and finite.
    pub factor: f64,
}

/// Refuses another quantity.
fn expect_kind(quantity: &Quantity, kind: QuantityKind, expected: &'static str) -> Result<(), ConversionRefused> {
    let found = quantity.kind;
    if found == kind { Ok(()) } else { Err(ConversionRefused::Kind { found, expected }) }
}

/// Refuses another part.
fn expect_part(quantity: &Quantity, expected: Part) -> Result<(), ConversionRefused> {
    let found = quantity.part;
    if found == expected { Ok(()) } else { Err(ConversionRefused::Part { found, expected }) }
}

/// Refuses another reference than one in the geometry of each value.
fn expect_same_geometry(quantity: &Quantity) -> Result<(), ConversionRefused> {
    match quantity.reference {
        Reference::SameGeometry => Ok(()),
        Reference::Unstated => Err(ConversionRefused::ReferenceUnstated),
        found => Err(ConversionRefused::Reference { found, expected: "`same-geometry`; convert the reference first" }),
    }
}

/// `expected` says why the quantity has none.
fn expect_no_reference(quantity: &Quantity, expected: &'static str) -> Result<(), ConversionRefused> {
    match quantity.reference {
        Reference::None => Ok(()),
        Reference::Unstated => Err(ConversionRefused::ReferenceUnstated),
        found => Err(ConversionRefused::Reference { found, expected }),
    }
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
