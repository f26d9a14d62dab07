//! A separation as parts of a document: beside the matrix, which stays as it is.

use ndarray::{Array2, Axis, s};

use super::{Matrix, Separated};
use crate::dataset::{Acquisition, Document, Factorisation, Id, Measurement, Step, is_same_part};
use crate::quantity::{
    Basis, EmissionAxis, Flag, NormalisedAt, Part, Quantity, QuantityKind, Uncertainty, WavelengthAxis,
};

/// The parts that a separation makes of a matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Parts {
    /// The elastic radiance factor, one row, under `ID-elastic`.
    pub elastic: Measurement,
    /// The luminescent matrix, rows as in the matrix, under `ID-luminescent`; estimates next to the diagonal are flagged
    /// `interpolated`.
    pub luminescent: Measurement,
    /// Its factors, under `ID-factors`.
    pub factorisation: Factorisation,
}

/// A part has the id already.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("there is a {what} `{id}` already")]
pub struct IdTaken {
    what: &'static str,
    id: Id,
}

impl Parts {
    /// True where a document has all these parts as they are.
    #[must_use]
    pub fn are_in(&self, document: &Document) -> bool {
        let is_there =
            |part: &Measurement| document.measurement(part.id.as_str()).is_some_and(|there| is_same_part(there, part));
        let factors = document.factorisation(self.factorisation.id.as_str());
        is_there(&self.elastic)
            && is_there(&self.luminescent)
            && factors.is_some_and(|there| is_same_part(there, &self.factorisation))
    }

    /// Puts the parts into their document, with the step that made them.
    ///
    /// # Errors
    /// [`IdTaken`].
    pub fn store(self, document: &mut Document) -> Result<(), IdTaken> {
        let Self { elastic, luminescent, factorisation } = self;
        for id in [&elastic.id, &luminescent.id] {
            if document.measurement(id.as_str()).is_some() {
                return Err(IdTaken { what: "measurement", id: id.clone() });
            }
        }
        if document.factorisation(factorisation.id.as_str()).is_some() {
            return Err(IdTaken { what: "factorisation", id: factorisation.id });
        }
        document.provenance.steps.push(Step::by_this_program(format!(
            "`{}` separated into `{}` and `{}`, with the factors `{}` (reflected light within {} nm of the excitation)",
            factorisation.measurement, elastic.id, luminescent.id, factorisation.id, factorisation.reach_nm
        )));
        document.measurements.extend([elastic, luminescent]);
        document.factorisations.push(factorisation);
        Ok(())
    }
}

/// The separation of a measurement as parts of its document; `data_digest` is the digest of the measurement. `None` where it
/// has no emission wavelengths, which no matrix lacks.
#[must_use]
pub fn parts(measurement: &Measurement, matrix: &Matrix, separated: &Separated, data_digest: &str) -> Option<Parts> {
    let EmissionAxis::Wavelengths(axis) = &measurement.emission else { return None };
    Some(Parts {
        elastic: elastic(measurement, axis, &separated.elastic, &separated.elastic_sigma),
        luminescent: luminescent(measurement, matrix, separated),
        factorisation: factorisation(measurement, matrix, axis, separated, data_digest),
    })
}

pub(super) fn named(measurement: &Measurement, what: &str) -> Id {
    Id::from_title(&format!("{}-{what}", measurement.id))
}

