//! A measurement: rows, excitation states, values, uncertainty.

use ndarray::ArcArray2;

use super::super::error::ReadError;
use super::super::fields::{decode_attributes, decode_fields};
use super::super::layout::{self, name};
use super::super::tree::{Data, Values};
use super::parts::{emission_axis, quantity};
use super::{At, dataset_text, masks, numbers, parsed};
use crate::dataset::{Acquisition, Derivation, DirectionTest, Excitation, Id, Measurement};
use crate::quantity::{Component, Direction, DirectionError, Geometry, Statement, Uncertainty};

pub(super) fn measurement(id: Id, at: &At<'_>) -> Result<Measurement, ReadError> {
    let standard = at.group.dataset(name::VALUE_U);
    let uncertainty = Uncertainty {
        standard: standard.map(|_| matrix(at, name::VALUE_U, numbers)).transpose()?,
        statement: standard.map_or_else(
            || Ok(Statement::default()),
            |dataset| decode_attributes(&dataset.attributes, &at.member_path(name::VALUE_U)),
        )?,
        components: components(at)?,
    };
    Ok(Measurement {
        id,
        title: at.optional_text(name::TITLE)?,
        quantity: quantity(at)?,
        role: at.parsed(name::ROLE)?,
        sample: at.optional_parsed(name::SAMPLE)?,
        instrument: at.optional_parsed(name::INSTRUMENT)?,
        white_reference: at.optional_parsed(name::WHITE_REFERENCE)?,
        emission: emission_axis(at)?,
        excitations: excitations(at)?,
        acquisitions: rows(at)?,
        values: matrix(at, name::VALUE, numbers)?,
        flags: matrix(at, name::VALUE_FLAG, masks)?,
        uncertainty,
        conditions: decode_fields(at.group, &at.path, None)?,
        direction_tests: direction_tests(at)?,
        derivation: at.child(name::DERIVATION).map(|at| derivation(&at)).transpose()?,
    })
}

/// A matrix through a conversion of its values.
pub(super) fn matrix<T: Clone>(
    at: &At<'_>,
    name: &str,
    convert: impl Fn(&Data, &str) -> Result<Values<T>, ReadError>,
) -> Result<ArcArray2<T>, ReadError> {
    let (shape, data) = at.matrix(name)?;
    let path = at.member_path(name);
    let values = convert(data, &path)?;
    let found = || ReadError::unexpected(&path, format!("{} values", values.len()), format!("{shape:?} values"));
    values.to_matrix(shape).ok_or_else(found)
}

/// A column with one value for each row of the table it belongs to.
struct Table<'a, 'b> {
    at: &'b At<'a>,
    masks: Vec<u8>,
}

impl<'a, 'b> Table<'a, 'b> {
    fn new(at: &'b At<'a>, stated: &str) -> Result<Self, ReadError> {
        Ok(Self { at, masks: at.integers(stated)? })
    }

    fn complete<T>(&self, name: &str, column: Vec<T>) -> Result<Vec<T>, ReadError> {
        if column.len() == self.masks.len() {
            return Ok(column);
        }
        let (found, expected) = (format!("{} values", column.len()), format!("{} (one per row)", self.masks.len()));
        Err(ReadError::unexpected(&self.at.member_path(name), found, expected))
    }

    fn numbers(&self, name: &str) -> Result<Vec<f64>, ReadError> {
        self.complete(name, self.at.numbers(name)?)
    }

    fn integers<T: TryFrom<i128>>(&self, name: &str) -> Result<Vec<T>, ReadError> {
        self.complete(name, self.at.integers(name)?)
    }

    /// Texts; a column that nobody stated may be left out.
    fn texts(&self, name: &str, bit: usize) -> Result<Vec<String>, ReadError> {
        let stated = (0..self.masks.len()).any(|row| self.states(row, bit));
        if !stated && self.at.group.dataset(name).is_none() {
            return Ok(vec![String::new(); self.masks.len()]);
        }
        self.complete(name, self.at.texts(name)?)
    }

    fn states(&self, row: usize, bit: usize) -> bool {
        self.masks[row] & (1 << bit) != 0
    }

    fn stated<T: Clone>(&self, column: &[T], row: usize, bit: usize) -> Option<T> {
        if self.states(row, bit) { column.get(row).cloned() } else { None }
    }
}

pub(super) fn rows(at: &At<'_>) -> Result<Vec<Acquisition>, ReadError> {
    let table = Table::new(at, name::STATED)?;
    let angles = [name::THETA_I, name::PHI_I, name::THETA_V, name::PHI_V].map(|name| table.numbers(name));
    let [theta_i, phi_i, theta_v, phi_v] = angles;
    let angles = [theta_i?, phi_i?, theta_v?, phi_v?];
    let excitation: Vec<u32> = table.integers(name::EXCITATION)?;
    let order: Vec<u32> = table.integers(name::ORDER)?;
    let repeats: Vec<u32> = table.integers(name::REPEATS)?;
    let time = table.texts(name::TIME, 2)?;
    let exposure = table.numbers(name::EXPOSURE)?;
    let quality: Vec<i32> = table.integers(name::QUALITY_CODE)?;
    debug_assert_eq!(layout::ROW_FIELDS[2], name::TIME);
    (0..table.masks.len())
        .map(|row| {
            Ok(Acquisition {
                geometry: table.states(row, 0).then(|| geometry(at, &angles, row)).transpose()?,
                excitation: table.stated(&excitation, row, 1),
                order: order[row],
                repeats: repeats[row],
                time: table.stated(&time, row, 2),
                exposure_ms: table.stated(&exposure, row, 3),
                quality_code: table.stated(&quality, row, 4),
            })
        })
        .collect()
}

