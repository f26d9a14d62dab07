//! A fitted model: its terms and parameters, covariance, residuals, separability.

use super::super::error::EncodeError;
use super::super::layout::name;
use super::super::tree::{Array, Data, Dataset, Group};
use super::faithful;
use super::parts::emission_axis;
use crate::dataset::{Attachment, FittedParameter, FittedTerm, Model, Separability};

pub(super) fn model(model: &Model) -> Result<Group, EncodeError> {
    let mut group = Group::default();
    group.optional_text(name::TITLE, model.title.as_ref())?;
    group.text(name::MEASUREMENT, model.measurement.as_str())?;
    group.text(name::DATA_DIGEST, &model.data_digest)?;
    group.text(name::REDUCTION, &model.reduction)?;
    group.optional_text(name::MASK, model.mask.as_ref())?;
    group.text(name::REFERENCE, &faithful(name::REFERENCE, &model.reference)?)?;
    group.text(name::UNIT, &model.unit)?;
    group.text(name::METHOD, &model.method)?;
    group.attribute(name::CONVERGED, Data::U8(vec![u8::from(model.converged)].into()));
    group.attribute(name::RESIDUAL_RMS, Data::F64(vec![model.residuals.rms].into()));
    group.attribute(name::REDUCED_CHI_SQUARE, Data::F64(vec![model.residuals.reduced_chi_square].into()));
    group.attribute(name::RESIDUAL_COUNT, Data::U64(vec![model.residuals.count].into()));
    group.attribute(name::RESIDUAL_LEFT_OUT, Data::U64(vec![model.residuals.left_out].into()));
    let emission = emission_axis(&mut group, &model.emission)?;
    covariance(&mut group, model, emission)?;
    if !model.identifiability.is_empty() {
        group.texts(name::IDENTIFIABILITY, model.identifiability.iter().map(String::as_str), "")?;
    }
    for (position, fitted) in model.terms.iter().enumerate() {
        group.groups.push((format!("{}{position}", name::TERM), term(fitted)?));
    }
    for (position, fitted) in model.nuisances.iter().enumerate() {
        parameter(&mut group, &format!("{}{position}", name::NUISANCE), fitted)?;
    }
    if let Some(check) = &model.separability {
        group.groups.push((name::SEPARABILITY.to_owned(), separability(check, &model.unit)?));
    }
    if let Some(attached) = &model.donaldson {
        group.groups.push((name::DONALDSON.to_owned(), attachment(attached)?));
    }
    Ok(group)
}

fn attachment(attachment: &Attachment) -> Result<Group, EncodeError> {
    let mut group = Group::default();
    group.text(name::FACTORISATION, attachment.factorisation.as_str())?;
    group.text(name::ELASTIC, attachment.elastic.as_str())?;
    group.text(name::ELASTIC_DIGEST, &attachment.elastic_digest)?;
    group.text(name::LUMINESCENT, attachment.luminescent.as_str())?;
    group.text(name::LUMINESCENT_DIGEST, &attachment.luminescent_digest)?;
    group.text(name::REFLECTANCE, attachment.reflectance.name())?;
    if !attachment.consistency.is_empty() {
        group.texts(name::CONSISTENCY, attachment.consistency.iter().map(String::as_str), "")?;
    }
    Ok(group)
}

/// One table is a matrix; one per emission value has that axis before. Both axes of a table run over the same parameters, yet
/// have a scale each: CF forbids a dimension twice in one variable.
fn covariance(group: &mut Group, model: &Model, emission: &str) -> Result<(), EncodeError> {
    let (tables, rows, columns) = model.covariance.dim();
    group.index_scale(name::COVARIANCE_ROW, rows);
    group.index_scale(name::COVARIANCE_COLUMN, columns);
    let mut shape = vec![rows, columns];
    let mut axes = vec![name::COVARIANCE_ROW.to_owned(), name::COVARIANCE_COLUMN.to_owned()];
    if tables != 1 {
        shape.insert(0, tables);
        axes.insert(0, emission.to_owned());
    }
    let array = Array { shape, data: Data::F64(model.covariance.iter().copied().collect()) };
    group
        .put(name::COVARIANCE, Dataset { axes, ..Dataset::new(array) })
        .long_name("covariance of the parameters; the unit of an element is the product of the units of its two");
    let names = model.covariance_parameters.iter().map(String::as_str);
    group.texts(name::COVARIANCE_PARAMETERS, names, name::COVARIANCE_ROW)?;
    Ok(())
}

