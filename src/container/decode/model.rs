//! A fitted model: its terms and parameters, covariance, residuals, separability.

use ndarray::{ArcArray, Ix3};

use super::super::error::ReadError;
use super::super::layout::name;
use super::parts::emission_axis;
use super::{At, dataset_text, numbers};
use crate::dataset::{Attachment, FittedParameter, FittedTerm, Id, Model, Residuals, Separability};

pub(super) fn model(id: Id, at: &At<'_>) -> Result<Model, ReadError> {
    let identifiability = at.group.dataset(name::IDENTIFIABILITY).map(|_| at.texts(name::IDENTIFIABILITY));
    Ok(Model {
        id,
        title: at.optional_text(name::TITLE)?,
        measurement: at.parsed(name::MEASUREMENT)?,
        data_digest: at.text(name::DATA_DIGEST)?,
        reduction: at.text(name::REDUCTION)?,
        mask: at.optional_text(name::MASK)?,
        reference: at.parsed(name::REFERENCE)?,
        unit: at.text(name::UNIT)?,
        emission: emission_axis(at)?,
        terms: at.numbered(name::TERM).map(|at| term(&at)).collect::<Result<_, _>>()?,
        nuisances: parameters(at, name::NUISANCE)?,
        covariance_parameters: at.texts(name::COVARIANCE_PARAMETERS)?,
        covariance: covariance(at)?,
        residuals: Residuals {
            rms: at.number(name::RESIDUAL_RMS)?,
            reduced_chi_square: at.number(name::REDUCED_CHI_SQUARE)?,
            count: at.integer(name::RESIDUAL_COUNT)?,
            left_out: at.integer(name::RESIDUAL_LEFT_OUT)?,
        },
        converged: at.truth(name::CONVERGED)?,
        method: at.text(name::METHOD)?,
        identifiability: identifiability.transpose()?.unwrap_or_default(),
        separability: at.child(name::SEPARABILITY).map(|at| separability(&at)).transpose()?,
        donaldson: at.child(name::DONALDSON).map(|at| attachment(&at)).transpose()?,
    })
}

fn attachment(at: &At<'_>) -> Result<Attachment, ReadError> {
    let consistency = at.group.dataset(name::CONSISTENCY).map(|_| at.texts(name::CONSISTENCY));
    Ok(Attachment {
        factorisation: at.parsed(name::FACTORISATION)?,
        elastic: at.parsed(name::ELASTIC)?,
        elastic_digest: at.text(name::ELASTIC_DIGEST)?,
        luminescent: at.parsed(name::LUMINESCENT)?,
        luminescent_digest: at.text(name::LUMINESCENT_DIGEST)?,
        reflectance: at.parsed(name::REFLECTANCE)?,
        consistency: consistency.transpose()?.unwrap_or_default(),
    })
}

fn covariance(at: &At<'_>) -> Result<ArcArray<f64, Ix3>, ReadError> {
    let (array, path) = (&at.dataset(name::COVARIANCE)?.array, at.member_path(name::COVARIANCE));
    let (tables, rows, columns) = match array.shape[..] {
        [rows, columns] => (1, rows, columns),
        [tables, rows, columns] => (tables, rows, columns),
        _ => {
            let found = format!("shape {:?}", array.shape);
            return Err(ReadError::unexpected(
                &path,
                found,
                "two axes, parameter and parameter, or emission before them",
            ));
        }
    };
    let values = numbers(&array.data, &path)?;
    let found =
        || ReadError::unexpected(&path, format!("{} values", values.len()), format!("{:?} values", array.shape));
    values.to_array((tables, rows, columns)).ok_or_else(found)
}

fn term(at: &At<'_>) -> Result<FittedTerm, ReadError> {
    Ok(FittedTerm {
        kind: at.parsed(name::KIND)?,
        distribution: at.optional_parsed(name::DISTRIBUTION)?,
        denominator: at.optional_parsed(name::DENOMINATOR)?,
        parameters: parameters(at, name::PARAMETER)?,
    })
}

/// Parameters by their number from 0.
fn parameters(at: &At<'_>, prefix: &str) -> Result<Vec<FittedParameter>, ReadError> {
    (0..)
        .map(|position: usize| format!("{prefix}{position}"))
        .take_while(|name| at.group.dataset(name).is_some())
        .map(|name| parameter(at, &name))
        .collect()
}

fn parameter(at: &At<'_>, name: &str) -> Result<FittedParameter, ReadError> {
    let (dataset, path) = (at.dataset(name)?, at.member_path(name));
    Ok(FittedParameter {
        name: dataset_text(dataset, name::PARAMETER_NAME, &path)?,
        unit: dataset_text(dataset, name::UNITS, &path)?,
        value: at.numbers(name)?,
        standard_uncertainty: at.numbers(&format!("{name}{}", name::SUFFIX_U))?,
        shared_relative_uncertainty: at.numbers_or_none(&format!("{name}{}", name::SUFFIX_SHARED))?,
        interval_low: at.numbers_or_none(&format!("{name}{}", name::SUFFIX_LOW))?,
        interval_high: at.numbers_or_none(&format!("{name}{}", name::SUFFIX_HIGH))?,
    })
}

fn separability(at: &At<'_>) -> Result<Separability, ReadError> {
    Ok(Separability {
        theta_i_deg: at.numbers(name::THETA_I)?,
        mean_over_viewing: at.numbers(name::MEAN_OVER_VIEWING)?,
        spread_over_viewing: at.numbers(name::SPREAD_OVER_VIEWING)?,
        theta_v_deg: at.numbers(name::THETA_V)?,
        mean_over_incidence: at.numbers(name::MEAN_OVER_INCIDENCE)?,
        spread_over_incidence: at.numbers(name::SPREAD_OVER_INCIDENCE)?,
        cosine_amplitude: at.number(name::COSINE_AMPLITUDE)?,
        cosine_relative_rms: at.number(name::COSINE_RELATIVE_RMS)?,
        constancy_relative_rms: at.number(name::CONSTANCY_RELATIVE_RMS)?,
        rank_one_relative_rms: at.number(name::RANK_ONE_RELATIVE_RMS)?,
    })
}
