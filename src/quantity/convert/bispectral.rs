//! Bispectral densities, what a Donaldson matrix tabulates, and reradiation functions.

use std::f64::consts::PI;

use super::super::kind::{NormalisedAt, Part, Quantity, QuantityKind, Reference, ReferenceLight};
use super::super::wavelength::{Bandpass, WavelengthAxis};
use super::{Conversion, ConversionRefused, expect_kind, expect_no_reference, expect_part, expect_same_geometry};

/// The width w(em) that the off-diagonal values of a Donaldson matrix contain, nm.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EmissionWidth(f64);

impl EmissionWidth {
    /// A width in nm.
    ///
    /// # Errors
    /// [`ConversionRefused::Width`] unless it is positive and finite.
    pub fn new(nm: f64) -> Result<Self, ConversionRefused> {
        if nm > 0.0 && nm.is_finite() { Ok(Self(nm)) } else { Err(ConversionRefused::Width(nm)) }
    }

    /// The stated bandpass of an emission axis at one of its wavelengths. It is not the step of the axis.
    ///
    /// # Errors
    /// [`ConversionRefused::BandpassUnstated`] where the source does not say, [`ConversionRefused::Width`].
    pub fn of(axis: &WavelengthAxis, emission: usize) -> Result<Self, ConversionRefused> {
        let Bandpass::Stated { fwhm_nm, .. } = &axis.bandpass else { return Err(ConversionRefused::BandpassUnstated) };
        let width = if fwhm_nm.len() == 1 { fwhm_nm.first() } else { fwhm_nm.get(emission) };
        Self::new(*width.ok_or(ConversionRefused::BandpassUnstated)?)
    }

    /// The width in nm.
    #[must_use]
    pub fn nm(self) -> f64 {
        self.0
    }
}

/// A cell of a Donaldson matrix: where it is excited, and where it is looked at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cell {
    /// Centre of the excitation, nm.
    pub excitation_nm: f64,
    /// Full width of the excitation at half maximum, nm.
    pub excitation_fwhm_nm: f64,
    /// Centre of the emission, nm.
    pub emission_nm: f64,
    /// Width of the emission bandpass.
    pub emission_width: EmissionWidth,
}

impl Cell {
    /// True where both bandpasses overlap, so that reflected light is in the value: triangles of these half widths end
    /// a full width away from their centres.
    #[must_use]
    pub fn is_diagonal(&self) -> bool {
        (self.emission_nm - self.excitation_nm).abs() < self.excitation_fwhm_nm + self.emission_width.nm()
    }

    fn off_diagonal(&self) -> Result<f64, ConversionRefused> {
        let width = self.excitation_fwhm_nm;
        if !(width >= 0.0 && width.is_finite()) {
            return Err(ConversionRefused::Width(width));
        }
        if self.is_diagonal() {
            let Self { excitation_nm, emission_nm, .. } = *self;
            return Err(ConversionRefused::Diagonal { excitation_nm, emission_nm });
        }
        Ok(self.emission_width.nm())
    }
}

const DENSITY: QuantityKind = QuantityKind::BispectralLuminescentRadianceFactor;
const NAME: &str = "`bispectral-luminescent-radiance-factor`";

/// An off-diagonal value of a Donaldson matrix from a density: times w(em). The density is the one of CIE ILV
/// 17-21-101, per nm; the matrix is what an instrument of that bandpass tabulates.
///
/// # Errors
/// [`ConversionRefused`] unless it is a luminescent density and the cell lies off the diagonal.
pub fn donaldson_from_density(quantity: &Quantity, cell: &Cell) -> Result<Conversion, ConversionRefused> {
    expect_kind(quantity, DENSITY, NAME)?;
    expect_part(quantity, Part::Luminescent)?;
    let factor = cell.off_diagonal()?;
    let quantity = Quantity { kind: QuantityKind::DonaldsonMatrix, ..quantity.clone() };
    Ok(Conversion { quantity, factor })
}

/// The density from an off-diagonal value of a Donaldson matrix: over w(em), nm-1.
///
/// # Errors
/// [`ConversionRefused`] unless it is a Donaldson matrix with luminescent light off its diagonal, where the cell lies.
pub fn density_from_donaldson(quantity: &Quantity, cell: &Cell) -> Result<Conversion, ConversionRefused> {
    expect_kind(quantity, QuantityKind::DonaldsonMatrix, "`donaldson-matrix`")?;
    // Off the diagonal the total is luminescent alone.
    if !matches!(quantity.part, Part::Luminescent | Part::Total) {
        return Err(ConversionRefused::Part { found: quantity.part, expected: Part::Luminescent });
    }
    let factor = 1.0 / cell.off_diagonal()?;
    let quantity = Quantity { kind: DENSITY, part: Part::Luminescent, ..quantity.clone() };
    Ok(Conversion { quantity, factor })
}

/// The BRRDF from the density: over pi, sr-1 nm-1, as a BRDF is a radiance factor over pi.
///
/// # Errors
/// [`ConversionRefused`] unless it is a luminescent density with the reference `same-geometry`.
pub fn brrdf_from_density(quantity: &Quantity) -> Result<Conversion, ConversionRefused> {
    expect_kind(quantity, DENSITY, NAME)?;
    expect_part(quantity, Part::Luminescent)?;
    expect_same_geometry(quantity)?;
    let quantity = Quantity {
        kind: QuantityKind::Brrdf,
        reference: Reference::None,
        certified_factor: Vec::new(),
        ..quantity.clone()
    };
    Ok(Conversion { quantity, factor: 1.0 / PI })
}

