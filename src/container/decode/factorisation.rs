//! The factors of a Donaldson matrix.

use super::super::error::ReadError;
use super::super::layout::name;
use super::measurement::matrix;
use super::parts::wavelength_axis;
use super::{At, numbers};
use crate::dataset::{Factorisation, Id};

pub(super) fn factorisation(id: Id, at: &At<'_>) -> Result<Factorisation, ReadError> {
    let findings = at.group.dataset(name::IDENTIFIABILITY).map(|_| at.texts(name::IDENTIFIABILITY));
    let u = |name: &str| format!("{name}{}", name::SUFFIX_U);
    Ok(Factorisation {
        id,
        title: at.optional_text(name::TITLE)?,
        measurement: at.parsed(name::MEASUREMENT)?,
        data_digest: at.text(name::DATA_DIGEST)?,
        excitation_nm: at.numbers(name::WAVELENGTH_EXCITATION)?,
        emission: wavelength_axis(at)?,
        excitation: matrix(at, name::EXCITATION_FACTOR, numbers)?,
        excitation_u: matrix(at, &u(name::EXCITATION_FACTOR), numbers)?,
        emission_factor: matrix(at, name::EMISSION_FACTOR, numbers)?,
        emission_factor_u: matrix(at, &u(name::EMISSION_FACTOR), numbers)?,
        elastic: at.numbers(name::ELASTIC)?,
        elastic_u: at.numbers(&u(name::ELASTIC))?,
        reach_nm: at.number(name::REACH)?,
        floor: at.number(name::FLOOR)?,
        residual_rms: at.number(name::RESIDUAL_RMS)?,
        residual_count: at.integer(name::RESIDUAL_COUNT)?,
        method: at.text(name::METHOD)?,
        findings: findings.transpose()?.unwrap_or_default(),
    })
}
