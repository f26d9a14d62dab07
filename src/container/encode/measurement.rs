//! A measurement as a group that is complete in itself: values, uncertainty, flags and every coordinate.

use super::super::error::EncodeError;
use super::super::fields::{encode_attributes, encode_fields};
use super::super::layout::{self, name};
use super::super::tree::{Array, Data, Dataset, Group, Values};
use super::parts::{certified_factor, emission_axis, quantity, si_unit, value_flags};
use crate::dataset::{Acquisition, Derivation, DirectionTest, Excitation, Id, Measurement};
use crate::quantity::{BandpassCorrection, BandpassShape, Component, Geometry};

/// The group of a measurement, without its position.
pub(in super::super) fn encode_measurement(measurement: &Measurement) -> Result<Group, EncodeError> {
    measurement.check_shape().map_err(crate::dataset::DocumentError::from)?;
    let mut group = Group::default();
    group.optional_text(name::TITLE, measurement.title.as_ref())?;
    group.text(name::ROLE, measurement.role.name())?;
    group.optional_id(name::SAMPLE, measurement.sample.as_ref())?;
    group.optional_id(name::INSTRUMENT, measurement.instrument.as_ref())?;
    group.optional_id(name::WHITE_REFERENCE, measurement.white_reference.as_ref())?;
    encode_fields(&mut group, &measurement.conditions)?;
    group.index_scale(name::ACQUISITION, measurement.acquisitions.len());
    let emission = emission_axis(&mut group, &measurement.emission)?;
    rows(&mut group, &measurement.acquisitions)?;
    excitations(&mut group, &measurement.excitations)?;
    certified_factor(&mut group, &measurement.quantity, emission);
    values(&mut group, measurement, emission)?;
    components(&mut group, &measurement.uncertainty.components, emission)?;
    direction_tests(&mut group, &measurement.direction_tests);
    if let Some(derivation) = &measurement.derivation {
        group.groups.push((name::DERIVATION.to_owned(), derived_from(derivation)?));
    }
    Ok(group)
}

fn rows(group: &mut Group, rows: &[Acquisition]) -> Result<(), EncodeError> {
    let stated = rows.iter().map(|row| {
        let known = [
            row.geometry.is_some(),
            row.excitation.is_some(),
            row.time.is_some(),
            row.exposure_ms.is_some(),
            row.quality_code.is_some(),
        ];
        bits(known)
    });
    stated_fields(group, name::STATED, stated.collect(), &layout::ROW_FIELDS, name::ACQUISITION);
    angles(group, rows);
    let mut column = |name: &str, data: Data| {
        group.vector(name, data, name::ACQUISITION).unit("1");
    };
    column(name::EXCITATION, Data::U32(rows.iter().map(|row| row.excitation.unwrap_or(0)).collect()));
    column(name::ORDER, Data::U32(rows.iter().map(|row| row.order).collect()));
    column(name::REPEATS, Data::U32(rows.iter().map(|row| row.repeats).collect()));
    column(name::QUALITY_CODE, Data::I32(rows.iter().map(|row| row.quality_code.unwrap_or(0)).collect()));
    group
        .vector(name::EXPOSURE, optional_numbers(rows.iter().map(|row| row.exposure_ms)), name::ACQUISITION)
        .unit("ms")
        .long_name("integration time");
    if rows.iter().any(|row| row.time.is_some()) {
        let times = rows.iter().map(|row| row.time.as_deref().unwrap_or(""));
        group.texts(name::TIME, times, name::ACQUISITION)?.long_name("time of acquisition, RFC 3339");
    }
    Ok(())
}