/// The elastic radiance factor of a matrix, one row.
pub(super) fn elastic(measurement: &Measurement, axis: &WavelengthAxis, elastic: &[f64], sigma: &[f64]) -> Measurement {
    let row = |numbers: &[f64]| Array2::from_shape_fn((1, numbers.len()), |(_, column)| numbers[column]);
    let geometry = measurement.acquisitions.first().and_then(|row| row.geometry);
    let same = measurement.acquisitions.iter().all(|row| row.geometry == geometry);
    let quantity = Quantity {
        kind: QuantityKind::RadianceFactor,
        part: Part::Elastic,
        normalised_at: NormalisedAt::Emission,
        // A ratio of light to light of one wavelength has no basis that could matter.
        basis: Basis::Energy,
        ..measurement.quantity.clone()
    };
    let values = row(elastic);
    let flags = values.mapv(|value| if value.is_nan() { Flag::NotMeasured.bit() } else { 0 });
    Measurement {
        title: measurement.title.as_ref().map(|title| format!("{title}: elastic part")),
        sample: measurement.sample.clone(),
        instrument: measurement.instrument.clone(),
        white_reference: measurement.white_reference.clone(),
        flags: flags.into_shared(),
        uncertainty: Uncertainty { standard: Some(row(sigma).into_shared()), ..measurement.uncertainty.clone() },
        conditions: measurement.conditions.clone(),
        ..Measurement::new(
            named(measurement, "elastic"),
            measurement.role,
            quantity,
            EmissionAxis::Wavelengths(axis.clone()),
            vec![Acquisition::at(geometry.filter(|_| same), 0)],
            values,
        )
    }
}

fn luminescent(measurement: &Measurement, matrix: &Matrix, separated: &Separated) -> Measurement {
    let mut values = measurement.values.to_owned();
    let mut sigma = Array2::from_elem(values.raw_dim(), f64::NAN);
    let mut flags = measurement.flags.to_owned();
    for (k, row) in matrix.rows.iter().enumerate() {
        values.slice_mut(s![*row, ..]).assign(&separated.luminescent.index_axis(Axis(0), k));
        sigma.slice_mut(s![*row, ..]).assign(&separated.luminescent_sigma.index_axis(Axis(0), k));
        for column in 0..matrix.emission_nm.len() {
            if separated.overlap.holds(matrix, k, column) {
                flags[(*row, column)] = Flag::Interpolated.bit();
            } else if separated.luminescent[(k, column)].is_nan() && flags[(*row, column)] == 0 {
                flags[(*row, column)] = Flag::NotMeasured.bit();
            }
        }
    }
    luminescent_part(measurement, values, sigma, flags)
}

/// The luminescent part of a matrix, cell by cell.
pub(super) fn luminescent_part(
    measurement: &Measurement,
    values: Array2<f64>,
    sigma: Array2<f64>,
    flags: Array2<u16>,
) -> Measurement {
    Measurement {
        id: named(measurement, "luminescent"),
        title: measurement.title.as_ref().map(|title| format!("{title}: luminescent part")),
        quantity: Quantity { part: Part::Luminescent, ..measurement.quantity.clone() },
        values: values.into_shared(),
        flags: flags.into_shared(),
        uncertainty: Uncertainty { standard: Some(sigma.into_shared()), ..measurement.uncertainty.clone() },
        derivation: None,
        ..measurement.clone()
    }
}

fn factorisation(
    measurement: &Measurement,
    matrix: &Matrix,
    axis: &WavelengthAxis,
    separated: &Separated,
    data_digest: &str,
) -> Factorisation {
    let factors = &separated.factors;
    let tried: Vec<String> = separated.tried.iter().map(|(rank, rms)| format!("{rank}: {rms:.3e}")).collect();
    Factorisation {
        id: named(measurement, "factors"),
        title: None,
        measurement: measurement.id.clone(),
        data_digest: data_digest.to_owned(),
        excitation_nm: matrix.excitation_nm.clone(),
        emission: axis.clone(),
        excitation: factors.excitation.to_shared(),
        excitation_u: factors.excitation_sigma.to_shared(),
        emission_factor: factors.emission.to_shared(),
        emission_factor_u: factors.emission_sigma.to_shared(),
        elastic: separated.elastic.clone(),
        elastic_u: separated.elastic_sigma.clone(),
        reach_nm: separated.overlap.reach_nm.iter().copied().fold(0.0, f64::max),
        floor: separated.floor.rms,
        residual_rms: factors.rms,
        residual_count: factors.count as u64,
        method: format!(
            "non-negative factors of the cells clear of reflected light, smooth where nothing else decides; residual r.m.s. by \
             the number of factors: {}",
            tried.join(", ")
        ),
        findings: separated.findings.clone(),
    }
}
