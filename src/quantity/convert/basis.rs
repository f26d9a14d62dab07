//! Energy and photons.

use super::super::kind::{Basis, Quantity, QuantityKind};
use super::{Conversion, ConversionRefused};

/// A ratio of energies as one of photons, or back: a photon carries h c / lambda, so photons out over photons in are
/// energy out over energy in times lambda_em / lambda_ex.
///
/// A `radiance-factor` and a `brdf` compare light of one wavelength: their number stays, whatever the wavelengths.
///
/// # Errors
/// [`ConversionRefused`] where the basis is unstated, a wavelength is none, or the quantity is no ratio of one pair of
/// wavelengths: an absolute quantity has no unit of photons in the standard, a sum over a band has no wavelength.
pub fn to_basis(
    quantity: &Quantity,
    basis: Basis,
    excitation_nm: f64,
    emission_nm: f64,
) -> Result<Conversion, ConversionRefused> {
    use QuantityKind::{BispectralLuminescentRadianceFactor, Brdf, Brrdf, DonaldsonMatrix, RadianceFactor};
    let (from, into) = (quantity.basis, basis);
    if from == Basis::Unstated || into == Basis::Unstated {
        return Err(ConversionRefused::BasisUnstated);
    }
    let ratio = match quantity.kind {
        RadianceFactor | Brdf => 1.0,
        BispectralLuminescentRadianceFactor | DonaldsonMatrix | Brrdf => {
            let valid = |nm: f64| nm > 0.0 && nm.is_finite();
            if let Some(found) = [excitation_nm, emission_nm].into_iter().find(|nm| !valid(*nm)) {
                return Err(ConversionRefused::Wavelength(found));
            }
            emission_nm / excitation_nm
        }
        found => return Err(ConversionRefused::Kind { found, expected: "a ratio at one pair of wavelengths" }),
    };
    let factor = match (from, into) {
        (Basis::Energy, Basis::Photon) => ratio,
        (Basis::Photon, Basis::Energy) => 1.0 / ratio,
        _ => 1.0,
    };
    Ok(Conversion { quantity: Quantity { basis: into, ..quantity.clone() }, factor })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::super::super::kind::Part;
    use super::*;

    fn density() -> Quantity {
        let kind = QuantityKind::BispectralLuminescentRadianceFactor;
        Quantity { basis: Basis::Energy, ..Quantity::absolute(kind, Part::Luminescent) }
    }

    #[test]
    fn one_photon_for_one_is_less_energy() {
        // All photons of 400 nm come out at 500 nm: 0.8 of the energy.
        let there = to_basis(&density(), Basis::Photon, 400.0, 500.0).unwrap();
        assert_eq!((there.quantity.basis, 0.8 * there.factor), (Basis::Photon, 1.0));
        let back = to_basis(&there.quantity, Basis::Energy, 400.0, 500.0).unwrap();
        assert_eq!((back.quantity, back.factor), (density(), 0.8));
        assert_eq!(to_basis(&density(), Basis::Energy, 400.0, 500.0).unwrap().factor, 1.0);
    }

    #[test]
    fn a_factor_at_one_wavelength_is_the_same_in_both() {
        let factor = Quantity { kind: QuantityKind::RadianceFactor, ..density() };
        assert_eq!(to_basis(&factor, Basis::Photon, f64::NAN, 500.0).unwrap().factor, 1.0);
    }

    #[test]
    fn what_is_not_known_refuses() {
        let unstated = Quantity { basis: Basis::Unstated, ..density() };
        assert_eq!(to_basis(&unstated, Basis::Photon, 400.0, 500.0), Err(ConversionRefused::BasisUnstated));
        assert_eq!(to_basis(&density(), Basis::Unstated, 400.0, 500.0), Err(ConversionRefused::BasisUnstated));
        for nm in [0.0, -400.0, f64::INFINITY] {
            assert_eq!(to_basis(&density(), Basis::Photon, nm, 500.0), Err(ConversionRefused::Wavelength(nm)));
            assert_eq!(to_basis(&density(), Basis::Photon, 400.0, nm), Err(ConversionRefused::Wavelength(nm)));
        }
        for kind in [QuantityKind::SpectralRadiance, QuantityKind::LuminanceFactor, QuantityKind::BandRadianceFactor] {
            let refused = to_basis(&Quantity { kind, ..density() }, Basis::Photon, 400.0, 500.0);
            assert!(matches!(refused, Err(ConversionRefused::Kind { .. })), "{kind}");
        }
    }
}