fn angles(group: &mut Group, rows: &[Acquisition]) {
    type Angle = fn(&Geometry) -> f64;
    let columns: [(&str, &str, Angle); 4] = [
        (name::THETA_I, "polar angle of incidence, from the normal", |g| g.incidence.theta_deg()),
        (name::PHI_I, "azimuth of incidence, counter-clockwise from the mark", |g| g.incidence.phi_deg()),
        (name::THETA_V, "polar angle of viewing, from the normal", |g| g.viewing.theta_deg()),
        (name::PHI_V, "azimuth of viewing, counter-clockwise from the mark", |g| g.viewing.phi_deg()),
    ];
    for (name, long_name, angle) in columns {
        let data = optional_numbers(rows.iter().map(|row| row.geometry.as_ref().map(angle)));
        group.vector(name, data, name::ACQUISITION).unit("degree").long_name(long_name);
    }
}

fn excitations(group: &mut Group, states: &[Excitation]) -> Result<(), EncodeError> {
    if states.is_empty() {
        return Ok(());
    }
    group.index_scale(name::EXCITATION_STATE, states.len());
    let stated = states.iter().map(|state| {
        let known = [
            state.light.is_some(),
            state.wavelength_nm.is_some(),
            state.fwhm_nm.is_some(),
            state.filter.is_some(),
            state.polarisation.is_some(),
            state.actual_nm.is_some(),
            state.shape.is_some(),
            state.correction.is_some(),
        ];
        bits(known)
    });
    let axis = name::EXCITATION_STATE;
    stated_fields(group, name::EXCITATION_STATED, stated.collect(), &layout::EXCITATION_FIELDS, axis);
    group
        .vector(name::EXCITATION_WAVELENGTH, optional_numbers(states.iter().map(|state| state.wavelength_nm)), axis)
        .unit("nm")
        .long_name("nominal centre of the excitation in air");
    group
        .vector(name::EXCITATION_FWHM, optional_numbers(states.iter().map(|state| state.fwhm_nm)), axis)
        .unit("nm")
        .long_name("full width at half maximum of the excitation");
    let lights = states.iter().map(|state| state.light.as_ref().map_or("", Id::as_str));
    group.texts(name::EXCITATION_LIGHT, lights, axis)?;
    let filters = states.iter().map(|state| state.filter.as_deref().unwrap_or(""));
    group.texts(name::EXCITATION_FILTER, filters, axis)?;
    group
        .vector(name::EXCITATION_ACTUAL, optional_numbers(states.iter().map(|state| state.actual_nm)), axis)
        .unit("nm")
        .long_name("centre of the excitation as calibrated");
    let shapes = states.iter().map(|state| state.shape.map_or("", BandpassShape::name));
    group.texts(name::EXCITATION_SHAPE, shapes, axis)?;
    let corrections = states.iter().map(|state| state.correction.map_or("", BandpassCorrection::name));
    group.texts(name::EXCITATION_CORRECTION, corrections, axis)?;
    let polarisations = states.iter().map(|state| state.polarisation.as_deref().unwrap_or(""));
    group.texts(name::EXCITATION_POLARISATION, polarisations, axis)?;
    Ok(())
}

fn values(group: &mut Group, measurement: &Measurement, emission: &str) -> Result<(), EncodeError> {
    let axes = vec![name::ACQUISITION.to_owned(), emission.to_owned()];
    let shape = vec![measurement.values.nrows(), measurement.values.ncols()];
    let matrix = |data: Data| Dataset { axes: axes.clone(), ..Dataset::new(Array { shape: shape.clone(), data }) };
    let value = group.put(name::VALUE, matrix(Data::F64(Values::of_matrix(&measurement.values))));
    quantity(value, &measurement.quantity)?;
    let coordinates = [name::THETA_I, name::PHI_I, name::THETA_V, name::PHI_V].join(" ");
    value.checked_text(name::COORDINATES, &coordinates)?;
    let mut ancillary = vec![name::VALUE_FLAG];
    if measurement.uncertainty.standard.is_some() {
        ancillary.push(name::VALUE_U);
    }
    value.checked_text(name::ANCILLARY, &ancillary.join(" "))?;
    if let Some(standard) = &measurement.uncertainty.standard {
        let uncertainty = group.put(name::VALUE_U, matrix(Data::F64(Values::of_matrix(standard))));
        uncertainty
            .unit(measurement.quantity.kind.unit())
            .long_name("standard uncertainty (k = 1), independent between values");
        si_unit(uncertainty, measurement.quantity.kind);
        encode_attributes(&mut uncertainty.attributes, &measurement.uncertainty.statement)?;
    }
    group.put(name::VALUE_FLAG, matrix(Data::U16(Values::of_matrix(&measurement.flags))));
    value_flags(group);
    Ok(())
}

