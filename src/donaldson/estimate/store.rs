//! An estimate as parts of a document: a matrix, and beside it the parts and the factors that a separation leaves.

use ndarray::Array2;

use super::super::store::{Parts, elastic, luminescent_part, named};
use super::{Axes, Estimate, Interval};
use crate::dataset::{Acquisition, Excitation, Factorisation, Id, Measurement, Role};
use crate::quantity::{
    Bandpass, BandpassCorrection, BandpassShape, Basis, EmissionAxis, Flag, NormalisedAt, Part, Quantity, QuantityKind,
    Uncertainty, WavelengthAxis, WavelengthError,
};

/// The matrix of an estimate: the total where excitation and emission are the same, luminescence above, no value below.
/// Its emission is as wide as a step: spectra are averaged from neighbour to neighbour.
///
/// # Errors
/// [`WavelengthError`] where the axes do not ascend.
pub fn matrix(axes: &Axes, found: &Estimate, id: Id) -> Result<Measurement, WavelengthError> {
    let bandpass = Bandpass::Stated {
        fwhm_nm: vec![axes.width_nm],
        shape: BandpassShape::Triangular,
        correction: BandpassCorrection::Uncorrected,
    };
    let emission = EmissionAxis::Wavelengths(WavelengthAxis::new(axes.emission_nm.clone(), bandpass)?);
    let quantity = Quantity {
        part: Part::Total,
        normalised_at: NormalisedAt::Excitation,
        basis: Basis::Energy,
        ..Quantity::unstated(QuantityKind::DonaldsonMatrix)
    };
    // Where excitation and emission are the same a cell holds both.
    let cell = |join: fn(&Interval, Option<&Interval>) -> f64| {
        Array2::from_shape_fn(found.luminescent.dim(), |(i, j)| {
            let is_reflected = (axes.excitation_nm[i] - axes.emission_nm[j]).abs() < 1e-6;
            if axes.emission_nm[j] < axes.excitation_nm[i] && !is_reflected {
                return f64::NAN;
            }
            join(&found.luminescent[(i, j)], is_reflected.then(|| &found.reflectance[j]))
        })
    };
    let value = |one: &Interval, other: Option<&Interval>| one.best + other.map_or(0.0, |other| other.best);
    let sigma = |one: &Interval, other: Option<&Interval>| one.sigma().hypot(other.map_or(0.0, Interval::sigma));
    let rows = (0_u32..).zip(&axes.excitation_nm);
    let rows = rows.map(|(order, _)| Acquisition { excitation: Some(order), ..Acquisition::at(None, order) });
    let mut measurement = Measurement::new(id, Role::Sample, quantity, emission, rows.collect(), cell(value));
    measurement.uncertainty = Uncertainty { standard: Some(cell(sigma).into_shared()), ..Uncertainty::default() };
    measurement.flags = below(axes).into_shared();
    let state = |nm: &f64| Excitation { wavelength_nm: Some(*nm), ..Excitation::default() };
    measurement.excitations = axes.excitation_nm.iter().map(state).collect();
    Ok(measurement)
}

/// What stands beside the matrix; `data_digest` is its digest, `lights` the names of those it was estimated under. `None` where it
/// has no emission wavelengths, which no estimate lacks.
#[must_use]
pub fn parts(
    measurement: &Measurement,
    axes: &Axes,
    found: &Estimate,
    lights: &[String],
    data_digest: &str,
) -> Option<Parts> {
    let EmissionAxis::Wavelengths(axis) = &measurement.emission else { return None };
    let best = |list: &[Interval]| list.iter().map(|interval| interval.best).collect::<Vec<f64>>();
    let sigma = |list: &[Interval]| list.iter().map(Interval::sigma).collect::<Vec<f64>>();
    let row = |numbers: Vec<f64>| Array2::from_shape_fn((1, numbers.len()), |(_, k)| numbers[k]).into_shared();
    let (reflectance, reflectance_sigma) = (best(&found.reflectance), sigma(&found.reflectance));
    let factorisation = Factorisation {
        id: named(measurement, "factors"),
        title: None,
        measurement: measurement.id.clone(),
        data_digest: data_digest.to_owned(),
        excitation_nm: axes.excitation_nm.clone(),
        emission: axis.clone(),
        excitation: row(best(&found.excitation)),
        excitation_u: row(sigma(&found.excitation)),
        emission_factor: row(best(&found.emission)),
        emission_factor_u: row(sigma(&found.emission)),
        elastic: reflectance.clone(),
        elastic_u: reflectance_sigma.clone(),
        reach_nm: axes.width_nm / 2.0,
        floor: f64::NAN,
        residual_rms: 0.0,
        residual_count: 0,
        method: format!(
            "estimated from spectra under {}; 95 % intervals over {} excitation spectra that fit, prior included: {}",
            lights.join(", "),
            found.shapes,
            found.prior
        ),
        findings: found.findings(axes),
    };
    let cells = |of: fn(&Interval) -> f64| {
        let is_below = below(axes);
        Array2::from_shape_fn(found.luminescent.dim(), |at| {
            if is_below[at] == 0 { of(&found.luminescent[at]) } else { f64::NAN }
        })
    };
    let flags = below(axes);
    Some(Parts {
        elastic: elastic(measurement, axis, &reflectance, &reflectance_sigma),
        luminescent: luminescent_part(measurement, cells(|one| one.best), cells(Interval::sigma), flags),
        factorisation,
    })
}

/// Nothing radiates below its excitation: such cells have no value, and nobody looked.
fn below(axes: &Axes) -> Array2<u16> {
    let shape = (axes.excitation_nm.len(), axes.emission_nm.len());
    Array2::from_shape_fn(shape, |(i, j)| {
        let is_below = axes.emission_nm[j] < axes.excitation_nm[i] - 1e-6;
        if is_below { Flag::NotMeasuredByDesign.bit() } else { 0 }
    })
}