fn geometry(at: &At<'_>, [theta_i, phi_i, theta_v, phi_v]: &[Vec<f64>; 4], row: usize) -> Result<Geometry, ReadError> {
    let direction = |theta_deg: f64, phi_deg: f64, [theta, phi]: [&str; 2]| {
        Direction::from_degrees(theta_deg, phi_deg).map_err(|error| {
            let (column, angle, expected) = match error {
                DirectionError::Phi(_) => (phi, phi_deg, "an azimuth of 0 up to 360 degrees"),
                _ => (theta, theta_deg, "a polar angle of 0 to 90 degrees"),
            };
            ReadError::unexpected(&format!("{}[{row}]", at.member_path(column)), format!("{angle} degrees"), expected)
        })
    };
    Ok(Geometry {
        incidence: direction(theta_i[row], phi_i[row], [name::THETA_I, name::PHI_I])?,
        viewing: direction(theta_v[row], phi_v[row], [name::THETA_V, name::PHI_V])?,
    })
}

fn excitations(at: &At<'_>) -> Result<Vec<Excitation>, ReadError> {
    if at.group.dataset(name::EXCITATION_STATED).is_none() {
        return Ok(Vec::new());
    }
    let table = Table::new(at, name::EXCITATION_STATED)?;
    let lights = table.texts(name::EXCITATION_LIGHT, 0)?;
    let wavelengths = table.numbers(name::EXCITATION_WAVELENGTH)?;
    let widths = table.numbers(name::EXCITATION_FWHM)?;
    let filters = table.texts(name::EXCITATION_FILTER, 3)?;
    let polarisations = table.texts(name::EXCITATION_POLARISATION, 4)?;
    let actual = if at.group.dataset(name::EXCITATION_ACTUAL).is_some() {
        table.numbers(name::EXCITATION_ACTUAL)?
    } else {
        Vec::new()
    };
    let shapes = table.texts(name::EXCITATION_SHAPE, 6)?;
    let corrections = table.texts(name::EXCITATION_CORRECTION, 7)?;
    let shape_path = at.member_path(name::EXCITATION_SHAPE);
    let correction_path = at.member_path(name::EXCITATION_CORRECTION);
    let light_path = at.member_path(name::EXCITATION_LIGHT);
    (0..table.masks.len())
        .map(|row| {
            Ok(Excitation {
                light: table.stated(&lights, row, 0).map(|id| parsed(&id, &light_path)).transpose()?,
                wavelength_nm: table.stated(&wavelengths, row, 1),
                fwhm_nm: table.stated(&widths, row, 2),
                filter: table.stated(&filters, row, 3),
                polarisation: table.stated(&polarisations, row, 4),
                actual_nm: table.stated(&actual, row, 5),
                shape: table.stated(&shapes, row, 6).map(|name| parsed(&name, &shape_path)).transpose()?,
                correction: table
                    .stated(&corrections, row, 7)
                    .map(|name| parsed(&name, &correction_path))
                    .transpose()?,
            })
        })
        .collect()
}

fn components(at: &At<'_>) -> Result<Vec<Component>, ReadError> {
    let named = (0..).map(|position: usize| format!("{}{position}", name::COMPONENT));
    named
        .map_while(|name| at.group.dataset(&name).map(|dataset| (name, dataset)))
        .map(|(name, dataset)| {
            let path = at.member_path(&name);
            let over = dataset_text(dataset, name::CORRELATED_OVER, &path)?;
            Ok(Component {
                name: dataset_text(dataset, name::CAUSE, &path)?,
                relative: at.numbers(&name)?,
                correlated_over: parsed(&over, &format!("{path}@{}", name::CORRELATED_OVER))?,
                statement: decode_attributes(&dataset.attributes, &path)?,
            })
        })
        .collect()
}

fn direction_tests(at: &At<'_>) -> Result<Vec<DirectionTest>, ReadError> {
    if at.group.dataset(name::DIRECTION_TEST_ROW).is_none() {
        return Ok(Vec::new());
    }
    let rows: Vec<u32> = at.integers(name::DIRECTION_TEST_ROW)?;
    let vectors = |name: &str| {
        let vectors = matrix(at, name, numbers)?;
        if vectors.dim() == (rows.len(), 3) {
            return Ok(vectors);
        }
        let found = format!("shape {:?}", vectors.shape());
        Err(ReadError::unexpected(&at.member_path(name), found, format!("[{}, 3]", rows.len())))
    };
    let (incidence, viewing) = (vectors(name::DIRECTION_TEST_INCIDENCE)?, vectors(name::DIRECTION_TEST_VIEWING)?);
    let vector = |all: &ArcArray2<f64>, row: usize| [all[(row, 0)], all[(row, 1)], all[(row, 2)]];
    let tests = rows.iter().enumerate();
    Ok(tests
        .map(|(i, &row)| DirectionTest { row, incidence: vector(&incidence, i), viewing: vector(&viewing, i) })
        .collect())
}

fn derivation(at: &At<'_>) -> Result<Derivation, ReadError> {
    Ok(Derivation {
        numerator: at.parsed(name::NUMERATOR)?,
        numerator_row: at.integers(name::NUMERATOR_ROW)?,
        reference: at.parsed(name::REFERENCE)?,
        reference_group: at.integers(name::REFERENCE_GROUP)?,
        row_reference: at.integers(name::ROW_REFERENCE)?,
        dark: at.optional_parsed(name::DARK)?,
    })
}