fn term(term: &FittedTerm) -> Result<Group, EncodeError> {
    let mut group = Group::default();
    group.text(name::KIND, term.kind.name())?;
    if let Some(distribution) = term.distribution {
        group.text(name::DISTRIBUTION, distribution.name())?;
    }
    if let Some(denominator) = term.denominator {
        group.text(name::DENOMINATOR, denominator.name())?;
    }
    for (position, fitted) in term.parameters.iter().enumerate() {
        parameter(&mut group, &format!("{}{position}", name::PARAMETER), fitted)?;
    }
    Ok(group)
}

fn parameter(group: &mut Group, name: &str, parameter: &FittedParameter) -> Result<(), EncodeError> {
    let value = group.vector(name, Data::F64(parameter.value.clone().into()), "");
    value.checked_text(name::PARAMETER_NAME, &parameter.name)?.checked_text(name::UNITS, &parameter.unit)?;
    value.checked_text(name::LONG_NAME, &parameter.name)?;
    let axis = format!("{name}{}", name::INDEX);
    let uncertainty = Data::F64(parameter.standard_uncertainty.clone().into());
    group
        .vector(&format!("{name}{}", name::SUFFIX_U), uncertainty, &axis)
        .checked_text(name::UNITS, &parameter.unit)?
        .long_name("standard uncertainty (k = 1) from independent errors");
    if !parameter.shared_relative_uncertainty.is_empty() {
        let shared = Data::F64(parameter.shared_relative_uncertainty.clone().into());
        group
            .vector(&format!("{name}{}", name::SUFFIX_SHARED), shared, &axis)
            .unit("1")
            .long_name("relative standard uncertainty from errors shared by all rows");
    }
    for (suffix, ends, meaning) in [
        (name::SUFFIX_LOW, &parameter.interval_low, "lower end of the 95 % interval, NaN where the data leave it open"),
        (
            name::SUFFIX_HIGH,
            &parameter.interval_high,
            "upper end of the 95 % interval, NaN where the data leave it open",
        ),
    ] {
        if !ends.is_empty() {
            group
                .vector(&format!("{name}{suffix}"), Data::F64(ends.clone().into()), &axis)
                .checked_text(name::UNITS, &parameter.unit)?
                .long_name(meaning);
        }
    }
    Ok(())
}

/// The means are in the unit of what was fitted.
fn separability(check: &Separability, unit: &str) -> Result<Group, EncodeError> {
    let mut group = Group::default();
    group.scale(name::THETA_I, &check.theta_i_deg, "degree", "signed in-plane angle of incidence");
    group.scale(name::THETA_V, &check.theta_v_deg, "degree", "signed in-plane angle of viewing");
    for (name, values, axis) in [
        (name::MEAN_OVER_VIEWING, &check.mean_over_viewing, name::THETA_I),
        (name::SPREAD_OVER_VIEWING, &check.spread_over_viewing, name::THETA_I),
        (name::MEAN_OVER_INCIDENCE, &check.mean_over_incidence, name::THETA_V),
        (name::SPREAD_OVER_INCIDENCE, &check.spread_over_incidence, name::THETA_V),
    ] {
        group.vector(name, Data::F64(values.clone().into()), axis).checked_text(name::UNITS, unit)?;
    }
    for (name, value) in [
        (name::COSINE_AMPLITUDE, check.cosine_amplitude),
        (name::COSINE_RELATIVE_RMS, check.cosine_relative_rms),
        (name::CONSTANCY_RELATIVE_RMS, check.constancy_relative_rms),
        (name::RANK_ONE_RELATIVE_RMS, check.rank_one_relative_rms),
    ] {
        group.attribute(name, Data::F64(vec![value].into()));
    }
    Ok(group)
}
