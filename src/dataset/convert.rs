//! A measurement in another quantity, value by value, by the named conversions of `quantity::convert`.

use ndarray::Array2;

use super::{Id, Measurement};
use crate::quantity::{
    Basis, Cell, Conversion, ConversionRefused, EmissionAxis, EmissionWidth, Flag, Geometry, Quantity, QuantityKind,
    Reference, brdf_from_radiance_factor, brrdf_from_density, density_from_brrdf, density_from_donaldson,
    donaldson_from_density, radiance_factor_from_brdf, to_basis, to_fixed_geometry, to_same_geometry,
};

/// What to convert into.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Target {
    /// Another quantity.
    Kind(QuantityKind),
    /// Another reference of a factor.
    Reference(Reference),
    /// Energy or photons.
    Basis(Basis),
}

/// Why a measurement is not converted.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NotConverted {
    /// No named conversion leads from one to the other.
    #[error(
        "no conversion leads from `{from}` to `{into}`; there are: radiance-factor and brdf; \
         bispectral-luminescent-radiance-factor and donaldson-matrix; bispectral-luminescent-radiance-factor and brrdf"
    )]
    NoSuch {
        /// What the values are.
        from: QuantityKind,
        /// What was asked for.
        into: QuantityKind,
    },
    /// A conversion lacks something.
    #[error("row {row}, column {column}: {why}")]
    Refused {
        /// Row of the value.
        row: usize,
        /// Its column.
        column: usize,
        /// What it lacks.
        why: ConversionRefused,
    },
    /// A reference can be taken in the same geometry or in one geometry.
    #[error(
        "no conversion leads to the reference `{0}`; expected `same-geometry` or `fixed-geometry(theta_i,theta_v)`"
    )]
    Reference(Reference),
    /// A row has no geometry.
    #[error("row {0} has no geometry, and the conversion of a reference needs cos(theta_i)")]
    NoGeometry(usize),
    /// There is nothing to convert.
    #[error("it holds no values")]
    Empty,
}

/// A converted measurement.
#[derive(Debug, Clone, PartialEq)]
pub struct Converted {
    /// The measurement, under an id of its own.
    pub measurement: Measurement,
    /// How many values have no counterpart, because excitation and emission overlap there; they are not measured.
    pub without: usize,
}

/// Converts every value and its uncertainty; relative uncertainties that values share stay. A value where excitation and
/// emission overlap is reflected light in a Donaldson matrix and nothing in a density: there the result is NaN, flagged
/// `not-measured`.
///
/// # Errors
/// [`NotConverted`], where a conversion lacks what it needs for any other value.
pub fn convert(measurement: &Measurement, target: Target) -> Result<Converted, NotConverted> {
    let (rows, columns) = measurement.shape();
    let mut quantity: Option<Quantity> = None;
    let mut factors = Array2::from_elem((rows, columns), f64::NAN);
    let mut refused = None;
    for ((row, column), factor) in factors.indexed_iter_mut() {
        match conversion(measurement, target, row, column)? {
            Ok(conversion) => {
                *factor = conversion.factor;
                quantity.get_or_insert(conversion.quantity);
            }
            Err(why @ ConversionRefused::Diagonal { .. }) => refused = Some(NotConverted::Refused { row, column, why }),
            // What has no value loses none.
            Err(_) if measurement.values.get((row, column)).is_none_or(|value| value.is_nan()) => {}
            Err(why) => return Err(NotConverted::Refused { row, column, why }),
        }
    }
    let quantity = quantity.ok_or_else(|| refused.unwrap_or(NotConverted::Empty))?;
    let mut flags = measurement.flags.clone();
    let mut without = 0;
    for ((flag, factor), value) in flags.iter_mut().zip(&factors).zip(&measurement.values) {
        if factor.is_nan() && !value.is_nan() {
            *flag |= Flag::NotMeasured.bit();
            without += 1;
        }
    }
    let mut uncertainty = measurement.uncertainty.clone();
    uncertainty.standard =
        measurement.uncertainty.standard.as_ref().map(|standard| (standard * &factors).into_shared());
    let measurement = Measurement {
        id: Id::from_title(&format!("{}-{}", measurement.id, suffix(target))),
        quantity,
        values: (&measurement.values * &factors).into_shared(),
        flags,
        uncertainty,
        derivation: None,
        ..measurement.clone()
    };
    Ok(Converted { measurement, without })
}