/// The density from the BRRDF: times pi, nm-1, relative to the perfect diffuser in the same geometry.
///
/// # Errors
/// [`ConversionRefused`] unless it is a luminescent `brrdf` without a reference.
pub fn density_from_brrdf(quantity: &Quantity) -> Result<Conversion, ConversionRefused> {
    expect_kind(quantity, QuantityKind::Brrdf, "`brrdf`")?;
    expect_part(quantity, Part::Luminescent)?;
    expect_no_reference(quantity, "`none`: a BRRDF is no ratio to a diffuser")?;
    let quantity = Quantity {
        kind: DENSITY,
        normalised_at: NormalisedAt::Excitation,
        reference: Reference::SameGeometry,
        reference_light: ReferenceLight::Same,
        certified_factor: Vec::new(),
        ..quantity.clone()
    };
    Ok(Conversion { quantity, factor: PI })
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test")]
mod tests {
    use super::super::super::kind::Basis;
    use super::super::super::wavelength::{BandpassCorrection, BandpassShape};
    use super::*;

    fn quantity(kind: QuantityKind, part: Part) -> Quantity {
        Quantity {
            kind,
            part,
            normalised_at: NormalisedAt::Excitation,
            basis: Basis::Energy,
            reference: Reference::SameGeometry,
            reference_light: ReferenceLight::Same,
            certified_factor: Vec::new(),
        }
    }

    fn cell(excitation_nm: f64, emission_nm: f64, width: f64) -> Cell {
        let emission_width = EmissionWidth::new(width).unwrap();
        Cell { excitation_nm, excitation_fwhm_nm: 5.0, emission_nm, emission_width }
    }

    #[test]
    fn a_matrix_holds_the_density_times_the_bandpass_and_not_the_step() {
        let density = quantity(DENSITY, Part::Luminescent);
        let there = donaldson_from_density(&density, &cell(400.0, 540.0, 8.0)).unwrap();
        assert_eq!((there.quantity.kind, there.factor), (QuantityKind::DonaldsonMatrix, 8.0));
        let back = density_from_donaldson(&there.quantity, &cell(400.0, 540.0, 8.0)).unwrap();
        assert_eq!((back.quantity, back.factor), (density, 0.125));
        // The total of a matrix is luminescent off its diagonal.
        let total = quantity(QuantityKind::DonaldsonMatrix, Part::Total);
        assert_eq!(density_from_donaldson(&total, &cell(400.0, 540.0, 8.0)).unwrap().quantity.part, Part::Luminescent);
    }

    #[test]
    fn the_diagonal_is_no_density() {
        let total = quantity(QuantityKind::DonaldsonMatrix, Part::Total);
        for emission in [400.0, 412.9, 387.1] {
            let refused = density_from_donaldson(&total, &cell(400.0, emission, 8.0));
            assert!(matches!(refused, Err(ConversionRefused::Diagonal { .. })), "{emission}");
        }
        assert!(density_from_donaldson(&total, &cell(400.0, 413.0, 8.0)).is_ok());
        let elastic = quantity(QuantityKind::DonaldsonMatrix, Part::Elastic);
        let refused = density_from_donaldson(&elastic, &cell(400.0, 540.0, 8.0));
        assert!(matches!(refused, Err(ConversionRefused::Part { found: Part::Elastic, .. })));
        let unknown = Cell { excitation_fwhm_nm: f64::NAN, ..cell(400.0, 540.0, 8.0) };
        assert!(matches!(density_from_donaldson(&total, &unknown), Err(ConversionRefused::Width(_))));
    }

    #[test]
    fn without_a_width_there_is_no_conversion() {
        for width in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(EmissionWidth::new(width), Err(ConversionRefused::Width(_))), "{width}");
        }
        let mut axis = WavelengthAxis::new(vec![500.0, 510.0], Bandpass::Unstated).unwrap();
        assert_eq!(EmissionWidth::of(&axis, 0), Err(ConversionRefused::BandpassUnstated));
        let stated = |fwhm_nm| Bandpass::Stated {
            fwhm_nm,
            shape: BandpassShape::Triangular,
            correction: BandpassCorrection::Uncorrected,
        };
        axis.bandpass = stated(vec![8.0]);
        assert_eq!(EmissionWidth::of(&axis, 1).unwrap().nm(), 8.0);
        axis.bandpass = stated(vec![8.0, 0.0]);
        assert_eq!(EmissionWidth::of(&axis, 1), Err(ConversionRefused::Width(0.0)));
        assert_eq!(EmissionWidth::of(&axis, 2), Err(ConversionRefused::BandpassUnstated));
    }

    #[test]
    fn a_reradiation_function_is_the_density_over_pi() {
        let density = quantity(DENSITY, Part::Luminescent);
        let there = brrdf_from_density(&density).unwrap();
        assert_eq!((there.quantity.kind, there.quantity.reference), (QuantityKind::Brrdf, Reference::None));
        let back = density_from_brrdf(&there.quantity).unwrap();
        assert_eq!(back.quantity, density);
        assert!((there.factor * back.factor - 1.0).abs() < 1e-15);
        let fixed = Reference::FixedGeometry { theta_i_deg: 0.0, theta_v_deg: 45.0 };
        let refused = brrdf_from_density(&Quantity { reference: fixed, ..density.clone() });
        assert!(matches!(refused, Err(ConversionRefused::Reference { .. })));
        let refused = brrdf_from_density(&Quantity { part: Part::Total, ..density.clone() });
        assert!(matches!(refused, Err(ConversionRefused::Part { .. })));
        assert!(matches!(density_from_brrdf(&density), Err(ConversionRefused::Kind { .. })));
        let unstated = Quantity { reference: Reference::Unstated, ..there.quantity };
        assert_eq!(density_from_brrdf(&unstated), Err(ConversionRefused::ReferenceUnstated));
    }
}
