//! A bispectral measurement as a text of a matrix: `# key: value` lines, emission wavelengths along the first row,
//! excitation wavelengths along the first column. Importing the text gives the same values to the bit; what it cannot
//! hold is listed.

use std::io::Write;

use super::grid::Grid;
use super::table_csv::{head, number};
use crate::dataset::{Document, Measurement};
use crate::quantity::{Bandpass, BandpassShape, EmissionAxis};

/// Why a measurement is not written.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum MatrixError {
    /// It is no table over two wavelengths.
    #[error("measurement `{measurement}` cannot be a matrix: {why}; `--to csv` writes every measurement")]
    Refused {
        /// Which.
        measurement: String,
        /// Why.
        why: String,
    },
    /// The target took nothing.
    #[error("the file could not be written: {0}")]
    Write(#[from] std::io::Error),
}

/// Writes a measurement of a document, and returns what the text does not hold, one line each.
///
/// # Errors
/// [`MatrixError`] for rows without an excitation wavelength, two of one, and a band; and what the target reports.
pub fn write(
    document: &Document,
    measurement: &Measurement,
    target: &mut impl Write,
) -> Result<Vec<String>, MatrixError> {
    let refused = |why: String| MatrixError::Refused { measurement: measurement.id.to_string(), why };
    let grid = Grid::of(measurement).map_err(refused)?;
    for (name, value) in head::keys(document, measurement) {
        // A matrix has no column of uncertainties that a factor could belong to.
        if name != "coverage-factor" {
            writeln!(target, "# {name}: {value}")?;
        }
    }
    writeln!(target, "# rows: excitation")?;
    let line = |first: String, numbers: &mut dyn Iterator<Item = f64>| {
        std::iter::once(first).chain(numbers.map(number)).collect::<Vec<_>>().join(",")
    };
    writeln!(target, "{}", line("ex_nm\\em_nm".to_owned(), &mut grid.emission_nm.iter().copied()))?;
    for (row, nm) in grid.excitation_nm.iter().enumerate() {
        let mut values = (0..grid.emission_nm.len()).map(|column| grid.value(row, column));
        writeln!(target, "{}", line(number(*nm), &mut values))?;
    }
    Ok(lost(document, measurement, &grid))
}

fn lost(document: &Document, measurement: &Measurement, grid: &Grid<'_>) -> Vec<String> {
    let mut lost = grid.lost(document);
    let mut note = |is_lost: bool, what: String| lost.extend(is_lost.then_some(what));
    note(measurement.conditions.operator.is_some(), "the operator".to_owned());
    note(measurement.acquisitions.iter().any(|row| row.time.is_some()), "times".to_owned());
    note(measurement.quantity.certified_factor.len() > 1, "the certified factor of each wavelength".to_owned());
    let absent = measurement.values.iter().filter(|value| value.is_infinite()).count();
    note(absent > 0, format!("{absent} values that are not finite"));
    if let EmissionAxis::Wavelengths(axis) = &measurement.emission {
        note(!axis.actual_nm.is_empty(), "calibrated emission wavelengths".to_owned());
        if let Bandpass::Stated { fwhm_nm, shape, .. } = &axis.bandpass {
            note(fwhm_nm.len() > 1, format!("the bandpass of {} wavelengths", fwhm_nm.len()));
            note(*shape != BandpassShape::Unstated, "the shape of the bandpass".to_owned());
        }
    }
    let states = &measurement.excitations;
    let more = states.iter().any(|state| state.light.is_some() || state.fwhm_nm.is_some() || state.filter.is_some());
    let several = more && head::common_state(measurement).is_none();
    note(several, "lights, bandwidths and filters of the excitation: rows have different ones".to_owned());
    lost
}