/// What tells the converted measurement from the one that it was made of.
fn suffix(target: Target) -> String {
    match target {
        Target::Kind(kind) => kind.name().to_owned(),
        Target::Reference(Reference::FixedGeometry { theta_i_deg, theta_v_deg }) => {
            format!("fixed-{theta_i_deg}-{theta_v_deg}")
        }
        Target::Reference(reference) => reference.to_string(),
        Target::Basis(basis) => basis.name().to_owned(),
    }
}

type Answer = Result<Conversion, ConversionRefused>;

fn conversion(measurement: &Measurement, target: Target, row: usize, column: usize) -> Result<Answer, NotConverted> {
    let quantity = &measurement.quantity;
    match target {
        Target::Kind(into) => of_kind(measurement, into, row, column),
        Target::Basis(basis) => {
            let excited = excitation(measurement, row).map_or(f64::NAN, |(nm, _)| nm);
            let emitted = measurement.emission.wavelengths().and_then(|nm| nm.get(column).copied());
            Ok(to_basis(quantity, basis, excited, emitted.unwrap_or(f64::NAN)))
        }
        Target::Reference(Reference::SameGeometry) => Ok(to_same_geometry(quantity, geometry(measurement, row)?)),
        Target::Reference(Reference::FixedGeometry { theta_i_deg, theta_v_deg }) => {
            Ok(to_fixed_geometry(quantity, geometry(measurement, row)?, theta_i_deg, theta_v_deg))
        }
        Target::Reference(other) => Err(NotConverted::Reference(other)),
    }
}

fn of_kind(measurement: &Measurement, into: QuantityKind, row: usize, column: usize) -> Result<Answer, NotConverted> {
    use QuantityKind::{BispectralLuminescentRadianceFactor as Density, Brdf, Brrdf, DonaldsonMatrix, RadianceFactor};
    let quantity = &measurement.quantity;
    let by_cell = |convert: fn(&Quantity, &Cell) -> Answer| {
        cell(measurement, row, column).and_then(|cell| convert(quantity, &cell))
    };
    Ok(match (quantity.kind, into) {
        (RadianceFactor, Brdf) => brdf_from_radiance_factor(quantity),
        (Brdf, RadianceFactor) => radiance_factor_from_brdf(quantity),
        (Density, DonaldsonMatrix) => by_cell(donaldson_from_density),
        (DonaldsonMatrix, Density) => by_cell(density_from_donaldson),
        (Density, Brrdf) => brrdf_from_density(quantity),
        (Brrdf, Density) => density_from_brrdf(quantity),
        (from, into) => return Err(NotConverted::NoSuch { from, into }),
    })
}

fn geometry(measurement: &Measurement, row: usize) -> Result<&Geometry, NotConverted> {
    let acquisition = measurement.acquisitions.get(row);
    acquisition.and_then(|row| row.geometry.as_ref()).ok_or(NotConverted::NoGeometry(row))
}

/// Wavelength and width of a row's excitation, nm; NaN for a width that is not stated.
fn excitation(measurement: &Measurement, row: usize) -> Option<(f64, f64)> {
    let state = measurement.excitation_of(measurement.acquisitions.get(row)?)?;
    Some((state.centre_nm()?, state.fwhm_nm.unwrap_or(f64::NAN)))
}

fn cell(measurement: &Measurement, row: usize, column: usize) -> Result<Cell, ConversionRefused> {
    let EmissionAxis::Wavelengths(axis) = &measurement.emission else {
        return Err(ConversionRefused::BandpassUnstated);
    };
    let emission_width = EmissionWidth::of(axis, column)?;
    let (excitation_nm, excitation_fwhm_nm) =
        excitation(measurement, row).ok_or(ConversionRefused::Wavelength(f64::NAN))?;
    let emission_nm = axis.nm.get(column).copied().unwrap_or(f64::NAN);
    Ok(Cell { excitation_nm, excitation_fwhm_nm, emission_nm, emission_width })
}
