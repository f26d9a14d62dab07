//! What turns the values of a measurement into a BRDF.

use std::f64::consts::PI;

use crate::dataset::Measurement;
use crate::quantity::{Geometry, QuantityKind, Reference};

/// From a value to a BRDF, 1/sr.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Conversion {
    /// It is one.
    None,
    /// From a radiance factor with this reference.
    Factor(Reference),
}

impl Conversion {
    /// The conversion for a measurement, or why there is none.
    pub(super) fn of(measurement: &Measurement) -> Result<Self, String> {
        let quantity = &measurement.quantity;
        match quantity.kind {
            QuantityKind::Brdf => Ok(Self::None),
            QuantityKind::RadianceFactor => {
                // One geometry is as good as another to learn whether the reference is stated.
                let known = measurement.acquisitions.iter().find_map(|row| row.geometry);
                known
                    .map_or(Ok(1.0), |geometry| quantity.reference.lit_fraction(&geometry))
                    .map_err(|e| e.to_string())?;
                Ok(Self::Factor(quantity.reference))
            }
            kind @ (QuantityKind::BispectralLuminescentRadianceFactor | QuantityKind::Brrdf) => Err(format!(
                "`{kind}` is a density in {}, and the format knows the unit 1/sr alone; use --to json",
                kind.unit()
            )),
            QuantityKind::DonaldsonMatrix => Err(
                "a Donaldson matrix holds densities times a width beside factors, and the format knows BRDFs alone; \
                     use --to json"
                    .to_owned(),
            ),
            kind if kind.is_factor() => {
                Err(format!("`{kind}` is a ratio of sums over wavelengths; export the spectral factor"))
            }
            kind => Err(format!("`{kind}` is relative to no irradiance; export a radiance factor or a BRDF")),
        }
    }

    /// What a value in this geometry is multiplied with; `None` where it has no BRDF (grazing incidence).
    ///
    /// A factor is Y/E over what its reference had, with Y = pi L; a BRDF is L over the irradiance of the surface,
    /// E cos(theta_i).
    pub(super) fn scale(&self, geometry: &Geometry) -> Option<f64> {
        match self {
            Self::None => Some(1.0),
            // The same number on both sides: 1 / pi exactly, at grazing incidence, too.
            Self::Factor(Reference::SameGeometry) => Some(1.0 / PI),
            Self::Factor(reference) => {
                let lit = reference.lit_fraction(geometry).ok()?;
                let scale = lit / (PI * geometry.incidence.cos_theta());
                scale.is_finite().then_some(scale)
            }
        }
    }
}