/// Uncertainty that values share, one vector for each cause.
fn components(group: &mut Group, components: &[Component], emission: &str) -> Result<(), EncodeError> {
    for (position, component) in components.iter().enumerate() {
        let name = format!("{}{position}", name::COMPONENT);
        let dataset = group.vector(&name, Data::F64(component.relative.clone().into()), emission);
        dataset.unit("1").long_name("relative standard uncertainty shared between values");
        dataset
            .checked_text(name::CAUSE, &component.name)?
            .checked_text(name::CORRELATED_OVER, component.correlated_over.name())?;
        encode_attributes(&mut dataset.attributes, &component.statement)?;
    }
    Ok(())
}

/// Directions of some rows a second time, as unit vectors.
fn direction_tests(group: &mut Group, tests: &[DirectionTest]) {
    if tests.is_empty() {
        return;
    }
    group.index_scale(name::DIRECTION_TEST, tests.len());
    group.index_scale(name::XYZ, 3);
    let rows = Data::U32(tests.iter().map(|test| test.row).collect());
    group.vector(name::DIRECTION_TEST_ROW, rows, name::DIRECTION_TEST).unit("1").long_name("row of the measurement");
    type Vector = fn(&DirectionTest) -> [f64; 3];
    let vectors: [(&str, &str, Vector); 2] = [
        (name::DIRECTION_TEST_INCIDENCE, "unit vector from the surface to the source", |test| test.incidence),
        (name::DIRECTION_TEST_VIEWING, "unit vector from the surface to the detector", |test| test.viewing),
    ];
    for (name, long_name, vector) in vectors {
        let data = Data::F64(tests.iter().flat_map(vector).collect());
        let axes = vec![name::DIRECTION_TEST.to_owned(), name::XYZ.to_owned()];
        let array = Array { shape: vec![tests.len(), 3], data };
        group.put(name, Dataset { axes, ..Dataset::new(array) }).unit("1").long_name(long_name);
    }
}

fn derived_from(derivation: &Derivation) -> Result<Group, EncodeError> {
    let mut group = Group::default();
    group.text(name::NUMERATOR, derivation.numerator.as_str())?;
    group.text(name::REFERENCE, derivation.reference.as_str())?;
    group.optional_id(name::DARK, derivation.dark.as_ref())?;
    for (name, rows) in [
        (name::NUMERATOR_ROW, &derivation.numerator_row),
        (name::REFERENCE_GROUP, &derivation.reference_group),
        (name::ROW_REFERENCE, &derivation.row_reference),
    ] {
        group.vector(name, Data::I32(rows.clone().into()), "").unit("1");
    }
    Ok(group)
}

/// A mask that says which optional fields are stated, in the words of CF.
fn stated_fields(group: &mut Group, name: &str, masks: Vec<u8>, fields: &[&str], axis: &str) {
    let all = Data::U8((0..fields.len()).map(|bit| 1 << bit).collect());
    group.vector(name, Data::U8(masks.into()), axis).flags(all, fields).long_name("which fields the source states");
}

fn bits<const N: usize>(known: [bool; N]) -> u8 {
    known.iter().enumerate().fold(0, |mask, (bit, known)| mask | (u8::from(*known) << bit))
}

/// NaN where nothing is stated; the mask beside it tells that from a stated NaN.
fn optional_numbers(numbers: impl Iterator<Item = Option<f64>>) -> Data {
    Data::F64(numbers.map(|number| number.unwrap_or(f64::NAN)).collect())
}
